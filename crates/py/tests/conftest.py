"""What tests share: the program to compare with, and shots that cost little."""

import json
import os
import pickle
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import hertzchain as hc

ROOT = Path(__file__).resolve().parents[3]


def program() -> Path:
    """The command line that was built beside the extension."""
    if named := os.environ.get("HERTZCHAIN"):
        return Path(named)
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    built = [target / profile / "hertzchain" for profile in ("debug", "release")]
    found = [path for path in built if path.exists()]
    if not found:
        pytest.fail("no program to compare with: run `cargo build` first, or name it in HERTZCHAIN")
    return max(found, key=lambda path: path.stat().st_mtime)


@pytest.fixture
def cli() -> Callable[..., Any]:
    """Runs a verb of the program and gives its JSON."""

    def run(*arguments: object) -> Any:
        done = subprocess.run([program(), *map(str, arguments), "--json"], check=True, capture_output=True, text=True)
        return json.loads(done.stdout)

    return run


def pickled(result: object) -> bool:
    """Whether what comes back from a pickle says the same."""
    back = pickle.loads(pickle.dumps(result))
    return type(back) is type(result) and repr(back) == repr(result)


@pytest.fixture
def dry() -> hc.Experiment:
    return hc.preset("dry")


SMALL = {
    "materials": {"steel": hc.Material(213e9, 0.3, density=7960.0)},
    "striker": hc.Striker(speed=0.5),
    "beads": [hc.Beads(count=10, radius=6.35e-3, material="steel")],
    "contacts": [hc.Contacts(["elastic_hertz", hc.Law("damping_cubic", coefficient=77.0)])],
    "sensors": {"bead": 3},
}


@pytest.fixture
def small() -> hc.Experiment:
    """Ten balls: a shot costs a tenth of the paper's."""
    return hc.build(SMALL)
