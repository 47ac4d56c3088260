"""Keyword options: declared once, in Rust."""

import inspect
import sys
from pathlib import Path

import pytest

import hertzchain as hc

sys.path.insert(0, str(Path(__file__).parents[1]))
import keywords


def test_the_stub_for_type_checkers_has_the_options_of_rust():
    assert keywords.STUB.read_text(encoding="utf-8") == keywords.stub(), "run python crates/py/keywords.py"


@pytest.mark.parametrize("verb", ["shot", "sweep", "measure", "fit", "design", "gauge"])
def test_every_option_is_in_the_signature_and_documented(verb):
    function = getattr(hc, verb)
    known = inspect.signature(function).parameters
    names = [line.split(":")[0].strip() for line in keywords.fields(verb).splitlines()]
    assert names and all(name in known and name in function.__doc__ for name in names)


def test_values_of_any_python_type_reach_the_option(small):
    import numpy as np

    exact = hc.shot(small, 0.5, accuracy=1e-9).tof_incident_s
    assert hc.shot(small, np.float64(0.5), accuracy=np.float32(1e-9)).tof_incident_s == pytest.approx(exact, rel=1e-8)
    assert hc.shot(small, "50 cm/s", accuracy="1e-9", check=np.False_).tof_incident_s == exact
    with pytest.raises(hc.OptionError, match="accuracy = 2"):
        hc.shot(small, accuracy=2)
