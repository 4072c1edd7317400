"""Compute the bobweight card: the masses that a balancing shop fixes to each crank pin to represent
rods and pistons. Define the records of the scheme `factor`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np

from ..core.phasors import Figure
from ..core.records import HIDDEN, INLINE, Node, Polar
from ..engine.engine import CylinderNumber, Engine
from ..engine.rods import CylinderMasses
from ..file.model import PISTON_PARTS
from .planes import measure_direction

DEFINITION = (
    "bobweight of a crank pin = rotating mass + factor x reciprocating mass of the rods on that "
    "pin; rotating: rod big ends, rod bearings, oil; reciprocating: pistons with rings, pins and "
    "locks, rod small ends"
)
NO_THROW = (
    "counts as 0, because crank.throw_mass is 0 or not given; a throw mass would make the "
    "counterweights heavier by this mass at the crank radius"
)
PIN_ALONE = (
    "The throw counts as its crank pin alone: a web given by profile or mass does not tell what "
    "belongs to its cheek."
)
WHOLE_PISTON = "piston complete"
ROTATING = ("big end", "rod bearing", "oil")
PISTON = (WHOLE_PISTON, *PISTON_PARTS)
_RECIPROCATING = (*PISTON, "crosshead", "small end")


class CardLine(NamedTuple):
    """One line of a bobweight card.

    Attributes:
        part: Name of the part, such as "rings".
        rotates: Whether the part turns with the pin; otherwise it reciprocates.
        each_g: Mass of the part for each rod on the pin, g.
    """

    part: str
    rotates: bool
    each_g: tuple[float, ...]

    @property
    def sum_g(self) -> float:
        """Mass for all rods on the pin, g."""
        return sum(self.each_g)


class Bobweight(NamedTuple):
    """The bobweight of one crank pin, in grams as on the card and the scales of a balancing shop.

    Attributes:
        throw: Number of the throw, from 1.
        cylinders: Numbers of the cylinders whose rods are on the pin.
        factor: Share of the reciprocating mass that the bobweight includes.
        piston_g: Pistons with rings, pins and locks.
        small_end_g: Small ends of the rods.
        big_end_g: Big ends of the rods.
        rod_bearing_g: Rod bearings.
        oil_g: Oil.
        rotating_g: Sum of all rotating parts.
        reciprocating_g: Sum of all reciprocating parts.
        bobweight_g: Rotating mass plus factor times reciprocating mass.
        throw_g: Part of the throw mass (at the crank radius) that belongs to this pin;
            counterweights balance this mass in addition to the bobweight. With webs, pin and
            cheeks; the pin alone if the file gives a web by its profile or mass.
        lines: All parts that are weighed, in the order of the card.
        is_whole_throw: Whether `throw_g` has the cheeks as well.
    """

    throw: int
    cylinders: tuple[CylinderNumber, ...]
    factor: float
    piston_g: float
    small_end_g: float
    big_end_g: float
    rod_bearing_g: float
    oil_g: float
    rotating_g: float
    reciprocating_g: float
    bobweight_g: float
    throw_g: float
    lines: tuple[CardLine, ...]
    is_whole_throw: Annotated[bool, HIDDEN] = True


def fill_card(engine: Engine, factor: float) -> tuple[Bobweight, ...]:
    """Return the bobweight of each crank pin for this share of the reciprocating mass."""
    return tuple(_weigh(engine, rows, factor) for rows in engine.rows_by_pin)


def _weigh(engine: Engine, rows: list[int], factor: float) -> Bobweight:
    masses = [engine.weighed[row] for row in rows]
    lines = _list_lines(masses)
    shares = [engine.find_throw_share(row) for row in rows]

    def total(*parts: str) -> float:
        return sum(line.sum_g for line in lines if line.part in parts)

    rotating = total(*ROTATING)
    reciprocating = total(*_RECIPROCATING)
    return Bobweight(
        throw=masses[0].throw + 1,
        cylinders=tuple(engine.numbers[row] for row in rows),
        factor=factor,
        piston_g=total(*PISTON),
        small_end_g=total("small end"),
        big_end_g=total("big end"),
        rod_bearing_g=total("rod bearing"),
        oil_g=total("oil"),
        rotating_g=rotating,
        reciprocating_g=reciprocating,
        bobweight_g=rotating + factor * reciprocating,
        throw_g=1e3 * sum(share.mass for share in shares),
        lines=lines,
        is_whole_throw=all(share.is_whole for share in shares),
    )


def _list_lines(masses: list[CylinderMasses]) -> tuple[CardLine, ...]:
    """Return the parts of the rods on one pin; parts that no rod has are omitted."""
    rods = [_list_parts(cylinder) for cylinder in masses]
    lines = []
    for part in (*ROTATING, *_RECIPROCATING):
        if any(part in rod for rod in rods):
            each_g = tuple(1e3 * float(rod.get(part, 0.0)) for rod in rods)
            lines.append(CardLine(part=part, rotates=part in ROTATING, each_g=each_g))
    return tuple(lines)


def _list_parts(cylinder: CylinderMasses) -> dict[str, Figure]:
    """Return the masses that move with one rod, kg, by the names of the card."""
    parts = {
        "big end": cylinder.big_end,
        "rod bearing": cylinder.rod_bearing,
        "oil": cylinder.oil,
        "small end": cylinder.small_end,
    }
    for key, mass in cylinder.piston_parts:
        parts[WHOLE_PISTON if key == "mass" else key] = mass
    if np.any(cylinder.crosshead):
        parts["crosshead"] = cylinder.crosshead
    return parts


class _FromPin(Polar):
    """Annotation of an unbalance whose angle counts from cylinder 1's pin, deg, in (-180, 180]."""

    def split(self, value: complex) -> Node:
        """Return size and angle of the unbalance."""
        angle = measure_direction(value) if value else None
        return {self.magnitude: abs(value), self.angle: angle}


