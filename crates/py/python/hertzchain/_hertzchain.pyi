"""The extension: thin bindings of the Rust libraries. Use `hertzchain` instead."""

from collections.abc import Callable, Sequence
from os import PathLike
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
_Table = tuple[str, str]
_Progress = Callable[[int], object] | None

@final
class Experiment:
    """A described experiment, valid and in SI; unchangeable and picklable.

    Make one with `hertzchain.load`, `hertzchain.preset` or `hertzchain.build`.
    """

    @staticmethod
    def open(path: str | PathLike[str]) -> Experiment: ...
    @staticmethod
    def from_text(name: str, text: str) -> Experiment: ...
    @staticmethod
    def from_tables(name: str, tables: str) -> Experiment: ...
    @staticmethod
    def preset(name: str) -> Experiment: ...
    @property
    def name(self) -> str:
        """Name of the file or preset."""
    @property
    def title(self) -> str:
        """What the experiment is."""
    @property
    def text(self) -> str:
        """The file's text, as it was read."""
    @property
    def is_dimensionless(self) -> bool:
        """Whether K = m = 1 stands for SI."""
    @property
    def speed_m_s(self) -> float | None:
        """Speed of the striker in m/s; None without a striker."""
    @property
    def beads(self) -> int:
        """Number N of beads."""
    @property
    def sensor_bead(self) -> int:
        """Number n of the bead whose signal times the pulses."""
    @property
    def has_wall(self) -> bool:
        """Whether bead N leans on something, so that there is a wall signal."""
    @property
    def cases(self) -> list[str]:
        """Names of the chains that a campaign measures."""
    def numbers(self) -> list[tuple[str, float, str]]:
        """Every number that the file gives: path, value in SI, SI unit."""
    def get(self, path: str) -> float:
        """One number in SI, by its path or an unmistakable end of it."""
    def case(self, name: str) -> Experiment:
        """The chain of one of a campaign's cases."""
    def set(self, values: dict[str, float] | dict[str, str] | dict[str, float | str]) -> Experiment:
        """This experiment with numbers set: in SI, or as text with a unit."""

@final
class Force:
    """A force law of Python on some contacts."""

    def __new__(
        cls,
        name: str,
        equation: str,
        force: Callable[[Floats, Floats], object],
        energy: Callable[[Floats], object] | None,
        first: int,
        last: int | None,
        beside: bool,
    ) -> Force: ...

@final
class Run:
    """A sweep or an ensemble with everything that its numbers follow from."""

    def __new__(
        cls, experiment: Experiment, speeds_m_s: Floats, names: Sequence[str], values: Sequence[Floats], options: str
    ) -> Run: ...
    @property
    def name(self) -> str: ...
    def speeds(self) -> Floats: ...
    def values(self) -> list[Floats]: ...
    def compute(self, is_curve: bool, progress: _Progress) -> dict[str, Any]: ...
    def shard(self, number: int, of: int, folder: str, threads: int) -> bool: ...

_Outcome = tuple[list[float], list[float]] | str
_Batches = list[tuple[str, list[list[float]]]]

@final
class Likelihood:
    """Measurements against a model with free numbers; picklable."""

    def __new__(cls, table: _Table, experiment: Experiment, options: str) -> Likelihood: ...
    @property
    def name(self) -> str: ...
    def outcomes(self, points: Sequence[Sequence[float]]) -> list[_Outcome]: ...

def fit_spread(
    likelihood: Likelihood,
    size: int,
    workers: int,
    compute: Callable[[_Batches], Callable[[float], list[list[_Outcome]] | None]] | None,
    progress: _Progress,
) -> dict[str, Any]: ...
def gather(run: Run, folder: str) -> dict[str, Any]: ...
def options(verb: str) -> list[tuple[str, str, str | None, str]]: ...
def presets() -> dict[str, str]: ...
def schema() -> str: ...
def shot(
    experiment: Experiment,
    options: str,
    watch: tuple[Sequence[tuple[str, int]], float | None] | None,
    forces: Sequence[Force],
    progress: _Progress,
) -> dict[str, Any]: ...
def speeds(text: str) -> Floats: ...
def check(experiment: Experiment, options: str) -> dict[str, Any]: ...
def theory(experiment: Experiment, options: str) -> dict[str, Any]: ...
def laws(name: str | None) -> list[dict[str, Any]]: ...
__version__: str

def instruction_set() -> str: ...
def campaign_series(experiment: Experiment, options: str) -> int: ...
def campaign(experiment: Experiment, options: str, progress: _Progress) -> dict[str, Any]: ...
def run_program(arguments: Sequence[str]) -> int: ...
def measure(records: Sequence[str], options: str, threads: int, folder: str, progress: _Progress) -> dict[str, Any]: ...
def is_table(path: str | PathLike[str], with_options_of_recordings: bool) -> bool: ...
def fit(tables: Sequence[tuple[_Table, Experiment]], options: str, progress: _Progress) -> dict[str, Any]: ...
def fit_pulses(experiment: Experiment, options: str, progress: _Progress) -> dict[str, Any]: ...
def design(table: _Table, experiment: Experiment, options: str, progress: _Progress) -> dict[str, Any]: ...
def gauge(
    tables: tuple[_Table, _Table],
    experiments: tuple[Experiment, Experiment],
    more_oils: _Table | None,
    options: str,
    progress: _Progress,
) -> dict[str, Any]: ...
