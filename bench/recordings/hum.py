"""Errors made over errors stated, for shots with hum, ramps and steps under them.

usage: python hum.py PROGRAM [LEAD [OPTION …]]      (needs numpy)

LEAD is a time in ms before and after each shot, 0 when absent; with it there are rows of higher
harmonics and of a supply's ripple of 1 to 3 kHz. OPTIONs are of `measure`. Thirty shots of three bells at 1 MS/s for each disturbance and noise, with random phases, slopes and
places. Prints a table in Markdown: of incident and of reflected times the root mean square of made
over stated, and the median of what is stated, in µs.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

INCIDENT, REFLECTED = 761.9e-6, 797.9e-6
LEAD = float(sys.argv[2]) / 1e3 if len(sys.argv) > 2 else 0.0
TIMES = np.arange(3000 + round(2e6 * LEAD)) / 1e6
SHOTS = 30


def hum(share, hz=50):
    return lambda random: share * np.sin(2 * np.pi * hz * TIMES + random.uniform(0, 2 * np.pi))


def ripple(share):
    return lambda random: hum(share, random.uniform(1000, 3000))(random)


def ramp(share):
    return lambda random: share * random.uniform(-1, 1) * TIMES / TIMES[-1]


def step(share):
    return lambda random: share * random.choice([-1, 1]) * (random.uniform(0, TIMES[-1]) < TIMES)


def both(one, other):
    return lambda random: one(random) + other(random)


DISTURBANCES = {
    "none": lambda random: 0 * TIMES,
    "hum of 0.1 %": hum(0.001),
    "hum of 1 %": hum(0.01),
    "hum of 5 %": hum(0.05),
    "hum of 20 %": hum(0.2),
    "hum of 5 %, third harmonic of 1.5 %": both(hum(0.05), hum(0.015, 150)),
    "ramp up to 10 %": ramp(0.1),
    "ramp up to 50 %": ramp(0.5),
    "step of 1 %": step(0.01),
    "step of 5 %": step(0.05),
    "hum of 5 %, ramp up to 10 %": both(hum(0.05), ramp(0.1)),
    "hum of 5 %, step of 1 %": both(hum(0.05), step(0.01)),
}

if LEAD > 0:
    DISTURBANCES |= {
        "hum of 1 %, 13th harmonic of 0.2 %": both(hum(0.01), hum(0.002, 650)),
        "hum of 5 %, 13th harmonic of 1 %": both(hum(0.05), hum(0.01, 650)),
        "hum of 20 %, 13th harmonic of 4 %": both(hum(0.2), hum(0.04, 650)),
        "ripple of 0.1 %": ripple(0.001),
        "ripple of 1 %": ripple(0.01),
        "ripple of 5 %": ripple(0.05),
        "hum of 5 %, ripple of 1 %": both(hum(0.05), ripple(0.01)),
    }


def bell(place, height, width):
    turn = 2 * np.arccos(0.5 ** (1 / 6)) * (TIMES - place) / width
    return height * np.where(abs(turn) < np.pi / 2, np.cos(turn) ** 6, 0.0)


def shot(noise, disturbance, random):
    first = LEAD + 600e-6 + random.uniform(0, 1e-6)
    wall = first + INCIDENT
    pulses = bell(first, 1, 46e-6) + bell(wall, 1.6, 40e-6) + bell(wall + REFLECTED, 0.47, 52e-6)
    return pulses + disturbance(random) + random.normal(0, noise, len(TIMES))


def cells(shots, name, true):
    times = [shot[name] for shot in shots if shot.get(name)]
    pulls = np.array([(time["value"] - true) / time["sigma"] for time in times])
    stated = np.median([time["sigma"] for time in times])
    return f"{np.sqrt(np.mean(pulls**2)):.2f} | {1e6 * stated:.2f}"


def main():
    program = sys.argv[1]
    print("| under the shot | noise, dB | incident: made/stated | stated, µs | reflected: made/stated | stated, µs |")
    print("|---|---|---|---|---|---|")
    for noise_db in (40, 60):
        for name, disturbance in DISTURBANCES.items():
            random = np.random.default_rng(11)
            noise = 10 ** (-noise_db / 20)
            volts = [shot(noise, disturbance, random) for _ in range(SHOTS)]
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "shots.npy"
                np.save(path, np.array(volts))
                words = [program, "measure", path, "--rate", "1MHz", "--json", "--whole", *sys.argv[3:]]
                shots = json.loads(subprocess.run(words, capture_output=True).stdout)["shots"]
            incident = cells(shots, "tof_incident_s", INCIDENT)
            reflected = cells(shots, "tof_reflected_s", REFLECTED)
            print(f"| {name} | {noise_db} | {incident} | {reflected} |")


if __name__ == "__main__":
    main()
