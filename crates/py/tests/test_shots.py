"""Shots, sweeps and ensembles: the command line's numbers, and NumPy's ways."""

import pickle

import numpy as np
import pytest
from conftest import pickled

import hertzchain as hc
from hertzchain.results import unit

NUMBERS = ["tof_incident_s", "tof_reflected_s", "accuracy_reached", "duration_s"]


def test_a_shot_has_the_bits_of_the_command_line(cli, dry):
    reported = cli("shot", "--preset", "dry", "--speed", "0.37", "--check")
    found = hc.shot(dry, 0.37, check=True)
    for name in reported:
        # The budget is a dict of doubles; times are doubles; all must be equal, not close.
        theirs = reported[name]
        ours = found.energy if name == "energy" else getattr(found, name)
        assert ours == theirs, name
    # The command line would say so of a chain that is not named.
    assert "assumed_model" not in found.details


def test_what_has_no_effect_on_an_ensemble_is_refused(dry):
    for named in ({"speed": [0.1, 0.9]}, {"solver.accuracy": [1e-3, 1e-9]}, {"young_modulus": 2e11, "materials.aisi316.young_modulus": 1e11}):
        with pytest.raises(hc.OptionError, match=r"give these as its speeds|share the solver|named twice"):
            hc.ensemble(dry, 0.5, named)
    masked = hc.ensemble(dry, np.ma.array([0.5, 0.6], mask=[False, True]), error_control="per-shot")
    assert np.isnan(masked.tof_incident_s).tolist() == [False, True] and list(masked.errors) == [(1,)]


@pytest.mark.parametrize("sensor", ["bead_0", "bead_41", "contact_41", "bead_plus_wall_41", "velocity_42", ("bead", 7.9), ("bead", True)])
def test_a_sensor_that_is_not_there_is_refused(dry, sensor):
    with pytest.raises(hc.OptionError, match=r"there is no|is no sensor"):
        hc.shot(dry, trace=[sensor])


def test_a_sweep_has_the_bits_of_the_command_line(cli, dry):
    reported = cli("sweep", "--preset", "dry", "--speeds", "log:0.1:1.2:20")
    found = hc.sweep(dry, "log:0.1:1.2:20")
    for name in NUMBERS:
        theirs = [point[name] for point in reported["points"]]
        assert found.columns[name].tolist() == theirs
    assert found.columns["wall_peak_n"].tolist() == [p["passage"]["wall"]["value"] for p in reported["points"]]
    for name in ("power_law_incident", "power_law_reflected"):
        ours, theirs = getattr(found, name), reported[name]
        assert (ours.prefactor_s, ours.exponent) == (theirs["prefactor_s"], theirs["exponent"])
        assert (ours.prefactor_error_s, ours.exponent_accuracy) == (theirs["prefactor_error_s"], theirs["exponent_accuracy"])


def test_calibration_and_the_striker_are_those_of_the_command_line(cli, dry):
    reported = cli("sweep", "--preset", "dry", "--speeds", "0.2:1:200")
    found = hc.sweep(dry, "0.2:1:200")
    assert found.error_control == reported["error_control"] and found.error_control.startswith("calibrated")
    assert found.tof_incident_s.tolist() == [point["tof_incident_s"] for point in reported["points"]]
    assert found.calibration == reported["calibration"]
    reported = cli("sweep", "--preset", "dry", "--speeds", "0.2,0.5", "--rebound")
    rebounds = [point["striker_rebound"]["end_m_s"] for point in reported["points"]]
    assert hc.sweep(dry, [0.2, 0.5], rebound=True).columns["striker_rebound_m_s"].tolist() == rebounds


@pytest.mark.parametrize("verb", ["check", "theory"])
def test_descriptions_are_those_of_the_command_line(cli, dry, verb):
    reported = cli(verb, "--preset", "dry", "--speed", "0.4")
    groups = reported["groups"] if verb == "check" else reported
    found = getattr(hc, verb)(dry, 0.4)
    for ours, theirs in zip(found, groups, strict=True):
        assert ours.title == theirs["title"]
        assert [(row.name, row.value, row.unit) for row in ours.rows] == [(row["name"], row["value"], row["unit"]) for row in theirs["rows"]]


def test_laws_are_those_of_the_command_line(cli):
    reported = cli("laws")
    found = hc.laws()
    assert [law.name for law in found] == [law["name"] for law in reported]
    assert [law.parameters for law in found] == [law["parameters"] for law in reported]
    assert "damping_cubic" in repr(hc.laws("damping_cubic")[0])


