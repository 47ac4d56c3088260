"""Force laws of Python, against the built-in ones."""

import numpy as np
import pytest

import hertzchain as hc

STEEL = hc.Material(213e9, 0.3, density=7960.0)
RADIUS = 6.35e-3
# K = Y √(2R) / (3 (1 − ν²)), spheres alike and the half-bead at the wall too.
STIFFNESS = 213e9 * np.sqrt(2 * RADIUS) / (3 * (1 - 0.3**2))


def row(*laws: str | hc.Law) -> hc.Experiment:
    return hc.build(
        materials={"steel": STEEL},
        striker=hc.Striker(speed=0.7),
        beads=[hc.Beads(8, RADIUS, "steel")],
        contacts=[hc.Contacts(list(laws))],
        sensors={"bead": 3},
    )


def hertz(overlap, rate):
    return STIFFNESS * overlap**1.5


def hertz_energy(overlap):
    return 0.4 * STIFFNESS * overlap**2.5


CUBIC = 77.0


def test_hertz_written_in_python_is_the_built_in_hertz():
    built_in = hc.shot(row("elastic_hertz"), accuracy=1e-9)
    own = hc.shot(row("elastic_hertz"), accuracy=1e-9, forces=hc.ForceLaw(hertz, hertz_energy))
    # Both are right to 1e-9; two errors add.
    assert own.tof_incident_s == pytest.approx(built_in.tof_incident_s, rel=2e-9)
    assert own.tof_reflected_s == pytest.approx(built_in.tof_reflected_s, rel=2e-9)
    assert own.energy is not None and abs(own.energy["relative_residual"]) <= 1e-9


def test_a_law_with_losses_has_a_budget():
    law = hc.ForceLaw(lambda overlap, rate: hertz(overlap, rate) + CUBIC * rate**3, hertz_energy, name="hertz_and_cubic")
    chain = row("elastic_hertz", hc.Law("damping_cubic", coefficient=CUBIC))
    built_in, own = hc.shot(chain, accuracy=1e-8), hc.shot(chain, accuracy=1e-8, forces=law)
    assert own.tof_incident_s == pytest.approx(built_in.tof_incident_s, rel=2e-8)  # two errors
    assert own.energy is not None and built_in.energy is not None
    assert abs(own.energy["relative_residual"]) <= 1e-8
    lost = sum(own.energy["dissipated_j"].values())
    # Energies are right to some fifty times the accuracy of times.
    assert lost == pytest.approx(sum(built_in.energy["dissipated_j"].values()), rel=1e-6)


def test_without_an_energy_there_is_no_budget():
    assert hc.shot(row("elastic_hertz"), forces=hc.ForceLaw(hertz)).energy is None


def test_a_law_acts_beside_others_and_on_some_contacts():
    chain = row("elastic_hertz", hc.Law("damping_cubic", coefficient=CUBIC))
    beside = hc.ForceLaw(lambda overlap, rate: CUBIC * rate**3, lambda overlap: 0 * overlap, beside=True)
    with_both = hc.shot(row("elastic_hertz"), accuracy=1e-8, forces=beside)
    assert with_both.tof_incident_s == pytest.approx(hc.shot(chain, accuracy=1e-8).tof_incident_s, rel=2e-8)  # two errors
    parts = [hc.ForceLaw(hertz, hertz_energy, last=4), hc.ForceLaw(hertz, hertz_energy, first=5, last=6)]
    whole = hc.shot(row("elastic_hertz"), accuracy=1e-8)
    assert hc.shot(row("elastic_hertz"), accuracy=1e-8, forces=parts).tof_incident_s == pytest.approx(whole.tof_incident_s, rel=2e-8)


def test_what_a_law_raises_is_raised():
    def broken(overlap, rate):
        raise LookupError("no such bead")

    with pytest.raises(LookupError, match="no such bead"):
        hc.shot(row("elastic_hertz"), forces=hc.ForceLaw(broken))


@pytest.mark.parametrize("wrong", [lambda o, r: 1.0, lambda o, r: o[:, None] + np.zeros(3), lambda o, r: "much", lambda o, r: None])
def test_a_law_must_return_a_number_a_contact(wrong):
    with pytest.raises((ValueError, TypeError)):
        hc.shot(row("elastic_hertz"), forces=hc.ForceLaw(wrong))


def test_a_law_that_makes_no_sense_is_refused():
    with pytest.raises(hc.HertzchainError):
        hc.shot(row("elastic_hertz"), forces=hc.ForceLaw(lambda overlap, rate: np.nan * overlap))
    with pytest.raises(hc.OptionError, match="contact 30"):
        hc.shot(row("elastic_hertz"), forces=hc.ForceLaw(hertz, first=30))


def test_what_is_no_force_law_is_refused_in_words() -> None:
    for law in ("abc", 3.0, np.ones(2), hertz):
        with pytest.raises(hc.OptionError, match="forces takes ForceLaw"):
            hc.shot(row("elastic_hertz"), forces=law)
    assert hc.shot(row("elastic_hertz"), forces=None, trace=None).trace is None
