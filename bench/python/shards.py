"""What Dask costs a shard: the numbers of docs/how-to/many-machines.md.

    pip install '.[dask]'
    python bench/python/shards.py

For one worker and for two, of one thread each: what a shard without shots takes of
the wall clock, of this process, which has the client and the scheduler, and of the
workers; and what shots take in one process and in shards, with the bytes they leave.
Times of processors can be told on a busy machine, too.
"""

import tempfile
import time
from pathlib import Path

import numpy as np
from dask.distributed import Client, LocalCluster

import hertzchain as hc
from hertzchain import distributed

EMPTY = 400
SHARDS = 8
SHOTS = 2_000
ACCURACY = 1e-5
TIMES = 3


def workers_s(client: Client | None) -> float:
    """Processor time of all workers so far."""
    return 0.0 if client is None else sum(client.run(time.process_time).values())


def swept(client: Client | None, speeds: np.ndarray, shards: int) -> tuple[np.ndarray, int]:
    """Seconds of the clock, of this process and of the workers; bytes of the shards."""
    with tempfile.TemporaryDirectory() as folder:
        begun = np.array([time.perf_counter(), time.process_time(), workers_s(client)])
        distributed.sweep(hc.preset("dry"), speeds, folder=folder, client=client, shards=shards, accuracy=ACCURACY)
        ended = np.array([time.perf_counter(), time.process_time(), workers_s(client)])
        return ended - begun, sum(path.stat().st_size for path in Path(folder).glob("sweep-*.h5"))


def measured(client: Client | None) -> None:
    speeds = np.geomspace(0.1, 1.2, SHOTS)
    swept(client, speeds[:20], 20)  # workers import the package
    for _ in range(TIMES):
        clock, own, workers = 1e3 * swept(client, speeds[:1], EMPTY)[0] / EMPTY
        print(f"  a shard without shots: {clock:.2f} ms of the clock, {own:.2f} ms of this process, {workers:.2f} ms of workers")
    for _ in range(TIMES):
        (clock, own, workers), size = swept(client, speeds, SHARDS)
        print(f"  {SHOTS} shots in {SHARDS} shards: {clock:.2f} s of the clock, {own:.2f} s, {workers:.2f} s; {size / SHOTS:.1f} bytes a shot")


if __name__ == "__main__":
    print("in process")
    measured(None)
    for workers in (1, 2):
        print(f"{workers} workers")
        with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
            measured(client)