class PlaneNeed(NamedTuple):
    """Counterweight that a balance factor requires in one plane of the crankshaft.

    Attributes:
        position_mm: Position of the plane along the crankshaft.
        wanted: Unbalance that the masses on the pins require in this plane, kg m.
        present: Unbalance of the file's counterweights in this plane, kg m.
        missing: Unbalance that has to be added: wanted minus present, kg m.
    """

    position_mm: float
    wanted: Annotated[complex, _FromPin("wanted_kg_m", "wanted_deg"), INLINE]
    present: Annotated[complex, _FromPin("present_kg_m", "present_deg"), INLINE]
    missing: Annotated[complex, _FromPin("missing_kg_m", "missing_deg"), INLINE]


@dataclass(frozen=True, kw_only=True, order=True)
class FactorPeaks:
    """Largest free force and moment over a revolution (sum of all orders) of an engine that is
    balanced by a factor.

    Attributes:
        factor: Balance factor.
        peak_force_N: Largest force.
        along_N: Largest component of the force along the axis of the first bank.
        across_N: Largest component of the force at right angles to this axis.
        peak_moment_Nm: Largest moment.
        bobweight_g: Bobweight of the first pin.
        counterweight_kg_m: Largest counterweight to add.
        by_moment: Whether the moment determines the best factor, because the pins balance each
            other and no factor changes the force much.
    """

    factor: float
    peak_force_N: float
    along_N: float
    across_N: float
    peak_moment_Nm: float
    bobweight_g: float
    counterweight_kg_m: float
    by_moment: Annotated[bool, HIDDEN]

    @property
    def cost(self) -> tuple[float, float]:
        """Sort key that is smallest at the best factor: force, then moment, or (`by_moment`) the
        reverse.
        """
        force = round(self.peak_force_N, 6)
        moment = round(self.peak_moment_Nm, 6)
        return (moment, force) if self.by_moment else (force, moment)
