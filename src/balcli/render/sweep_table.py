"""Variants of a sweep as a table: few of them whole, of many the first and the last."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.phasors import Array
from ..studies.quantity_names import tell_assumed_speed
from .sheet import NAMELESS, Grid, Sheet, given, number
from .units import name_with_unit, unit_of_name

if TYPE_CHECKING:
    from ..studies.sweep import Sweep


class Ends(NamedTuple):
    """The first and the last variants of a sweep.

    Attributes:
        first, last: (variants, columns): parameters, then quantities.
        left_out: how many stand between them.
    """

    first: Array
    last: Array
    left_out: int


def make_sheet(sweep: Sweep, ends: Ends) -> Sheet:
    """The table, each column in the unit that fits it."""
    figures = np.concatenate([ends.first, ends.last])
    largest = np.nanmax(np.abs(figures), axis=0, initial=0).tolist()
    names = [p.unit for p in sweep.parameters] + [q.unit for q in sweep.quantities]
    units = [unit_of_name(name).fit(size) for name, size in zip(names, largest, strict=True)]
    sizes = np.array([unit.size for unit in units])
    asked = len(sweep.parameters)  # how many columns hold what was asked for, which is told whole
    rows = [
        (*(given(value, 8) for value in row[:asked]), *map(number, row[asked:]))
        for row in (figures / sizes).tolist()
    ]
    heads = map(name_with_unit, sweep.columns, (unit.name for unit in units))
    notes = []
    if ends.left_out:
        rows.insert(len(ends.first), ("…",) * len(sweep.columns))
        variants = len(figures) + ends.left_out
        notes += [
            f"{variants} variants, of which {ends.left_out} are not shown: -o X.csv writes all."
        ]
    if "operation.speed" not in sweep.columns and (assumed := tell_assumed_speed(sweep.file)):
        notes += [assumed]
    grid = Grid("", tuple(heads), tuple(rows), " ".join(notes))
    return Sheet(f"{sweep.file.name or NAMELESS}: variants", (grid,))
