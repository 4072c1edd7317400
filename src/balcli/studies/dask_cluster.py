"""Sweeps beyond one process: the same boxes, computed by the workers of a dask cluster (extra
`balcli[scale]`).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import islice
from typing import Any

from ..errors import BalcliError
from .sweep import Box, Chunk, Sweep, divide_grid, evaluate_box

BATCH = 16  # boxes that a worker computes at a time
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
    try:
        if address == "local":
            with (
                dask.LocalCluster(threads_per_worker=1, dashboard_address=None) as cluster,
                dask.Client(cluster) as client,
            ):
                yield client
        else:
            with dask.Client(address, timeout=10) as client:
                yield client
    except (OSError, ValueError) as error:
        raise BalcliError(f"--dask {address}: no cluster answers there ({error})") from None


def evaluate_on_cluster(sweep: Sweep, client: Any) -> Iterator[Chunk]:
    """All variants, computed by the workers of a client's cluster, in the order of rows; a bounded
    number of batches is under way at a time.
    """
    batches = _group(divide_grid(sweep.shape))
    most = AHEAD * max(sum(client.nthreads().values()), 1)
    job = client.scatter(sweep, broadcast=True)

    def submit(count: int) -> Iterator[Any]:
        for batch in islice(batches, count):
            yield client.submit(_evaluate_batch, job, batch, pure=False)

    waiting = deque(submit(most))
    while waiting:
        yield from waiting.popleft().result()
        waiting.extend(submit(1))


def _evaluate_batch(sweep: Sweep, batch: list[Box]) -> list[Chunk]:
    return [Chunk(box, evaluate_box(sweep, box)) for box in batch]


def _group(boxes: Iterator[Box]) -> Iterator[list[Box]]:
    """So many boxes at a time as a worker computes."""
    while batch := list(islice(boxes, BATCH)):
        yield batch
