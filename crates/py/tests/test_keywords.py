"""Keyword options: declared once, in Rust."""

import inspect
import sys
from pathlib import Path

import pytest

import hertzchain as hc
from hertzchain import distributed

sys.path.insert(0, str(Path(__file__).parents[1]))
import keywords


def test_the_stub_for_type_checkers_has_the_options_of_rust():
    assert keywords.STUB.read_text(encoding="utf-8") == keywords.stub(), "run python crates/py/keywords.py"


@pytest.mark.parametrize("verb", keywords.VERBS)
def test_every_option_is_in_the_signature_and_documented(verb):
    function = getattr(hc, verb)
    known = inspect.signature(function).parameters
    names = [line.split(":")[0].strip() for line in keywords.fields(verb).splitlines()]
    assert names and all(name in known and name in function.__doc__ for name in names)


def test_speeds_of_an_ensemble_are_its_argument_alone(small, tmp_path):
    for call in (hc.ensemble, lambda *one, **how: distributed.sweep(*one, folder=tmp_path, **how)):
        with pytest.raises(TypeError, match="'speeds'; did you mean 'speed'"):
            call(small, speeds="0.2,0.4")
    assert "speeds :" not in hc.ensemble.__doc__ and "speeds" not in inspect.signature(hc.ensemble).parameters


def test_values_of_any_python_type_reach_the_option(small):
    import numpy as np

    exact = hc.shot(small, 0.5, accuracy=1e-9).tof_incident_s
    assert hc.shot(small, np.float64(0.5), accuracy=np.float32(1e-9)).tof_incident_s == pytest.approx(exact, rel=1e-8)
    assert hc.shot(small, "50 cm/s", accuracy="1e-9", check=np.False_).tof_incident_s == exact
    with pytest.raises(hc.OptionError, match="accuracy = 2"):
        hc.shot(small, accuracy=2)
