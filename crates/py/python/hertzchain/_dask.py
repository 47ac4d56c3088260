"""Work handed out to the workers of a Dask client, or done here."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import islice
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from .errors import HertzchainError, InternalError

if TYPE_CHECKING:
    from dask.distributed import Client, Future

AHEAD = 4
"""Shards handed out for each thread of the workers: enough that none waits."""

RETRIES = 3
"""How often a shard is computed again that raised something that is not ours: a disk may have been full."""

LOOK_S = 5.0
"""Time between looks at how many workers there are; they come and go."""

AGAIN = ("lost", "pending")
"""Of a shard whose worker died with what it had to tell: it is computed again."""

GONE = "the cluster is gone: what is done lies in the folder, and the same call goes on with it"

Shard = Callable[..., tuple[int, "bool | str"]]
"""Computes a shard; its number, and whether it was there or why it can't be."""

Arguments = Callable[[int], tuple[Any, ...]]
"""Of the shard of a number."""


def poisoned_or(number: int, kept: Callable[[], bool]) -> tuple[int, bool | str]:
    """A shard's outcome; what will never work is told and not tried again, a full disk is raised."""
    try:
        return number, kept()
    except InternalError:
        raise
    except HertzchainError as error:
        return number, str(error)


def run(shard: Shard, arguments: Arguments, of: int, client: Client | None, tell: Any) -> tuple[int, dict[int, str]]:
    """Runs all shards: how many were kept, and why others failed."""
    kept, poisoned = 0, dict[int, str]()
    results = _here(shard, arguments, of) if client is None else _there(shard, arguments, of, client)
    for number, outcome in results:
        if isinstance(outcome, str):
            poisoned[number] = outcome
        else:
            kept += outcome
        if tell is not None:
            tell(1)
    return kept, dict(sorted(poisoned.items()))


def _here(shard: Shard, arguments: Arguments, of: int) -> Iterator[tuple[int, bool | str]]:
    for number in range(1, of + 1):
        try:
            outcome = shard(*arguments(number))
        except Exception as error:  # as a worker's: told, and the others go on
            outcome = number, _told(error)
        yield outcome


def _there(shard: Shard, arguments: Arguments, of: int, client: Client) -> Iterator[tuple[int, bool | str]]:
    """Hands shards out as workers finish others, so that a scheduler never has them all."""
    from dask.distributed import as_completed

    waiting = iter(range(1, of + 1))
    # Keys of this call alone: a scheduler that knows a key does not compute it again.
    call = uuid4().hex
    numbers: dict[Any, int] = {}

    def hand_out(number: int) -> Future:
        key = f"hertzchain-shard-{call}-{number}-of-{of}"
        numbers[key] = number
        return client.submit(shard, *arguments(number), key=key, pure=False, retries=RETRIES)

    room = _Room(client)
    with _connected():
        running = as_completed([hand_out(number) for number in islice(waiting, room.now())])
        for future in running:
            if future.status in AGAIN:
                running.add(future)
                continue
            number = numbers.pop(future.key)
            yield _outcome(number, future)
            future.release()
            for following in islice(waiting, max(0, room.now() - len(numbers))):
                running.add(hand_out(following))


@contextmanager
def _connected(*also: type[OSError]) -> Iterator[None]:
    """A scheduler may die between any two words with it."""
    from dask.distributed import CancelledError
    from distributed.comm import CommClosedError

    try:
        yield
    except (CommClosedError, CancelledError, *also) as error:
        raise ConnectionError(GONE) from error


def _outcome(number: int, future: Future) -> tuple[int, bool | str]:
    """What a worker told of a shard; what is said of one that killed its workers."""
    if future.status == "finished":
        return future.result()
    if future.status != "error":
        raise ConnectionError(GONE)
    return number, _told(future.exception())


def _told(error: BaseException | None) -> str:
    return f"{type(error).__name__}: {error}"


class _Room:
    """How many shards may be handed out."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self._seen = -LOOK_S
        self._shards = AHEAD

    def now(self) -> int:
        """By the threads that the workers have had at the last look."""
        if time.monotonic() - self._seen > LOOK_S:
            self._seen = time.monotonic()
            self._shards = AHEAD * max(1, threads(self._client))
        return self._shards


def threads(client: Client) -> int:
    """Threads of all workers."""
    # No worker's own error can come of this one, so whatever is wrong with the way there is it.
    with _connected(OSError):
        known: Any = client.nthreads()
    return sum(known.values())


Batches = list[tuple[str, list[list[float]]]]
"""Names and points."""


def batches(task: Callable[..., Any], work: tuple[str, str], client: Client) -> Callable[[Batches], Callable[[float], Any]]:
    """A way to have batches of points of a work, by its file and name, computed as the library asks for it."""
    from dask.distributed import TimeoutError, wait

    call = uuid4().hex

    def compute(named: Batches) -> Callable[[float], Any]:
        """Hands out batches; gives what waits for them."""
        keys = ((f"hertzchain-batch-{call}-{name}", points) for name, points in named)
        with _connected():
            futures = [client.submit(task, *work, points, key=key, pure=False, retries=RETRIES) for key, points in keys]

        def waiting(seconds: float) -> Any:
            """Outcomes in order, or None if there are some to come."""
            try:
                with _connected():
                    wait(futures, timeout=seconds)
                    return client.gather(futures)
            except TimeoutError:
                return None

        return waiting

    return compute
