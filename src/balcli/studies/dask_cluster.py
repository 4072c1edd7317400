"""Sweeps beyond one process: the same boxes, computed by the workers of a dask cluster (extra
`balcli[scale]`).
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Iterator
from concurrent.futures import CancelledError
from contextlib import ExitStack, contextmanager
from itertools import islice
from typing import Any

from ..errors import BalcliError
from .boxes import Box, BoxSize
from .sweep import Chunk, Sweep, divide_sweep, evaluate_box, size_boxes

BATCH_S = 0.5  # for which a worker computes before it sends what it has
BATCH = 64  # that it computes at a time
RETRIES = 3  # of a batch that a worker has not finished
AHEAD = 4  # batches for each thread that may wait to be fetched


@contextmanager
def connect_cluster(address: str) -> Iterator[Any]:
    """A client of the scheduler at an address such as tcp://host:8786, or of a cluster on this
    machine (`local`) that ends with it.

    Raises:
        BalcliError: dask is not installed, or nobody answers.
    """
    try:
        import distributed
    except ImportError:
        raise BalcliError("--dask needs dask: install balcli[scale]") from None
    dask: Any = distributed
    with ExitStack() as ends:
        try:
            if address == "local":
                own = dask.LocalCluster(threads_per_worker=1, dashboard_address=None)
                client = ends.enter_context(dask.Client(ends.enter_context(own)))
            else:
                client = ends.enter_context(dask.Client(address, timeout=10))
        except (OSError, ValueError) as error:
            raise BalcliError(f"--dask {address}: no cluster answers there ({error})") from None
        yield client


def evaluate_on_cluster(sweep: Sweep, client: Any) -> Iterator[Chunk]:
    """All variants, computed by the workers of a client's cluster, in the order of rows; a bounded
    number of batches is under way at a time. The first box is computed here, to see how long one
    takes. The sweep goes with each batch, so that one whose worker is lost can be given to another.

    Raises:
        BalcliError: all workers are lost, again and again.
    """
    from distributed import KilledWorker  # an extra

    size = size_boxes(sweep)
    boxes = divide_sweep(sweep, size)
    start = time.perf_counter()
    yield from _evaluate_batch(sweep, size, [next(boxes)])
    batch = min(max(int(BATCH_S / (time.perf_counter() - start)), 1), BATCH)

    def submit(count: int) -> Iterator[Any]:
        for some in islice(_group(boxes, batch), count):
            yield client.submit(_evaluate_batch, sweep, size, some, pure=False, retries=RETRIES)

    waiting = deque(submit(AHEAD * max(sum(client.nthreads().values()), 1)))
    while waiting:
        try:
            found = waiting.popleft().result()
        except (KilledWorker, CancelledError) as error:
            raise BalcliError(
                f"--dask: the cluster has lost its workers ({type(error).__name__}), and what they "
                "computed; start it again, or leave --dask out"
            ) from None
        yield from found
        waiting.extend(submit(1))


def _evaluate_batch(sweep: Sweep, size: BoxSize, batch: list[Box]) -> list[Chunk]:
    return [Chunk(box, evaluate_box(sweep, box, size)) for box in batch]


def _group(boxes: Iterator[Box], count: int) -> Iterator[list[Box]]:
    """So many boxes at a time."""
    while batch := list(islice(boxes, count)):
        yield batch
