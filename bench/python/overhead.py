"""What Python costs: an ensemble from Python and the same from Rust, run by turns.

    cargo build --release --example throughput -p hertzchain-study
    pip install .
    python bench/python/overhead.py target/release/examples/throughput

Prints the median of the ratios of neighbouring runs and their quartiles, and how
long a call goes on after Ctrl-C. Both halves must be built with the same profile.
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
print("begun", flush=True)
try:
    hc.ensemble(hc.preset("dry"), np.linspace(0.1, 1.0, 2_000_000))
except KeyboardInterrupt:
    print(time.perf_counter() - came[0])
"""


def rust_s(process: subprocess.Popen[str]) -> float:
    """One run of the Rust program."""
    assert process.stdin is not None and process.stdout is not None
    process.stdin.write("\n")
    process.stdin.flush()
    return float(process.stdout.readline().split()[0])


def python_s(experiment: hc.Experiment, speeds: np.ndarray) -> float:
    """One run from Python."""
    begun = time.perf_counter()
    hc.ensemble(experiment, speeds)
    return time.perf_counter() - begun


def ratios(program: str) -> np.ndarray:
    """Python's times over Rust's, run by turns, whoever is first changing."""
    dry = hc.preset("dry")
    speeds = 0.1 * 12.0 ** (np.arange(SHOTS) / (SHOTS - 1))
    with subprocess.Popen([program, "dry", str(SHOTS)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        rust_s(process), python_s(dry, speeds)  # warm
        found = []
        for pair in range(PAIRS):
            if pair % 2:
                own = python_s(dry, speeds)
                found.append(own / rust_s(process))
            else:
                theirs = rust_s(process)
                found.append(python_s(dry, speeds) / theirs)
        process.stdin.close()  # type: ignore[union-attr]
    return np.array(found)


def after_ctrl_c_s() -> float:
    """How long a call goes on after the signal."""
    child = subprocess.Popen([sys.executable, "-c", textwrap.dedent(CTRL_C)], stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    child.stdout.readline()
    time.sleep(1.0)
    child.send_signal(signal.SIGINT)
    return float(child.stdout.readline())


def main() -> None:
    found = ratios(sys.argv[1])
    low, middle, high = np.quantile(found, (0.25, 0.5, 0.75))
    print(f"Python over Rust, {PAIRS} pairs of {SHOTS} shots: median {middle:.4f}, quartiles {low:.4f} to {high:.4f}")
    stops = sorted(after_ctrl_c_s() for _ in range(5))
    print(f"after Ctrl-C: {1e3 * stops[2]:.0f} ms, at most {1e3 * stops[-1]:.0f} ms of 5")


if __name__ == "__main__":
    main()
