"""Sweeps, ensembles, campaigns and posteriors on a ``dask.distributed`` client, shard by shard.

``pip install hertzchain[dask]``. A shard is a part of a run, named by a hash of everything that its
numbers follow from; its bits depend neither on where nor when nor beside what it is computed.
Workers write shards as HDF5 files into a folder that all of them see; the scheduler hears of their
names alone. What is there and whole is not computed again: a run that was broken off goes on with
the same call. Without a client everything stays in this process.

>>> from dask.distributed import Client  # doctest: +SKIP
>>> with Client("scheduler:8786") as client:  # doctest: +SKIP
...     run = sweep(hc.preset("dry"), speeds, folder="run/", client=client)
>>> run.load().tof_incident_s  # doctest: +SKIP
"""

from __future__ import annotations

import os
import pickle
import socket
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import lru_cache, wraps
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from numpy.typing import ArrayLike

from . import _hertzchain as _native
from . import _options as options
from . import inference
from ._hertzchain import Experiment
from .errors import HertzchainError, InternalError, OptionError
from .experiment import opened
from .results import Ensemble, FitResult, Result
from .simulation import broadcast, gathered

if TYPE_CHECKING:
    from dask.distributed import Client, Future
    from typing_extensions import Unpack

    from ._keywords import EnsembleOptions

__all__ = ["DistributedResult", "campaign", "fit", "sweep"]

# Most shots of a shard: it takes seconds, of which a scheduler spends less than 2 %.
SHOTS_A_SHARD = 20_000
# Least shards for each thread of the workers, so that they end together although some are slower.
SHARDS_A_THREAD = 4
# Each is a file and a task of some ms.
MOST_SHARDS = 1_000_000
# Threads assumed of a cluster whose workers are yet to come.
UNKNOWN = 16
# Most points of the model in a batch.
POINTS = 32
# Shards submitted for each thread of the workers: enough that none waits.
AHEAD = 4
# How often a shard is computed again that raised something that is not ours: a disk may have been full.
RETRIES = 3
# Seconds between counts of the workers; they come and go.
LOOK_S = 5.0
GONE = "the cluster is gone: finished shards are in the folder, and the same call goes on with them"

Outcome = tuple[int, "bool | str"]
"""Number of a shard, and whether it was there before or why it failed."""
Task = Callable[..., Outcome]
Arguments = Callable[[int], tuple[Any, ...]]
Batches = list[tuple[str, list[list[float]]]]
"""Names and points."""


@dataclass(frozen=True, repr=False)
class DistributedResult(Result):
    """Outcome of a distributed run: a table of its shards; `load` returns its numbers.

    Attributes
    ----------
    folder : Path
        Where the shards are.
    shards : int
        How many the run has.
    kept : int
        Shards that were there before, whole.
    failed : dict of int to str
        Shards by number from 1 that could not be computed, and why; the rest is there.
    """

    _index = "shard"

    folder: Path
    shards: int
    kept: int
    failed: dict[int, str]
    _work: tuple[_native.Run, Experiment, tuple[int, ...], tuple[str, ...]] | None = None

    def load(self) -> Ensemble:
        """All shards put together: the bits of a run in one process.

        Returns
        -------
        Ensemble
            Columns of the run's shape in SI, NaN where there is no number; without widths, pulse speeds and durations.

        Raises
        ------
        OptionError
            Shards that are missing or damaged; a run without any time of flight; a campaign's.
        """
        if self._work is None:
            raise OptionError("recordings of a campaign are measured, not loaded: see hertzchain.measure")
        run, experiment, shape, names = self._work
        found = _native.gather(run, str(self.folder))
        return gathered(experiment, shape, names, {**found, "speed_m_s": run.speeds(), "values": run.values()})

    def _columns(self) -> dict[str, list[Any]]:
        numbers = list(range(1, self.shards + 1))
        return {"shard": numbers, "failed": [at in self.failed for at in numbers], "why": [self.failed.get(at, "") for at in numbers]}

    def _summary(self) -> tuple[str, dict[str, str]]:
        rows = {"shards": f"{self.shards}, {self.kept} of them kept"}
        return f"Distributed run in {self.folder}", rows | {f"shard {at} failed": why for at, why in self.failed.items()}


