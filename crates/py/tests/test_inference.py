"""Fits, gauges and designs: the command line's numbers."""

import json
from csv import reader

import numpy as np
import pytest
from conftest import ROOT, pickled

import hertzchain as hc
from hertzchain.inference import csv

ERROR_S = 3e-7


def noisy(preset: str, seed: int, count: int = 6) -> dict[str, np.ndarray]:
    speeds = np.geomspace(0.2, 1.2, count)
    truth = hc.sweep(hc.preset(preset), speeds)
    rng = np.random.default_rng(seed)
    columns = {"speed_m_s": speeds, "speed_error_m_s": np.full(count, 1e-6)}
    for end in ("tof_incident_s", "tof_reflected_s"):
        columns[end] = truth.columns[end] + ERROR_S * rng.standard_normal(count)
        columns[f"{end}_error"] = np.full(count, ERROR_S)
    return columns


@pytest.fixture(scope="module")
def dry_data() -> dict[str, np.ndarray]:
    return noisy("dry", 1)


@pytest.fixture
def table(tmp_path, dry_data):
    path = tmp_path / "speeds.csv"
    path.write_text(csv(dry_data))
    return path


@pytest.mark.parametrize("method", ["covariance", "profile", "posterior"])
def test_a_fit_has_the_numbers_of_the_command_line(cli, table, dry_data, method):
    # A few steps of a sampler report as much of its bits as many.
    reported = cli("fit", table, "--preset", "dry", "--free", "eta,B", "--method", method, "--steps", "20")
    from_file = hc.fit(table, "dry", free="eta,B", method=method, steps=20)
    from_columns = hc.fit(dry_data, hc.preset("dry"), free=["eta", "B"])
    assert from_file.details == reported
    assert from_columns.covariance.tolist() == reported["covariance"]
    assert [p.value for p in from_columns.parameters.values()] == [p["value"] for p in reported["parameters"]]
    assert ("unconverged" in (reported["posterior"] or {})) == (method == "posterior")


def test_a_fit_finds_what_made_the_data(dry_data):
    fitted = hc.fit(dry_data, free=["eta", "B"])
    # Four standard errors: one in ten thousand draws is farther; the seed is fixed.
    for name, value in (("eta", 3.2e4), ("B", 77.0)):
        parameter = next(p for key, p in fitted.parameters.items() if key.endswith(name))
        assert parameter.standard_error is not None
        assert abs(parameter.value - value) < 4 * parameter.standard_error
    assert fitted.converged and fitted.chi_square is not None and fitted.chi_square["probability"] > 1e-3
    assert set(fitted.rows) >= {"measured", "fitted", "fitted_error", "residual"}
    assert "±" in repr(fitted) and fitted.to_xarray()["covariance"].shape == (2, 2)
    assert len(fitted.to_pandas()) == 12
    assert pickled(fitted) and all(map(pickled, fitted.parameters.values()))


def test_a_model_that_is_not_named_is_stated(dry_data):
    paper = "the paper's chain is assumed"
    calls = {
        "model='dry'": lambda **model: hc.fit(dry_data, free=["eta"], **model),
        "model='dry')": lambda **model: hc.design(dry_data, free=["eta"], speeds=[0.3], picks=1, **model),
        "model='pump', dry_model='dry'": lambda **model: hc.gauge(dry_data, dry_data, use="incident", **model),
    }
    for absent, call in calls.items():
        with pytest.warns(hc.ExperimentWarning, match=paper):
            found = call()
        stated = found.details["assumed_model"] if hasattr(found, "details") else found.assumed_model
        assert paper in stated and absent in stated
    assert hc.fit(dry_data, "dry", free=["eta"]).details["assumed_model"] is None


def test_what_is_improbable_about_a_model_is_a_warning(dry_data):
    for call in (hc.fit, hc.design):
        with pytest.warns(hc.ExperimentWarning, match="Poisson ratio of `aisi316` is 0.7") as warned:
            call(dry_data, "dry", free="eta", fixed={"nu": 0.7})
        assert warned[0].filename == __file__


def test_tables_of_pandas_and_sweeps_are_data(dry_data):
    import pandas as pd

    plain = hc.fit(dry_data, free="B")
    assert hc.fit(pd.DataFrame(dry_data), free="B").covariance.tolist() == plain.covariance.tolist()
    swept = hc.sweep(hc.preset("dry"), dry_data["speed_m_s"])
    exact = hc.fit(swept, free="B", tof_error=1e-7, speed_error=1e-7)
    # Data without noise: what the solver's accuracy of 1e-5 leaves.
    assert next(iter(exact.parameters.values())).value == pytest.approx(77.0, rel=1e-2)


