"""Compute exact coefficients in powers of lambda (crank radius over rod length), and compare them
with the coefficients printed in the five books and papers of the tables.

Kvasnikov, Determination of the unbalance of piston engines, Tomsk 1920, has Tables I and II
(coefficients A_n of the piston's acceleration and D_k of the rod's angular acceleration) and
statements on orders. The errata of these two tables are explained by series that were cut off after
one or two terms.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any, TypeAlias

import numpy as np

from ..core.mechanisms import power_series as series
from ..core.phasors import Array
from ..engine.build import build
from ..engine.parse import parse
from ..file.examples import folder
from ..forces.symmetry import Textbook, find_textbook
from .recomputed import (
    ErratumClass,
    Explanation,
    Print,
    Ranges,
    Row,
    Table,
    Words,
    as_numbers,
    head_rows,
    read_data,
)

Generator: TypeAlias = Callable[[int, int], series.Series]

POWER = 12
COLUMNS = ("function", "order", "power", "coefficient", "source", "equation")

GENERATED: dict[str, Generator] = {  # coefficients that are listed up to the requested power
    "displacement x/r from TDC": series.displacement,
    "velocity v/(r w)": series.velocity,
    "acceleration A_n (r w^2)": series.piston,
    "cos beta (displacement/l)": series.cos_beta,
    "rod angle": series.beta,
    "rod angular acceleration D_k": series.rod,
}


def _accelerate(order: int, power: int) -> series.Series:
    """Return the coefficients of an acceleration in rod lengths."""
    return {p: order * order * c for p, c in series.cos_beta(order, power).items()}


def _lower_rod(order: int, power: int) -> series.Series:
    """Return the coefficients of the rod's angular acceleration, divided by the rod ratio."""
    return {p - 1: c for p, c in series.rod(order, power + 1).items()}


def _expand_cos_beta(_: int, power: int) -> series.Series:
    return series.cos_beta_in_sine(power)


def _expand_beta(_: int, power: int) -> series.Series:
    return series.beta_in_sine(power)


