"""Runs on real clusters: killed workers, a killed scheduler, poisoned shards."""

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, pickled
from dask.distributed import Client, LocalCluster
from test_inference import noisy

import hertzchain as hc
from hertzchain import _hertzchain as _native
from hertzchain import distributed
from hertzchain.inference import csv

RIG = ROOT / "crates/sim/tests/small.toml"
PAGE = ROOT / "docs/how-to/many-machines.md"
SPEEDS = np.linspace(0.1, 1.0, 120)
MODULI = np.array([[200e9], [213e9]])


def cluster() -> LocalCluster:
    return LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)


@pytest.fixture(scope="module")
def client() -> Iterator[Client]:
    with cluster() as local, Client(local) as client:
        yield client


def same(found: hc.Ensemble, expected: hc.Ensemble) -> None:
    """Every number has the same bits."""
    assert found.shape == expected.shape and set(found.errors) == set(expected.errors)
    # A shard reports the place in the file beside the reason.
    assert all(found.errors[at].endswith(why) for at, why in expected.errors.items())
    assert set(found.columns) >= {"tof_incident_s", "tof_reflected_s", "wall_peak_n"}
    for name, column in found.columns.items():
        assert np.array_equal(column, expected[name], equal_nan=True), name


def recordings(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.glob("*.h5")}


def test_each_run_of_a_folder_loads_its_own_shards(dry, tmp_path):
    runs = [(speeds, distributed.sweep(dry, speeds, folder=tmp_path, shards=2)) for speeds in ([0.2, 0.5], [0.3, -1.0])]
    for speeds, run in runs:
        with np.testing.suppress_warnings() as quiet:
            quiet.filter(hc.ExperimentWarning)
            same(run.load(), hc.ensemble(dry, speeds))
    with pytest.warns(hc.ExperimentWarning, match="1 of 2 shots could not be computed"):
        runs[1][1].load()


def test_the_block_of_the_page_runs_on_a_cluster(client, tmp_path):
    (block,) = (text for text in PAGE.read_text(encoding="utf-8").split("```") if "dask.distributed" in text)
    code = block.removeprefix("python\n")
    for there, here in (("scheduler:8786", client.scheduler.address), ("/shared/run", f"{tmp_path}/run")):
        assert code.count(there) == 1, there
        code = code.replace(there, here)
    space = {"speeds": SPEEDS[:5], "moduli": MODULI}
    exec(code, space)
    same(space["found"], hc.ensemble(hc.preset("dry"), space["speeds"], {"young_modulus": MODULI}))


def test_a_run_on_workers_has_the_bits_of_one_in_process(small, client, tmp_path):
    parameters = {"young_modulus": MODULI}
    there = distributed.sweep(small, SPEEDS, parameters, folder=tmp_path / "there", client=client, shards=17)
    here = distributed.sweep(small, SPEEDS, parameters, folder=tmp_path / "here", shards=3)
    whole = hc.ensemble(small, SPEEDS, parameters)
    same(there.load(), whole)
    same(here.load(), whole)
    assert (there.shards, there.kept, there.failed) == (17, 0, {})
    again = distributed.sweep(small, SPEEDS, parameters, folder=tmp_path / "there", client=client, shards=17)
    assert again.kept == 17 and "17 of them kept" in repr(again)
    assert pickled(again) and not again.load().errors


def test_work_is_cut_so_that_every_thread_has_some(small, client, tmp_path):
    there = distributed.sweep(small, SPEEDS, folder=tmp_path / "there", client=client)
    assert there.shards == 4 * 2
    same(there.load(), hc.ensemble(small, SPEEDS))
    few = distributed.sweep(small, SPEEDS[:3], folder=tmp_path / "few", client=client)
    assert few.shards == 3
    alone = distributed.sweep(small, SPEEDS, folder=tmp_path / "alone")
    assert alone.shards == 1
    same(alone.load(), there.load())
    # With other workers, or none, a run goes on with the shards that it has.
    again = distributed.sweep(small, SPEEDS, folder=tmp_path / "there")
    assert (again.shards, again.kept) == (8, 8)


