"""Figures of a scheme that are no device."""

from __future__ import annotations

from typing import Literal, NamedTuple

Dimension = Literal["", "force", "moment", "unbalance", "length", "angle"]


class Range(NamedTuple):
    """The least and the largest of several figures."""

    least: float
    largest: float


class Detail(NamedTuple):
    """A figure, or words, with its label.

    Attributes:
        label: what it is, in words.
        dimension: of the value: "force" (N), "moment" (N m), "unbalance" (kg m), "length" (m),
            "angle" (degrees), or "" for plain numbers and words.
        group: what it belongs to, such as "order 2"; empty if to the whole scheme.
    """

    label: str
    dimension: Dimension
    value: float | str | Range | tuple[float, ...]
    group: str = ""


class Bobweight(NamedTuple):
    """The bobweight of one crank pin, in grams as on the card and the scales of a balancing shop.

    Attributes:
        throw: of the pin, from 1.
        cylinders: numbers of the cylinders whose rods are on the pin.
        piston_g, small_end_g, big_end_g, rod_bearing_g, oil_g: of all these rods together.
        rotating_g: big ends, rod bearings and oil.
        reciprocating_g: pistons and small ends.
        factor: share of the reciprocating mass that counts.
        bobweight_g: rotating plus factor times reciprocating.
    """

    throw: int
    cylinders: tuple[int, ...]
    piston_g: float
    small_end_g: float
    big_end_g: float
    rod_bearing_g: float
    oil_g: float
    rotating_g: float
    reciprocating_g: float
    factor: float
    bobweight_g: float


class FactorPeaks(NamedTuple):
    """What an engine balanced by the shop's factor still shakes: largest values over a revolution,
    of all orders.

    Attributes:
        force: N. along, across: its components along the axis of the first bank and across it, N.
        moment: N m.
    """

    factor: float
    force: float
    along: float
    across: float
    moment: float


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
