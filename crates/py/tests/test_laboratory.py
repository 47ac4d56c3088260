"""What a laboratory meets first: names and files, missing ones, axes with names, printed numbers."""

import numpy as np
import pytest

import hertzchain as hc


def test_an_experiment_is_named_by_its_preset_or_its_file(tmp_path, small):
    file = tmp_path / "row.toml"
    file.write_text(small.text)
    by_object = hc.shot(small, 0.5).tof_incident_s
    assert hc.shot(file, 0.5).tof_incident_s == hc.shot(str(file), 0.5).tof_incident_s == by_object
    assert hc.shot("dry", 0.5).tof_incident_s == hc.shot(hc.preset("dry"), 0.5).tof_incident_s
    assert hc.sweep(file, [0.5]).tof_incident_s[0] == hc.ensemble(file, 0.5).tof_incident_s
    assert repr(hc.check(file)) == repr(hc.check(small))
    with pytest.raises(hc.OptionError, match="expected an Experiment"):
        hc.shot(7)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "call",
    [
        lambda: hc.load("nowhere.toml"),
        lambda: hc.shot("nowhere.toml"),
        lambda: hc.measure("nowhere.csv"),
        lambda: hc.measure(["nowhere.csv"]),
        lambda: hc.fit("nowhere.csv", "dry", free="B"),
    ],
)
def test_a_file_that_is_not_there_is_a_file_not_found_error(call):
    with pytest.raises(FileNotFoundError, match="nowhere") as caught:
        call()
    assert isinstance(caught.value, hc.OptionError) and caught.value.filename.startswith("nowhere")


def test_a_record_that_can_not_be_read_and_a_speed_that_is_none_warn(tmp_path, small):
    (tmp_path / "empty.csv").write_text("")
    with pytest.warns(hc.ExperimentWarning, match="nothing was measured"):
        measured = hc.measure(tmp_path / "empty.csv")
    assert "0 of 1 records" in str(measured)
    for call in (hc.sweep, hc.ensemble):
        with pytest.warns(hc.ExperimentWarning, match="1 of 2 shots"):
            call(small, [0.5, np.nan])


def test_messages_name_arguments_of_python(small):
    with pytest.raises(hc.OptionError, match=r"step needs solver rk4 or verlet"):
        hc.shot(small, step=1e-6)
    with pytest.raises(hc.OptionError) as caught:
        hc.measure(np.ones(100), rate=1e6, beads=3, sensor=7)
    assert "--" not in str(caught.value) and "sensor 7" in str(caught.value)


def test_axes_of_xarray_are_named_after_what_varies(small):
    speeds, moduli = np.array([0.2, 0.5, 1.0]), np.array([[200e9], [213e9]])
    data = hc.ensemble(small, speeds, {"young_modulus": moduli}).to_xarray()
    assert data["tof_incident_s"].dims == ("young_modulus", "speed_m_s")
    between = data["tof_incident_s"].interp(speed_m_s=0.35)
    assert between.dims == ("young_modulus",) and np.isfinite(between).all()
    assert data.mean("speed_m_s")["tof_incident_s"].sizes == {"young_modulus": 2}
    assert hc.sweep(small, speeds).to_xarray()["tof_incident_s"].sel(speed_m_s=0.5) > 0.0
    # Inputs that change together keep their axis, inputs of several axes have them all.
    both = hc.ensemble(small, speeds, {"young_modulus": np.array([200e9, 210e9, 220e9])}).to_xarray()
    assert both["tof_incident_s"].dims == both["young_modulus"].dims == ("speed_m_s",)
    grid = hc.ensemble(small, speeds * np.array([[1.0], [1.1]])).to_xarray()
    assert grid["speed_m_s"].dims == ("axis_0", "axis_1")


def test_a_result_prints_its_numbers(small):
    swept = hc.sweep(small, [0.2, 0.5])
    for value in (0.2, *swept.tof_incident_s, *swept.tof_reflected_s):
        assert f"{value:.7g}" in repr(swept)
    assert "and 5 more" in repr(hc.ensemble(small, np.linspace(0.2, 0.5, 15)))


def test_an_array_is_measured_as_its_file_is(tmp_path, small):
    shot = hc.shot(small, 0.5, trace=["bead_plus_wall_3"], interval_s=1e-6, duration=2e-3)
    volts = 1e-2 * shot.trace["bead_plus_wall_3"] + 1e-4 * np.random.default_rng(0).standard_normal((3, shot.trace.time_s.size))
    how = {"rate": "1 MHz", "beads": 10, "sensor": 3}
    times = lambda found: [record["tof_incident_s"] for record in found.shots]
    np.save(tmp_path / "shots.npy", volts)
    from_file = times(hc.measure(tmp_path / "shots.npy", rows="shots", **how))
    assert times(hc.measure(volts, **how)) == from_file
    assert times(hc.measure(volts.T, rows="moments", **how)) == from_file
    assert times(hc.measure(np.asfortranarray(volts)[:1, :], **how)) == from_file[:1]
    assert times(hc.measure(np.concatenate(volts), shot_samples=volts.shape[1], **how)) == from_file
    with pytest.warns(hc.ExperimentWarning, match="give the rate"):
        hc.measure(volts)
