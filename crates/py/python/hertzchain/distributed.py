"""Sweeps, ensembles and campaigns on a ``dask.distributed`` client, shard by shard.

``pip install hertzchain[dask]``. A shard is a part of a run, named by a hash of
everything that its numbers follow from; its bits depend neither on where nor
when nor beside what it is computed. Workers write shards as HDF5 files into a
folder that all of them see; the scheduler hears of their names alone. What is
there and whole is not computed again: a run that was broken off goes on with the
same call. Without a client everything stays in this process.

>>> from dask.distributed import Client  # doctest: +SKIP
>>> with Client("scheduler:8786") as client:  # doctest: +SKIP
...     run = sweep(hc.preset("dry"), speeds, folder="run/", client=client)
>>> run.load().tof_incident_s  # doctest: +SKIP
"""

from __future__ import annotations

import os
import pickle
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from . import _hertzchain as _native
from . import _options as options
from ._hertzchain import Experiment
from ._table import lines
from .errors import HertzchainError, OptionError
from .results import Ensemble
from .shooting import broadcast, units_of

if TYPE_CHECKING:
    from dask.distributed import Client

__all__ = ["Distributed", "campaign", "sweep"]

SHOTS_A_SHARD = 20_000
"""So many that a shard takes seconds: what a scheduler spends on one is then below 2 %."""

AHEAD = 4
"""Shards handed out for each thread of the workers: enough that none waits."""

RETRIES = 3
"""How often a shard is computed again whose worker has died with it, or that raised."""


@dataclass(frozen=True)
class Distributed:
    """What a distributed run has done.

    Attributes
    ----------
    folder : Path
        Where the shards are.
    shards : int
        How many the run has.
    kept : int
        Shards that were there before, whole.
    poisoned : dict of int to str
        Shards by number from 1 that could not be computed, and why; the rest is there.
    """

    folder: Path
    shards: int
    kept: int
    poisoned: dict[int, str]
    _shape: tuple[int, ...] | None = None
    _experiment: Experiment | None = None
    _names: tuple[str, ...] = ()

    def load(self) -> Ensemble:
        """All shards put together: the bits of a run in one process.

        Raises
        ------
        OptionError
            Shards that are missing, damaged, or of several runs.
        """
        if self._shape is None or self._experiment is None:
            raise OptionError("recordings of a campaign are measured, not loaded: see hertzchain.measure")
        run = _opened(str(self.folder / RUN))
        found = _native.gather(str(self.folder))
        shape = self._shape
        columns = {name: column.reshape(shape) for name, column in found["columns"].items() if name != "speed_m_s"}
        values = run.values()
        return Ensemble(
            experiment=self._experiment.name,
            shape=shape,
            speed_m_s=run.speeds().reshape(shape),
            parameters={name: value.reshape(shape) for name, value in zip(self._names, values, strict=True)},
            columns=columns,
            errors={tuple(int(i) for i in np.unravel_index(at, shape)): why for at, why in found["errors"]},
            units=units_of(self._experiment, self._names),
            dimensionless=self._experiment.is_dimensionless,
        )

    def __repr__(self) -> str:
        rows = {"shards": f"{self.shards}, {self.kept} of them kept"}
        rows |= {f"shard {number} is poisoned": why for number, why in self.poisoned.items()}
        return lines(f"Distributed run in {self.folder}", rows)


RUN = "run.pickle"


@lru_cache(maxsize=2)
def _opened(path: str) -> _native.Run:
    """A run from its file; a worker reads it once."""
    return pickle.loads(Path(path).read_bytes())


def _written(run: _native.Run, folder: Path) -> str:
    """The run's file, whole or not at all."""
    folder.mkdir(parents=True, exist_ok=True)
    path, beside = folder / RUN, folder / f".{RUN}.{os.getpid()}"
    beside.write_bytes(pickle.dumps(run))
    beside.replace(path)
    _opened.cache_clear()
    return str(path.resolve())


def _shard(path: str, number: int, of: int) -> tuple[int, bool]:
    """Computes a shard on a worker; tells its number and whether it was there."""
    folder = str(Path(path).parent)
    return number, _native.shard(_opened(path), number, of, folder, 1, None)


def _series(experiment: Experiment, out: str, number: int, of: int, seed: int | None) -> tuple[int, bool]:
    done = _native.campaign(experiment, out, f"{number}/{of}", seed, 1, None)
    if done["failed"]:
        raise OptionError("; ".join(done["failed"]))
    return number, done["run"] == 0


Task = Callable[..., tuple[int, bool]]


def _run(
    task: Task, arguments: Callable[[int], tuple[Any, ...]], of: int, client: Client | None, name: str, tell: Any
) -> tuple[int, dict[int, str]]:
    """Runs all shards: how many were kept, and why others failed."""
    kept, poisoned = 0, dict[int, str]()
    results = _here(task, arguments, of) if client is None else _there(task, arguments, of, client, name)
    for number, outcome in results:
        if isinstance(outcome, str):
            poisoned[number] = outcome
        else:
            kept += outcome
        if tell is not None:
            tell(1)
    return kept, poisoned


