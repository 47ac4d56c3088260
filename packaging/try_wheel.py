#!/usr/bin/env python3
"""Installs this machine's wheel where no Rust is on the path, and tries package, program and explorer.

    packaging/try_wheel.py target/wheels [--tests] [--pages]

With --tests the package's tests run there, too, but for long ones. With --pages the blocks of README.md,
of the tutorials and of the page on installing are executed to the letter, with nothing else on the path.
"""

import argparse
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from urllib.request import urlopen

ROOT = Path(__file__).resolve().parent.parent
# An installation that takes longer compiles something, or the wheel carries too much.
LONGEST_S = 10.0
PAGES = ["README.md", "docs/tutorials", "docs/how-to/install.md"]
SMOKE = """
import hertzchain as hc
import numpy as np
curve = hc.sweep(hc.preset("dry"), np.geomspace(0.1, 1.2, 5))
assert np.all(np.diff(curve.tof_incident_s) < 0)
assert abs(hc.shot(hc.preset("dry"), 0.5).tof_incident_s - 761.904e-6) < 1e-8
assert len(hc.laws()) > 10
"""


def wheel(folder: Path) -> Path:
    """Returns the wheel for this machine."""
    machine = platform.machine().lower()
    found = [path for path in folder.glob("hertzchain-*.whl") if machine in path.name or "universal2" in path.name]
    if len(found) != 1:
        sys.exit(f"{folder}: expected one wheel for {machine}, found {[path.name for path in found]}")
    return found[0]


class Environment:
    """A virtual environment in a folder, with nothing but it and the system on the path."""

    def __init__(self, folder: Path) -> None:
        subprocess.run([sys.executable, "-m", "venv", folder / "venv"], check=True)
        self.folder = folder
        self.programs = folder / "venv" / ("Scripts" if os.name == "nt" else "bin")
        path = os.pathsep.join([str(self.programs), os.defpath])
        self.variables = {**os.environ, "PATH": path, "HERTZCHAIN": str(self.programs / "hertzchain")}
        for compiler in ("cargo", "rustc"):
            if found := shutil.which(compiler, path=path):
                sys.exit(f"{found} is on the path; expected an environment without Rust")

    def run(self, program: str, *words: object) -> None:
        subprocess.run([self.programs / program, *map(str, words)], cwd=self.folder, env=self.variables, check=True)

    def explorer(self) -> None:
        """Loads the explorer's page from its server."""
        words = [self.programs / "hertzchain", "explore", "--no-browser"]
        with subprocess.Popen(words, env=self.variables, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as server:
            assert server.stdout
            address = next((found[0] for line in server.stdout if (found := re.search(r"http://\S+", line))), None)
            page = urlopen(address).read() if address else b""
            server.terminate()
        if b"<html" not in page:
            sys.exit(f"hertzchain explore: expected a page at the address that it prints, {address}")


def install(environment: Environment, path: Path) -> None:
    """Installs the wheel and holds the time against the longest."""
    # NumPy is fetched first: what is timed is ours.
    environment.run("pip", "install", "--quiet", "numpy")
    start = time.monotonic()
    environment.run("pip", "install", "--quiet", "--no-index", path)
    took_s = time.monotonic() - start
    print(f"{path.name}: {path.stat().st_size / 1e6:.1f} MB, installed in {took_s:.1f} s", flush=True)
    if took_s > LONGEST_S:
        sys.exit(f"installed in {took_s:.1f} s; at most {LONGEST_S:.0f} s are expected")


def main() -> None:
    parser = argparse.ArgumentParser(description="Try this machine's wheel where no Rust is on the path.")
    parser.add_argument("folder", type=Path, help="a folder of wheels")
    parser.add_argument("--tests", action="store_true", help="run the package's tests, but for long ones")
    parser.add_argument("--pages", action="store_true", help="execute the pages that a newcomer follows")
    options = parser.parse_args()
    path = wheel(options.folder).resolve()
    with tempfile.TemporaryDirectory() as name:
        environment = Environment(Path(name))
        install(environment, path)
        environment.run("python", "-c", SMOKE)
        environment.run("hertzchain", "--version")
        environment.run("hertzchain", "shot", "--preset", "dry", "--out", "shot")
        environment.explorer()
        if options.tests:
            environment.run("pip", "install", "--quiet", f"{path}[test]")
            environment.run("python", "-m", "pytest", "-m", "not long", "-q", ROOT / "crates/py/tests")
        if options.pages:
            environment.run("pip", "install", "--quiet", f"{path}[plot,table]")
            run_blocks = ["--program", environment.programs / "hertzchain", "--wheel", path]
            environment.run("python", ROOT / "docs/run_blocks.py", *PAGES, *run_blocks)
    print("the wheel works")


if __name__ == "__main__":
    main()
