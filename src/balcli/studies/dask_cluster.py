"""Sweeps on a dask cluster (extra `balcli[scale]`)."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import ExitStack, contextmanager
from functools import partial
from typing import Any

from ..errors import BalcliError
from .sweep import Item, Outcome, Share, run_in_order

RETRIES = 3  # of what a worker has not finished
AHEAD = 4  # tasks for each thread that may wait to be fetched


@contextmanager
def connect_cluster(address: str) -> Iterator[Share]:
    """Yield what shares work among the workers of the scheduler at an address such as
    tcp://host:8786, or of a cluster on this machine (`local`) that ends with it.

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
        yield partial(run_on_cluster, client)


def run_on_cluster(
    client: Any, work: Callable[[Item], Outcome], items: Iterable[Item]
) -> Iterator[Outcome]:
    """Yield `work(item)` for each item, in their order, by the workers of a client's cluster.

    Raises:
        BalcliError: All workers are lost, again and again.
    """
    from distributed import KilledWorker  # an extra

    submit = partial(client.submit, pure=False, retries=RETRIES)
    ahead = AHEAD * max(sum(client.nthreads().values()), 1)
    try:
        yield from run_in_order(submit, work, items, ahead)
    except (KilledWorker, CancelledError) as error:
        raise BalcliError(
            f"--dask: the cluster has lost its workers ({type(error).__name__}), and what they "
            "computed; start it again, or leave --dask out"
        ) from None