def test_cases_are_named_by_numbers_as_the_table_has_them(dry_data, tmp_path):
    import pandas as pd

    cases = pd.DataFrame({**dry_data, "case": [1] * 3 + [2] * 3})
    cases.to_csv(tmp_path / "cases.csv", index=False)
    for data in (cases, tmp_path / "cases.csv"):
        found = [hc.fit(data, "dry", free="B", case=case) for case in (1, "1")]
        assert [one.details["data"]["values"] for one in found] == [6, 6]
    assert hc.fit(dry_data, "dry", free="eta,B", bounds={"B": (0, None)}).converged


def test_a_joint_fit_says_how_many_values_of_which_models_it_has(dry_data):
    both = hc.fit(dry_data, "dry", free="eta", also=[(dry_data, "hertz-viscoelastic")])
    assert repr(both).startswith("Fit of dry.toml, hertz-viscoelastic.toml to 24 values in 2 tables")


def test_what_is_masked_was_not_measured(dry_data):
    reflected = np.ma.masked_greater(dry_data["tof_reflected_s"], np.sort(dry_data["tof_reflected_s"])[-3])
    seen = hc.fit({**dry_data, "tof_reflected_s": reflected}, free="B")
    assert len(seen.to_pandas()) == 10
    absent = hc.fit({**dry_data, "tof_reflected_s": reflected.filled(np.nan)}, free="B")
    assert seen.covariance.tolist() == absent.covariance.tolist()
    names = np.ma.array(["a"] * 6, mask=[True] + [False] * 5)
    with pytest.raises(hc.OptionError, match="only numbers can be masked"):
        hc.fit({**dry_data, "case": names}, free="B")


def test_walkers_in_a_folder_are_led_on(dry_data, tmp_path):
    how = {"free": "eta,B", "method": "posterior"}
    hc.fit(dry_data, folder=tmp_path, steps=40, **how)
    led_on = hc.fit(dry_data, folder=tmp_path, steps=60, **how)
    assert led_on.details["posterior"] == hc.fit(dry_data, steps=60, **how).details["posterior"]
    with pytest.raises(hc.OptionError, match="resume"):
        hc.fit(noisy("dry", 2), folder=tmp_path, steps=60, **how)


def test_bounds_priors_and_starts_are_those_of_the_command_line(cli, table):
    reported = cli(
        "fit", table, "--preset", "dry", "--free", "eta,B", "--prior", "B=80+-5", "--bounds", "eta=1e4:1e5", "--start", "B=70", "--set", "young_modulus=212 GPa"
    )  # fmt: skip
    found = hc.fit(table, free="eta,B", prior={"B": (80.0, 5.0)}, bounds={"eta": (1e4, 1e5)}, start={"B": 70.0}, fixed={"young_modulus": "212 GPa"})
    for ours, theirs in zip(found.details["parameters"], reported["parameters"], strict=True):
        assert ours == theirs


@pytest.mark.long
def test_a_design_and_a_gauge_are_those_of_the_command_line(cli, tmp_path, table, dry_data):
    reported = cli("design", table, "--preset", "dry", "--free", "eta,B", "--target", "B", "--picks", "2")
    found = hc.design(dry_data, free="eta,B", target="B", picks=2)
    assert (found.ranked, found.series) == (reported["ranked"], reported["series"])
    assert len(found.to_pandas()) == len(found.ranked) and "measure next" in repr(found)
    assert pickled(found)
    wet = noisy("motor", 2, 2)
    (tmp_path / "wet.csv").write_text(csv(wet))
    reported = cli("gauge", tmp_path / "wet.csv", "--dry", table, "--preset", "motor")
    gauged = hc.gauge(wet, dry_data, model="motor")
    assert gauged.details == reported and gauged.verdict in repr(gauged)
    assert pickled(gauged) and gauged.to_xarray()["stiffness"].attrs["units"] == "N/m^1.5"


def test_a_gauge_of_a_film_is_a_table_of_the_films_numbers():
    number = {"name": "viscosity", "unit": "Pa s", "value": 0.1, "standard_error": 0.01}
    rows = [{"speed_m_s": 0.5, "film": {**number, "determined": True}}, {"speed_m_s": 0.6, "missing": "no fit"}]
    gauged = hc.GaugeResult({"verdict": "One film.", "oils": [], "contacts": rows, "film": {"parameters": [number]}})
    assert gauged.to_pandas()["value"].tolist() == [0.1] and "0.1 ± 0.01 Pa s" in repr(gauged)
    film = gauged.to_xarray()["film"]
    assert film.values.tolist() == [0.1] and film.attrs["units"] == "Pa s"


def test_a_measurement_is_fitted_in_memory_as_from_its_file(tmp_path):
    row = hc.load(ROOT / "crates/sim/tests/small.toml")
    hc.campaign(row, tmp_path / "records")
    measured = hc.measure(tmp_path / "records")
    how = {"free": "steel.eta", "case": "dry", "speed_error": "0.1mm/s"}
    measured.save(tmp_path)
    from_file = hc.fit(tmp_path / "speeds.csv", row, **how).details
    # Messages name the file; what is in memory has a name without a folder.
    bare = json.loads(json.dumps(from_file).replace(f"{tmp_path}/", ""))
    assert hc.fit(measured, row, **how).details == bare


