"""The bobweight card: what a balancing shop hangs on each crank pin for rods and pistons."""

from __future__ import annotations

from collections.abc import Iterator

from ..engine.build import Engine
from ..engine.rods import Weighed
from .scheme_figures import Bobweight, CardLine

DEFINITION = (
    "bobweight of a crank pin = rotating mass + factor x reciprocating mass of the rods on that "
    "pin; rotating: rod big ends, rod bearings, oil; reciprocating: pistons with rings, pins and "
    "locks, rod small ends"
)
NO_THROW = (
    "counts as 0, as crank.throw_mass is 0 or not given: with it the counterweights are heavier by "
    "what the throw itself weighs at the crank radius"
)
WHOLE_PISTON = "piston complete"
PISTON = (WHOLE_PISTON, "piston", "pin", "rings", "locks")


def fill_card(engine: Engine, factor: float) -> tuple[Bobweight, ...]:
    """The bobweight of each crank pin for this share of the reciprocating mass."""
    return tuple(_weigh(engine, rows, factor) for rows in engine.rows_by_pin)


def _weigh(engine: Engine, rows: list[int], factor: float) -> Bobweight:
    """The bobweight of the pin of these cylinders."""
    masses = [engine.weighed[row] for row in rows]
    return Bobweight(
        throw=masses[0].throw + 1,
        cylinders=tuple(engine.numbers[row] for row in rows),
        lines=tuple(_list_lines(masses)),
        factor=factor,
        throw_g=1e3 * sum(float(one.share) for one in masses),
    )


def _list_lines(masses: list[Weighed]) -> Iterator[CardLine]:
    """All that is weighed of the rods on one pin; parts that none of them has are left out."""

    def weigh(part: str, rotates: bool, each_kg: list[float]) -> CardLine:
        return CardLine(part, rotates, tuple(1e3 * mass for mass in each_kg))

    yield weigh("big end", True, [float(one.big_end) for one in masses])
    yield weigh("rod bearing", True, [float(one.rod_bearing) for one in masses])
    yield weigh("oil", True, [float(one.oil) for one in masses])
    pistons = [
        {WHOLE_PISTON if key == "mass" else key: float(mass) for key, mass in one.piston_parts}
        for one in masses
    ]
    for part in PISTON:
        if any(part in piston for piston in pistons):
            yield weigh(part, False, [piston.get(part, 0.0) for piston in pistons])
    yield weigh("small end", False, [float(one.small_end) for one in masses])
