"""Work shared among the threads of this process."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from itertools import islice
from typing import TypeVar

from ..errors import BalcliError

Item = TypeVar("Item")
Outcome = TypeVar("Outcome")
ALONE_S = 1.0  # before several threads share what is left: most sweeps have ended by then


def share_work(
    work: Callable[[Item], Outcome], items: Iterable[Item], threads: int, alone_s: float = ALONE_S
) -> Iterator[Outcome]:
    """Yield `work(item)` for each item, in their order; a bounded number of items is under way.

    Args:
        work: numpy does most of it outside Python's lock.
        items: to work on.
        threads: at most so many work.
        alone_s: seconds before the threads start.

    Raises:
        BalcliError: the system gives no thread.
    """
    waiting = iter(items)
    end = time.monotonic() + alone_s
    for item in waiting:
        yield work(item)
        if threads > 1 and time.monotonic() > end:
            break
    first = list(islice(waiting, 2 * threads))
    if not first:
        return
    from concurrent.futures import ThreadPoolExecutor  # most sweeps have ended without it

    pool = ThreadPoolExecutor(threads)
    try:
        running = deque(pool.submit(work, item) for item in first)
        while running:
            yield running.popleft().result()
            running.extend(pool.submit(work, item) for item in islice(waiting, 1))
    except RuntimeError as error:
        raise BalcliError(f"--jobs {threads}: {error}; give fewer, as --jobs 1") from None
    finally:
        pool.shutdown(cancel_futures=True)
