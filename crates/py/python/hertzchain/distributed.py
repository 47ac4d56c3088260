"""Sweeps, ensembles, campaigns and posteriors on a ``dask.distributed`` client, shard by shard.

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
import socket
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal
from uuid import uuid4

import numpy as np
from numpy.typing import ArrayLike

from . import _dask
from . import _hertzchain as _native
from . import _options as options
from ._hertzchain import Experiment
from ._posing import FitOptions, assumed, kept, modelled, table, words
from ._table import Tabled, lines, warned
from .curves import Ensemble, Odd
from .errors import OptionError
from .inferred import Fitted
from .inferring import fitted
from .shooting import broadcast, units_of

if TYPE_CHECKING:
    from dask.distributed import Client
    from typing_extensions import Unpack

__all__ = ["Distributed", "campaign", "fit", "sweep"]

SHOTS_A_SHARD = 20_000
"""Most shots of a shard: so many that it takes seconds, and a scheduler spends less than 2 % on it."""

SHARDS_A_THREAD = 4
"""Shards for each thread of the workers, or more: they end together although some are slower."""

MOST_SHARDS = 1_000_000
"""Each is a file and a task of some ms."""

UNKNOWN = 16
"""Threads that a cluster is taken to have whose workers are yet to come."""

@dataclass(frozen=True, repr=False)
class Distributed(Tabled):
    """What a distributed run has done: a table of its shards; its numbers are what `load` gives.

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

    References
    ----------
    Shards, their names and what becomes of those that fail: docs/across-machines.md.
    """

    _index = "shard"

    folder: Path
    shards: int
    kept: int
    poisoned: dict[int, str]
    _run: _native.Run | None = None
    _experiment: Experiment | None = None
    _shape: tuple[int, ...] = ()
    _names: tuple[str, ...] = ()

    def load(self) -> Ensemble:
        """All shards put together: the bits of a run in one process.

        Returns
        -------
        Ensemble
            Columns of the run's shape in SI, NaN where there is no number.

        Raises
        ------
        OptionError
            Shards that are missing, damaged, or of several runs; a campaign's.

        Warns
        -----
        ExperimentWarning
            What is odd about the first such shot, and of how many; it is in ``Ensemble.odd``.
        """
        if self._run is None or self._experiment is None:
            raise OptionError("recordings of a campaign are measured, not loaded: see hertzchain.measure")
        run = self._run
        found = _native.gather(str(self.folder))
        shape = self._shape
        columns = {name: column.reshape(shape) for name, column in found["columns"].items() if name != "speed_m_s"}
        values = run.values()
        odd = Odd.of(found["odd"], shape)
        if odd is not None:
            warned(odd.lines, odd.shots)
        return Ensemble(
            experiment=self._experiment.name,
            shape=shape,
            speed_m_s=run.speeds().reshape(shape),
            parameters={name: value.reshape(shape) for name, value in zip(self._names, values, strict=True)},
            columns=columns,
            errors={tuple(int(i) for i in np.unravel_index(at, shape)): why for at, why in found["errors"]},
            units=units_of(self._experiment, self._names),
            odd=odd,
            dimensionless=self._experiment.is_dimensionless,
        )

    def _columns(self) -> dict[str, list[Any]]:
        numbers = list(range(1, self.shards + 1))
        why = [self.poisoned.get(number, "") for number in numbers]
        return {"shard": numbers, "poisoned": [bool(said) for said in why], "why": why}

    def __repr__(self) -> str:
        rows = {"shards": f"{self.shards}, {self.kept} of them kept"}
        rows |= {f"shard {number} is poisoned": why for number, why in self.poisoned.items()}
        return lines(f"Distributed run in {self.folder}", rows)


@lru_cache(maxsize=4)
def _read(path: str) -> tuple[Any, str]:
    """What is to be computed, from its file, and its name here; a worker reads it once."""
    work = pickle.loads(Path(path).read_bytes())
    return work, work.name


def _opened(path: str, name: str) -> Any:
    """What is to be computed, if it has the same bits here as where its name comes from."""
    work, own = _read(path)
    if own != name:
        raise OptionError(
            f"the worker on {socket.gethostname()} would compute other bits: what it was sent as {name} is {own} there, by its "
            f"build of hertzchain and its instruction set ({_native.instruction_set()}); install one build everywhere, and name "
            "one instruction set for all machines in HERTZCHAIN_INSTRUCTION_SET"
        )
    return work


def _written(work: _native.Run | _native.Likelihood, folder: Path) -> str:
    """Its file, whole or not at all, by a name that no other work has."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder.resolve() / f"run-{work.name}.pickle"
    beside = path.with_name(f".{path.name}.{uuid4().hex}.part")
    beside.write_bytes(pickle.dumps(work))
    beside.replace(path)
    return str(path)


