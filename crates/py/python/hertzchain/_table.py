"""What all results have in common: columns with units, for xarray and pandas."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

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
    of = name.removesuffix("_error").removesuffix("_deviation")
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


def frame(columns: Mapping[str, Any], dimensionless: bool, index: str | None = None) -> pd.DataFrame:
    """A pandas table with the units of its columns in ``attrs["units"]``."""
    import pandas as pd

    made = pd.DataFrame(dict(columns))
    made.attrs["units"] = {name: unit(name, dimensionless) for name in columns}
    return made if index is None else made.set_index(index)


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
