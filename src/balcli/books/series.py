"""Exact coefficients of power series in lambda, compared with those printed in the five sources.

The module also recomputes Tables I and II of Kvasnikov, Determination of the unbalance of piston
engines, Tomsk 1920: A_n of the piston's acceleration and D_k of the rod's angular acceleration. One
or two terms of the series explain their errata.

"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np

from ..core.mechanisms import closed_form, power_series as series
from ..core.phasors import Array
from .recomputed import Explanation, Print, Ranges, Row, Table, Words, as_numbers, head_rows

Generator: TypeAlias = Callable[[int, int], series.Series]

POWER = 12
COLUMNS = ("function", "order", "power", "coefficient", "source", "equation")

GENERATED: dict[str, Generator] = {  # listed up to the requested power
    "displacement x/r from TDC": series.displacement,
    "velocity v/(r w)": series.velocity,
    "acceleration A_n (r w^2)": series.piston,
    "cos beta (displacement/l)": series.cos_beta,
    "rod angle": series.beta,
    "rod angular acceleration D_k": series.rod,
}
PRINTED: dict[str, Generator] = {  # other forms, listed if a source prints them
    "displacement (from shaft)/r": series.from_shaft,
    "acceleration (l w^2)": lambda n, power: {
        p: n * n * c for p, c in series.cos_beta(n, power).items()
    },
    "rod angular acceleration D_k / p": lambda k, power: {
        p - 1: c for p, c in series.rod(k, power + 1).items()
    },
    "cos beta, power of sin^p": lambda _, power: series.cos_beta_in_sine(power),
    "rod angle, power of sin^p": lambda _, power: series.beta_in_sine(power),
}


def tabulate_series(printed: Print, ranges: Ranges) -> Table:
    """Return a row for each coefficient and each source that prints it; coefficients that no source
    prints have one row without a source.
    """
    power = POWER if ranges.power is None else ranges.power
    shown = [words for words in printed.rows if int(words[2] or 0) <= power]
    functions = [*GENERATED, *PRINTED]

    def place(pair: tuple[Row, Words]) -> tuple[int, float, float]:
        function, order, exponent, *_ = pair[0]
        return functions.index(str(function)), float(order or 0), float(exponent or 0)

    rows, words = zip(*sorted(_list_rows(shown, power), key=place), strict=True)
    return printed.compare(COLUMNS, rows, words, stub=3)


def _list_rows(shown: list[Words], power: int) -> Iterator[tuple[Row, Words]]:
    """Yield the printed coefficients with their prints, then the coefficients up to the power that
    no source prints.
    """
    for words in shown:
        function, order, exponent, _, source, equation = words
        n, p = int(order or 0), int(exponent or 0)
        exact = {**GENERATED, **PRINTED}[function or ""](n, p).get(p, 0)
        yield (function, None if order is None else n, p, str(exact), source, equation), words
    known = {words[:3] for words in shown}
    for name, generate in GENERATED.items():
        for n in range(power + 2):
            for p, c in generate(n, power).items():
                if (name, str(n), str(p)) not in known:
                    yield (name, n, p, str(c), None, None), (None,) * len(COLUMNS)


Exact: TypeAlias = Callable[[list[int], Array], Array]
Terms: TypeAlias = Callable[[int, int], series.Series]


def tabulate_piston(printed: Print, ranges: Ranges) -> Table:
    """Return Table I: coefficients A_n."""
    return _tabulate(printed, ranges, closed_form.piston, series.piston)


def tabulate_rod(printed: Print, ranges: Ranges) -> Table:
    """Return Table II: coefficients D_k."""
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
            Explanation("first term of the series alone", first(1), "approximation"),
            Explanation("two terms of the series", first(2), "approximation"),
        ],
    )


def _sum(terms: series.Series, lam: Array, count: int) -> Array:
    return np.asarray(sum(float(terms[p]) * lam**p for p in sorted(terms)[:count]))
