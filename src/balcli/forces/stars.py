"""Phasor stars: the rotating vectors of the cylinders, and their sums.

Each cylinder contributes two vectors to an order of the free force: one turns with the crank, one
against it (`core.phasors`). Drawn from one point, at crank angle 0, the vectors that turn in one
direction are a star of the order; in an in-line engine with equal cylinders, the directions in the
star of order n are n times the crank angles. Put one after the other, the vectors form a polygon.
If it closes, their sum is 0: no force of this order turns in this direction. Moments have stars as
well: each vector is that of the force times the cylinder's axial distance from the point of
reference, turned ahead by a quarter turn. Source: W. Thomson, Fundamentals of Automotive Engine
Balance.
"""

from collections.abc import Collection, Iterable, Iterator
from itertools import pairwise
from typing import Annotated, Literal, NamedTuple, TypeAlias

import numpy as np

from ..core.loads import sum_weighted
from ..core.records import INLINE, Polar, angle_deg
from ..engine.engine import CylinderNumber, Engine
from .spectrum import Spectra, compute_spectra
from .symmetry import without_devices

Force = Annotated[complex, Polar("force_N", "force_deg"), INLINE]
Moment = Annotated[complex | None, Polar("moment_Nm", "moment_deg"), INLINE]
Turns: TypeAlias = Literal["forward", "backward"]
WAYS: tuple[Turns, ...] = ("forward", "backward")  # in the order of `Phasors.vectors`


class Ray(NamedTuple):
    """Vectors of one cylinder at crank angle 0.

    Attributes:
        cylinder: Number of the cylinder.
        force: Vector of its force.
        moment: Vector of its moment about the point of reference; omitted if it is not known.
    """

    cylinder: CylinderNumber
    force: Force
    moment: Moment = None


class Bank(NamedTuple):
    """Vectors of the cylinders of one bank, and their sums.

    Attributes:
        axis_deg: Direction of the bank, from x; null if several banks count as one (`Star.banks`).
        force: Sum of the vectors of force.
        cylinders: Vectors of each cylinder, by number.
        moment: Sum of the vectors of moment; omitted if it is not known.
    """

    axis_deg: float | None
    force: Force
    cylinders: tuple[Ray, ...]
    moment: Moment = None

    @property
    def directions(self) -> dict[float, list[CylinderNumber]]:
        """Cylinders by the direction of their force, deg, ascending; cylinders without force are
        left out.
        """
        by_direction: dict[float, list[CylinderNumber]] = {}
        for ray in self.cylinders:
            if ray.force:
                by_direction.setdefault(find_direction(ray.force), []).append(ray.cylinder)
        return dict(sorted(by_direction.items()))


class Star(NamedTuple):
    """Vectors of the cylinders of one order that turn in one direction; devices are left out.

    Attributes:
        order: Order.
        turns: "forward": with the crank; "backward": against it.
        force: Sum of all vectors of force.
        banks: Vectors of each bank. More than two banks with one cylinder each, as in a radial,
            count as one bank.
        moment: Sum of all vectors of moment; omitted if it is not known.
    """

    order: float
    turns: Turns
    force: Force
    banks: tuple[Bank, ...]
    moment: Moment = None


def find_stars(
    engine: Engine, asked: Iterable[float], kinds: Collection[str] = ("force", "moment")
) -> Iterator[Star]:
    """Yield the stars of each order: the vectors that turn with the crank, and those that turn
    against it; a star without vectors is left out.

    Args:
        engine: One engine with one crank, not an array of variants.
        asked: Orders, ascending; there is no star of order 0.
        kinds: "force", and also "moment" if it is wanted and known.
    """
    orders = np.array([order for order in asked if order > 0])
    alone = without_devices(engine)
    axes = engine.cylinders.axis_of_each_deg
    row_of = engine.numbers.index
    banks = _list_banks(engine)
    count = len(engine.cylinders.starts)
    by_cylinder = compute_spectra(alone, orders, kinds, by_cylinder=True)
    total = compute_spectra(alone, orders, kinds)
    members = np.array([np.isin(engine.numbers, bank) for bank in banks], float)
    weighted = {
        kind.name: sum_weighted(phasors, members) for kind, phasors in by_cylinder.vectors()
    }
    sums = Spectra(orders, None, weighted)
    for k, order in enumerate(orders.tolist()):
        for way, turns in enumerate(WAYS):
            if not by_cylinder["force"].vectors[way, k].any():
                continue
            of_banks = []
            for row, bank in enumerate(banks):
                axis_deg = float(axes[row_of(bank[0])]) if len(banks) == count else None
                rays = tuple(Ray(n, **_pick(by_cylinder, way, k, row_of(n))) for n in bank)
                of_banks.append(Bank(axis_deg=axis_deg, cylinders=rays, **_pick(sums, way, k, row)))
            yield Star(order, turns, banks=tuple(of_banks), **_pick(total, way, k))


def find_direction(vector: complex) -> float:
    """Return the direction of a vector, deg from 0 to 360, without rounding errors."""
    return round(angle_deg(vector), 6) % 360


def _list_banks(engine: Engine) -> list[list[CylinderNumber]]:
    """Return the cylinders of each bank, by number; one list for a radial (`Star.banks`)."""
    ends = [*engine.cylinders.starts, len(engine.numbers)]
    banks = [sorted(engine.numbers[slice(*pair)]) for pair in pairwise(ends)]
    alone = len(banks) > 2 and max(map(len, banks)) == 1
    return [sorted(engine.numbers)] if alone else banks


def _pick(spectra: Spectra, *place: int) -> dict[str, complex]:
    """Return the vectors of force and moment at a place of `Phasors.vectors`."""
    return {kind.name: complex(phasors.vectors[place]) for kind, phasors in spectra.vectors()}
