"""The bobweight card: what a balancing shop hangs on each crank pin for rods and pistons."""

from __future__ import annotations

from ..engine.build import Engine
from .details import Bobweight

DEFINITION = (
    "bobweight of a crank pin = rotating mass + factor x reciprocating mass of the rods on that "
    "pin; rotating: rod big ends, rod bearings, oil; reciprocating: pistons with rings, pins and "
    "clips, rod small ends"
)


def fill_card(engine: Engine, factor: float) -> tuple[Bobweight, ...]:
    """The bobweight of each crank pin for this share of the reciprocating mass."""
    return tuple(_weigh(engine, rows, factor) for rows in engine.rows_by_pin)


def _weigh(engine: Engine, rows: list[int], factor: float) -> Bobweight:
    """The bobweight of the pin of these cylinders."""
    masses = [engine.weighed[row] for row in rows]
    piston, small_end, big_end, rod_bearing, oil = (
        1e3 * sum(float(mass) for mass in of_each)
        for of_each in zip(
            *((m.piston, m.small_end, m.big_end, m.rod_bearing, m.oil) for m in masses),
            strict=True,
        )
    )
    rotating = big_end + rod_bearing + oil
    reciprocating = piston + small_end
    return Bobweight(
        throw=masses[0].throw + 1,
        cylinders=tuple(engine.numbers[row] for row in rows),
        piston_g=piston,
        small_end_g=small_end,
        big_end_g=big_end,
        rod_bearing_g=rod_bearing,
        oil_g=oil,
        rotating_g=rotating,
        reciprocating_g=reciprocating,
        factor=factor,
        bobweight_g=rotating + factor * reciprocating,
    )
