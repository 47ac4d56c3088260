"""Keyword options of the verbs, for type checkers: written by crates/py/keywords.py."""

from collections.abc import Iterable, Mapping
from os import PathLike
from typing import Any, Literal, TypedDict

Path = str | PathLike[str]
Quantity = str | float


class ShotOptions(TypedDict, total=False):
    speed: Quantity | None
    accuracy: Quantity | None
    solver: Literal["adaptive", "rk4", "verlet"] | None
    step: Quantity | None
    duration: Quantity | None
    pick: Literal["peak", "flank-10", "flank-50", "cross-correlation"] | None
    check: bool


class SweepOptions(TypedDict, total=False):
    speeds: Quantity
    accuracy: Quantity | None
    solver: Literal["adaptive", "rk4", "verlet"] | None
    step: Quantity | None
    duration: Quantity | None
    pick: Literal["peak", "flank-10", "flank-50", "cross-correlation"] | None
    check: bool
    rebound: bool
    error_control: Literal["per-shot", "calibrated", "none"]
    threads: Quantity | None


class EnsembleOptions(TypedDict, total=False):
    accuracy: Quantity | None
    solver: Literal["adaptive", "rk4", "verlet"] | None
    step: Quantity | None
    duration: Quantity | None
    pick: Literal["peak", "flank-10", "flank-50", "cross-correlation"] | None
    check: bool
    rebound: bool
    error_control: Literal["per-shot", "calibrated", "none"]
    threads: Quantity | None
    speed: Quantity


class MeasureOptions(TypedDict, total=False):
    rig: Path | None
    shots: Path | None
    rate: Quantity | None
    trust_rate: bool
    channel: str | int | Iterable[str | int] | None
    time_unit: str | int | None
    shot_samples: Quantity | None
    level: Quantity | None
    whole: bool
    rows: Literal["shots", "channels", "times", "moments"] | None
    method: Literal["local", "onset", "correlation", "shape"]
    onset: Quantity | None
    beads: Quantity | None
    sensor: Quantity | None
    polarity: Literal["positive", "negative"] | None
    wall_polarity: Literal["positive", "negative"] | None
    smooth: Quantity | None
    low_pass: Quantity | None
    filter: Literal["first", "butterworth2", "butterworth3", "butterworth4", "bessel2", "bessel3", "bessel4"] | None
    ac_coupling: Quantity | None
    mains: Quantity | None
    sensitivity: Quantity | None
    wall_sensitivity: Quantity | None
    skew: Quantity | None
    speed_error: Quantity | None
    speed_gap: Quantity
    reference: str | int
    keep_dubious: bool


class FitOptions(TypedDict, total=False):
    shots: Path | None
    rate: Quantity | None
    channel: str | int | Iterable[str | int] | None
    low_pass: Quantity | None
    filter: Literal["first", "butterworth2", "butterworth3", "butterworth4", "bessel2", "bessel3", "bessel4"] | None
    most_shots: Quantity
    case: str | int | None
    use: Literal["incident", "reflected", "wall-ratio", "returning-ratio"] | Iterable[Literal["incident", "reflected", "wall-ratio", "returning-ratio"]]
    speed_error: Quantity | None
    tof_error: Quantity | None
    ratio_error: Quantity | None
    error_shots: Quantity | None
    model: Path | None
    fixed: Mapping[str, Any] | None
    accuracy: Quantity
    threads: Quantity | None
    free: Quantity | Iterable[Quantity] | None
    start: Mapping[str, Any] | None
    bounds: Mapping[str, Any] | None
    prior: Mapping[str, Any] | None
    scale: Mapping[str, Any] | None
    systematic: Mapping[str, Any] | None
    own: Quantity | Iterable[Quantity] | None
    method: Literal["covariance", "profile", "posterior"]
    against: Mapping[str, Any] | None
    steps: Quantity
    direct: bool
    robust: bool
    starts: Quantity
    seed: Quantity


class DesignOptions(TypedDict, total=False):
    case: str | int | None
    use: Literal["incident", "reflected", "wall-ratio", "returning-ratio"] | Iterable[Literal["incident", "reflected", "wall-ratio", "returning-ratio"]]
    speed_error: Quantity | None
    tof_error: Quantity | None
    ratio_error: Quantity | None
    error_shots: Quantity | None
    model: Path | None
    fixed: Mapping[str, Any] | None
    accuracy: Quantity
    threads: Quantity | None
    free: Quantity | Iterable[Quantity] | None
    start: Mapping[str, Any] | None
    bounds: Mapping[str, Any] | None
    prior: Mapping[str, Any] | None
    scale: Mapping[str, Any] | None
    systematic: Mapping[str, Any] | None
    target: Quantity | Iterable[Quantity] | None
    speeds: Quantity | None
    preloads: Quantity | Iterable[Quantity]
    sensors: Quantity | Iterable[Quantity] | None
    costs: Mapping[str, Any] | None
    picks: Quantity


class GaugeOptions(TypedDict, total=False):
    wet_case: str | int | None
    dry_case: str | int | None
    case: str | int | None
    use: Literal["incident", "reflected", "wall-ratio", "returning-ratio"] | Iterable[Literal["incident", "reflected", "wall-ratio", "returning-ratio"]]
    speed_error: Quantity | None
    tof_error: Quantity | None
    ratio_error: Quantity | None
    error_shots: Quantity | None
    model: Path | None
    dry_model: Path | None
    dry_free: Quantity | Iterable[Quantity]
    own: Quantity | Iterable[Quantity] | None
    film: Quantity | Iterable[Quantity] | None
    systematic: Mapping[str, Any] | None
    oils: Path | None
    accuracy: Quantity
    threads: Quantity | None
