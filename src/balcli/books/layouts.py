"""Free forces and moments of the common layouts in textbook units, computed from the example
engines, without the offsets of their piston pins.

F_n = m_rec r omega^2 A_n is the force of order n of one cylinder's reciprocating mass (F_1 with
A_1 = 1), a the distance of neighbouring throws; moments are about the middle of the crankshaft. All
else that textbooks leave out, `forces.textbook` takes off.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ..engine.build import Engine, build
from ..engine.parse import parse
from ..file.examples import folder
from ..file.model import EngineFile
from ..forces.textbook import find_textbook
from .recomputed import Print, Ranges, Row, Table

ORDERS = (1, 2, 4, 6)


def tabulate_layouts(printed: Print, ranges: Ranges) -> Table:
    """One row an engine; semi-axes (equal: a circle) of force F and moment M of each order."""
    ends = [f"{letter}{n}_{axis}" for n in ORDERS for letter in "FM" for axis in ("major", "minor")]
    rows = [_row(name) for name in printed.column("engine")]
    return printed.compare(("engine", "layout", "cylinders", *ends), rows, stub=3)


class Layouts(NamedTuple):
    """The table, and the different intervals between firings of each engine, deg, ascending; none
    where the file of several cylinders gives no firing order.
    """

    table: Table
    gaps_deg: Mapping[str, tuple[float, ...]]


def add_firing(table: Table) -> Layouts:
    """The table of layouts with the firing intervals of its engines."""
    names = [str(row[0]) for row in table.exact]
    return Layouts(table, {name: _find_gaps(_build(_read(name))) for name in names})


def _find_gaps(engine: Engine) -> tuple[float, ...]:
    alone = len(engine.numbers) == 1  # and has no order
    fires = [0.0] if alone else [*map(float, engine.fires_deg.values())]
    instants = [*fires, 180.0 * engine.strokes]
    return tuple(sorted({round(b - a, 1) for a, b in pairwise(instants)}))


def _read(name: str) -> EngineFile:
    return parse((folder() / f"{name}.toml").read_text(encoding="utf-8"), name)


def _build(file: EngineFile) -> Engine:
    return build(file.with_table("piston", offset=0.0))


def _row(name: str) -> Row:
    file = _read(name)
    engine = _build(file)
    found = find_textbook(engine, np.array(ORDERS, float), ("force", "moment"))
    vectors = found.reciprocating.vectors()
    axes = [
        axis[k] / size if axis[k] else 0.0
        for k, order in enumerate(ORDERS)
        for kind, phasors in vectors
        for size in (found.units.size(kind, order),)
        for axis in (phasors.major, phasors.minor)
    ]
    return (name, file.name, len(engine.numbers), *map(float, axes))
