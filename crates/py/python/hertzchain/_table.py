"""What all results have in common: columns with units, for xarray and pandas."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from .errors import ExperimentWarning

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

Floats = NDArray[np.float64]

_ENDINGS = (
    ("_beads_per_s", "beads/s"),
    ("_m_s", "m/s"),
    ("_s", "s"),
    ("_n", "N"),
    ("_j", "J"),
    ("_m", "m"),
    ("_v", "V"),
)


def unit(name: str, dimensionless: bool = False) -> str:
    """SI unit of a column by the end of its name, its error's too; "1" for plain numbers."""
    if dimensionless:
        return "1"
    of = name.replace("_sigma", "").removesuffix("_error").removesuffix("_deviation")
    return next((unit for ending, unit in _ENDINGS if of.endswith(ending)), "1")


def dataset(
    columns: Mapping[str, tuple[tuple[str, ...], Any]],
    coordinates: Mapping[str, tuple[tuple[str, ...], Any]],
    dimensionless: bool,
    attributes: Mapping[str, Any],
) -> xr.Dataset:
    """An xarray dataset, each of whose variables has its unit in ``attrs``."""
    import xarray as xr

    def with_unit(name: str, part: tuple[tuple[str, ...], Any]) -> tuple[tuple[str, ...], Any, dict[str, str]]:
        return (*part, {"units": unit(name, dimensionless)})

    made = xr.Dataset(
        {name: with_unit(name, part) for name, part in columns.items()},
        coords={name: with_unit(name, part) for name, part in coordinates.items()},
    )
    made.attrs.update({key: value for key, value in attributes.items() if value is not None})
    return made


def frame(columns: Mapping[str, Any], dimensionless: bool, index: str | None = None, units: Mapping[str, str] | None = None) -> pd.DataFrame:
    """A pandas table with the units of its columns in ``attrs["units"]``; ``units`` of those whose names do not say."""
    import pandas as pd

    made = pd.DataFrame(dict(columns))
    made.attrs["units"] = {name: unit(name, dimensionless) for name in columns} | dict(units or {})
    return made if index is None else made.set_index(index)


class Tabled:
    """A result that is a table: columns of one length, each with its unit."""

    _index: ClassVar[str | None] = None

    def _columns(self) -> Mapping[str, Sequence[Any] | NDArray[Any]]:
        raise NotImplementedError

    def _units(self) -> Mapping[str, str]:
        """Units of columns whose names do not say theirs."""
        return {}

    def to_pandas(self) -> pd.DataFrame:
        """The table as pandas has it.

        Returns
        -------
        pandas.DataFrame
            Units of all columns, by name, in ``attrs["units"]``.
        """
        return frame(self._columns(), False, self._index, self._units())

    def to_xarray(self) -> xr.Dataset:
        """The table as xarray has it.

        Returns
        -------
        xarray.Dataset
            One variable a column over the table's rows, its unit in ``attrs["units"]``.
        """
        columns, units = self._columns(), self._units()
        of = self._index or "row"
        made = dataset(
            {name: ((of,), _whole(values)) for name, values in columns.items() if name != self._index},
            {} if self._index is None else {of: ((of,), _whole(columns[of]))},
            False,
            {},
        )
        for name, own in units.items():
            made[name].attrs["units"] = own
        return made


def _whole(values: Sequence[Any] | NDArray[Any]) -> NDArray[Any]:
    """As an array of one dimension; lists and dicts stay what they are."""
    if isinstance(values, np.ndarray):
        return values
    plain = all(isinstance(value, (bool, int, float, str)) for value in values)
    made = np.empty(len(values), dtype=object)
    made[:] = list(values)
    return np.array(values) if plain else made


def number(value: float | None) -> float:
    """NaN where there is none."""
    return float("nan") if value is None else value


def warned(lines_of_first: Sequence[str], shots: int) -> None:
    """One warning for all odd shots of a call."""
    if lines_of_first:
        others = {1: "", 2: "\n(the same or the like goes for another shot)"}.get(shots, f"\n(the same or the like goes for {shots - 1} other shots)")
        warnings.warn("\n".join(lines_of_first) + others, ExperimentWarning, stacklevel=3)


def short(value: float | None, digits: int = 6) -> str:
    """A number for people; a dash where there is none."""
    return "–" if value is None or np.isnan(value) else f"{value:.{digits}g}"


def lines(title: str, rows: Mapping[str, str]) -> str:
    """Names and values, aligned under a title."""
    width = max((len(name) for name in rows), default=0)
    return "\n".join([title, *(f"  {name:<{width}}  {value}" for name, value in rows.items())])


def span(values: Floats, name: str, dimensionless: bool = False) -> str:
    """Least and largest number of a column with its unit."""
    finite = values[np.isfinite(values)]
    if finite.size == 0:
        return "–"
    of = unit(name, dimensionless)
    return f"{short(float(finite.min()))} … {short(float(finite.max()))}" + ("" if of == "1" else f" {of}")
