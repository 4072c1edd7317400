"""Where the cylinders of an engine file stand: crank pins and firing angles (deg), places along the
crank (m).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..enginefile.model import EngineFile, Override
from ..errors import InputError, Problem
from . import firing
from .arrays import column
from .layout import Plan, cycle
from .rods import own_or


def pins(
    file: EngineFile, layout: Plan, top: Mapping[int, Any]
) -> tuple[dict[int, Any], dict[int, Any]]:
    """Crank pin and firing angle of every cylinder, deg; the firing angles are empty where the file
    says nothing of them.
    """
    order, intervals = file.layout.firing_order, file.layout.firing_intervals
    sense = -1 if file.layout.rotary else 1
    splay = {c.number: c.bank * file.crank.splay for c in layout.cells}
    if file.crank.throws is None and order is not None:
        fires = firing.instants(order, intervals, cycle(file.layout))
        wanted = firing.pins(fires, top, sense)
        throw = {c.throw: wanted[c.number] - splay[c.number] for c in reversed(layout.cells)}
    else:
        fires = {}
        throw = dict(enumerate(file.crank.throws or (0.0,)))
    pin = {
        c.number: own_or(file, c.number, "throw", throw[c.throw] + splay[c.number])
        for c in layout.cells
    }
    if order is None:
        return pin, fires
    relative = {n: angle - pin[1] for n, angle in pin.items()}
    if not fires:
        found = intervals or firing.from_pins(order, relative, top, cycle(file.layout), sense)
        if isinstance(found, Problem):
            raise InputError([found])
        fires = firing.instants(order, found, cycle(file.layout))
    if off := firing.disagreement(
        fires, relative, top, sense, throws_given=file.crank.throws is not None
    ):
        raise InputError([off])
    return pin, fires


def places(file: EngineFile, layout: Plan, rank: int) -> tuple[dict[int, Any], NDArray[np.float64]]:
    """Place of every cylinder and of every throw along the crank, m (a throw stands in the middle
    of its rods).
    """
    crank = file.crank
    spacing = 0.0 if crank.spacing is None else crank.spacing  # which may be an array of variants
    along = crank.positions or [
        (t - (layout.throws - 1) / 2) * spacing for t in range(layout.throws)
    ]
    middle = (layout.rods_on_throw - 1) / 2
    lean = {
        c.number: (c.bank - middle) * file.layout.stagger if layout.rods_on_throw > 1 else 0.0
        for c in layout.cells
    }
    place = {
        c.number: own_or(file, c.number, "position", along[c.throw] + lean[c.number]) / 1e3
        for c in layout.cells
    }
    throws = [
        sum(place[c.number] - lean[c.number] / 1e3 for c in layout.cells if c.throw == t)
        / layout.rods_on_throw
        for t in range(layout.throws)
    ]
    return place, column(throws, rank)


MOMENTS_UNKNOWN = (
    "moments are not known, because crank.spacing is missing: give it (or crank.positions); 0 says "
    "that all throws stand in one plane"
)


def are_places_known(file: EngineFile, layout: Plan) -> bool:
    """Whether the file says where the throws stand along the crank (of one throw it need not)."""
    crank = file.crank
    said = crank.spacing is not None or crank.positions is not None
    own = any(cylinder.position is not None for cylinder in file.cylinder.values())
    return layout.throws == 1 or said or own


def reference(file: EngineFile, throws: NDArray[np.float64]) -> tuple[Any, Any, Any]:
    """x, y, z (m) of the point of moments: the file's, or on the crank axis half-way between the
    first and the last throw.
    """
    if file.frame.reference is not None:
        x, y, z = file.frame.reference
        return x / 1e3, y / 1e3, z / 1e3
    return 0.0, 0.0, (throws.min(axis=0) + throws.max(axis=0)) / 2


def share_axes(axis_deg: Mapping[int, Any]) -> list[list[int]]:
    """The banks: numbers of the cylinders that have the same axis, by value, at every variant.

    Banks, and the cylinders of each, stand in the order in which `axis_deg` names them.
    """
    banks: dict[bytes, list[int]] = {}
    for number, axis in axis_deg.items():
        value = np.asarray(axis, float) + 0.0  # which makes 0.0 of -0.0
        banks.setdefault(value.tobytes(), []).append(number)
    return list(banks.values())


def strangers(layout: Plan, own: Mapping[int, Override]) -> list[Problem]:
    """Tables of cylinders that the engine does not have."""
    count = len(layout.cells)
    made = (
        f"crank.throws and layout make {count} cylinder{'s' * (count > 1)}; give every throw "
        "its "
        "angle in crank.throws"
    )
    return [
        Problem(f"cylinder.{n}", f"there is no cylinder {n}: {made}")
        for n in own
        if n not in layout.numbers
    ]
