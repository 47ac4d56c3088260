"""Campaigns and measurements: the command line's bytes and numbers."""

import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest
from conftest import ROOT, pickled, program

import hertzchain as hc

SMALL = ROOT / "crates/sim/tests/small.toml"


@pytest.fixture(scope="module")
def records(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("campaign") / "records"
    seen: list[int] = []
    done = hc.campaign(hc.load(SMALL), folder, progress=seen.append)
    assert sum(seen) == done.shots and done.kept == 0 and len(done.files) == done.run
    return folder


def test_recordings_are_the_bytes_of_the_command_line(records, tmp_path):
    subprocess.run([program(), "campaign", SMALL, "--out", tmp_path / "cli"], check=True, capture_output=True)
    theirs = sorted(path.name for path in (tmp_path / "cli").glob("*.h5"))
    assert theirs == sorted(path.name for path in records.glob("*.h5"))
    for name in theirs:
        assert (records / name).read_bytes() == (tmp_path / "cli" / name).read_bytes()


def test_a_campaign_goes_on_and_comes_in_parts(records, tmp_path):
    again = hc.campaign(hc.load(SMALL), records)
    assert again.run == 0 and again.kept == len(again.files) and pickled(again)
    for shard in ("1/2", "2/2"):
        hc.campaign(hc.load(SMALL), tmp_path / "parts", shard=shard)
    assert {p.name: p.read_bytes() for p in records.glob("*.h5")} == {p.name: p.read_bytes() for p in (tmp_path / "parts").glob("*.h5")}
    with pytest.raises(hc.OptionError, match="i/n"):
        hc.campaign(hc.load(SMALL), tmp_path, shard="3/2")
    with pytest.raises(hc.OptionError):
        hc.campaign(hc.load(SMALL), records, seed=8)


def test_recordings_open_in_h5py(records):
    with h5py.File(next(iter(sorted(records.glob("*.h5"))))) as file:
        assert len(file.keys()) > 0


def test_speeds_of_a_measurement_are_a_coordinate_where_they_are_known(records, tmp_path):
    measured = hc.measure(records, rig=SMALL)
    data = measured.to_xarray()
    assert data["tof_incident_s"].coords["speed_m_s"].values.tolist() == measured["speed_m_s"].tolist()
    assert data["speed_m_s"].attrs["units"] == "m/s" and data.groupby("speed_m_s").mean(...)["tof_incident_s"].notnull().any()
    time_s = 1e-6 * np.arange(3000)
    bells = sum(height * np.exp(-(((time_s - at) / 2e-5) ** 2)) for at, height in ((6e-4, 1.0), (1.36e-3, 1.6), (2.16e-3, 0.5)))
    unknown = hc.measure(bells + np.random.default_rng(1).normal(0, 1e-3, 3000), rate=1e6)
    assert "speed_m_s" not in unknown.to_xarray().coords and "speed_m_s" not in repr(unknown)


def test_measurements_are_those_of_the_command_line(cli, records):
    reported = cli("measure", records, "--rig", SMALL)
    found = hc.measure(records, rig=SMALL)
    assert found.shots == reported["shots"] and found.ratios == reported["ratios"]
    for case in reported["cases"]:
        own = found.cases[case["case"]]
        assert own["tof_incident_s"].tolist() == [row["tof_incident_s"]["mean"] for row in case["speeds"]]
    assert found.verdict is None and "Measured" in repr(found)
    assert pickled(found) and all(map(pickled, found.cases.values()))
    picked = {shot["tof_incident_s"]["value"] for shot in found.shots if "missing" not in shot}
    reported = found.to_pandas()
    assert len(reported) == len(found.shots) and set(reported["tof_incident_s"].dropna()) == picked


def test_arrays_are_recordings_too(small):
    shot = hc.shot(small, 0.5, trace=["bead_plus_wall_3"], interval_s=1e-6, duration=2e-3)
    assert shot.trace is not None
    rng = np.random.default_rng(0)
    volts = 1e-2 * shot.trace["bead_plus_wall_3"] + 1e-4 * rng.standard_normal(shot.trace.time_s.size)
    found = hc.measure(volts, rate=1e6, beads=10, sensor=3)
    (record,) = found.shots
    # Noise of 1e-4 V on pulses of 1 V and samples of 1 µs: a tenth of a microsecond.
    assert record["tof_incident_s"]["value"] == pytest.approx(shot.tof_incident_s, abs=1e-7)
    # Not in which folder of this process it was.
    assert record["file"] == "array.npy" and found.tables["shots.csv"] == hc.measure(volts, rate=1e6, beads=10, sensor=3).tables["shots.csv"]
    # Rows are shots, also where there are more of them than samples, if that is stated.
    few = volts[::4]
    assert len(hc.measure(np.tile(few, (few.size + 1, 1)), rate=2.5e5, rows="shots").shots) == few.size + 1


def test_what_can_not_be_read_is_told(tmp_path):
    (tmp_path / "empty.csv").write_text("")
    found = hc.measure(tmp_path / "empty.csv")
    assert found.refused and found.verdict
    with pytest.raises(hc.OptionError, match="no recordings"):
        hc.measure(tmp_path / "nothing") if (tmp_path / "nothing").mkdir() is None else None
    with pytest.raises(hc.OptionError, match='rate = "fast"'):
        hc.measure(tmp_path / "empty.csv", rate="fast")
    with pytest.raises(hc.OptionError, match="volts"):
        hc.measure(np.zeros((2, 2, 2, 2)))


@pytest.mark.filterwarnings("ignore::hertzchain.ExperimentWarning")
def test_arrays_of_any_axes_are_read_as_their_files_are(small, tmp_path):
    traces = hc.shot(small, 0.5, trace=["bead_3", "bead_plus_wall_3"], interval_s=1e-6, duration=2e-3).trace
    assert traces is not None
    both = 1e-2 * np.array(list(traces.signals.values()))
    both += np.random.default_rng(0).normal(0.0, 1e-4, both.shape)
    how = {"rate": 1e6, "beads": 10, "sensor": 3}

    def times(records, **more):
        return [(record.get("tof_incident_s"), record.get("missing")) for record in hc.measure(records, **how, **more).shots]

    shapes = {"shots": both, "channels": both.T, "both": both[None], "columns": np.tile(both, (5, 1)).T}
    for name, volts in shapes.items():
        np.save(tmp_path / f"{name}.npy", volts)
        assert times(volts) == times(tmp_path / f"{name}.npy")
    assert [len(times(volts)) for volts in shapes.values()] == [2, 1, 1, 10]
    # A channel is chosen from rows, which are no shots then.
    assert times(both, channel=2) == times(both[1])
    pandas = pytest.importorskip("pandas")
    assert times(pandas.Series(both[1])) == times(both[1]) and times(pandas.DataFrame(both.T)) == times(both.T)
    assert times(pandas.Series([str(tmp_path / "shots.npy")])) == times(both)


@pytest.mark.filterwarnings("ignore::hertzchain.ExperimentWarning")
def test_flags_are_texts_whether_a_shot_has_some_or_none(records):
    pandas = pytest.importorskip("pandas")
    texts = ("file", "case", "counted", "not_counted_because", "flags")
    for found in (hc.measure(records, rig=SMALL), hc.measure(np.random.default_rng(0).normal(size=2000), rate=1e6)):
        table = found.to_pandas()
        assert all(isinstance(cell, str) for name in texts for cell in table[name])
        assert not any(pandas.api.types.is_numeric_dtype(table[name]) for name in texts)
