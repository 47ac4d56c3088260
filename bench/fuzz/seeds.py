#!/usr/bin/env python3
"""Writes the corpora: one small file a format. Needs NumPy, SciPy, h5py and docs/record.py.

The first byte of a record chooses its ending (fuzz_targets/records.rs) and is no part of the file.
"""

import json
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
import scipy.io

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(ROOT / "docs"))
import record  # noqa: E402

ENDINGS = [".csv", ".txt", ".npy", ".npz", ".wav", ".tdms", ".mat", ".h5"]


def write(target: str, name: str, content: bytes) -> None:
    folder = HERE / "corpus" / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(content)


def main() -> None:
    table = "speed_m_s,speed_error_m_s,tof_incident_s,tof_incident_s_error\n0.2,1e-4,9.03e-4,2e-7\n0.5,1e-4,7.56e-4,2e-7\n"
    write("tables", "curve", table.encode())
    write("tables", "shots", b"file;shot;case;speed;speed error\na.csv;1;dry;0,5;0,001\nb.csv;;gear;0,7;0,001\n")
    places = [[0.1 * at, 0.2 - 0.1 * at] for at in range(8)]
    chain = {"names": ["a", "b"], "seed": 1, "ensembles": 2, "differential_share": 0.5, "keep_every": 1, "loss": "Squares"}
    chain |= {"steps": 2, "places": places, "ln_densities": [-0.5 * (a * a + b * b) for a, b in places]}
    chain |= {"samples": [number for place in 2 * places for number in place], "accepted": 7, "failed": 0}
    write("checkpoint", "chain", json.dumps(chain).encode())
    time_s = 1e-6 * np.arange(100)
    volts = np.exp(-(((time_s - 3e-5) / 5e-6) ** 2)) + 1.5 * np.exp(-(((time_s - 7e-5) / 5e-6) ** 2))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        rows = list(zip(map(float, time_s), map(float, volts)))
        record.text(str(folder / "a.csv"), "Time (s),Volts", rows)
        record.labview(str(folder / "a.txt"), rows)
        record.npy(str(folder / "a.npy"), list(volts))
        record.wav(str(folder / "a.wav"), list(volts))
        record.tdms(str(folder / "a.tdms"), list(volts))
        np.savez_compressed(folder / "a.npz", time=time_s, volts=volts)
        scipy.io.savemat(folder / "a.mat", {"time": time_s, "volts": volts})
        with h5py.File(folder / "a.h5", "w") as file:
            file.create_dataset("volts", data=volts).attrs["sample_rate"] = 1e6
        for number, ending in enumerate(ENDINGS):
            write("records", ending[1:], bytes([number]) + (folder / f"a{ending}").read_bytes())


if __name__ == "__main__":
    main()
