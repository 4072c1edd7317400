"""Kvasnikov, Determination of the unbalance of piston engines, Tomsk 1920: Tables I and II.

A_n of the piston's and D_k of the rod's acceleration. The errata are recomputed from one and two
terms of the series.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from ..core.mechanisms import closed_form
from ..core.mechanisms import power_series as series
from ..core.phasors import Array
from .printed import Print, as_numbers, head_rows
from .ranges import Ranges
from .recomputed import Explanation, Row, Table

Exact: TypeAlias = Callable[[list[int], Array], Array]
Terms: TypeAlias = Callable[[int, int], series.Series]


def tabulate_piston(printed: Print, ranges: Ranges) -> Table:
    """Table I: A_n."""
    return _tabulate(printed, ranges, closed_form.piston, series.piston)


def tabulate_rod(printed: Print, ranges: Ranges) -> Table:
    """Table II: D_k."""
    return _tabulate(printed, ranges, closed_form.rod, series.rod)


def _tabulate(printed: Print, ranges: Ranges, exact: Exact, terms: Terms) -> Table:
    headings = ranges.lam or printed.headings()
    lam, stub = as_numbers(headings), printed.column("coefficient")
    orders = [int(label.partition("_")[2]) for label in stub]
    columns = (printed.columns[0], *headings)

    def first(count: int) -> tuple[Row, ...]:
        return head_rows(stub, [_sum(terms(n, n + 2 * count), lam, count) for n in orders])

    return printed.compare(
        columns,
        head_rows(stub, exact(orders, lam)),
        printed.align_cells(stub, columns),
        [
            Explanation("author's approximation: first term of the series alone", first(1)),
            Explanation("author's approximation: two terms of the series", first(2)),
        ],
    )


def _sum(terms: series.Series, lam: Array, count: int) -> Array:
    return np.asarray(sum(float(terms[p]) * lam**p for p in sorted(terms)[:count]))
