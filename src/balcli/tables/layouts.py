"""Free forces and moments of the common layouts in textbook units, computed from the example
engines, without the offsets of their piston pins.

F_n = m_rec r omega^2 A_n is the force of order n of one cylinder's reciprocating mass (F_1 with
A_1 = 1), a the distance of neighbouring throws; moments are about the middle of the crankshaft. All
else that textbooks leave out, `forces.textbook` takes off.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..enginefile.examples import folder
from .printed import Print
from .ranges import Ranges
from .recomputed import Row, Table

if TYPE_CHECKING:
    from ..enginefile.model import EngineFile

ORDERS = (1, 2, 4, 6)


def tabulate_layouts(printed: Print, ranges: Ranges) -> Table:
    """One row an engine; semi-axes (equal: a circle) of the force F and the moment M of each
    order.
    """
    ends = [f"{letter}{n}_{axis}" for n in ORDERS for letter in "FM" for axis in ("major", "minor")]
    rows = [_row(name or "") for name in printed.column("engine")]
    return printed.compare(("engine", "layout", "cylinders", *ends), rows, stub=3)


def _row(name: str) -> Row:
    from ..engine.build import build
    from ..engine.load import parse
    from ..forces.textbook import find_textbook

    file = parse((folder() / f"{name}.toml").read_text(encoding="utf-8"), name)
    engine = build(_without_offset(file))
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


def _without_offset(file: EngineFile) -> EngineFile:
    piston = file.piston.model_copy(update={"offset": 0.0})
    return file.model_copy(update={"piston": piston})
