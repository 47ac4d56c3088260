"""What Dask costs a shard: the numbers of docs/across-machines.md.

    pip install '.[dask]'
    python bench/python/shards.py

For one worker and for two, of one thread each: how long a shard without shots takes
from being handed out to being told, how long shots take in shards and in one
process by turns, and how many bytes are left. Times are wall time: run it on a quiet
machine.
"""

import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from dask.distributed import Client, LocalCluster

import hertzchain as hc
from hertzchain import distributed

EMPTY = 400
SHARDS = 8
SHOTS = 4_000
ACCURACY = 1e-5
TIMES = 3


def seconds(call: Callable[[], object]) -> float:
    begun = time.perf_counter()
    call()
    return time.perf_counter() - begun


def swept(client: Client | None, speeds: np.ndarray, shards: int) -> tuple[float, int]:
    """Wall time of a run in shards, and bytes of its files."""
    dry = hc.preset("dry")
    with tempfile.TemporaryDirectory() as folder:
        wall_s = seconds(lambda: distributed.sweep(dry, speeds, folder=folder, client=client, shards=shards, accuracy=ACCURACY))
        return wall_s, sum(path.stat().st_size for path in Path(folder).glob("sweep-*.h5"))


def measured(workers: int) -> None:
    dry, speeds = hc.preset("dry"), np.geomspace(0.1, 1.2, SHOTS)
    with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        swept(client, speeds[: 10 * workers], 10 * workers)  # workers import the package
        empty_s = min(swept(client, speeds[:1], EMPTY)[0] for _ in range(TIMES)) / EMPTY
        print(f"{workers} workers: {1e3 * empty_s:.2f} ms a shard without shots, {1 / empty_s:.0f} shards a second")
        ratios = []
        for _ in range(TIMES):
            here_s = seconds(lambda: hc.ensemble(dry, speeds, accuracy=ACCURACY, threads=workers))
            there_s, size = swept(client, speeds, SHARDS)
            ratios.append(there_s / here_s)
            print(f"  {SHOTS} shots: {here_s:.3f} s in {workers} threads, {there_s:.3f} s in {SHARDS} shards, {size / SHOTS:.1f} bytes a shot")
        print(f"  median ratio {np.median(ratios):.4f}")


if __name__ == "__main__":
    for workers in (1, 2):
        measured(workers)
