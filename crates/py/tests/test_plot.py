"""Figures: what they show, read back from the axes."""

import dataclasses
import runpy

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import pytest
from conftest import ROOT
from test_inference import noisy

import hertzchain as hc
from hertzchain import plot


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def test_signals_are_in_microseconds_and_newtons(small):
    shot = hc.shot(small, 0.5, trace=["bead_3", "contact_10"])
    ax = plot.signals(shot)
    times, forces = ax.lines[1].get_data()
    assert shot.trace is not None
    assert np.array_equal(times, 1e6 * shot.trace.time_s) and np.array_equal(forces, shot.trace["contact_10"])
    assert ax.get_xlabel() == "Time (µs)" and ax.get_ylabel() == "Force (N)"
    with pytest.raises(ValueError, match="trace=True"):
        plot.signals(hc.shot(small))
    mixed = hc.shot(small, 0.5, trace=["bead_3", "velocity_3"])
    assert plot.signals(mixed, "velocity_3").get_ylabel() == "Velocity (m/s)"
    with pytest.raises(ValueError, match="N and m/s"):
        plot.signals(mixed, ["bead_3", "velocity_3"])


def test_a_space_time_map_has_a_row_a_contact(small):
    ax = plot.space_time(hc.shot(small, 0.5, trace=[f"contact_{i}" for i in range(11)]))
    (mesh,) = ax.collections
    assert mesh.get_array().shape[0] == 11
    plot.space_time(hc.shot(small, 0.5, trace=[f"velocity_{i}" for i in range(11)]), "velocity")


def test_curves_and_ratios_are_those_of_the_sweeps(small):
    swept = hc.sweep(small, [0.2, 0.5, 1.0])
    ax = plot.times_of_flight({"row": swept}, laws=True)
    assert np.array_equal(ax.lines[0].get_ydata(), 1e6 * swept.tof_incident_s)
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["row incident", "row reflected"]
    ratio = plot.ratios({"same": swept}, swept).lines[0].get_ydata()
    assert np.allclose(ratio, 1.0, rtol=1e-12)  # logarithm and back


def test_ratios_are_not_drawn_where_the_dry_curve_has_no_speeds(small):
    wet = hc.sweep(small, [0.2, 0.295, 0.5, 0.61, 1.0])
    with pytest.warns(hc.ExperimentWarning, match="2 of 5 ratios of oil are not drawn"):
        ratio = plot.ratios({"oil": wet}, hc.sweep(small, [0.3, 0.4, 0.5, 0.6])).lines[0].get_ydata()
    assert np.isnan(ratio[[0, 4]]).all()
    # The same chain: a chord of a curved line is off by some 1e-3.
    assert np.allclose(ratio[1:4], 1.0, atol=2e-3)
    with pytest.warns(hc.ExperimentWarning, match="5 of 5"):
        plot.ratios({"oil": wet}, hc.sweep(small, [2.0]))


def test_the_papers_figures_are_of_its_model():
    paper = runpy.run_path(str(ROOT / "crates/py/examples/paper_figures.py"))
    axes = paper["figure2"]()
    assert axes.shape == (4,) and all(ax.lines for ax in axes)
    few = np.array([0.2, 0.6, 1.1])
    dry = hc.sweep(hc.preset("dry"), few)
    ax = paper["figure3"](few)
    assert np.array_equal(ax.lines[0].get_ydata(), 1e6 * dry.tof_incident_s)
    pump = hc.sweep(hc.preset("pump"), few)
    line = paper["figure4"](few).lines[0]
    assert np.allclose(line.get_ydata(), pump.tof_incident_s / dry.tof_incident_s, rtol=1e-12)  # logarithm and back


def test_fits_have_bands_and_posteriors_corners():
    fitted = hc.fit(noisy("dry", 3, 5), free="eta,B")
    upper, lower = plot.fit(fitted)
    assert len(upper.collections) >= 2 and lower.get_ylabel() == "Residual (σ)"
    drawn = np.random.default_rng(0).multivariate_normal([p.value for p in fitted.parameters.values()], fitted.covariance, 2000)
    axes = plot.corner(dataclasses.replace(fitted, samples=drawn))
    assert axes.shape == (2, 2) and not axes[0, 1].axison
    given = plt.subplots(2, 2)[1]
    assert plot.corner(fitted, axes=given)[0, 0] is given[0, 0]


def test_a_case_has_one_colour_and_no_two_cases_one_look(small):
    swept = hc.sweep(small, [0.2, 0.5])

    def looks(ax):
        """Colour and dashes by label."""
        handles, labels = ax.get_legend_handles_labels()
        lines = [handle if hasattr(handle, "get_linestyle") else handle[0] for handle in handles]
        return {label: (line.get_color(), line.get_linestyle()) for label, line in zip(labels, lines, strict=True)}

    curves = {name: swept for name in ("dry", "dry pushed", "silicone", "a", "h")}
    found = looks(plot.times_of_flight(curves))
    assert len(set(found.values())) == len(found) == 10
    for others in (["silicone", "glycerol"], ["pump", "glycerol", "silicone"]):
        assert looks(plot.ratios(dict.fromkeys(others, swept), swept))["silicone"][0] == found["silicone incident"][0]


def test_legends_of_long_names_stay_inside_the_figure(small):
    swept = hc.sweep(small, [0.2, 0.5])
    ax = plot.times_of_flight({"dry": swept, "dry pushed": swept, "silicone of 100 cSt": swept})
    ax.figure.canvas.draw()
    box, figure = ax.get_legend().get_window_extent(), ax.figure.bbox
    assert box.x0 >= 0.0 and box.x1 <= figure.width and box.y1 <= figure.height


@pytest.mark.parametrize("ends", [(0.6, 1.23), (0.98, 1.02), (0.3, 1.2), (0.075, 1.23), (1e-3, 3.0), (0.011, 1.3)])
def test_axes_of_any_range_have_three_ticks(ends):
    ax = plt.subplots()[1]
    ax.plot(ends, ends)
    ax.set_xscale("log")
    plot.plain_ticks(ax.xaxis, (1.0, 2.0, 5.0))
    low, high = ax.get_xlim()
    shown = [tick for tick in ax.get_xticks() if low <= tick <= high]
    assert 3 <= len(shown) <= 9


def test_functions_draw_into_axes_they_are_given(small):
    swept = hc.sweep(small, [0.2, 0.5])
    own = plt.subplots()[1]
    assert plot.times_of_flight(swept, ax=own) is own
    assert plot.ratios({"same": swept}, swept, ax=own) is own


def test_fits_of_pulses_show_samples_in_volts_and_residuals_in_standard_errors():
    time_s = np.linspace(-1e-4, 4e-4, 50)
    measured = np.exp(-((time_s / 3e-5) ** 2))
    rows = {
        "source": np.array(["first"] * 50 + ["second"] * 50), "channel": np.ones(100), "time_s": np.tile(time_s, 2),
        "measured_v": np.tile(measured, 2), "error_v": np.full(100, 0.01), "fitted_v": np.tile(measured + 0.02, 2),
    }  # fmt: skip
    fitted = dataclasses.replace(hc.fit(noisy("dry", 3, 3), free="B"), rows=rows)
    upper, lower = plot.fit(fitted)
    times, volts = upper.lines[0].get_data()
    assert np.array_equal(times, 1e6 * time_s) and np.array_equal(volts, measured)
    residuals = lower.lines[1].get_ydata()
    assert residuals.shape == (50,) and np.allclose(residuals, -2.0, rtol=1e-9)  # rounding of a difference
    assert upper.get_ylabel() == "Signal (V)" and lower.get_xlabel().endswith("(µs)")