@lru_cache(maxsize=4)
def _read(path: str) -> tuple[Any, str]:
    """Work from its file, and its name here; a worker reads it once."""
    work = pickle.loads(Path(path).read_bytes())
    return work, work.name


def _opened(path: str, name: str) -> Any:
    """Work from its file, if it has the same bits here as where its name comes from."""
    work, own = _read(path)
    if own != name:
        raise OptionError(
            f"the worker on {socket.gethostname()} would compute other bits: the work named {name} is {own} there, by its "
            f"build of hertzchain and its instruction set ({_native.instruction_set()}); install one build everywhere, and name "
            "one instruction set for all machines in HERTZCHAIN_INSTRUCTION_SET"
        )
    return work


def _written(work: _native.Run | _native.Likelihood, folder: Path) -> str:
    """Writes work atomically; returns its file, by a name that no other work has."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder.resolve() / f"run-{work.name}.pickle"
    beside = path.with_name(f".{path.name}.{uuid4().hex}.part")
    beside.write_bytes(pickle.dumps(work))
    beside.replace(path)
    return str(path)


def _parts(most: int, least: int, client: Client | None) -> int:
    """Number of parts of work, at most ``most``, so that all threads of the workers have some."""
    threads = 0 if client is None else _cluster_threads(client) or UNKNOWN
    return max(1, least, min(most, SHARDS_A_THREAD * threads))


def _cut(folder: Path, name: str) -> int | None:
    """Number of shards of a run that has some in its folder already: it resumes with these."""
    found = [path.stem.rpartition("-of-")[2] for path in folder.glob(f"sweep-{name}-*-of-*.h5")]
    return int(max(found, key=found.count)) if found else None


def _shard(path: str, name: str, number: int, of: int, threads: int) -> Outcome:
    """Computes a shard of a sweep on a worker."""
    return _outcome_of(number, lambda: _opened(path, name).shard(number, of, str(Path(path).parent), threads))


def _series(experiment: Experiment, out: str, number: int, of: int, seed: int | None, threads: int) -> Outcome:
    """Runs a part of a campaign on a worker."""

    def is_stored() -> bool:
        how = options.text("campaign", {}, out=out, shard=f"{number}/{of}", seed=seed, threads=threads or None)
        done = _native.campaign(experiment, how, None)
        if done["failed"]:
            raise OptionError("; ".join(done["failed"]))
        return done["kept"] > 0 and done["run"] == 0

    return _outcome_of(number, is_stored)


def _outcomes(path: str, name: str, points: list[list[float]]) -> list[Any]:
    """Residuals of points on a worker."""
    return _opened(path, name).outcomes(points)


@options.with_options("distributed.sweep", "finished shards")
def sweep(
    experiment: Experiment | options.Path_,
    speed: ArrayLike | None = None,
    parameters: Mapping[str, ArrayLike] | None = None,
    *,
    folder: str | os.PathLike[str],
    client: Client | None = None,
    shards: int | None = None,
    progress: object = None,
    **how: Unpack[EnsembleOptions],
) -> DistributedResult:
    """Computes shots over arrays of speeds and of named numbers on a cluster.

    Shards, clusters and what they cost: docs/how-to/many-machines.md. All workers must have the build
    and the instruction set of the caller. A shard has the bits of ``hertzchain sweep --shard i/n``.

    Parameters
    ----------
    experiment, speed, parameters
        As for `hertzchain.ensemble`: speeds in m/s and numbers in SI, broadcast to one shape.
    folder : path
        Where shards go, seen by all workers under this name. The same folder
        again goes on where a run was broken off.
    shards : int, optional
        Parts of the run. When absent, as many as the folder has some of; else four for each
        thread of the workers, and no part of more than 20,000 shots.

    Returns
    -------
    DistributedResult
        ``load`` puts the shards together; failed ones are listed and stop nothing.

    Raises
    ------
    OptionError, ExperimentError
        Arrays and names that do not fit.
    ConnectionError
        The scheduler is gone: the same call resumes.
    """
    experiment = opened(experiment)
    speeds, named = broadcast(experiment, speed, parameters)
    run = _native.Run(experiment, speeds, list(named), list(named.values()), options.text("distributed.sweep", how))
    path = _written(run, Path(folder))
    if shards is None:
        shards = _cut(Path(folder), run.name) or _parts(speeds.size, -(-speeds.size // SHOTS_A_SHARD), client)
    of = options.count("shards", shards, 1, MOST_SHARDS)
    # A worker's threads compute a shard each; in this process all compute one (0).
    threads = options.count("threads", how.get("threads"), 1) or int(client is not None)
    with options.progress(progress, of, "shard") as update:
        kept, failed = _run_all(_shard, lambda number: (path, run.name, number, of, threads), of, client, update)
    return DistributedResult(Path(folder), of, kept, failed, (run, experiment, speeds.shape, tuple(named)))


@options.with_options(None, "finished shards")
def campaign(
    experiment: Experiment | options.Path_,
    out: str | os.PathLike[str],
    *,
    client: Client | None = None,
    shards: int | None = None,
    seed: int | None = None,
    progress: object = None,
) -> DistributedResult:
    """Runs a campaign's series on a cluster; recordings are the bytes of a run in one process.

    Series and their files: docs/explanation/rig.md; shards: docs/how-to/many-machines.md.

    Parameters
    ----------
    experiment, seed
        As for `hertzchain.campaign`.
    out : path
        Where recordings go, seen by all workers under this name.
    shards : int, optional
        Parts into which series are split. When absent, four for each thread of the workers,
        and no more than there are series; one without a client.

    Returns
    -------
    DistributedResult
        Shards that can't be computed are listed in it; the others' recordings are in the folder.

    Raises
    ------
    OptionError, ExperimentError
        As for `hertzchain.campaign`, where no shard can be run.
    ConnectionError
        The scheduler is gone: the same call resumes.
    """
    into = str(Path(out).resolve())
    experiment = opened(experiment)
    series = _native.campaign_series(experiment, options.text("campaign", {}, seed=seed))
    shards = _parts(series, 1, client) if shards is None else options.count("shards", shards, 1, MOST_SHARDS)
    threads = int(client is not None)
    with options.progress(progress, shards, "shard") as update:
        arguments = lambda at: (experiment, into, at, shards, seed, threads)
        kept, failed = _run_all(_series, arguments, shards, client, update)
    if len(failed) == shards:
        raise OptionError(next(iter(failed.values())))
    return DistributedResult(Path(out), shards, kept, failed)


@wraps(inference.fit)
def fit(*data: Any, **how: Any) -> FitResult:
    """As `hertzchain.fit`, with every curve computed (``direct``), on a cluster or in this process."""
    return inference.fit(*data, **{**how, "direct": True})


def fit_on(client: Client, likelihood: _native.Likelihood, folder: options.Path_ | None, points: int | None, update: Any) -> dict[str, Any]:
    """A fit whose residuals workers compute, in batches named by a hash of the problem and their points."""
    if folder is None:
        raise OptionError("a fit on a cluster needs a folder that all workers see")
    work = _written(likelihood, Path(folder).resolve()), likelihood.name
    return _native.fit_spread(likelihood, points or POINTS, _cluster_threads(client) or UNKNOWN, _batches(work, client), update)


def _outcome_of(number: int, kept: Callable[[], bool]) -> Outcome:
    """A shard's outcome; errors of input are returned and not retried, a full disk is raised."""
    try:
        return number, kept()
    except InternalError:
        raise
    except HertzchainError as error:
        return number, str(error)