def test_a_file_a_dict_and_objects_are_the_same_chain(tmp_path, small):
    (tmp_path / "row.toml").write_text(small.text)
    loaded = hc.load(tmp_path / "row.toml")
    plain = hc.build(
        {
            "materials": {"steel": {"young_modulus": "213 GPa", "poisson_ratio": 0.3, "density": "7.96 g/cm^3"}},
            "striker": {"speed": "500 mm/s"},
            "beads": [{"count": 10, "radius": "6.35 mm", "material": "steel"}],
            "contacts": [{"laws": ["elastic_hertz", {"law": "damping_cubic", "coefficient": "77 kg s/m^2"}]}],
            "sensors": {"bead": 3},
        }
    )
    times = {hc.shot(chain).tof_incident_s for chain in (small, loaded, plain)}
    assert len(times) == 1


def test_an_ensemble_broadcasts_as_numpy_does(small):
    speeds = np.array([0.2, 0.5, 1.0])
    moduli = np.array([[200e9], [213e9]])
    found = hc.ensemble(small, speeds, {"young_modulus": moduli})
    assert found.shape == found.tof_incident_s.shape == (2, 3)
    assert np.array_equal(found.parameters["young_modulus"], np.broadcast_to(moduli, (2, 3)))
    for row, modulus in enumerate(moduli.ravel()):
        own = hc.sweep(small.set({"young_modulus": float(modulus)}), speeds)
        for name, column in own.columns.items():
            # A shot's bits depend on no neighbour.
            assert np.array_equal(found[name][row], column, equal_nan=True), name
    assert found.error_control.startswith("per shot: so few")


def test_an_ensemble_of_no_dimension_is_one_shot(small):
    found = hc.ensemble(small, 0.5)
    assert found.shape == () and found.tof_incident_s.shape == ()
    assert float(found.tof_incident_s) == hc.sweep(small, [0.5]).tof_incident_s[0]
    assert hc.ensemble(small, np.empty((0, 3))).shape == (0, 3)


def test_results_depend_on_no_threads(small):
    speeds = np.linspace(0.1, 1.0, 50)
    one, two = (hc.ensemble(small, speeds, threads=threads) for threads in (1, 3))
    for name in one.columns:
        assert np.array_equal(one[name], two[name], equal_nan=True)


def test_unjudged_shots_are_as_right_as_was_asked(small):
    speeds = np.linspace(0.2, 1.0, 20)
    exact = [hc.shot(small, float(speed), accuracy=1e-9).tof_incident_s for speed in speeds]
    for error_control in ("per-shot", "calibrated", "none"):
        found = hc.ensemble(small, speeds, accuracy=1e-6, error_control=error_control)
        # The accuracy asked for is the tolerance.
        assert np.allclose(found.tof_incident_s, exact, rtol=1e-6, atol=0)


def test_what_fails_is_told_and_the_rest_is_computed(small):
    found = hc.ensemble(small, [0.5, np.nan, -1.0, 0.6])
    assert sorted(found.errors) == [(1,), (2,)]
    assert np.isfinite(found.tof_incident_s[[0, 3]]).all() and np.isnan(found.tof_incident_s[[1, 2]]).all()
    swept = hc.sweep(small, [0.5, np.inf])
    assert list(swept.errors) == [1]
    with pytest.raises(hc.OptionError, match="no shot could be computed"):
        hc.ensemble(small, [-1.0, np.nan])


def test_what_is_odd_is_warned_of_once_a_call_and_told():
    pump, speeds = hc.preset("pump"), np.array([[0.5, 0.1], [0.05, 0.6]])
    with pytest.warns(hc.ExperimentWarning, match="Poisson ratio") as warned:
        found = hc.ensemble(pump, speeds)
    assert len(warned) == 1 and found.warnings is not None
    assert (found.warnings.index, found.warnings.shots) == ((0, 1), 2)
    assert "Poisson ratio" in found.warnings.messages[0] and "warnings" in repr(found)
    with pytest.warns(hc.ExperimentWarning, match="another shot"):
        swept = hc.sweep(pump, speeds.ravel())
    assert sorted(swept.warnings) == [1, 2] and swept.warnings[1] == found.warnings.messages
    assert hc.ensemble(pump, [0.5, 0.6]).warnings is None


def test_traces_are_sampled_where_asked(small):
    found = hc.shot(small, 0.5, trace=["bead_3", ("contact", 10), "velocity_0", "position_10"], interval_s=1e-6)
    trace = found.trace
    assert trace is not None
    assert set(trace.signals) == {"bead_3", "contact_10", "velocity_0", "position_10"}
    assert np.allclose(np.diff(trace.time_s), 1e-6, rtol=1e-9)  # rounding of multiples
    peak = found.passage["wall"]
    sampled = trace["contact_10"].max()
    # A parabola about the peak is lower by its curvature: width 30 µs, half a microsecond.
    assert sampled == pytest.approx(peak["value"], rel=2e-3)
    numbers, stacked = hc.shot(small, 0.5, trace=[f"contact_{i}" for i in range(11)]).trace.stacked("contact")
    assert numbers.tolist() == list(range(11)) and stacked.shape[0] == 11
    assert found.energy is not None and abs(found.energy["relative_residual"]) < found.accuracy_asked
    assert set(hc.shot(small, trace=True).trace.signals) == {"bead_3", "contact_10"}