def test_an_unknown_option_is_named_with_the_nearest(dry_data):
    with pytest.raises(TypeError, match="'speed_eror'; did you mean 'speed_error'"):
        hc.fit(dry_data, "dry", free="B", speed_eror=1e-4)


def test_a_fit_of_recordings_is_that_of_the_command_line(cli, tmp_path):
    rig = ROOT / "crates/sim/tests/small.toml"
    row = hc.load(rig)
    hc.campaign(row, tmp_path / "records")
    options = ("--case", "dry", "--free", "steel.eta,sensor_gain", "--most-shots", "2", "--out", tmp_path / "out")
    reported = cli("fit", tmp_path / "records", "--model", rig, *options)
    seen: list[int] = []
    found = hc.fit(tmp_path / "records", row, case="dry", free=["steel.eta", "sensor_gain"], most_shots=2, progress=seen.append)
    assert found.details == reported and sum(seen) > 10
    with open(tmp_path / "out/pulses.csv", newline="", encoding="utf-8") as file:
        titles, *lines = reader(file)
    theirs = dict(zip(titles, zip(*lines, strict=True), strict=True))
    for own, their in (("time_s", "time_s"), ("measured_v", "measured_V"), ("fitted_v", "fitted_V")):
        assert found.rows[own].tolist() == list(map(float, theirs[their]))
    assert found.to_pandas().attrs["units"]["measured_v"] == "V" and "whole pulses of 2 records" in repr(found)
    files = sorted((tmp_path / "records").glob("*.h5"))
    assert hc.fit(files, row, case="dry", free="steel.eta,sensor_gain", most_shots=2).details == {**reported, "free": reported["free"]}
    with pytest.raises(hc.OptionError, match="has no case `another`"):
        hc.fit(files[:1], row, case="another", free="steel.eta")


@pytest.mark.parametrize(
    ("data", "options", "words"),
    [
        ({}, {"free": "B"}, "one length"),
        ({"speed_m_s": [1.0, 2.0], "tof_incident_s": [1.0]}, {"free": "B"}, "one length"),
        ({"v": [1.0], "t": [1.0]}, {"free": "B"}, "speed_m_s"),
        ("nowhere.csv", {"free": "B"}, "can't be read"),
        (7, {"free": "B"}, "expected a file"),
        ({"speed_m_s": [0.5], "tof_incident_s": [7e-4]}, {"free": "beta", "tof_error": 1e-6, "speed_error": 1e-6}, "beta"),
        ({"speed_m_s": [0.5], "tof_incident_s": [7e-4]}, {"free": []}, "nothing is free"),
        ({"speed_m_s": [0.5], "tof_incident_s": [7e-4]}, {"free": None}, "nothing is free"),
        ({"speed_m_s": [0.5], "tof_incident_s": [7e-4]}, {"free": {"eta": 1e4}}, "nothing is free"),
        ({"speed_m_s": [0.5], "tof_incident_s": [7e-4]}, {"free": "B", "against": "hertz"}, "a dict of models"),
        ({"speed_m_s": [0.5], "tof_incident_s": [7e-4]}, {"free": "B", "method": "guess"}, "posterior"),
    ],
)
def test_what_makes_no_sense_is_refused_in_words(data, options, words):
    with pytest.raises(hc.HertzchainError, match=words):
        hc.fit(data, **options)


def test_a_printed_fit_says_that_the_model_does_not_follow_the_data() -> None:
    measured = hc.sweep("dry", np.geomspace(0.2, 1.0, 5))
    how = {"tof_error": "0.1 us", "speed_error": 0}
    assert "does not follow" in repr(hc.fit(measured, "hertz", free="Y", **how))
    assert "does not follow" not in repr(hc.fit(measured, "dry", free="eta", **how))


def test_several_tables_are_fitted_together_with_a_systematic_error() -> None:
    dry = hc.preset("dry")
    near = hc.sweep(dry, np.geomspace(0.2, 1.0, 5))
    far_row = dry.set({"sensors.bead": 20})
    far = hc.sweep(far_row, np.geomspace(0.2, 1.0, 5))
    how = {"free": "eta,B", "tof_error": "0.1 us", "speed_error": 0, "systematic": {"delay": 2e-7}}
    one = hc.fit(near, dry, **how)
    both = hc.fit(near, dry, also=[(far, far_row)], **how)
    assert list(both.parameters) == ["eta", "B", "delay"]
    assert both.parameters["delay"].standard_error < one.parameters["delay"].standard_error
    assert len(both.details["tables"]) == 2 and len(both.rows["file"]) == 20
    assert both.parameters["B"].value == pytest.approx(77, abs=both.parameters["B"].standard_error)
