"""Work shared among the threads of this process."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from itertools import chain, islice
from threading import Event, Thread
from typing import TypeVar

Item = TypeVar("Item")
Outcome = TypeVar("Outcome")
ALONE_S = 1.0  # before several threads share what is left: most sweeps have ended by then


def share_work(
    work: Callable[[Item], Outcome], items: Iterable[Item], threads: int, alone_s: float = ALONE_S
) -> Iterator[Outcome]:
    """What becomes of each item, in their order.

    Args:
        work: what is done with one; numpy does most of its own outside Python's lock.
        items: to work on.
        threads: that do it.
        alone_s: seconds for which one does it alone.
    """
    waiting = iter(items)
    end = time.monotonic() + (alone_s if threads > 1 else math.inf)
    for item in waiting:
        yield work(item)
        if time.monotonic() > end:
            break
    yield from _share(work, waiting, threads)


def _share(
    work: Callable[[Item], Outcome], items: Iterator[Item], threads: int
) -> Iterator[Outcome]:
    """The same by so many threads, a little ahead of who asks for it; by this one alone where the
    system gives no other.
    """
    first = list(islice(items, 2 * threads))
    if not first:
        return
    threads = _count_startable(threads)
    if not threads:
        yield from map(work, chain(first, items))
        return
    from concurrent.futures import ThreadPoolExecutor  # most sweeps have ended without it

    pool = ThreadPoolExecutor(threads)
    try:
        waiting = deque(pool.submit(work, item) for item in first)
        while waiting:
            yield waiting.popleft().result()
            waiting.extend(pool.submit(work, item) for item in islice(items, 1))
    finally:
        pool.shutdown(cancel_futures=True)


def _count_startable(threads: int) -> int:
    """How many of so many threads the system gives: a user or a container may have few."""
    ended, started = Event(), list[Thread]()
    with suppress(RuntimeError):  # it gives no more
        for _ in range(threads):
            thread = Thread(target=ended.wait)
            thread.start()
            started.append(thread)
    ended.set()
    for thread in started:
        thread.join()
    return len(started)