def _threads(client: Client | None) -> int:
    """Threads of a shard: one of a worker's, of which each computes a shard; all (0) in process."""
    return 0 if client is None else 1


def _parts(most: int, least: int, a_thread: int, client: Client | None) -> int:
    """Into how many parts work of at most so many is cut, so that all threads of the workers have some."""
    threads = 0 if client is None else _dask.threads(client) or UNKNOWN
    return max(1, least, min(most, a_thread * threads))


def _cut(folder: Path, name: str) -> int | None:
    """Into how many shards a run was cut of which there are some in its folder: it goes on with these."""
    found = [path.stem.rpartition("-of-")[2] for path in folder.glob(f"sweep-{name}-*-of-*.h5")]
    return int(max(found, key=found.count)) if found else None


def _shard(path: str, name: str, number: int, of: int, threads: int) -> tuple[int, bool | str]:
    """Computes a shard of a sweep on a worker."""
    folder = str(Path(path).parent)
    return _dask.poisoned_or(number, lambda: _native.shard(_opened(path, name), number, of, folder, threads, None))


def _series(experiment: Experiment, out: str, number: int, of: int, seed: int | None, threads: int) -> tuple[int, bool | str]:
    """Runs a part of a campaign on a worker."""

    def kept() -> bool:
        done = _native.campaign(experiment, out, f"{number}/{of}", seed, threads, None)
        if done["failed"]:
            raise OptionError("; ".join(done["failed"]))
        return done["kept"] > 0 and done["run"] == 0

    return _dask.poisoned_or(number, kept)


