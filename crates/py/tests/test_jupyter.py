"""Figures in a notebook, shown by the inline backend of a real kernel."""

import nbformat
import pytest
from nbclient import NotebookClient

SETUP = """
import matplotlib.pyplot as plt
import numpy as np
import hertzchain as hc
from hertzchain import plot
row = hc.preset("dry").set({"beads[0].count": 10.0})
swept = hc.sweep(row, [0.2, 0.5, 1.0])
"""

OURS = "ax = plot.times_of_flight(swept)"
THEIRS = "fig = plt.figure(); line = plt.plot([0, 1])"
STYLED = "with plot.style():\n    fig, ax = plt.subplots()"


@pytest.mark.parametrize("first", [OURS, STYLED], ids=["drawn", "styled"])
def test_figures_are_shown_after_the_first_one_of_this_package(first, monkeypatch):
    monkeypatch.delenv("MPLBACKEND", raising=False)
    cells = [nbformat.v4.new_code_cell(code) for code in (SETUP, first, THEIRS, OURS, THEIRS)]
    notebook = NotebookClient(nbformat.v4.new_notebook(cells=cells), timeout=120, kernel_name="python3").execute()
    shown = [["image/png" in output.get("data", {}) for output in cell.outputs].count(True) for cell in notebook.cells[1:]]
    assert shown == [1, 1, 1, 1]
