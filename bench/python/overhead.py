"""What Python costs: an ensemble from Python and the same from Rust, run by turns.

    cargo build --release --example throughput -p hertzchain-study
    pip install .
    python bench/python/overhead.py target/release/examples/throughput

Prints the median of the ratios of neighbouring runs and their quartiles, for speeds
alone and with a number of each shot's own, and how long calls go on after Ctrl-C.
Both halves must be built with the same profile.
"""

import signal
import subprocess
import sys
import textwrap
import time

import numpy as np

import hertzchain as hc

SHOTS = 8192
PAIRS = 20
NUMBER = "damping_cubic.coefficient"
"""Of which each shot has its own value, in the second comparison."""

CALLS = {
    "ensemble": "hc.ensemble(dry, np.linspace(0.1, 1.0, 2_000_000))",
    "ensemble with a number of each shot's own": "hc.ensemble(dry, np.linspace(0.1, 1.0, 2_000_000), {'damping_cubic.coefficient': np.linspace(70.0, 80.0, 2_000_000)})",
    "sweep": "hc.sweep(dry, np.linspace(0.1, 1.0, 100_000))",
    "sweep by pilots": "hc.sweep(dry, np.linspace(0.1, 1.0, 100_000), judges='pilots')",
}
CTRL_C = """
import signal, time
import numpy as np
import hertzchain as hc
came = []
usual = signal.getsignal(signal.SIGINT)
def note(*rest):
    came.append(time.perf_counter())
    usual(*rest)
signal.signal(signal.SIGINT, note)
dry = hc.preset("dry")
print("begun", flush=True)
try:
    CALL
except KeyboardInterrupt:
    print(time.perf_counter() - came[0])
"""


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


def ratios(program: str, names: list[str]) -> np.ndarray:
    """Python's times over Rust's, run by turns, whoever is first changing."""
    dry = hc.preset("dry")
    speeds = 0.1 * 12.0 ** (np.arange(SHOTS) / (SHOTS - 1))
    numbers = {name: dry.get(name) * (1.0 + 0.1 * np.arange(SHOTS) / SHOTS) for name in names}
    with subprocess.Popen([program, "dry", str(SHOTS), *names], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
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


def after_ctrl_c_s(call: str, wait_s: float) -> float:
    """How long a call goes on after the signal."""
    child = subprocess.Popen([sys.executable, "-c", textwrap.dedent(CTRL_C).replace("CALL", call)], stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    child.stdout.readline()
    time.sleep(wait_s)
    child.send_signal(signal.SIGINT)
    return float(child.stdout.readline())


def main() -> None:
    for about, names in {"speeds alone": [], f"{NUMBER} of each shot's own": [NUMBER]}.items():
        low, middle, high = np.quantile(ratios(sys.argv[1], names), (0.25, 0.5, 0.75))
        print(f"Python over Rust, {about}, {PAIRS} pairs of {SHOTS} shots: median {middle:.4f}, quartiles {low:.4f} to {high:.4f}", flush=True)
    for about, call in CALLS.items():
        stops = sorted(after_ctrl_c_s(call, wait_s) for wait_s in (0.1, 0.5, 1.0, 2.0, 4.0))
        print(f"after Ctrl-C, {about}: {1e3 * stops[2]:.0f} ms, at most {1e3 * stops[-1]:.0f} ms of 5", flush=True)


if __name__ == "__main__":
    main()