# Other forms of coefficients, listed only if a source prints them.
PRINTED: dict[str, Generator] = {
    "displacement (from shaft)/r": series.from_shaft,
    "acceleration (l w^2)": _accelerate,
    "rod angular acceleration D_k / p": _lower_rod,
    "cos beta, power of sin^p": _expand_cos_beta,
    "rod angle, power of sin^p": _expand_beta,
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
    """Yield each printed coefficient with its printed texts, then the coefficients, up to the given
    power, that no source prints.
    """
    for words in shown:
        function, order, exponent, _, source, equation = words
        n = int(order or 0)
        p = int(exponent or 0)
        exact = {**GENERATED, **PRINTED}[function or ""](n, p).get(p, 0)
        yield (function, None if order is None else n, p, str(exact), source, equation), words
    printed = {words[:3] for words in shown}
    for name, generate in GENERATED.items():
        for n in range(power + 2):
            for p, c in generate(n, power).items():
                if (name, str(n), str(p)) not in printed:
                    yield (name, n, p, str(c), None, None), (None,) * len(COLUMNS)


Exact: TypeAlias = Callable[[list[int], Array], Array]
Terms: TypeAlias = Callable[[int, int], series.Series]


def tabulate_coefficients(printed: Print, ranges: Ranges, exact: Exact, terms: Terms) -> Table:
    """Return Kvasnikov's Table I (coefficients A_n) or II (D_k), by closed form and series."""
    headings = ranges.lam or printed.headings()
    lam = as_numbers(headings)
    stub = printed.column("coefficient")
    orders = [int(label.partition("_")[2]) for label in stub]
    supposed = []
    for count, kind in enumerate(("first term of the series alone", "two terms of the series"), 1):
        body = [_sum(terms(n, n + 2 * count), lam, count) for n in orders]
        supposed.append(Explanation(kind, head_rows(stub, body), "approximation"))
    return printed.compare_columns(headings, exact(orders, lam), supposed)


def _sum(terms: series.Series, lam: Array, count: int) -> Array:
    return np.asarray(sum(float(terms[p]) * lam**p for p in sorted(terms)[:count]))


# ------------------------------------------------------------------ statements
_ORDERS = np.arange(1.0, 21.0)
_PAIRS = "true for evenly spaced throws; in a four-stroke engine, pairs of throws share an angle"
_REASONS = {
    "star of 5": "the sums of cos k gamma belong to the orders k - 1 and k + 1",
    "vee of 4, gamma = 45 deg": "along y: cos 2 gamma is 0, sin 2 gamma is not",
    **{f"row of {count}, four-stroke": _PAIRS for count in (4, 6, 8)},
}


def tabulate_kvasnikov_statements(printed: Print, ranges: Ranges) -> Table:
    """Return the computed figures of Kvasnikov's statements on sizes of orders, and on the orders
    that stars, vees and rows leave unbalanced. Each layout is analyzed as an engine of equal
    cylinders. Rotating masses are left out, because counterweights can cancel them.
    """
    engines = tomllib.loads(read_data("kvasnikov-layouts.toml"))
    books = {layout: _analyze(layout, tables) for layout, tables in engines.items()}
    layouts = printed.column("layout")
    quantities = printed.column("quantity")
    answers = [
        _QUANTITIES[quantity](books[layout])
        for layout, quantity in zip(layouts, quantities, strict=True)
    ]
    stated = as_numbers(printed.column("answer")).tolist()
    others: list[tuple[ErratumClass, str, int, float]] = [
        ("error", _REASONS[layout], n, stated[n])
        for n, layout in enumerate(layouts)
        if layout in _REASONS
    ]
    return printed.compare_answers(answers, others)


def _analyze(name: str, tables: Mapping[str, Any]) -> Textbook:
    file = parse((folder() / "single.toml").read_text(encoding="utf-8"), name)
    file = file.with_table("crank", throws=tables["throws"], spacing=100.0)
    for key in ("layout", "rod"):
        if key in tables:
            file = file.with_table(key, **tables[key])
    return find_textbook(build(file), _ORDERS, ("force", "moment", "couple"))


def _find_order(book: Textbook, kind: str, place: int) -> float:
    """Return an order that a force or moment has, by its place in the ascending list of the orders
    (place 0: the lowest order); 0 if the list is shorter.
    """
    found = book.reciprocating[kind]
    orders = [*found.orders[~found.balanced].tolist(), 0.0, 0.0, 0.0]
    return float(orders[place])


def _find_share(book: Textbook, kind: str, order: int) -> float:
    """Return the size of an order in percent of order 1."""
    major = book.reciprocating[kind].major
    return float(100 * major[order - 1] / major[0])


def _find_force(book: Textbook, order: int, axis: str) -> float:
    """Return the force of an order along x or y, divided by one cylinder's force of that order."""
    force = book.reciprocating["force"]
    along = np.abs(force.x if axis == "x" else force.y)[order - 1]
    return float(along / (book.units.force * book.units.ratios[order - 1]))


_QUANTITIES: dict[str, Callable[[Textbook], float]] = {
    **{f"force of order {n}": partial(_find_share, kind="force", order=n) for n in (2, 4, 6)},
    **{f"moment M_z of order {k}": partial(_find_share, kind="couple", order=k) for k in (3, 5)},
    "lowest order of force": partial(_find_order, kind="force", place=0),
    "lowest order of force above 1": partial(_find_order, kind="force", place=1),
    "next order of force": partial(_find_order, kind="force", place=2),
    "lowest order of moment M_z": partial(_find_order, kind="couple", place=0),
    "lowest order of M_x, M_y": partial(_find_order, kind="moment", place=0),
    "force of order 1 along x": partial(_find_force, order=1, axis="x"),
    "force of order 1 along y": partial(_find_force, order=1, axis="y"),
    "force of order 2 along x": partial(_find_force, order=2, axis="x"),
    "force of order 2 along y": partial(_find_force, order=2, axis="y"),
}
