"""How long calls go on after Ctrl-C.

    pip install '.[dask]'
    python bench/python/interrupt.py           # all calls
    python bench/python/interrupt.py sweep fit # these

Each call is begun twenty times in one process and interrupted at moments spread over
its first second. The time runs from before the signal is sent until the caller
has the exception; on a busy machine it has the wait for a processor in it.
"""

import signal
import subprocess
import sys
import tempfile
import textwrap
import time

import numpy as np

TRIES = 20
FIRST_S, LAST_S = 0.02, 1.0

LONG_ROW = "hc.preset('dry').set({'beads[0].count': 900.0})"
CALLS = {
    "ensemble": "hc.ensemble(dry, np.linspace(0.1, 1.0, 2_000_000))",
    "ensemble with numbers": "hc.ensemble(dry, np.linspace(0.1, 1.0, 2_000_000), {'damping_cubic.coefficient': np.linspace(70.0, 80.0, 2_000_000)})",
    "inputs of an ensemble": "hc.ensemble(dry, np.full(5000, 0.5), {'young_modulus': np.full((9000, 1), 2e11)})",
    "sweep": "hc.sweep(dry, np.linspace(0.1, 1.0, 100_000))",
    "calibrated sweep": "hc.sweep(dry, np.linspace(0.1, 1.0, 100_000))",
    "sweep with rebound": "hc.sweep(dry, np.linspace(0.1, 1.0, 100_000), rebound=True)",
    "shot": "hc.shot(dry.set({'beads[0].count': 20000.0}), 0.5, accuracy=1e-10)",
    "campaign": "hc.campaign(hc.preset('paper'), folder)",
    "measure shots": "hc.measure([one_shot] * 200_000)",
    "measure a long record": "hc.measure(long_record)",
    "measure an array": "hc.measure(volts, rate=1e6)",
    "fit": f"hc.fit(data, {LONG_ROW}, free='eta,B')",
    "fit with profiles": f"hc.fit(data, {LONG_ROW}, free='eta,B', method='profile')",
    "fit with a posterior": "hc.fit(data, free='Y,eta,B', method='posterior', steps=10_000_000)",
    "fit with a posterior, direct": "hc.fit(data, free='eta,B', method='posterior', direct=True)",
    "gauge": "hc.gauge(data, data, model='motor')",
    "design": f"hc.design(data, {LONG_ROW}, free='eta,B')",
    "distributed sweep": "distributed.sweep(dry, np.linspace(0.1, 1.0, 100_000), folder=folder, client=client, shards=400)",
    "distributed campaign": "distributed.campaign(hc.preset('paper'), folder, client=client, shards=40)",
    "distributed fit": "distributed.fit(data, free='eta,B', method='posterior', folder=folder, client=client)",
    "distributed sweep in process": "distributed.sweep(dry, np.linspace(0.1, 1.0, 100_000), folder=folder)",
    "distributed fit in process": "distributed.fit(data, free='eta,B', method='posterior', folder=folder)",
}

CHILD = """
import signal, sys, tempfile, time
from contextlib import nullcontext
from pathlib import Path
import numpy as np
import hertzchain as hc

def main():
    signal.signal(signal.SIGINT, signal.default_int_handler)
    dry = hc.preset("dry")
    speeds = np.linspace(0.1, 1, 40)
    data = {"speed_m_s": speeds, "tof_incident_s": hc.ensemble(dry, speeds).tof_incident_s * (1 + 1e-4 * np.sin(np.arange(40) ** 2)),
            "tof_incident_s_error": np.full(40, 1e-6), "speed_error_m_s": np.full(40, 1e-6)}
    here = Path(sys.argv[1])
    if "measure" in sys.argv[2]:
        pulses = hc.shot(dry, 0.5, trace=["bead_plus_wall_7"], interval_s=1e-6, duration=4e-3).trace["bead_plus_wall_7"]
        noisy = 1e-2 * pulses + 1e-3 * np.random.default_rng(1).standard_normal(pulses.size)
        one_shot, long_record = here / "shot.npy", here / "long.csv"
        np.save(one_shot, noisy)
        volts = np.tile(noisy, (30_000, 1))
        long_record.write_text("time (us),volts\\n" + "".join(f"{at},{volt:.4f}\\n" for at, volt in enumerate(np.tile(noisy, 1500))))
    if "distributed" in sys.argv[2]:
        from dask.distributed import Client, LocalCluster
        from hertzchain import distributed
        local = LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
        client = Client(local)
    for number in range(int(sys.argv[3])):
        folder = here / str(number)
        print("begun", flush=True)
        try:
            CALL
            print("ended", flush=True)
        except KeyboardInterrupt:
            print(time.perf_counter(), flush=True)

if __name__ == "__main__":
    main()
"""


def after_ctrl_c_s(about: str) -> np.ndarray:
    """How long a call goes on each time."""
    with tempfile.TemporaryDirectory() as folder:
        script = f"{folder}/call.py"
        with open(script, "w") as file:
            file.write(textwrap.dedent(CHILD).replace("CALL", CALLS[about]))
        child = subprocess.Popen([sys.executable, script, folder, about, str(TRIES)], stdout=subprocess.PIPE, text=True)
        assert child.stdout is not None
        took_s = []
        for wait_s in np.linspace(FIRST_S, LAST_S, TRIES):
            assert child.stdout.readline() == "begun\n"
            time.sleep(wait_s)
            # The clock is the system's: it says the same in both processes.
            sent_s = time.perf_counter()
            child.send_signal(signal.SIGINT)
            ended = child.stdout.readline()
            if ended == "ended\n":
                raise SystemExit(f"{about}: over before {wait_s:.2f} s, so there is nothing to interrupt")
            took_s.append(float(ended) - sent_s)
        child.wait()
        return np.array(took_s)


def main() -> None:
    for about in sys.argv[1:] or CALLS:
        took_ms = 1e3 * after_ctrl_c_s(about)
        print(f"{about}: median {np.median(took_ms):.0f} ms, at most {took_ms.max():.0f} ms of {TRIES}", flush=True)


if __name__ == "__main__":
    main()