def test_results_convert_with_units(small):
    swept = hc.sweep(small, [0.2, 0.4, 0.8])
    data = swept.to_xarray()
    assert data["tof_incident_s"].attrs["units"] == "s" and data["wall_peak_n"].attrs["units"] == "N"
    assert data["speed_m_s"].attrs["units"] == "m/s"
    assert [unit(f"tof_incident_s{of}") for of in ("", "_error", "_deviation")] == ["s", "s", "s"]
    assert unit("wall_over_incident_err") == unit("tof_incident_s_error", dimensionless=True) == "1"
    table = swept.to_pandas()
    assert table.index.name == "speed_m_s" and table.attrs["units"]["tof_reflected_s"] == "s"
    found = hc.ensemble(small, [[0.2], [0.4]], {"young_modulus": [200e9, 210e9, 220e9]})
    data = found.to_xarray()
    assert data["speed_m_s"].dims == ("speed_m_s",) and data["young_modulus"].dims == ("young_modulus",)
    assert data["young_modulus"].attrs["units"] == "Pa" and data["tof_incident_s"].shape == (2, 3)
    assert len(found.to_pandas()) == 6
    shot = hc.shot(small, trace=True)
    assert shot.to_xarray()["contact_10"].attrs["units"] == "N"
    assert shot.to_pandas()["tof_incident_s"] == shot.tof_incident_s
    assert shot.trace.to_pandas().attrs["units"]["bead_3"] == "N"


def test_results_and_experiments_pickle(small):
    changed = small.set({"young_modulus": 200e9}).set({"beads[0].radius": "6 mm"})
    assert pickle.loads(pickle.dumps(changed)).numbers() == changed.numbers()
    shot, swept = hc.shot(changed, trace=True), hc.sweep(changed, [0.2, 0.5, 1.0])
    results = (shot, shot.trace, swept, swept.power_law_incident, hc.ensemble(changed, [0.2, 0.5]), hc.theory(changed), hc.check(changed))
    assert all(map(pickled, (*results, *hc.laws())))
    assert np.array_equal(pickle.loads(pickle.dumps(swept)).tof_incident_s, swept.tof_incident_s)


def test_results_print_well(small):
    shot, swept = hc.shot(small), hc.sweep(small, [0.2, 0.5, 1.0])
    assert "incident ToF" in repr(shot) and " s" in repr(shot)
    assert "3 speeds" in repr(swept) and "v^-0.2" in repr(swept)
    assert "10 beads" in repr(small) and "Trace of" in repr(hc.shot(small, trace=True).trace)
    assert "shape (2,)" in repr(hc.ensemble(small, [0.2, 0.5]))


def test_dimensionless_chains_have_no_units():
    chain = hc.build(
        units="dimensionless",
        striker={"speed": 1.0},
        beads=[{"count": 10, "mass": 1.0}],
        contacts=[{"laws": [{"law": "elastic_hertz", "stiffness": 1.0}]}],
        sensors={"bead": 3},
    )
    swept = hc.sweep(chain, [0.5, 1.0])
    assert swept.to_xarray()["tof_incident_s"].attrs["units"] == "1"
    with pytest.raises(hc.OptionError, match="dimensionless"):
        hc.shot(chain, "1 m/s")
    for speeds in ("1 km/h,2 km/h", "0.5, 1.m/s", "log:0.1:1e0 m/s:4"):
        with pytest.raises(hc.OptionError, match="dimensionless"):
            hc.sweep(chain, speeds)
    assert hc.sweep(chain, "5e-1,1E0").speed_m_s.tolist() == swept.speed_m_s.tolist()
    assert hc.sweep(chain, "log:1e-1:1.:3").speed_m_s.size == 3


def test_competing_maxima_and_a_wall_pulse_without_an_incident_one_are_reported():
    def row(beads, striker):
        return hc.build(
            units="dimensionless",
            striker={"speed": 1.0, "mass": striker},
            beads=[{"count": beads, "mass": 1.0}],
            contacts=[{"laws": [{"law": "elastic_hertz", "stiffness": 1.0}]}],
            sensors={"bead": 1},
            far_end={"kind": "half-bead"},
        )

    # A striker of ten beads presses a single one until after the wall's maximum.
    found = hc.shot(row(1, 10.0))
    assert found.tof_incident_s is None and found.passage["wall"]["value"] > 3.0
    # The train of a heavy one.
    columns = hc.sweep(row(3, 1000.0), [1.0]).columns
    names = ("competing_time_s", "competing_peak_n", "competing_reflected_time_s", "competing_reflected_peak_n")
    assert all(columns[name][0] > 0.0 for name in names)
