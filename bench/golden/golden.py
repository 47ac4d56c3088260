"""Records the numbers that the program prints, and compares them later.

usage: golden.py record|check [--program FILE] [--only TEXT]

While crates are moved and renamed no number may change. `record` runs the program in many ways and
keeps the numbers of its JSON output, bit for bit, in golden.json.gz beside this file; `check` runs
the same again and names what is missing. Numbers are compared as a multiset without their
keys, so that keys may be renamed and added. Python's standard library alone; about three minutes on two cores.
"""

import argparse
import collections
import concurrent.futures
import gzip
import json
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
STORED = HERE / "golden.json.gz"

PAPER = ["hertz", "hertz-viscoelastic", "dry", "motor", "gear", "pump"]
EXAMPLES = ["dimer-steel-ptfe", "exponent-section", "heavy-striker", "light-intruder", "newtons-cradle",
            "precompressed", "tapered", "vertical-on-specimen"]
SPEEDS = "0.075 0.1 0.1368 0.2 0.3993 0.5 0.8 1 1.152 1.23 2".split()
ERRORS = ["--tof-error", "2e-7", "--speed-error", "5e-4"]
# Times that machines need, and places.
VOLATILE = {"seconds", "elapsed_s", "threads", "shots_per_s"}


def commands(folder):
    """Every way the program is run: name -> words after its name; tables are made beforehand."""
    for name in PAPER:
        for speed in SPEEDS:
            yield f"shot {name} {speed}", ["shot", "-p", name, "--speed", f"{speed} m/s"]
        for accuracy in ["1e-3", "1e-5", "1e-6", "1e-7"]:
            yield f"sweep {name} {accuracy}", ["sweep", "-p", name, "--speeds", "log:0.075:2.0:23", "-a", accuracy]
    for name in EXAMPLES:
        yield f"shot {name}", ["shot", "-p", name]
        yield f"theory {name}", ["theory", "-p", name]
    yield "sweep pilots", ["sweep", "-p", "dry", "--speeds", "log:0.075:1.2:400", "-a", "1e-4"]
    yield "sweep rebound", ["sweep", "-p", "gear", "--speeds", "0.1,0.5,1", "--rebound"]
    for pick in ["flank-10", "flank-50", "cross-correlation"]:
        yield f"shot pick {pick}", ["shot", "-p", "motor", "--speed", "0.4", "--pick", pick]
    for solver in ["rk4", "verlet"]:
        yield f"shot {solver}", ["shot", "-p", "dry", "--solver", solver, "--step", "0.2 us"]
    data = ROOT / "crates/measure/tests/records/data"
    for file in ["oscilloscope.csv", "decimal-comma.csv", "segments.csv", "shots.npz", "shots.tdms"]:
        yield f"measure {file}", ["measure", f"{data / file}"]
    yield "measure campaign", ["measure", f"{folder / 'campaign'}", "--rig", f"{rig()}"]
    dry, motor = (f"{folder / name / 'sweep.csv'}" for name in ["dry", "motor"])
    fit = ["fit", dry, "-p", "dry", "--free", "eta,B", *ERRORS]
    yield "fit", fit
    yield "fit profile", [*fit, "--method", "profile"]
    yield "fit posterior", [*fit, "--method", "posterior", "--steps", "200", "--seed", "5"]
    yield "fit robust", [*fit, "--robust"]
    yield "fit against", [*fit, "--against", "hertz-viscoelastic=eta"]
    yield "design", ["design", dry, "-p", "dry", "--free", "eta,B", "--speeds", "0.1,0.4,1.2", *ERRORS]
    yield "gauge", ["gauge", motor, "--dry", dry, "-p", "motor", "--dry-preset", "dry", *ERRORS]


def rig():
    return ROOT / "crates/sim/tests/small.toml"


def numbers(value):
    """All numbers of a JSON value, as their shortest decimal texts."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key not in VOLATILE:
                yield from numbers(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from numbers(inner)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield repr(float(value))


def run(program, words):
    done = subprocess.run([program, *words, "--json"], capture_output=True, text=True)
    if not done.stdout.strip():
        return {"error": done.stderr}
    return sorted(numbers(json.loads(done.stdout)))


def prepare(program, folder):
    """The tables and recordings that other commands read."""
    for name in ["dry", "motor"]:
        out = ["--out", folder / name]
        subprocess.run([program, "sweep", "-p", name, "--speeds", "log:0.1:1.2:6", *out], check=True, capture_output=True)
    out = ["--out", folder / "campaign"]
    subprocess.run([program, "campaign", rig(), *out], check=True, capture_output=True)


def found(program, only):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        prepare(program, folder)
        asked = [(name, words) for name, words in commands(folder) if only in name]
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            results = pool.map(lambda one: run(program, one[1]), asked)
            return {name: result for (name, _), result in zip(asked, results)}


def differences(old, new):
    if isinstance(old, dict) or isinstance(new, dict):
        return [f"now: {new}"] if old != new else []
    missing = collections.Counter(old) - collections.Counter(new)
    return [f"{sum(missing.values())} of {len(old)} numbers are missing, such as {sorted(missing)[:4]}"] if missing else []


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["record", "check"])
    parser.add_argument("--program", default=ROOT / "target/release/hertzchain")
    parser.add_argument("--only", default="")
    options = parser.parse_args()
    new = found(options.program, options.only)
    if options.what == "record":
        with gzip.GzipFile(STORED, "wb", mtime=0) as file:
            file.write(json.dumps(new, indent=0).encode())
        failed = [name for name, result in new.items() if isinstance(result, dict)]
        print(f"{len(new)} runs, {sum(len(result) for result in new.values())} numbers; failed: {failed}")
        return 0
    old = {name: result for name, result in json.loads(gzip.decompress(STORED.read_bytes())).items() if options.only in name}
    changed = {name: differences(result, new.get(name, {})) for name, result in old.items()}
    changed = {name: what for name, what in changed.items() if what}
    for name, what in changed.items():
        print(f"{name}: {what[0]}")
    print(f"{len(old)} runs, {len(changed)} changed")
    return bool(changed)


if __name__ == "__main__":
    sys.exit(main())
