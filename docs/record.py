#!/usr/bin/env python3
"""Recordings for the pages' examples: a computed shot with noise, as instruments export it.

docs/run_blocks.py runs it in a page's folder. `hertzchain` must be on the path.
"""

import csv
import random
import struct
import subprocess
import wave
from collections.abc import Iterable, Iterator
from pathlib import Path

STEP_S = 1e-6
# Volts a newton, and the deviation of the noise in volts.
GAIN, NOISE = 0.005, 0.001


def main() -> None:
    subprocess.run(
        ["hertzchain", "shot", "--preset", "dry", "--speed", "0.5 m/s", "--out", "computed"],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    with open("computed/traces.csv", encoding="utf-8") as file:
        time_s, *forces_n = zip(*[map(float, row) for row in list(csv.reader(file))[1:]])
    random.seed(1)
    moments_s = [STEP_S * number for number in range(-200, int(time_s[-1] / STEP_S))]
    sensor, wall = (noisy(sampled(moments_s, time_s, force_n)) for force_n in forces_n)
    summed = [sum(pair) for pair in zip(sensor, wall)]
    text("shot.csv", "Time (s),Volts", zip(moments_s, summed))
    text("scope.csv", "Time (s),CH1,CH3", zip(moments_s, sensor, (-2 * value for value in wall)))
    labview("shot.txt", zip(moments_s, summed))
    npy("shot.npy", summed)
    # A shot between quiet, as raw counts of 0.1 mV.
    quiet = noisy([0.0] * 20_000)
    counts = [round(1e4 * volt) for volt in [*quiet, *summed, *quiet]]
    Path("samples.raw").write_bytes(struct.pack(f"<{len(counts)}h", *counts))
    # Two shots in a file, with quiet between them.
    wav("run.wav", [*summed, *[0.0] * 20_000, *summed])
    text("run-shots.csv", "file,shot,case,speed", [("run.wav", 1, "dry", 0.5), ("run.wav", 2, "dry", 0.5)])
    Path("shots").mkdir(exist_ok=True)
    text("shots/shot.csv", "Time (s),Volts", zip(moments_s, summed))
    text("shots.csv", "file,case,speed,speed error", [("shots/shot.csv", "dry", 0.5, 0.0005)])
    tdms("run.tdms", [*summed, *[0.0] * 20_000, *summed])
    text("run-tdms.csv", "file,shot,case,speed", [("run.tdms", 1, "dry", 0.5), ("run.tdms", 2, "dry", 0.5)])


def sampled(moments_s: list[float], time_s: tuple[float, ...], values: tuple[float, ...]) -> Iterator[float]:
    """Values at other moments, by straight lines; 0 before the first."""
    right = 1
    for moment_s in moments_s:
        while right + 1 < len(time_s) and time_s[right] < moment_s:
            right += 1
        share = (moment_s - time_s[right - 1]) / (time_s[right] - time_s[right - 1])
        yield 0.0 if moment_s < 0 else values[right - 1] + share * (values[right] - values[right - 1])


def noisy(forces_n: Iterable[float]) -> list[float]:
    return [GAIN * force_n + random.gauss(0, NOISE) for force_n in forces_n]


def cell(value: object) -> str:
    return f"{value:.6f}" if isinstance(value, float) else f"{value}"


def text(name: str, header: str, rows: object) -> None:
    Path(name).write_text("\n".join([header, *(",".join(map(cell, row)) for row in rows), ""]), encoding="utf-8")


def labview(name: str, rows: object) -> None:
    """Tabs and decimal commas, as LabVIEW writes them in much of Europe."""
    header = "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t,\n***End_of_Header***\t\nX_Value\tVoltage\n"
    lines = ("\t".join(map(cell, row)).replace(".", ",") + "\n" for row in rows)
    Path(name).write_text(header + "".join(lines), encoding="utf-8")


def npy(name: str, values: list[float]) -> None:
    header = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({len(values)},), }}"
    header += " " * (-(len(header) + 11) % 64) + "\n"
    start = b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode()
    Path(name).write_bytes(start + struct.pack(f"<{len(values)}d", *values))


def wav(name: str, values: list[float]) -> None:
    with wave.open(name, "wb") as file:
        file.setparams((1, 2, round(1 / STEP_S), 0, "NONE", ""))
        file.writeframes(b"".join(struct.pack("<h", int(9000 * value + random.gauss(0, 3))) for value in values))


def tdms(name: str, values: list[float]) -> None:
    """One segment with one channel; 10 is the type of doubles."""
    channel, interval = (struct.pack("<I", len(word)) + word for word in (b"/'run'/'ai0'", b"wf_increment"))
    meta = struct.pack("<I", 1) + channel + struct.pack("<IIIQ", 20, 10, 1, len(values))
    meta += struct.pack("<I", 1) + interval + struct.pack("<Id", 10, STEP_S)
    lead = struct.pack("<4sIIQQ", b"TDSm", 14, 4713, len(meta) + 8 * len(values), len(meta))
    Path(name).write_bytes(lead + meta + struct.pack(f"<{len(values)}d", *values))


if __name__ == "__main__":
    main()
