"""Every result, whatever its class: pandas, xarray, units, print, pickle."""

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT, SMALL, pickled
from test_inference import noisy

import hertzchain as hc
from hertzchain import distributed

RIG = ROOT / "crates/sim/tests/small.toml"
SPEEDS = np.array([0.2, 0.5, 1.0])
# Of no computation: what goes in, what goes wrong, and parts of what is reported.
NO_RESULTS = {
    hc.Beads, hc.Contacts, hc.Experiment, hc.FarEnd, hc.ForceLaw, hc.Law, hc.Material, hc.PowerOfSpeed, hc.Striker,
    hc.Finding, hc.Result, hc.Row, hc.ExperimentError, hc.ExperimentWarning, hc.HertzchainError, hc.InternalError, hc.MissingFileError, hc.OptionError,
}  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    return tmp_path_factory.mktemp("results")


@pytest.fixture(scope="module")
def results(folder) -> dict[type, Any]:
    """One of each class."""
    small, dry = hc.build(SMALL), noisy("dry", 1, 3)
    shot, swept = hc.shot(small, trace=True), hc.sweep(small, SPEEDS)
    with pytest.warns(hc.ExperimentWarning):
        warned = hc.ensemble(hc.preset("pump"), [0.1, 0.5])
    fitted = hc.fit(dry, free="eta,B")
    campaigned = hc.campaign(hc.load(RIG), folder / "records")
    measured = hc.measure(folder / "records")
    theory = hc.theory(small)
    found = [
        shot, shot.trace, swept, swept.power_law_incident, warned, warned.warnings, fitted, fitted.parameters["B"],
        hc.design(dry, free="eta,B", picks=1), hc.gauge(noisy("motor", 2, 2), dry, model="motor"), campaigned, measured,
        measured.cases["dry"], theory, theory.groups[0], hc.laws("damping_cubic")[0],
        distributed.sweep(small, SPEEDS, folder=folder / "shards", shards=2),
    ]  # fmt: skip
    return {type(result): result for result in found}


CLASSES = [found for _, found in inspect.getmembers(hc, inspect.isclass) if found not in NO_RESULTS] + [distributed.DistributedResult]
each = pytest.mark.parametrize("of", CLASSES, ids=lambda of: of.__name__)


@each
def test_a_result_is_a_table_of_pandas_with_units(of, results):
    table = results[of].to_pandas()
    units = table.attrs["units"]
    names = table.index if of is hc.Shot else table.columns
    assert len(table) > 0 and set(names) <= set(units) and all(isinstance(unit, str) and unit for unit in units.values())


@each
def test_a_result_is_a_dataset_of_xarray_with_units(of, results):
    data = results[of].to_xarray()
    assert len(data.data_vars) > 0
    for name in data.variables:
        # Of parameters a unit each.
        units = data[name].attrs.get("units")
        if of is hc.FitResult and name in ("parameter", "other"):
            continue
        if of is hc.MeasureResult and name == "record":
            continue
        assert units and (isinstance(units, str) or len(units) == data.sizes["parameter"]), name


@each
def test_a_result_prints_well(of, results):
    text = repr(results[of])
    # Not as Python would print a dataclass, arrays and all.
    assert not text.startswith(f"{of.__name__}(") or of is hc.WarningSummary
    assert len(text) < 6000 and "array(" not in text and " object at 0x" not in text
    assert "{" not in text.replace("^{", "")


@each
def test_a_result_comes_back_from_a_pickle(of, results):
    assert pickled(results[of])


def test_units_are_those_of_the_numbers(results):
    units: Callable[[type], dict[str, str]] = lambda of: results[of].to_pandas().attrs["units"]
    assert units(hc.Shot)["tof_incident_s"] == "s" and units(hc.Shot)["wall_peak_n"] == "N"
    assert units(hc.PowerLaw) == {**dict.fromkeys(units(hc.PowerLaw), "1"), "prefactor_s": "s", "prefactor_error_s": "s", "prefactor_accuracy_s": "s"}
    assert units(hc.Parameter)["value"] == "kg s/m^2" and units(hc.FitResult)["measured"] == "s"
    assert units(hc.DesignResult)["eta"] == "Pa s" and units(hc.MeasureResult)["tof_incident_sigma_s"] == "s"
    assert units(hc.MeasureResult)["wall_peak_v"] == "V" and units(hc.CampaignResult)["bytes"] == "B"
    fitted = results[hc.FitResult].to_xarray()
    assert fitted["value"].attrs["units"] == fitted["unit"].values.tolist() == ["Pa s", "kg s/m^2"]
    assert results[hc.GaugeResult].to_xarray()["stiffness_error"].attrs["units"] == "N/m^1.5"


def test_tables_hold_the_numbers_of_the_result(results):
    law = results[hc.PowerLaw]
    assert law.to_pandas()["exponent"][0] == law.exponent and law.to_xarray()["prefactor_s"].values[0] == law.prefactor_s
    description = results[hc.Description]
    assert description.to_pandas()["value"].tolist() == [row.value for group in description for row in group.rows]
    design = results[hc.DesignResult]
    assert design.to_pandas()["information_nats"].tolist() == [one["information_nats"] for one in design.ranked]
    assert results[distributed.DistributedResult].to_pandas()["failed"].tolist() == [False, False]
