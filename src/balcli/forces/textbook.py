"""Forces and moments as textbooks have them: multiples of those of one cylinder.

`F1 = m_rec r omega^2` is the first-order force of cylinder 1's reciprocating mass, `F_n = A_n F1`
its n-th; moments are multiples of `F_n a`, a the (smallest) distance of neighbouring throws. Where
the rod of cylinder 1 is articulated, its orders are no A_n, and its master's cylinder stands for
it. Textbooks count the reciprocating masses alone, each in the plane of its throw: what rotates is
the counterweights' business, and does not hide the layout. Source: Bosch, Automotive Handbook,
"Free forces and moments of the 1st and 2nd order".
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np

from ..core.mechanisms import harmonics
from ..core.phasors import Array
from ..engine.engine import Engine
from .kinds import Kind
from .spectrum import Spectra, compute_spectra

if TYPE_CHECKING:
    from ..core.mechanisms.linkage import Articulated


_NO_FORCE = 1e-12  # A_n of an order that the piston does not have


class TextbookUnits(NamedTuple):
    """What the forces and moments of an engine are multiples of.

    Attributes:
        orders: shape (orders,).
        force: F1, N.
        arm: a, the smallest distance of neighbouring throws, m; nan where all stand in one plane.
        ratios: |A_n| of each order, shape (orders,).
        cylinder: number of the cylinder of which they are.
        equal: whether all cylinders are like it.
    """

    orders: Array
    force: float
    arm: float
    ratios: Array
    cylinder: int
    equal: bool

    def size(self, kind: Kind, order: float) -> float:
        """F_n of one of the orders, N, or F_n a, N m; nan where there is no such force or arm."""
        ratio = float(self.ratios[np.searchsorted(self.orders, order)])
        if not self.force or ratio < _NO_FORCE:
            return float("nan")
        return self.force * ratio * (1.0 if kind.dimension == "force" else self.arm)

    def name(self, kind: Kind, order: object = "n") -> str:
        """How the unit of an order is written."""
        return f"F{order}" if kind.dimension == "force" else f"F{order}·a"


class Textbook(NamedTuple):
    """An engine's forces and moments, and what they are multiples of.

    Attributes:
        reciprocating: as textbooks have them, N and N m: reciprocating masses in the planes of
            their throws.
        built: with the rotating masses, too, and all where they stand; still without devices, at a
            steady speed.
    """

    units: TextbookUnits
    reciprocating: Spectra
    built: Spectra


def find_textbook(engine: Engine, orders: Array, kinds: Collection[str]) -> Textbook:
    """What an engine without trailing axes does, for these orders; names of kinds."""
    built = without_devices(engine)
    return Textbook(
        find_textbook_units(engine, orders),
        compute_spectra(with_reciprocating_only(built), orders, kinds),
        compute_spectra(built, orders, kinds),
    )


def without_devices(engine: Engine) -> Engine:
    """The cylinders alone, at a steady speed; moments about the crank's axis."""
    return replace(engine, devices=(), ripple=(), reference_m=(0.0, 0.0, engine.reference_m[2]))


def with_reciprocating_only(engine: Engine) -> Engine:
    """The engine without what turns with its pins, every cylinder in the plane of its throw."""
    c = engine.cylinders
    planes = engine.throws_m[[weighed.throw for weighed in engine.weighed]]
    return replace(engine, cylinders=replace(c, z=planes, rotating=0 * c.rotating))


def find_textbook_units(engine: Engine, orders: Array) -> TextbookUnits:
    """The units of an engine without trailing axes, for these orders."""
    c, row = engine.cylinders, engine.numbers.index(1)
    if c.linkage is not None and not engine.rotary:
        row = int(cast("Articulated", c.linkage).master[row])

    def of_this_one(values: Array) -> Array:
        return values[row : row + 1] if len(values) > 1 else values

    lam, eps = of_this_one(c.lam), of_this_one(c.eps)
    series = harmonics.find_harmonics(orders, lam, eps, {"piston"})["piston"]
    mass = float(of_this_one(c.reciprocating)[0])
    gaps = np.diff(np.unique(np.round(engine.throws_m, 9)))
    return TextbookUnits(
        orders=orders,
        force=float(mass * c.radius * engine.omega**2),
        arm=float(gaps.min()) if gaps.size else float("nan"),
        ratios=np.abs(series.c[:, 0]),
        cylinder=engine.numbers[row],
        equal=engine.equal,
    )
