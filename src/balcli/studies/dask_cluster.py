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
from .sweep import Box, Chunk, Sweep, boxes, values

BATCH = 16  # boxes that a worker computes at a time
AHEAD = 4  # batches for each thread that may wait to be fetched


@contextmanager
def client(address: str) -> Iterator[Any]:
    """A client of the scheduler at an address such as tcp://host:8786, or of a cluster of our own
    (`local`).

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
                dask.Client(cluster) as found,
            ):
                yield found
        else:
            with dask.Client(address, timeout=10) as found:
                yield found
    except (OSError, ValueError) as error:
        raise BalcliError(f"--dask {address}: no cluster answers there ({error})") from None


def chunks(sweep: Sweep, found: Any) -> Iterator[Chunk]:
    """All variants, computed by the cluster, in the order of rows; a bounded number of batches is
    under way at a time.
    """
    batches = _batches(boxes(sweep.shape))
    most = AHEAD * max(sum(found.nthreads().values()), 1)
    job = found.scatter(sweep, broadcast=True)
    waiting = deque(
        found.submit(_compute, job, batch, pure=False) for batch in islice(batches, most)
    )
    while waiting:
        yield from waiting.popleft().result()
        waiting.extend(
            found.submit(_compute, job, batch, pure=False) for batch in islice(batches, 1)
        )


def _compute(sweep: Sweep, batch: list[Box]) -> list[Chunk]:
    return [Chunk(box, values(sweep, box)) for box in batch]


def _batches(every: Iterator[Box]) -> Iterator[list[Box]]:
    while batch := list(islice(every, BATCH)):
        yield batch