def test_many_shots_are_cut_by_workers_and_by_size(client):
    def parts(shots: int, client: Client | None) -> int:
        return distributed._parts(shots, -(-shots // distributed.SHOTS_A_SHARD), client)

    assert [parts(shots, client) for shots in (1, 5, 16_000, 1_000_000)] == [1, 5, 8, 50]
    assert [parts(shots, None) for shots in (1, 16_000, 1_000_000)] == [1, 1, 50]


def test_numbers_of_parts_that_are_none_are_refused(small, client, tmp_path):
    for shards in (0, -3, 2.5, True):
        with pytest.raises(hc.OptionError, match="shards"):
            distributed.sweep(small, SPEEDS, folder=tmp_path, client=client, shards=shards)
        with pytest.raises(hc.OptionError, match="shards"):
            distributed.campaign(hc.load(RIG), tmp_path, client=client, shards=shards)
    with pytest.raises(hc.OptionError, match="points"):
        distributed.fit(noisy("dry", 1), "dry", free="eta", folder=tmp_path, client=client, points=0)


def test_a_shard_is_computed_with_the_threads_asked_for(small, tmp_path, monkeypatch):
    asked: list[int] = []
    monkeypatch.setattr(distributed, "_shard", lambda path, name, number, of, threads: asked.append(threads) or (number, False))
    for how in ({}, {"threads": 2}):
        distributed.sweep(small, [0.5], folder=tmp_path, **how)
    assert asked == [0, 2]


def test_a_campaign_is_cut_by_its_series(client, tmp_path):
    rig = hc.load(RIG)
    series = _native.campaign_series(rig, "{}")
    run = distributed.campaign(rig, tmp_path / "there", client=client)
    assert run.shards == min(series, 8) and not run.failed
    assert distributed.campaign(rig, tmp_path / "here").shards == 1
    assert recordings(tmp_path / "there") == recordings(tmp_path / "here")
    assert len(recordings(tmp_path / "there")) == series


def test_shards_have_the_bytes_of_the_command_line(cli_shards, dry, client, tmp_path):
    distributed.sweep(dry, hc.sweep(dry, "0.2:1:12").speed_m_s, folder=tmp_path / "there", client=client, shards=2)
    assert recordings(tmp_path / "there") == cli_shards("--preset", "dry", "--speeds", "0.2:1:12")


@pytest.fixture
def cli_shards(tmp_path) -> Callable[..., dict[str, bytes]]:
    """Both halves of a sweep by the program."""
    from conftest import program

    def run(*options: str) -> dict[str, bytes]:
        for shard in ("1/2", "2/2"):
            command = [program(), "sweep", *options, "--shard", shard, "--out", tmp_path / "cli"]
            subprocess.run(command, check=True, capture_output=True)
        return recordings(tmp_path / "cli")

    return run


def killed(folder: Path, ending: str, pids: Callable[[], set[int]], times: int) -> list[int]:
    """Kills a worker each time that another file has appeared, with SIGKILL; reports when."""
    dead: list[int] = []
    files: list[int] = []
    while len(dead) < times:
        there = len(list(folder.glob(ending)))
        if there > (files[-1] if files else 0) and (alive := pids() - set(dead)):
            files.append(there)
            dead.append(alive.pop())
            os.kill(dead[-1], signal.SIGKILL)
        time.sleep(0.01)
    return files


def pids(local: LocalCluster) -> set[int]:
    """Processes of the workers that live."""
    return {nanny.pid for nanny in local.workers.values() if nanny.pid is not None}


@contextmanager
def killing(folder: Path, ending: str, local: LocalCluster) -> Iterator[list[int]]:
    """Two workers are killed meanwhile; how many files there were each time."""
    files: list[int] = []
    killer = threading.Thread(target=lambda: files.extend(killed(folder, ending, lambda: pids(local), 2)), daemon=True)
    killer.start()
    yield files
    killer.join(timeout=60)
    assert len(files) == 2


def test_workers_killed_twice_lose_nothing_but_time(small, tmp_path):
    speeds = np.linspace(0.1, 1.0, 600)
    with cluster() as local, Client(local) as client, killing(tmp_path, "sweep-*.h5", local) as files:
        run = distributed.sweep(small, speeds, folder=tmp_path, client=client, shards=30)
    assert run.failed == {} and files[1] < 30
    same(run.load(), hc.ensemble(small, speeds))


@pytest.mark.long
def test_a_campaign_whose_workers_are_killed_has_the_same_bytes(tmp_path):
    rig = hc.load(RIG)
    hc.campaign(rig, tmp_path / "here")
    with cluster() as local, Client(local) as client, killing(tmp_path / "there", "*.h5", local):
        run = distributed.campaign(rig, tmp_path / "there", client=client, shards=6)
    assert run.failed == {}
    assert recordings(tmp_path / "there") == recordings(tmp_path / "here")
    again = distributed.campaign(rig, tmp_path / "there", shards=6)
    assert again.kept == 6


@contextmanager
def processes(folder: Path) -> Iterator[tuple[Path, subprocess.Popen[bytes]]]:
    """A scheduler and two workers, each a process; the file that reports its address."""
    reported = folder / f"scheduler-{time.monotonic_ns()}.json"
    dask = [sys.executable, "-m", "dask"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": folder}
    scheduler = subprocess.Popen([*dask, "scheduler", "--port", "0", "--no-dashboard", "--scheduler-file", reported], **quiet)
    worker = [*dask, "worker", "--nthreads", "1", "--no-nanny", "--no-dashboard", "--scheduler-file", reported, "--death-timeout", "30"]
    workers = [subprocess.Popen(worker, **quiet) for _ in range(2)]
    try:
        yield reported, scheduler
    finally:
        for process in (scheduler, *workers):
            process.kill()
            process.wait()


@pytest.mark.long
def test_a_run_goes_on_after_its_scheduler_was_killed(small, tmp_path):
    speeds = np.linspace(0.1, 1.0, 480)
    folder = tmp_path / "run"
    with processes(tmp_path) as (reported, scheduler), Client(scheduler_file=reported, timeout=5) as client:
        done: list[int] = []

        def kill(shards: int) -> None:
            done.append(shards)
            if len(done) == 5:
                scheduler.kill()

        with pytest.raises(ConnectionError, match="the same call goes on"):
            distributed.sweep(small, speeds, folder=folder, client=client, shards=40, progress=kill)
    assert 5 <= len(list(folder.glob("sweep-*.h5"))) < 40
    with processes(tmp_path) as (reported, _), Client(scheduler_file=reported, timeout=5) as client:
        run = distributed.sweep(small, speeds, folder=folder, client=client, shards=40)
    assert 5 <= run.kept < 40
    same(run.load(), hc.ensemble(small, speeds))


def test_bad_parameters_are_told_and_stop_nothing(small, client, tmp_path):
    speeds = SPEEDS.copy()
    speeds[5::10] = -1.0
    moduli = np.where(np.arange(120) % 10 == 3, -1.0, 213e9)
    run = distributed.sweep(small, speeds, {"young_modulus": moduli}, folder=tmp_path, client=client, shards=10)
    found = run.load()
    assert sorted(found.errors) == [(at,) for at in range(120) if at % 10 in (3, 5)]
    same(found, hc.ensemble(small, speeds, {"young_modulus": moduli}))


@pytest.mark.parametrize("where", ["on workers", "in process"])
def test_a_poisoned_shard_is_told_and_stops_nothing(where, small, client, tmp_path):
    client = client if where == "on workers" else None
    speeds = np.linspace(0.1, 1.0, 60)
    clean = distributed.sweep(small, speeds, folder=tmp_path / "clean", shards=6)
    # A folder where the third shard's file should go: no worker can write it.
    third = next((tmp_path / "clean").glob("sweep-*-3-of-6.h5")).name
    (tmp_path / "run" / third).mkdir(parents=True)
    run = distributed.sweep(small, speeds, folder=tmp_path / "run", client=client, shards=6)
    assert list(run.failed) == [3] and "shard 3 failed" in repr(run)
    with pytest.raises(hc.OptionError, match=r"1 of 6 shards are missing"):
        run.load()
    (tmp_path / "run" / third).rmdir()
    mended = distributed.sweep(small, speeds, folder=tmp_path / "run", client=client, shards=6)
    assert mended.kept == 5 and mended.failed == {}
    same(mended.load(), clean.load())


def test_a_failing_series_of_a_campaign_is_reported_and_stops_nothing(client, tmp_path):
    rig = hc.load(RIG)
    hc.campaign(rig, tmp_path / "here")
    lost = sorted(recordings(tmp_path / "here"))[2]
    # A folder where its file should go: no worker can write it.
    (tmp_path / "there" / lost / "in the way").mkdir(parents=True)
    run = distributed.campaign(rig, tmp_path / "there", client=client, shards=6)
    (number,) = run.failed
    assert f"shard {number} failed" in repr(run) and lost in run.failed[number]
    written = {path.name: path.read_bytes() for path in (tmp_path / "there").glob("*.h5") if path.is_file()}
    assert written == {name: data for name, data in recordings(tmp_path / "here").items() if name != lost}
    (tmp_path / "there" / lost / "in the way").rmdir()
    (tmp_path / "there" / lost).rmdir()
    mended = distributed.campaign(rig, tmp_path / "there", client=client, shards=6)
    assert (mended.kept, mended.failed) == (5, {})
    assert recordings(tmp_path / "there") == recordings(tmp_path / "here")


@pytest.mark.long
def test_a_campaign_goes_on_after_its_scheduler_was_killed(tmp_path):
    rig = hc.load(RIG)
    hc.campaign(rig, tmp_path / "here")
    with processes(tmp_path) as (reported, scheduler), Client(scheduler_file=reported, timeout=5) as client:
        with pytest.raises(ConnectionError, match="the same call goes on"):
            distributed.campaign(rig, tmp_path / "there", client=client, shards=6, progress=lambda _: scheduler.kill())
    assert recordings(tmp_path / "there")
    with processes(tmp_path) as (reported, _), Client(scheduler_file=reported, timeout=5) as client:
        run = distributed.campaign(rig, tmp_path / "there", client=client, shards=6)
    assert run.kept >= 1 and run.failed == {}
    assert recordings(tmp_path / "there") == recordings(tmp_path / "here")


def test_warnings_come_back_from_shards(client, tmp_path):
    pump, speeds = hc.preset("pump"), np.array([0.5, 0.1, 0.05, 0.6])
    run = distributed.sweep(pump, speeds, folder=tmp_path, client=client, shards=2)
    with pytest.warns(hc.ExperimentWarning, match="Poisson ratio"):
        found = run.load()
    with pytest.warns(hc.ExperimentWarning):
        whole = hc.ensemble(pump, speeds)
    assert found.warnings == whole.warnings and found.warnings is not None


@contextmanager
def other_instructions(client: Client) -> Iterator[None]:
    """Workers take vector instructions that this process does not."""
    variable = "HERTZCHAIN_INSTRUCTION_SET"
    other = next(name for name in ("sse2", "avx2") if name != hc.instruction_set())
    client.run(lambda: os.environ.update({variable: other}))
    try:
        yield
    finally:
        client.run(lambda: os.environ.pop(variable))


@pytest.mark.long
def test_a_worker_that_would_compute_other_bits_is_told_and_computes_nothing(small, posterior, client, tmp_path):
    data, how, _ = posterior
    with other_instructions(client):
        run = distributed.sweep(small, SPEEDS, folder=tmp_path, client=client, shards=2)
        with pytest.raises(hc.OptionError, match="HERTZCHAIN_INSTRUCTION_SET"):
            distributed.fit(data, folder=tmp_path / "fit", client=client, **how)
    assert list(run.failed) == [1, 2] and all("HERTZCHAIN_INSTRUCTION_SET" in why for why in run.failed.values())
    assert not recordings(tmp_path)
    assert distributed.sweep(small, SPEEDS, folder=tmp_path / "right", client=client, shards=2).failed == {}


@pytest.fixture(scope="module")
def posterior(tmp_path_factory) -> tuple[dict[str, np.ndarray], dict[str, object], hc.FitResult]:
    """Data, options, and the fit in this process, every curve computed."""
    row = hc.preset("dry").set({"beads[0].count": 10.0})
    data = noisy("dry", 1)
    how = {"free": "eta,B", "method": "posterior", "steps": 60, "seed": 4, "tof_error": 1e-6}
    return data, {"model": row, **how}, hc.fit(data, row, direct=True, **how)


@pytest.mark.long
def test_a_posterior_on_workers_has_the_bits_of_one_in_process(posterior, client, tmp_path):
    data, how, here = posterior
    there = distributed.fit(data, folder=tmp_path / "there", client=client, **how)
    assert there.details == here.details
    alone = distributed.fit(data, folder=tmp_path / "alone", **how)
    assert alone.details == here.details
    chains = [(tmp_path / name / "chain.json").read_bytes() for name in ("there", "alone")]
    assert chains[0] == chains[1]


@pytest.mark.long
def test_a_posterior_whose_workers_are_killed_has_the_same_bits(posterior, tmp_path):
    data, how, here = posterior
    with cluster() as local, Client(local) as client:
        done: list[int] = []
        dead: dict[int, int] = {}

        def kill(curves: int) -> None:
            """One worker after some hundred curves, another after some hundred more."""
            done.append(curves)
            if len(dead) < 2 and sum(done) > 500 * (len(dead) + 1) and (alive := pids(local) - set(dead)):
                os.kill(pid := alive.pop(), signal.SIGKILL)
                dead[pid] = sum(done)

        there = distributed.fit(data, folder=tmp_path, client=client, progress=kill, **how)
    # In mid-run: curves came before and after each.
    assert len(dead) == 2 and all(500 < curves < sum(done) - 500 for curves in dead.values())
    assert there.details == here.details


@pytest.mark.long
def test_a_posterior_goes_on_after_its_scheduler_was_killed(posterior, tmp_path):
    data, how, here = posterior
    folder = tmp_path / "fit"
    distributed.fit(data, folder=folder, **{**how, "steps": 20})
    saved = (folder / "chain.json").read_bytes()
    with processes(tmp_path) as (reported, scheduler), Client(scheduler_file=reported, timeout=5) as client:
        with pytest.raises(ConnectionError, match="the same call goes on"):
            distributed.fit(data, folder=folder, client=client, progress=lambda _: scheduler.kill(), **how)
        # no user is there from the beginning.
        with pytest.raises(ConnectionError, match="the same call goes on"):
            distributed.fit(data, folder=folder, client=client, **how)
    assert (folder / "chain.json").read_bytes() == saved
    with processes(tmp_path) as (reported, _), Client(scheduler_file=reported, timeout=5) as client:
        again = distributed.fit(data, folder=folder, client=client, **how)
    assert again.details["posterior"] == here.details["posterior"]


@pytest.mark.long
def test_a_poisoned_point_of_a_batch_is_told_and_changes_no_other(posterior, client, tmp_path):
    data, how, here = posterior
    best = [parameter.value for parameter in here.parameters.values()]
    likelihood = _native.Likelihood(("data", csv(data)), how["model"], '{"free": ["eta", "B"], "tof_error": 1e-6}')
    path = distributed._written(likelihood, tmp_path)
    points = [best, [float("nan"), 77.0], [-1e300, 77.0], best]

    def there(points: list[list[float]]) -> list[object]:
        return client.submit(distributed._outcomes, path, likelihood.name, points, pure=False).result()

    first, *poisoned, last = there(points)
    assert all(isinstance(why, str) and why for why in poisoned)
    assert [first] == [last] == there([best]) == likelihood.outcomes([best])


@pytest.mark.long
def test_a_poisoned_batch_ends_the_fit_and_says_why(posterior, client, tmp_path, monkeypatch):
    data, how, here = posterior

    def gone(work, folder):
        """As if no worker saw the folder."""
        return str(folder / "nowhere.pickle")

    with monkeypatch.context() as broken:
        broken.setattr(distributed, "_written", gone)
        with pytest.raises(hc.OptionError, match=r"nowhere\.pickle"):
            distributed.fit(data, folder=tmp_path, client=client, **how)
    assert distributed.fit(data, folder=tmp_path, client=client, **how).details == here.details


@pytest.mark.long
def test_a_posterior_goes_on_where_its_chain_stands(posterior, client, tmp_path):
    data, how, here = posterior
    distributed.fit(data, folder=tmp_path, client=client, **{**how, "steps": 20})
    assert distributed.fit(data, folder=tmp_path, client=client, **how).details["posterior"] == here.details["posterior"]
    other = {**data, "tof_incident_s": 1.1 * data["tof_incident_s"]}
    with pytest.raises(hc.OptionError, match="resume"):
        distributed.fit(other, folder=tmp_path, client=client, **how)


def test_what_makes_no_sense_is_refused_before_any_work(small, client, tmp_path):
    with pytest.raises(hc.OptionError, match="broadcast"):
        distributed.sweep(small, np.zeros(3), {"young_modulus": np.zeros(2)}, folder=tmp_path, client=client)
    with pytest.raises(hc.OptionError):
        distributed.sweep(small, SPEEDS, {"yung_modulus": 1.0}, folder=tmp_path, client=client)
    with pytest.raises(hc.OptionError, match="accuracy|1e-13"):
        distributed.sweep(small, SPEEDS, folder=tmp_path, client=client, accuracy=7.0)
    with pytest.raises(hc.OptionError, match="nothing is free"):
        distributed.fit(noisy("dry", 1), free=[], folder=tmp_path, client=client)
