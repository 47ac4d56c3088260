"""Runs on a real LocalCluster: killed workers, a restart, a poisoned shard."""

import os
import signal
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from dask.distributed import Client, LocalCluster

import hertzchain as hc
from hertzchain import distributed

SPEEDS = np.linspace(0.1, 1.0, 120)
MODULI = np.array([[200e9], [213e9]])


def cluster(workers: int = 2) -> LocalCluster:
    return LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None)


@pytest.fixture(scope="module")
def client():
    with cluster() as local, Client(local) as client:
        yield client


def same(found: hc.Ensemble, expected: hc.Ensemble) -> None:
    """Every number has the same bits."""
    assert found.shape == expected.shape and found.errors == expected.errors
    for name, column in found.columns.items():
        assert np.array_equal(column, expected[name], equal_nan=True), name


def test_a_run_on_workers_has_the_bits_of_one_in_process(small, client, tmp_path):
    parameters = {"young_modulus": MODULI}
    there = distributed.sweep(small, SPEEDS, parameters, folder=tmp_path / "there", client=client, shards=7)
    here = distributed.sweep(small, SPEEDS, parameters, folder=tmp_path / "here", shards=3)
    whole = hc.ensemble(small, SPEEDS, parameters)
    same(there.load(), whole)
    same(here.load(), whole)
    assert (there.shards, there.kept, there.poisoned) == (7, 0, {})
    again = distributed.sweep(small, SPEEDS, parameters, folder=tmp_path / "there", client=client, shards=7)
    assert again.kept == 7 and "7 of them kept" in repr(again)


def killed(folder: Path, client: Client, times: int) -> list[int]:
    """Kills a worker each time that another shard has appeared."""
    dead: list[int] = []
    seen = 0
    while len(dead) < times:
        parts = len(list(folder.glob("sweep-*.h5")))
        if parts > seen:
            seen = parts
            pids = set(client.run(os.getpid).values()) - set(dead)
            victim = pids.pop()
            os.kill(victim, signal.SIGKILL)
            dead.append(victim)
        time.sleep(0.02)
    return dead


def test_workers_killed_twice_lose_nothing_but_time(small, tmp_path):
    speeds = np.linspace(0.1, 1.0, 1500)
    with cluster() as local, Client(local) as client, Client(local) as watching:
        dead: list[int] = []
        killer = threading.Thread(target=lambda: dead.extend(killed(tmp_path, watching, 2)), daemon=True)
        killer.start()
        run = distributed.sweep(small, speeds, folder=tmp_path, client=client, shards=30)
        killer.join(timeout=60)
    assert len(dead) == 2 and run.poisoned == {}
    same(run.load(), hc.ensemble(small, speeds))


def test_a_run_goes_on_after_the_scheduler_was_lost(small, tmp_path):
    speeds = np.linspace(0.1, 1.0, 400)
    with cluster() as local, Client(local) as client:
        told: list[int] = []

        def enough(done: int) -> None:
            told.append(done)
            if len(told) == 3:
                raise ConnectionAbortedError("the scheduler is gone")

        with pytest.raises(ConnectionAbortedError):
            distributed.sweep(small, speeds, folder=tmp_path, client=client, shards=20, progress=enough)
    with cluster() as other, Client(other) as client:
        run = distributed.sweep(small, speeds, folder=tmp_path, client=client, shards=20)
    assert 3 <= run.kept
    same(run.load(), hc.ensemble(small, speeds))


def test_a_poisoned_shard_is_told_and_stops_nothing(small, client, tmp_path):
    speeds = SPEEDS.copy()
    speeds[5::10] = -1.0
    run = distributed.sweep(small, speeds, folder=tmp_path, client=client, shards=10)
    found = run.load()
    assert sorted(found.errors) == [(at,) for at in range(5, 120, 10)]
    same(found, hc.ensemble(small, speeds))


def test_a_campaign_on_workers_has_the_same_bytes(client, tmp_path):
    rig = hc.load(ROOT / "crates/rig/tests/small.toml")
    hc.campaign(rig, tmp_path / "here")
    run = distributed.campaign(rig, tmp_path / "there", client=client, shards=3)
    assert run.poisoned == {}
    files = {path.name: path.read_bytes() for path in (tmp_path / "here").glob("*.h5")}
    assert files == {path.name: path.read_bytes() for path in (tmp_path / "there").glob("*.h5")}


def test_what_makes_no_sense_is_refused_before_any_work(small, tmp_path):
    with pytest.raises(hc.OptionError, match="broadcast"):
        distributed.sweep(small, np.zeros(3), {"young_modulus": np.zeros(2)}, folder=tmp_path)
    with pytest.raises(hc.OptionError):
        distributed.sweep(small, SPEEDS, {"yung_modulus": 1.0}, folder=tmp_path)
    with pytest.raises(hc.OptionError, match="accuracy|1e-13"):
        distributed.sweep(small, SPEEDS, folder=tmp_path, accuracy=7.0)