def _run_all(task: Task, arguments: Arguments, of: int, client: Client | None, update: Any) -> tuple[int, dict[int, str]]:
    """Runs all shards; returns how many were there before, and why others failed."""
    kept, failed = 0, dict[int, str]()
    results = _in_process(task, arguments, of) if client is None else _on_workers(task, arguments, of, client)
    for number, outcome in results:
        if isinstance(outcome, str):
            failed[number] = outcome
        else:
            kept += outcome
        if update is not None:
            update(1)
    return kept, dict(sorted(failed.items()))


def _in_process(task: Task, arguments: Arguments, of: int) -> Iterator[Outcome]:
    for number in range(1, of + 1):
        try:
            outcome = task(*arguments(number))
        except Exception as error:  # as on a worker: reported, and the others go on
            outcome = number, f"{type(error).__name__}: {error}"
        yield outcome


def _on_workers(task: Task, arguments: Arguments, of: int, client: Client) -> Iterator[Outcome]:
    """Submits shards as others finish, so that a scheduler never has them all."""
    from dask.distributed import as_completed

    waiting = iter(range(1, of + 1))
    # Keys of this call alone: a scheduler that has a key does not compute it again.
    call = uuid4().hex
    numbers: dict[Any, int] = {}
    counted_at, room = -LOOK_S, AHEAD

    def submit() -> Iterator[Future]:
        nonlocal counted_at, room
        if time.monotonic() - counted_at > LOOK_S:
            counted_at, room = time.monotonic(), AHEAD * max(1, _cluster_threads(client))
        for number in islice(waiting, max(0, room - len(numbers))):
            key = f"hertzchain-shard-{call}-{number}-of-{of}"
            numbers[key] = number
            yield client.submit(task, *arguments(number), key=key, pure=False, retries=RETRIES)

    with _connected():
        running = as_completed(list(submit()))
        for future in running:
            # A worker died before its result was fetched: the shard is computed again.
            if future.status in ("lost", "pending"):
                running.add(future)
                continue
            number = numbers.pop(future.key)
            if future.status == "finished":
                yield future.result()
            elif future.status == "error":
                error = future.exception()
                yield number, f"{type(error).__name__}: {error}"
            else:
                raise ConnectionError(GONE)
            future.release()
            for following in submit():
                running.add(following)


