"""Sweeps on a dask cluster (extra `balcli[scale]`): workers compute blocks of the grid."""

from __future__ import annotations

import logging
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import ExitStack, contextmanager
from itertools import islice
from typing import Any, TypeVar

from ..errors import BalcliError
from .sweep import Block, Chunk, Sweep, divide_into_blocks, evaluate_chunks

Item = TypeVar("Item")
Outcome = TypeVar("Outcome")
ROWS = 1 << 18  # of variants whose figures a worker sends at a time
RETRIES = 3  # of what a worker has not finished
AHEAD = 4  # tasks for each thread that may wait to be fetched


@contextmanager
def connect_cluster(address: str) -> Iterator[Any]:
    """Yield a client of the scheduler at an address such as tcp://host:8786, or of a cluster on
    this machine (`local`) that ends with it.

    Raises:
        BalcliError: dask is not installed, or no scheduler responds.
    """
    try:
        import distributed
    except ImportError:
        raise BalcliError("--dask needs dask: install balcli[scale]") from None
    dask: Any = distributed
    with ExitStack() as ends:
        try:
            if address == "local":
                # Its workers, when it ends, complain of the scheduler's absence.
                cluster = dask.LocalCluster(
                    threads_per_worker=1, dashboard_address=None, silence_logs=logging.CRITICAL
                )
                client = ends.enter_context(dask.Client(ends.enter_context(cluster)))
            else:
                client = ends.enter_context(dask.Client(address, timeout=10))
        except (OSError, ValueError, RuntimeError) as error:
            raise BalcliError(f"--dask {address}: no cluster answers there ({error})") from None
        yield client


def evaluate_on_cluster(sweep: Sweep, client: Any) -> Iterator[Chunk]:
    """Yield all variants in the order of rows; errors as of `run_on_cluster`."""
    for found in run_on_cluster(client, _evaluate, divide_into_blocks(sweep, ROWS)):
        yield from found


def _evaluate(block: Block) -> list[Chunk]:
    """Return the chunks of a block with their boxes in the whole grid."""
    return [block.place(chunk) for chunk in evaluate_chunks(block.sweep)]


def run_on_cluster(
    client: Any, work: Callable[[Item], Outcome], items: Iterable[Item]
) -> Iterator[Outcome]:
    """Yield `work(item)` for each item, in their order, by the workers of a client's cluster; a
    bounded number of items is under way.

    Raises:
        BalcliError: all workers are lost, again and again.
    """
    from distributed import KilledWorker  # an extra

    to_do = iter(items)

    def submit(count: int) -> Iterator[Any]:
        for item in islice(to_do, count):
            yield client.submit(work, item, pure=False, retries=RETRIES)

    waiting = deque(submit(AHEAD * max(sum(client.nthreads().values()), 1)))
    while waiting:
        try:
            found = waiting.popleft().result()
        except (KilledWorker, CancelledError) as error:
            raise BalcliError(
                f"--dask: the cluster has lost its workers ({type(error).__name__}), and what they "
                "computed; start it again, or leave --dask out"
            ) from None
        waiting.extend(submit(1))
        yield found
