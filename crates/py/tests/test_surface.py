"""Whatever Python hands over: an exception or numbers, never a crash."""

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import hertzchain as hc

CHAIN = hc.build(
    {
        "units": "dimensionless",
        "striker": {"speed": 1.0},
        "beads": [{"count": 4, "mass": 1.0}],
        "contacts": [{"laws": [{"law": "elastic_hertz", "stiffness": 1.0}]}],
        "sensors": {"bead": 2},
    }
)
NAME = "elastic_hertz.stiffness"

few = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
dtypes = st.sampled_from(["f8", "f4", "f2", ">f8", "i4", "u1", "?", "c16", "U3", "O", "M8[s]", "g"])
shapes = hnp.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=3)
anything = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=9), st.binary(max_size=4),
    st.lists(st.floats(), max_size=3), st.dictionaries(st.text(max_size=3), st.floats(), max_size=2),
)  # fmt: skip


ROW = hc.build(
    {
        "materials": {"steel": {"young_modulus": "213 GPa", "poisson_ratio": 0.3, "density": "7960 kg/m^3"}},
        "striker": {"speed": "0.5 m/s"},
        "beads": [{"count": 4, "radius": "6.35 mm", "material": "steel"}],
        "contacts": [{"laws": [{"law": "elastic_hertz"}]}],
        "sensors": {"bead": 2},
    }
)
# Between these a shot takes as long as it is said to.
seconds = st.one_of(
    anything.filter(lambda value: not isinstance(value, (int, float))), st.booleans(),
    st.floats(max_value=2e-3), st.floats(min_value=1e6), st.integers(max_value=0),
)  # fmt: skip
sensors = st.one_of(
    anything,
    st.lists(st.sampled_from(["bead_1", "contact_0", "position_4", "velocity_9", "bead_-1", ("contact", 2), ("bead", 10**30), ("bead", 1.5)])),
)


def refused_or(call):
    """What a call gives; refusals are exceptions of ours or Python's own of type and value."""
    try:
        return call()
    except (hc.HertzchainError, TypeError, ValueError, OverflowError, KeyError):
        return None


@few
@given(st.data(), shapes, dtypes)
def test_arrays_of_any_shape_and_type(data, shape, dtype):
    elements = st.sampled_from([0.5, 1.0, 2.0]) if np.dtype(dtype).kind == "f" else None
    speeds = data.draw(hnp.arrays(dtype, shape, elements=elements))
    found = refused_or(lambda: hc.ensemble(CHAIN, speeds, error_control="none"))
    if found is not None:
        assert found.tof_incident_s.shape == speeds.shape
    refused_or(lambda: hc.sweep(CHAIN, speeds))


@few
@given(hnp.arrays("f8", hnp.array_shapes(min_dims=1, max_dims=3, max_side=4)))
def test_numbers_of_any_size(values):
    found = refused_or(lambda: hc.ensemble(CHAIN, values, error_control="none"))
    if found is not None:
        missing = np.zeros(found.shape, dtype=bool)
        for index in found.errors:
            missing[index] = True
        assert not np.isfinite(found.tof_incident_s[missing]).any()
    refused_or(lambda: hc.ensemble(CHAIN, 1.0, {NAME: values}, error_control="none"))


@few
@given(st.integers(1, 4), st.integers(1, 4), st.sampled_from(["transposed", "strided", "reversed", "read-only", "fortran", "broadcast"]))
def test_memory_of_any_layout_gives_the_same_bits(rows, columns, layout):
    plain = np.linspace(0.5, 2.0, rows * columns).reshape(rows, columns)
    read_only = plain.copy()
    read_only.flags.writeable = False
    spread = np.zeros((2 * rows, 3 * columns))
    spread[::2, ::3] = plain
    made = {
        "transposed": np.ascontiguousarray(plain.T).T,
        "strided": spread[::2, ::3],
        "reversed": np.ascontiguousarray(plain[::-1, ::-1])[::-1, ::-1],
        "read-only": read_only,
        "fortran": np.asfortranarray(plain),
        "broadcast": np.broadcast_to(plain[:1], (rows, columns)),
    }[layout]
    whole = plain if layout != "broadcast" else np.repeat(plain[:1], rows, axis=0)
    expected = hc.ensemble(CHAIN, whole, error_control="none").tof_incident_s
    found = hc.ensemble(CHAIN, made, error_control="none")
    assert np.array_equal(found.tof_incident_s, expected)
    assert np.array_equal(made, whole)


@few
@given(anything, anything, anything)
def test_any_argument_of_a_shot(speed, accuracy, duration):
    if isinstance(duration, (int, float)) or (isinstance(speed, float) and speed < 1e-3):
        duration = None
    refused_or(lambda: hc.shot(CHAIN, speed, accuracy=accuracy if accuracy != 0 else None, duration=duration))


@few
@given(seconds, st.one_of(anything, st.sampled_from([1e-18, 5e-324, 1e-9, 1e300])), sensors)
def test_any_time_and_sensor_of_a_shot(duration, interval_s, trace):
    found = refused_or(lambda: hc.shot(ROW, duration=duration, interval_s=interval_s, trace=trace))
    if found is not None and found.trace is not None:
        assert all(signal.shape == found.trace.time_s.shape for signal in found.trace.signals.values())


@few
@given(anything, anything)
def test_any_name_and_value(name, value):
    refused_or(lambda: CHAIN.set({name: value}))
    refused_or(lambda: CHAIN.get(name))
    refused_or(lambda: CHAIN.case(name))
    refused_or(lambda: hc.laws(name))
    refused_or(lambda: hc.preset(name))


@few
@given(st.recursive(anything, lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=5), inner, max_size=3)), max_leaves=8))
def test_any_dict_is_no_experiment_but_a_report(tables):
    if isinstance(tables, (dict, str)):
        refused_or(lambda: hc.build(tables))


@few
@given(st.dictionaries(st.sampled_from(["speed_m_s", "tof_incident_s", "tof_incident_s_error", "case"]), hnp.arrays("f8", st.integers(0, 4)), max_size=4))
def test_any_table_to_fit(columns):
    refused_or(lambda: hc.fit(columns, "hertz", free="Y"))


@few
@given(anything, shapes, dtypes)
def test_any_recording(rate, shape, dtype):
    volts = np.zeros(shape, dtype="f8").astype(dtype) if np.dtype(dtype).kind not in "UOM" else np.zeros(shape, dtype=dtype)
    refused_or(lambda: hc.measure(volts, rate=rate))