def _here(task: Task, arguments: Callable[[int], tuple[Any, ...]], of: int) -> Iterator[tuple[int, bool | str]]:
    for number in range(1, of + 1):
        try:
            yield task(*arguments(number))
        except HertzchainError as error:
            yield number, str(error)


def _there(
    task: Task, arguments: Callable[[int], tuple[Any, ...]], of: int, client: Client, name: str
) -> Iterator[tuple[int, bool | str]]:
    """Hands shards out as workers finish others, so that a scheduler never has them all."""
    from dask.distributed import as_completed

    threads = sum(client.nthreads().values()) or 1
    waiting = iter(range(1, of + 1))
    numbers: dict[str, int] = {}

    def hand_out(number: int) -> Any:
        key = f"hertzchain-{name}-{number}-of-{of}"
        numbers[key] = number
        return client.submit(task, *arguments(number), key=key, pure=False, retries=RETRIES)

    first = [hand_out(number) for number, _ in zip(waiting, range(AHEAD * threads - 1), strict=False)]
    if (last := next(waiting, None)) is not None:
        first.append(hand_out(last))
    running = as_completed(first)
    for future in running:
        number = numbers.pop(future.key)
        if future.status == "finished":
            yield future.result()
        else:
            yield number, f"{type(error).__name__}: {error}" if (error := future.exception()) else str(future.status)
        future.release()
        if (following := next(waiting, None)) is not None:
            running.add(hand_out(following))


def sweep(
    experiment: Experiment,
    speed: ArrayLike | None = None,
    parameters: Mapping[str, ArrayLike] | None = None,
    *,
    folder: str | os.PathLike[str],
    client: Client | None = None,
    shards: int | None = None,
    accuracy: float | None = None,
    pick: options.Pick | None = None,
    rebound: bool = False,
    judges: Literal["each", "pilots"] = "each",
    progress: object = None,
) -> Distributed:
    """Computes shots over arrays of speeds and of named numbers on a cluster.

    Parameters
    ----------
    experiment, speed, parameters, accuracy, pick, rebound, judges
        As for `hertzchain.ensemble`.
    folder : path
        Where shards go, seen by all workers under this name. The same folder
        again goes on where a run was broken off.
    client : dask.distributed.Client, optional
        Everything stays in this process when absent.
    shards : int, optional
        Parts of the run; about 20,000 shots each when absent.
    progress : bool, bar or function, optional
        Told of shards.

    Returns
    -------
    Distributed
        ``load`` puts the shards together; poisoned ones are told and stop nothing.

    Raises
    ------
    OptionError, ExperimentError
        Arrays and names that do not fit.

    Notes
    -----
    All workers must have the same instruction set; a shard has the bits of
    ``hertzchain sweep --shard i/n``.
    """
    speeds, named = broadcast(experiment, speed, parameters)
    how = options.how(accuracy, None, None, None, pick, False)
    asked = {"options": how, "rebound": bool(rebound), "judges": judges, "threads": 0}
    table = np.ascontiguousarray([np.ravel(value) for value in named.values()], dtype=float).reshape(len(named), speeds.size)
    run = _native.Run(experiment, np.ravel(speeds), list(named), table, asked)
    path = _written(run, Path(folder))
    of = shards or max(1, -(-speeds.size // SHOTS_A_SHARD))
    update, bar = options.progress(progress, of, "shard")
    try:
        kept, poisoned = _run(_shard, lambda number: (path, number, of), of, client, run.name, update)
    finally:
        if bar is not None:
            bar.close()  # type: ignore[attr-defined]
    return Distributed(Path(folder), of, kept, poisoned, speeds.shape, experiment, tuple(named))


def campaign(
    experiment: Experiment,
    out: str | os.PathLike[str],
    *,
    client: Client | None = None,
    shards: int,
    seed: int | None = None,
    progress: object = None,
) -> Distributed:
    """Runs a campaign's series on a cluster; recordings are the bytes of a run in one process.

    Parameters
    ----------
    experiment, seed
        As for `hertzchain.campaign`.
    out : path
        Where recordings go, seen by all workers under this name.
    client : dask.distributed.Client, optional
        Everything stays in this process when absent.
    shards : int
        Parts into which series are dealt.

    Raises
    ------
    OptionError, ExperimentError
        As for `hertzchain.campaign`, where no shard can be run.
    """
    into = os.fspath(out)
    name = f"{Path(into).name}-{seed}"
    update, bar = options.progress(progress, shards, "shard")
    try:
        kept, poisoned = _run(_series, lambda number: (experiment, into, number, shards, seed), shards, client, name, update)
    finally:
        if bar is not None:
            bar.close()  # type: ignore[attr-defined]
    if len(poisoned) == shards:
        raise OptionError(next(iter(poisoned.values())))
    return Distributed(Path(out), shards, kept, poisoned)
