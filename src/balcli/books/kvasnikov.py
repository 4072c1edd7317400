"""Kvasnikov, Determination of the unbalance of piston engines, Tomsk 1920: his statements on the
sizes of orders, and on the orders that stars, vees and rows of cylinders leave.

The figure of every statement is computed by analyzing an engine of that layout, made of equal
cylinders. Rotating masses are left out: counterweights can cancel them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from ..engine.build import build
from ..engine.parse import parse
from ..file.examples import folder
from ..forces.symmetry import Textbook, find_textbook
from .recomputed import ErratumClass, Print, Ranges, Table, as_numbers

Values: TypeAlias = dict[str, object]

_CYLINDER = "single"  # example engine with one cylinder
_ORDERS = np.arange(1.0, 21.0)
_LAYOUTS: dict[str, tuple[tuple[float, ...], Values, Values]] = {  # throws, [layout], [rod]
    "one cylinder, mu = 1/6": ((0,), {}, {"length": 252.0}),
    "one cylinder, mu = 1/4": ((0,), {}, {"length": 168.0}),
    "star of 5": ((0,), {"radial": 5}, {}),
    "star of 6": ((0,), {"radial": 6}, {}),
    "vee of 2, gamma = 45 deg": ((0,), {"bank_angle": 90.0}, {}),
    "vee of 2, gamma = 90 deg": ((0,), {"bank_angle": 180.0}, {}),
    "vee of 4, gamma = 45 deg": ((0, 180), {"bank_angle": 90.0}, {}),
    "vee of 8, gamma = 45 deg": ((0, 180, 180, 0), {"bank_angle": 90.0}, {}),
    "row of 3": ((0, 120, 240), {}, {}),
    "row of 4": ((0, 90, 270, 180), {}, {}),
    "row of 4, four-stroke": ((0, 180, 180, 0), {}, {}),
    "row of 5": ((0, 72, 288, 216, 144), {}, {}),
    "row of 6, four-stroke": ((0, 120, 240, 240, 120, 0), {}, {}),
    "row of 8, four-stroke": ((0, 90, 270, 180, 180, 270, 90, 0), {}, {}),
}
_PAIRS = "of throws at different, equal angles; in a four-stroke engine two have the same angle"
_REASONS = {
    "star of 5": "the sums of cos k gamma belong to the orders k - 1 and k + 1",
    "vee of 4, gamma = 45 deg": "along y: cos 2 gamma is 0, sin 2 gamma is not",
    "row of 4, four-stroke": _PAIRS,
    "row of 6, four-stroke": _PAIRS,
    "row of 8, four-stroke": _PAIRS,
}


def tabulate_statements(printed: Print, ranges: Ranges) -> Table:
    """Return the figures of his statements with those of the engines."""
    books = {layout: _analyze(layout) for layout in _LAYOUTS}
    layouts, quantities = printed.column("layout"), printed.column("quantity")
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


def _analyze(name: str) -> Textbook:
    throws, layout, rod = _LAYOUTS[name]
    file = parse((folder() / f"{_CYLINDER}.toml").read_text(encoding="utf-8"), name)
    file = file.with_table("crank", throws=throws, spacing=100.0).with_table("rod", **rod)
    engine = build(file.with_table("layout", **layout) if layout else file)
    return find_textbook(engine, _ORDERS, ("force", "moment", "couple"))


def _find_order(book: Textbook, kind: str, place: int) -> float:
    """Return the lowest order (place 0) of a force or moment, or the next ones; 0: there is none."""
    found = book.reciprocating[kind]
    orders = [*found.orders[~found.balanced].tolist(), 0.0, 0.0, 0.0]
    return float(orders[place])


def _find_share(book: Textbook, kind: str, order: int) -> float:
    """Return the size of an order in percent of order 1."""
    major = book.reciprocating[kind].major
    return float(100 * major[order - 1] / major[0])


def _find_force(book: Textbook, order: int, axis: str) -> float:
    """Return the force of an order along x or y, over that of one cylinder."""
    force = book.reciprocating["force"]
    along = np.abs(force.x if axis == "x" else force.y)[order - 1]
    return float(along / (book.units.force * book.units.ratios[order - 1]))


_QUANTITIES: dict[str, Callable[[Textbook], float]] = {
    "force of order 2": lambda book: _find_share(book, "force", 2),
    "force of order 4": lambda book: _find_share(book, "force", 4),
    "force of order 6": lambda book: _find_share(book, "force", 6),
    "moment M_z of order 3": lambda book: _find_share(book, "couple", 3),
    "moment M_z of order 5": lambda book: _find_share(book, "couple", 5),
    "lowest order of force": lambda book: _find_order(book, "force", 0),
    "lowest order of force above 1": lambda book: _find_order(book, "force", 1),
    "next order of force": lambda book: _find_order(book, "force", 2),
    "lowest order of moment M_z": lambda book: _find_order(book, "couple", 0),
    "lowest order of M_x, M_y": lambda book: _find_order(book, "moment", 0),
    "force of order 1 along x": lambda book: _find_force(book, 1, "x"),
    "force of order 1 along y": lambda book: _find_force(book, 1, "y"),
    "force of order 2 along x": lambda book: _find_force(book, 2, "x"),
    "force of order 2 along y": lambda book: _find_force(book, 2, "y"),
}
