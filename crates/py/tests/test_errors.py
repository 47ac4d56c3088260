"""Mistakes are exceptions with the program's reports."""

import pickle
import subprocess

import numpy as np
import pytest
from conftest import SMALL, program

import hertzchain as hc


def test_a_mistake_has_the_programs_report_with_file_line_and_key(tmp_path):
    file = tmp_path / "row.toml"
    file.write_text(hc.preset("dry").text.replace('radius = "6.35 mm"', 'radius = "6.35 kg"'))
    with pytest.raises(hc.ExperimentError) as caught:
        hc.load(file)
    reported = subprocess.run([program(), "check", file], capture_output=True, text=True, check=False)
    assert str(caught.value) == reported.stderr.rstrip()
    (finding,) = caught.value.findings
    line = file.read_text().splitlines()[finding.line - 1]
    assert finding.file == str(file) and finding.key == "radius" and line.startswith("radius")
    assert pickle.loads(pickle.dumps(caught.value)).findings == caught.value.findings


def test_a_mistake_in_a_dict_has_a_line_too():
    wrong = SMALL | {"striker": {"speed": "0.5 m"}}
    with pytest.raises(hc.ExperimentError, match="speed") as caught:
        hc.build(wrong)
    assert caught.value.findings[0].key == "speed" and caught.value.findings[0].line > 1


def test_every_mistake_is_told_at_once():
    with pytest.raises(hc.ExperimentError) as caught:
        hc.build(SMALL | {"strikr": {"speed": "0.5 m/s"}, "sensors": {"bed": 3}})
    assert {finding.key for finding in caught.value.findings} >= {"strikr", "bed"}


def test_what_is_odd_is_a_warning():
    with pytest.warns(hc.ExperimentWarning, match="poisson_ratio"):
        hc.shot(hc.preset("pump"), 0.1)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda e: hc.shot(e, -1.0), "not positive"),
        (lambda e: hc.shot(e, "0.5 kg"), "not a speed"),
        (lambda e: hc.shot(e, accuracy=1.0), "between 1e-13 and 1e-2"),
        (lambda e: hc.shot(e, step=1e-6), "rk4 or verlet"),
        (lambda e: hc.shot(e, solver="euler"), "verlet"),
        (lambda e: hc.shot(e, trace=["bead_99"]), "chain of 10 beads"),
        (lambda e: hc.shot(e, trace=["bed_3"]), "no sensor"),
        (lambda e: hc.shot(e, trace=["bead"]), "no sensor"),
        (lambda e: hc.shot(e, trace=True, interval_s=-1.0), "positive"),
        (lambda e: hc.shot(e, interval_s=1e-6), "trace"),
        (lambda e: hc.fit({"speed_m_s": [0.5]}, e, free="Y", points=4), "cluster"),
        (lambda e: hc.sweep(e, [[0.1]]), "one dimension"),
        (lambda e: hc.sweep(e, "1:2"), "FROM:TO:COUNT"),
        (lambda e: hc.sweep(e, np.ones(100_001)), "at most 100000"),
        (lambda e: hc.shot(e, trace=True, interval_s=1e-18), "sample less often"),
        (lambda e: hc.sweep(e, [0.1], error_control="all"), "calibrated"),
        (lambda e: hc.sweep(e, [0.1], threads=-1), "threads"),
        (lambda e: hc.sweep(e, [0.1], progress=7), "progress"),
        (lambda e: hc.ensemble(e, ["0.1"]), "real numbers"),
        (lambda e: hc.ensemble(e, np.zeros(3), {"young_modulus": np.zeros(4)}), "broadcast"),
        (lambda e: hc.ensemble(e, 0.5, {"yung_modulus": 1.0}), "young_modulus"),
        (lambda e: hc.ensemble(e, np.broadcast_to(0.5, (10**6, 10**6))), "in parts"),
        (lambda e: e.set({"young_modulus": "1 m"}), "young_modulus"),
        (lambda e: e.case("wet"), "no case"),
        (lambda e: hc.laws("elastic_herz"), "elastic_hertz"),
        (lambda e: hc.preset("dri"), "dry"),
        (lambda e: hc.load("nowhere.toml"), "can't be read"),
    ],
)
def test_what_makes_no_sense_is_refused_in_words(small, call, words):
    with pytest.raises(hc.HertzchainError, match=words):
        call(small)
    assert issubclass(hc.OptionError, ValueError)


def test_control_characters_of_names_and_titles_are_written_out():
    steering = "\x1b[31mred\x07\x9b"
    described = hc.check(hc.build(SMALL | {"title": steering}))
    missing = str(hc.MissingFileError(steering))
    for text in (repr(described), missing):
        assert "\\u001b[31mred\\u0007\\u009b" in text and not {"\x1b", "\x07", "\x9b"} & set(text)
