"""The three notebooks run from beginning to end and show what they should, and their code has sound types."""

import base64
import json
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from conftest import ROOT
from nbclient import NotebookClient

FOLDER = ROOT / "crates/py/examples"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


LONG = {"infer"}


FIGURES = {"infer": 2, "measure": 2, "predict": 4}
"""Figures that each notebook shows."""

LAST = {
    "measure": """
assert {name: case["speed_m_s"].size for name, case in measured.cases.items()} == dict.fromkeys(("dry", "pump", "gear", "motor"), 4)
assert not measured.lost and measured.verdict is None
assert all((case["shots"] == 2).all() for case in measured.cases.values())
assert all(len(ratio["incident"]) == 4 for ratio in measured.ratios)
"""
}
"""What is asked of a notebook's names at its end: every speed and every shot that was recorded is measured."""


@pytest.mark.parametrize("path", [pytest.param(path, marks=[pytest.mark.long] * (path.stem in LONG)) for path in NOTEBOOKS], ids=lambda path: path.stem)
def test_a_notebook_runs(path):
    notebook = nbformat.read(path, as_version=4)
    if path.stem in LAST:
        notebook.cells.append(nbformat.v4.new_code_cell(LAST[path.stem]))
    NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    figures = [base64.b64decode(output.data["image/png"]) for output in outputs if "image/png" in output.get("data", {})]
    assert len(figures) == FIGURES[path.stem]
    # A figure without anything in it has some two kilobytes.
    assert all(len(figure) > 5_000 for figure in figures), [len(figure) for figure in figures]


def test_there_is_one_notebook_a_question():
    assert [path.stem for path in NOTEBOOKS] == ["infer", "measure", "predict"]


def code(path: Path) -> str:
    cells = nbformat.read(path, as_version=4).cells
    return "\n\n".join(cell.source for cell in cells if cell.cell_type == "code")


def readme() -> str:
    """The example of README.md."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    example = text.split("<!-- python: example -->\n```python\n")[1]
    return example.split("```")[0]


@pytest.mark.long
def test_pyright_in_strict_mode_finds_nothing_in_the_examples(tmp_path):
    for path in NOTEBOOKS:
        (tmp_path / f"{path.stem}.py").write_text(code(path))
    # Matplotlib leaves open what its savefig takes.
    (tmp_path / "readme.py").write_text(f"# pyright: reportUnknownMemberType=false\n{readme()}")
    # The last expression of a cell is shown: that is no mistake in a notebook.
    settings = {"include": ["."], "typeCheckingMode": "strict", "reportUnusedExpression": False, "pythonVersion": "3.10"}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings))
    done = subprocess.run([sys.executable, "-m", "pyright", "-p", tmp_path, "--pythonpath", sys.executable], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
