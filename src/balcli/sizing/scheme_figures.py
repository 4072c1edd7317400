"""Figures of single schemes: bobweight cards, what a balance factor leaves, the best pairs of
shafts of variable speed.
"""

from __future__ import annotations

from typing import NamedTuple


class CardLine(NamedTuple):
    """One line of a bobweight card.

    Attributes:
        part: what is weighed, such as "rings".
        rotates: whether it turns with the pin, or else goes to and fro.
        each_g: mass for each rod on the pin, g.
    """

    part: str
    rotates: bool
    each_g: tuple[float, ...]

    @property
    def sum_g(self) -> float:
        """For all rods on the pin."""
        return sum(self.each_g)


class Bobweight(NamedTuple):
    """The bobweight of one crank pin, in grams as on the card and the scales of a balancing shop.

    Attributes:
        throw: of the pin, from 1.
        cylinders: numbers of the cylinders whose rods are on the pin.
        lines: all that is weighed, what rotates first.
        factor: share of the reciprocating mass that counts.
        throw_g: what the throw itself has at the crank radius on the side of this pin, for its
            rods: counterweights balance it besides the bobweight.
    """

    throw: int
    cylinders: tuple[int, ...]
    lines: tuple[CardLine, ...]
    factor: float
    throw_g: float

    @property
    def rotating_g(self) -> float:
        """Big ends, rod bearings and oil of all rods on the pin."""
        return sum(line.sum_g for line in self.lines if line.rotates)

    @property
    def reciprocating_g(self) -> float:
        """Pistons and small ends of all rods on the pin."""
        return sum(line.sum_g for line in self.lines if not line.rotates)

    @property
    def bobweight_g(self) -> float:
        """Rotating plus factor times reciprocating."""
        return self.rotating_g + self.factor * self.reciprocating_g

    def sum_of(self, *parts: str) -> float:
        """Of the lines of these parts, g."""
        return sum(line.sum_g for line in self.lines if line.part in parts)


class PlaneNeed(NamedTuple):
    """What a balance factor asks for in one plane of the crankshaft. Unbalances are kg m, their
    directions count from cylinder 1's crank pin in the sense of rotation.

    Attributes:
        z: of the plane, m.
        wanted: counterweight for all pins, as far as this plane takes it.
        present: what the file's counterweights do there.
        missing: what is still to be added.
    """

    z: float
    wanted: complex
    present: complex
    missing: complex


class FactorPeaks(NamedTuple):
    """What an engine balanced by the shop's factor still shakes: largest values over a revolution,
    of all orders.

    Attributes:
        force: N. along, across: its components along the axis of the first bank and across it, N.
        moment: N m.
        bobweight_g: of the first pin.
        counterweight: the largest weight that is missing, kg m.
        by_moment: whether the moment says which factor is best: the pins balance each other, so
            that no factor changes much of the force.
    """

    factor: float
    force: float
    along: float
    across: float
    moment: float
    bobweight_g: float
    counterweight: float
    by_moment: bool

    @property
    def cost(self) -> tuple[float, float]:
        """What is least where the factor is best: the force, or else the moment; then the other."""
        force, moment = round(self.force, 6), round(self.moment, 6)
        return (moment, force) if self.by_moment else (force, moment)


class Optimum(NamedTuple):
    """The best pair of unevenly turning shafts by one criterion (see `eccentric_slider`).

    Attributes:
        design: "a" or "b". criterion: "largest" or "mean". engine_force: "orders 1+2" or
            "all orders".
        k: radius of the driving pin over the eccentricity, r_b/e.
        mu: unbalance of each shaft, in units of m r (reciprocating mass times crank radius).
        largest, mean: absolute force that is left, in units of m r omega^2.
    """

    design: str
    criterion: str
    engine_force: str
    k: float
    mu: float
    largest: float
    mean: float


class Optima(NamedTuple):
    """The optima of both designs of unevenly turning shafts; the first is the one that is fitted.

    Attributes:
        unit_force: m r omega^2, N. unit_unbalance: m r, kg m.
    """

    unit_force: float
    unit_unbalance: float
    found: tuple[Optimum, ...]

    def find_unbalance(self, optimum: Optimum) -> float:
        """Unbalance of each shaft, kg m."""
        return optimum.mu * self.unit_unbalance
