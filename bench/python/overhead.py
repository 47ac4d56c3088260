"""What Python costs: an ensemble from Python and the same from Rust, run by turns.

    cargo build --release --example throughput -p hertzchain-sim
    pip install .
    python bench/python/overhead.py target/release/examples/throughput

Prints the median of the ratios of neighbouring runs and their quartiles: for speeds
alone, with a number of each shot's own, and for a column of speeds broadcast against a
row of numbers. A third argument chooses one of these, from 0. Both halves must be
built with the same profile.
"""

import subprocess
import sys
import time

import numpy as np

import hertzchain as hc

SHOTS = 4096
PAIRS = 20
NUMBER = "damping_cubic.coefficient"
"""Which varies in the second comparison and the third."""

COLUMNS = 64
"""Values of it in the third, along which 64 speeds are broadcast."""

COMPARED = {
    "speeds alone": [],
    "a number of each shot's own": [NUMBER],
    "speeds broadcast against numbers": [NUMBER, str(COLUMNS)],
}
"""And what the Rust program is told."""


def rust_s(process: subprocess.Popen[str]) -> float:
    """One run of the Rust program."""
    assert process.stdin is not None and process.stdout is not None
    process.stdin.write("\n")
    process.stdin.flush()
    return float(process.stdout.readline().split()[0])


def python_s(speeds: np.ndarray, numbers: dict[str, np.ndarray]) -> float:
    """One run from Python."""
    begun = time.perf_counter()
    hc.ensemble(hc.preset("dry"), speeds, numbers)
    return time.perf_counter() - begun


def arrays(told: list[str]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Speeds and numbers as the Rust program makes them."""
    columns = COLUMNS if len(told) > 1 else 1
    rows = np.arange(SHOTS // columns)
    speeds = 0.1 * 12.0 ** (rows / (rows.size - 1))
    if columns > 1:
        speeds, places = speeds[:, np.newaxis], np.arange(columns) / columns
    else:
        places = np.arange(SHOTS) / SHOTS
    return speeds, {name: hc.preset("dry").get(name) * (1.0 + 0.1 * places) for name in told[:1]}


def ratios(program: str, told: list[str]) -> np.ndarray:
    """Python's times over Rust's, run by turns, whoever is first changing."""
    speeds, numbers = arrays(told)
    with subprocess.Popen([program, "dry", str(SHOTS), *told], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        rust_s(process), python_s(speeds, numbers)  # warm
        found = []
        for pair in range(PAIRS):
            if pair % 2:
                own = python_s(speeds, numbers)
                found.append(own / rust_s(process))
            else:
                theirs = rust_s(process)
                found.append(python_s(speeds, numbers) / theirs)
        process.stdin.close()  # type: ignore[union-attr]
    return np.array(found)


def main() -> None:
    chosen = [list(COMPARED)[int(at)] for at in sys.argv[2:]] or COMPARED
    for about in chosen:
        low, middle, high = np.quantile(ratios(sys.argv[1], COMPARED[about]), (0.25, 0.5, 0.75))
        print(f"Python over Rust, {about}, {PAIRS} pairs of {SHOTS} shots: median {middle:.4f}, quartiles {low:.4f} to {high:.4f}", flush=True)


if __name__ == "__main__":
    main()
