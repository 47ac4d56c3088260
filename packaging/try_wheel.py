#!/usr/bin/env python3
"""Installs this machine's wheel where no Rust is on the path, and tries the package and the program.

    packaging/try_wheel.py target/wheels [--tests]

With --tests the package's tests run there, too, but for those that need the sources' own build.
"""

import os
import platform
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# An installation that takes longer compiles something, or the wheel carries too much.
LONGEST_S = 10.0
SMOKE = """
import hertzchain as hc
import numpy as np
curve = hc.sweep(hc.preset("dry"), np.geomspace(0.1, 1.2, 5))
assert np.all(np.diff(curve.tof_incident_s) < 0)
assert abs(hc.shot(hc.preset("dry"), 0.5).tof_incident_s - 761.904e-6) < 1e-8
assert len(hc.laws()) > 10
"""


def wheel(folder: Path) -> Path:
    """The wheel for this machine."""
    machine = platform.machine().lower()
    found = [path for path in folder.glob("hertzchain-*.whl") if machine in path.name or "universal2" in path.name]
    if len(found) != 1:
        sys.exit(f"{folder}: expected one wheel for {machine}, found {[path.name for path in found]}")
    return found[0]


def main() -> None:
    path = wheel(Path(sys.argv[1]))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([sys.executable, "-m", "venv", folder / "venv"], check=True)
        programs = folder / "venv" / ("Scripts" if os.name == "nt" else "bin")
        # Nothing but the environment and the system: no cargo, no rustc.
        environment = {**os.environ, "PATH": os.pathsep.join([str(programs), os.defpath])}
        run = lambda *words: subprocess.run(words, cwd=folder, env=environment, check=True)  # noqa: E731
        # NumPy is fetched first: what is timed is ours.
        run(programs / "pip", "install", "--quiet", "numpy")
        start = time.monotonic()
        run(programs / "pip", "install", "--quiet", "--no-index", path)
        took_s = time.monotonic() - start
        print(f"{path.name}: {path.stat().st_size / 1e6:.1f} MB, installed in {took_s:.1f} s")
        if took_s > LONGEST_S:
            sys.exit(f"installed in {took_s:.1f} s; at most {LONGEST_S:.0f} s are expected")
        run(programs / "python", "-c", SMOKE)
        run(programs / "hertzchain", "--version")
        run(programs / "hertzchain", "shot", "--preset", "dry", "--out", "shot")
        if "--tests" in sys.argv:
            run(programs / "pip", "install", "--quiet", f"{path}[test]")
            run(programs / "python", "-m", "pytest", "-m", "not long", "-q", str(ROOT / "crates/py/tests"))
    print("the wheel works")


if __name__ == "__main__":
    main()
