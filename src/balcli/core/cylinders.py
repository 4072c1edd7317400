"""Moving parts of an engine: its cylinders, one row each, and its balancing devices. SI units.

Stroke and dead centres of every piston; those of articulated ones differ from the crank's throw
and angle.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .mechanisms import harmonics
from .mechanisms.linkage import Linkage, revolution
from .phasors import Array, Complex, Figure

if TYPE_CHECKING:
    from .mechanisms.closed_form import Harmonics, Rows


@dataclass(frozen=True, eq=False)
class Cylinders:
    """All cylinders of an engine, sorted by bank: bank b has the rows from `starts[b]` on.

    Attributes:
        axis_deg: shape (banks, *trailing), cylinder axes from x.
        pin_deg: shape (cylinders, *trailing), crank pins from cylinder 1's pin, in the sense of
        rotation.
        starts: shape (banks,).
        first: bank of cylinder 1.
        z: shape (cylinders, *trailing), m.
        radius: crank radius, m.
        lam, eps: shape (cylinders or 1, *trailing), crank radius and offset over rod length.
        reciprocating, rotating: masses at the piston pin and at the crank pin, kg.
        couple: `H` of the rods, kg m2 (docs/theory.md: moment of inertia of two point masses less
        that of the rod).
        linkage: linkage of cylinders that are more than slider-cranks, with additional masses.
    """

    axis_deg: Array
    pin_deg: Array
    starts: NDArray[np.intp]
    first: int
    z: Array
    radius: Array
    lam: Array
    eps: Array
    reciprocating: Array
    rotating: Array
    couple: Array
    linkage: Linkage | None = None

    @property
    def count(self) -> int:
        """Number of cylinders."""
        return len(self.pin_deg)

    @property
    def axis_of_each_deg(self) -> Array:
        """Axis of each cylinder from x, deg, shape (cylinders, *trailing)."""
        return np.repeat(self.axis_deg, np.diff([*self.starts, self.count]), axis=0)

    @property
    def angle_deg(self) -> Array:
        """Each cylinder's own crank angle at crank angle 0 (`phi` in docs/theory.md), deg, shape
        (cylinders, *trailing).
        """
        return np.asarray(self.axis_deg[self.first] + self.pin_deg - self.axis_of_each_deg)

    @property
    def offset(self) -> Array:
        """Offset of the piston-pin path, m."""
        return self.eps * self.radius / self.lam

    @property
    def mechanisms(self) -> list[tuple[complex, ...]]:
        """Figures of each cylinder's mechanism, by which equal ones are known, of an engine without
        trailing axes.
        """
        lam, eps, linkage = self.lam, self.eps, self.linkage
        columns = (lam, eps) if linkage is None else linkage.figures(lam, eps)
        each = [np.broadcast_to(column, self.count).tolist() for column in columns]
        return list(zip(*each, strict=True))

    def find_distinct_harmonics(
        self, orders: ArrayLike, wanted: Collection[str]
    ) -> tuple[Harmonics, Rows]:
        """Return harmonics of the mechanisms that differ, and which of them each cylinder has.

        Args:
            orders: whole, shape (orders,).
            wanted: names of series (`closed_form.SERIES`).
        """
        kind = self.linkage or harmonics
        return kind.find_distinct_harmonics(orders, self.lam, self.eps, wanted)

    def find_highest_order(self) -> int:
        """Return the order beyond which no moving part exceeds rounding errors."""
        return (self.linkage or harmonics).find_highest_order(self.lam, self.eps)

    def count_all_samples(self) -> tuple[int, int]:
        """Return how many mechanisms differ, and about how many samples of a revolution they take
        together where they are sampled.
        """
        return (self.linkage or harmonics).count_all_samples(self.lam, self.eps)


class DeviceKind(IntEnum):
    """Kind of a device. Devices are summed in this order, as in an engine file."""

    COUNTERWEIGHT = 0
    SHAFT = 1
    SLIDER = 2
    OTHER = 3  # which no engine file can describe


class Device(NamedTuple):
    """Counterweight, balancer shaft or slider: mass x radius that turns at an order of the crank.

    Figures are numbers, or arrays of variants.

    Attributes:
        order: Turns for each turn of the crank.
        forward, backward: Mass x radius that turns with the crank, and against it, kg m.
        place: Position x + iy of its axis, m.
        z: Position along the crank, m.
        kind: Kind of the device.
        compensates: Whether it is there for its moment, and its force is meant to remain.
        crank: Index of the crank to which it is geared, or that carries it.
    """

    order: int
    forward: complex | Complex
    backward: complex | Complex
    place: complex | Complex
    z: Figure
    kind: DeviceKind = DeviceKind.OTHER
    compensates: bool = False
    crank: int = 0


_STEPS = 720


class Travel(NamedTuple):
    """One value a cylinder, shape (cylinders, *trailing)."""

    stroke: Array  # m
    top_deg: Array  # each cylinder's own crank angle (0: pin along the axis) at top dead centre
    bottom_deg: Array  # the same at the lower dead centre, less 180


def find_travel(c: Cylinders) -> Travel:
    """Return strokes and dead centres of all cylinders.

    They have a closed form for plain slider-cranks (`sin tau = e/(l + r)` at the top, `e/(l - r)`
    at the bottom), and are found on the curve of the motion for others.
    """
    if c.linkage is None:
        top, bottom = c.eps / (1 + c.lam), c.eps / (1 - c.lam)
        high = (1 + c.lam) * np.sqrt((1 - top) * (1 + top)) / c.lam
        low = (1 - c.lam) * np.sqrt((1 - bottom) * (1 + bottom)) / c.lam
        top_deg, bottom_deg = np.degrees(np.arcsin(top)), np.degrees(np.arcsin(bottom))
    else:
        psi = revolution(_STEPS)
        place = c.linkage.sample(lambda motion: motion.place, psi, c.lam, c.eps)
        top = _refine(c, c.linkage, psi[place.argmax(axis=-1)])
        bottom = _refine(c, c.linkage, psi[place.argmin(axis=-1)])
        high = c.linkage.motion(top[..., None], c.lam, c.eps).place[..., 0]
        low = c.linkage.motion(bottom[..., None], c.lam, c.eps).place[..., 0]
        top_deg = np.remainder(np.degrees(top) + 180, 360) - 180
        bottom_deg = np.degrees(bottom) - 180
    shape, found = c.pin_deg.shape, (c.radius * (high - low), top_deg, bottom_deg)
    return Travel(*(np.broadcast_to(v, np.broadcast_shapes(shape, v.shape)) for v in found))


def _refine(c: Cylinders, linkage: Linkage, psi: Array) -> Array:
    """Return zeros, by Newton's method, of the pistons' velocity near these angles (rad)."""
    for _ in range(6):
        motion = linkage.motion(psi[..., None], c.lam, c.eps)
        psi = psi - (motion.velocity / motion.acceleration)[..., 0]
    return psi