def _outcomes(path: str, name: str, points: list[list[float]]) -> list[Any]:
    """Residuals of points on a worker."""
    return _opened(path, name).outcomes(points)


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
        As for `hertzchain.ensemble`: speeds in m/s and numbers in SI, broadcast to one shape.
    folder : path
        Where shards go, seen by all workers under this name. The same folder
        again goes on where a run was broken off.
    client : dask.distributed.Client, optional
        Everything stays in this process when absent.
    shards : int, optional
        Parts of the run. When absent, as many as the folder has some of; else four for each
        thread of the workers (one with ``judges="pilots"``, whose pilots each shard computes),
        and no part of more than 20,000 shots.
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
    ConnectionError
        The scheduler is lost: the same call goes on where this one stood.

    Notes
    -----
    All workers must have the build and the instruction set of whoever calls: where
    they have not, shards are poisoned. A shard has the bits of ``hertzchain sweep --shard i/n``.

    References
    ----------
    Shards, clusters and what they cost: docs/across-machines.md.
    """
    speeds, named = broadcast(experiment, speed, parameters)
    how = options.how(accuracy, None, None, None, pick, False)
    asked = {"options": how, "rebound": bool(rebound), "judges": judges, "threads": 0}
    run = _native.Run(experiment, speeds, list(named), list(named.values()), asked)
    path = _written(run, Path(folder))
    if shards is None:
        least = -(-speeds.size // SHOTS_A_SHARD)
        a_thread = 1 if judges == "pilots" else SHARDS_A_THREAD
        shards = _cut(Path(folder), run.name) or _parts(speeds.size, least, a_thread, client)
    of = options.count("shards", shards, 1, MOST_SHARDS)
    with options.progress(progress, of, "shard") as update:
        kept, poisoned = _dask.run(_shard, lambda number: (path, run.name, number, of, _threads(client)), of, client, update)
    return Distributed(Path(folder), of, kept, poisoned, run, experiment, speeds.shape, tuple(named))


def campaign(
    experiment: Experiment,
    out: str | os.PathLike[str],
    *,
    client: Client | None = None,
    shards: int | None = None,
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
    shards : int, optional
        Parts into which series are dealt. When absent, four for each thread of the workers,
        and no more than there are series; one without a client.
    progress : bool, bar or function, optional
        Told of shards.

    Returns
    -------
    Distributed
        Shards that can't be computed are told in it; the others' recordings are in the folder.

    Raises
    ------
    OptionError, ExperimentError
        As for `hertzchain.campaign`, where no shard can be run.
    ConnectionError
        The scheduler is lost: the same call goes on where this one stood.

    References
    ----------
    Series and their files: docs/rig.md; shards: docs/across-machines.md.
    """
    into = str(Path(out).resolve())
    series = _native.campaign_series(experiment, seed)
    shards = _parts(series, 1, SHARDS_A_THREAD, client) if shards is None else options.count("shards", shards, 1, MOST_SHARDS)
    with options.progress(progress, shards, "shard") as update:
        kept, poisoned = _dask.run(_series, lambda number: (experiment, into, number, shards, seed, _threads(client)), shards, client, update)
    if len(poisoned) == shards:
        raise OptionError(next(iter(poisoned.values())))
    return Distributed(Path(out), shards, kept, poisoned)


POINTS = 32
"""Most points of the model in a batch."""

def fit(
    data: Any,
    model: Experiment | str | None = None,
    *,
    free: str | Iterable[str],
    folder: str | os.PathLike[str],
    client: Client | None = None,
    points: int | None = None,
    progress: object = None,
    **how: Unpack[FitOptions],
) -> Fitted:
    """Fits contact parameters with the model's curves computed on a cluster.

    Residuals of the descent, the profiles or the sampler's walkers are computed in
    batches of points, each named by a hash of the problem and its points.

    Parameters
    ----------
    data, model, free
        As for `hertzchain.fit`, of tables: times of flight in s, numbers in SI.
    folder : path
        Where the problem, residuals so far and the walkers' chain are, seen by all workers under
        this name. The same folder again goes on where a run was broken off.
    client : dask.distributed.Client, optional
        Everything stays in this process when absent.
    points : int, optional
        Most points of a batch. There are smaller ones where not every thread would have one.
    progress : bool, bar or function, optional
        Told of curves.
    **how
        As for `hertzchain.fit`, but ``direct``, which is meant, and ``against``.

    Returns
    -------
    Fitted
        With the bits of ``hertzchain.fit(..., direct=True)``.

    Raises
    ------
    OptionError, ExperimentError
        As for `hertzchain.fit`; batches that no worker could compute.
    ConnectionError
        The scheduler is lost: the same call goes on with what was saved.

    References
    ----------
    The sampler: [GoodmanWeare2010], docs/inferring.md; batches: docs/across-machines.md.
    """
    into = Path(folder).resolve()
    how["direct"] = True
    told = [*words(**how), *options.listed("free", free), *kept(into)]
    name, text = table(data)
    likelihood = _native.Likelihood((name, text), modelled(model), [*told, "--", name])
    size = POINTS if points is None else options.count("points", points, 1)
    workers, compute = 1, None
    if client is not None:
        compute = _dask.batches(_outcomes, (_written(likelihood, into), likelihood.name), client)
        workers = _dask.threads(client) or UNKNOWN
    with options.progress(progress, None, "curve") as update:
        found = _native.fit_spread(likelihood, size, workers, compute, update)
        return fitted({**found, "assumed_model": assumed(model=(model, "dry"))})