@contextmanager
def _connected(*also: type[OSError]) -> Iterator[None]:
    """Raises `ConnectionError` where the scheduler dies: it may do so at any time."""
    from dask.distributed import CancelledError
    from distributed.comm import CommClosedError

    try:
        yield
    except (CommClosedError, CancelledError, *also) as error:
        raise ConnectionError(GONE) from error


def _cluster_threads(client: Client) -> int:
    """Threads of all workers."""
    # No worker's own error can come of this one, so any error is one of the connection.
    with _connected(OSError):
        return sum(client.nthreads().values())


def _batches(work: tuple[str, str], client: Client) -> Callable[[Batches], Callable[[float], Any]]:
    """The function that submits batches of points; it returns a function that waits for them."""
    from dask.distributed import TimeoutError, wait

    call = uuid4().hex

    def compute(named: Batches) -> Callable[[float], Any]:
        keys = ((f"hertzchain-batch-{call}-{name}", points) for name, points in named)
        with _connected():
            futures = [client.submit(_outcomes, *work, points, key=key, pure=False, retries=RETRIES) for key, points in keys]

        def waiting(seconds: float) -> Any:
            """Outcomes in order, or None if some are not finished."""
            try:
                with _connected():
                    wait(futures, timeout=seconds)
                    return client.gather(futures)
            except TimeoutError:
                return None

        return waiting

    return compute
