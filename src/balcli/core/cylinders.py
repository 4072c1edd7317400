"""Define the cylinders and balancing devices of an engine in SI units, and compute strokes and dead
centres. Each cylinder is a row of the arrays; `*trailing` are further axes, such as variants.

`find_travel` computes stroke and dead centres of every piston. With an articulated rod, the stroke
is not twice the crank radius, and dead centres are not at crank angles 0 and 180 degrees.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
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
    """All cylinders of an engine, sorted by bank: the rows of bank b begin at `starts[b]`.

    Attributes:
        axis_deg: shape (banks, *trailing), angles of the cylinder axes from x.
        pin_deg: shape (cylinders, *trailing), angles of crank pins from cylinder 1's pin, in the
            direction of rotation.
        starts: shape (banks,), first row of each bank.
        first: index of the bank of cylinder 1.
        z: shape (cylinders, *trailing), position of each cylinder along the crank, m.
        radius, offset: shape (cylinders or 1, *trailing), crank radius and offset of the piston
            pin's path, m.
        lam, eps: shape (cylinders or 1, *trailing), crank radius and offset over rod length; 0 in
            harmonic motion (rod of infinite length).
        reciprocating, rotating: masses at the piston pin and at the crank pin, kg.
        couple: H of the rods, kg m2: moment of inertia of the two point masses that replace a rod,
            less that of the rod (docs/theory.md).
        linkage: articulated rods or a rotary mechanism, with their masses; None if all cylinders
            are plain slider-cranks.
    """

    axis_deg: Array
    pin_deg: Array
    starts: NDArray[np.intp]
    first: int
    z: Array
    radius: Array
    offset: Array
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
        """Direction of each cylinder's axis from x, deg, shape (cylinders, *trailing)."""
        return np.repeat(self.axis_deg, np.diff([*self.starts, self.count]), axis=0)

    @property
    def angle_deg(self) -> Array:
        """Angle of each crank pin from its cylinder's axis at crank angle 0 (`phi` in
        docs/theory.md), deg, shape (cylinders, *trailing).
        """
        return np.asarray(self.axis_deg[self.first] + self.pin_deg - self.axis_of_each_deg)

    @property
    def radius_of_each(self) -> Array:
        """Crank radius of each cylinder, m, shape (cylinders, *trailing)."""
        return np.broadcast_to(self.radius, (self.count, *self.radius.shape[1:]))

    @property
    def rod_length(self) -> Array:
        """Length of the rods, m, shape (cylinders or 1, *trailing); infinite in harmonic motion."""
        with np.errstate(divide="ignore"):
            return np.asarray(self.radius / self.lam)

    @property
    def harmonic(self) -> bool:
        """Whether every piston moves as a cosine of the crank angle."""
        return not np.any(self.lam)

    @property
    def mechanisms(self) -> list[tuple[complex, ...]]:
        """Figures that determine each cylinder's mechanism, and its crank radius; equal mechanisms
        have equal figures. The cylinders must have no trailing axes.
        """
        lam = self.lam
        eps = self.eps
        linkage = self.linkage
        columns = (lam, eps) if linkage is None else linkage.figures(lam, eps)
        each = [np.broadcast_to(column, self.count).tolist() for column in (*columns, self.radius)]
        return list(zip(*each, strict=True))

    def find_distinct_harmonics(
        self, orders: ArrayLike, wanted: Collection[str]
    ) -> tuple[Harmonics, Rows]:
        """Return the harmonics of all different mechanisms, and the index of each cylinder's
        mechanism. Those of a single engine are kept, because its devices and masses change more
        often than its mechanisms; do not change them.

        Args:
            orders: Whole orders, shape (orders,).
            wanted: Names of series (`closed_form.SERIES`).
        """
        kind = self.linkage or harmonics
        if self.pin_deg.ndim > 1:
            return kind.find_distinct_harmonics(orders, self.lam, self.eps, wanted)
        asked = np.asarray(orders, float).tobytes(), frozenset(wanted)
        if asked not in self._kept:
            self._kept[asked] = kind.find_distinct_harmonics(orders, self.lam, self.eps, wanted)
        return self._kept[asked]

    @cached_property
    def _kept(self) -> dict[tuple[bytes, frozenset[str]], tuple[Harmonics, Rows]]:
        """Harmonics by orders and series."""
        return {}

    def find_highest_order(self) -> int:
        """Return the order beyond which the harmonics of all mechanisms are below rounding."""
        return (self.linkage or harmonics).find_highest_order(self.lam, self.eps)

    def count_all_samples(self) -> tuple[int, int]:
        """Return the number of different mechanisms, and the approximate number of samples of a
        revolution that they need together if they are sampled.
        """
        return (self.linkage or harmonics).count_all_samples(self.lam, self.eps)


class DeviceKind(IntEnum):
    """Kind of a device. Devices are summed in the order of the kinds."""

    COUNTERWEIGHT = 0
    SHAFT = 1
    SLIDER = 2
    OTHER = 3  # a device that no engine file can describe


class Device(NamedTuple):
    """Counterweight, balancer shaft or slider, as vectors (mass x radius) that turn at a multiple
    of the crank speed. Values are numbers, or arrays of variants.

    Attributes:
        order: Turns or oscillations of the device per turn of the crank.
        forward: Mass x radius that turns with the crank, kg m.
        backward: Mass x radius that turns against the crank, kg m.
        place: Position x + iy of the device's axis, m.
        z: Position along the crank, m.
        kind: Kind of the device.
        compensates: Whether the device is fitted for its moment only, and its force may remain.
        spin: Angular momentum about its own axis at a crank speed of 1 rad/s, positive in the
            direction in which the crank turns, kg m2.
        axle: Axle of a locomotive that carries the device; empty: the driving axle.
        crank: Index of the crank that carries or drives the device.
        is_coupling: Whether it is the mass of a locomotive's coupling rods, which turns with the
            crank like a counterweight but is fitted to drive an axle.
        web: Number of the crankshaft's web that this is; 0: it is no web.
    """

    order: float
    forward: complex | Complex
    backward: complex | Complex
    place: complex | Complex
    z: Figure
    kind: DeviceKind = DeviceKind.OTHER
    compensates: bool = False
    spin: Figure = 0.0
    axle: str = ""
    crank: int = 0
    is_coupling: bool = False
    web: int = 0

    @property
    def is_counterweight(self) -> bool:
        """Whether it is fitted to the crank to balance it, as coupling rods are not."""
        return self.kind is DeviceKind.COUNTERWEIGHT and not self.is_coupling


_STEPS = 720


class Travel(NamedTuple):
    """Stroke and dead centres of each cylinder, each of shape (cylinders, *trailing).

    Attributes:
        stroke: Stroke, m.
        top_deg: Angle of the crank from the cylinder's axis at the upper dead centre.
        bottom_deg: Angle of the crank from the cylinder's axis at the lower dead centre, minus 180.
    """

    stroke: Array
    top_deg: Array
    bottom_deg: Array


def find_travel(c: Cylinders) -> Travel:
    """Return strokes and dead centres of all cylinders.

    Plain slider-cranks have a closed form. Let e be the offset, l the rod length, r the crank
    radius, and tau_top and tau_bottom the crank angles from the cylinder's axis at the dead
    centres. Then `sin tau_top = e/(l + r)`, `sin(tau_bottom - 180 deg) = e/(l - r)`, and the stroke
    is `(l + r) cos tau_top - (l - r) cos(tau_bottom - 180 deg)`. It is computed without a division
    by `lam`, which may be 0. Dead centres of other mechanisms are found numerically.
    """
    _, stroke, top_deg, bottom_deg = _find_dead_centres(c)
    shape = c.pin_deg.shape
    found = (c.radius * stroke, top_deg, bottom_deg)
    return Travel(*(np.broadcast_to(v, np.broadcast_shapes(shape, v.shape)) for v in found))


def find_innermost(c: Cylinders) -> Array:
    """Return the distance of each piston pin from the crank axis along its cylinder at the lower
    dead centre, m, shape (cylinders or 1, *trailing); infinite in harmonic motion.
    """
    return np.asarray(c.radius * _find_dead_centres(c)[0])


def _find_dead_centres(c: Cylinders) -> tuple[Array, Array, Array, Array]:
    """Return the distance of the piston pins from the crank axis at the lower dead centre and the
    stroke of the pistons, both in crank radii, and `top_deg` and `bottom_deg` of `Travel`.
    """
    if c.linkage is None:
        top = c.eps / (1 + c.lam)
        bottom = c.eps / (1 - c.lam)
        both = np.sqrt((1 - top) * (1 + top)) + np.sqrt((1 - bottom) * (1 + bottom))
        stroke = both + 2 * c.eps * (top + bottom) / ((1 - c.lam) * (1 + c.lam) * both)
        with np.errstate(divide="ignore"):
            low = (1 - c.lam) * np.sqrt((1 - bottom) * (1 + bottom)) / c.lam
        return low, stroke, np.degrees(np.arcsin(top)), np.degrees(np.arcsin(bottom))
    psi = revolution(_STEPS)
    place = c.linkage.sample(lambda motion: motion.place, psi, c.lam, c.eps)
    ends = psi[np.array([place.argmax(axis=-1), place.argmin(axis=-1)])]
    for _ in range(6):  # Newton's method for the zeros of the pistons' velocities
        motion = c.linkage.motion(ends[..., None], c.lam, c.eps)
        ends = ends - (motion.velocity / motion.acceleration)[..., 0]
    high, low = c.linkage.motion(ends[..., None], c.lam, c.eps).place[..., 0]
    top_deg = np.remainder(np.degrees(ends[0]) + 180, 360) - 180
    return low, high - low, top_deg, np.degrees(ends[1]) - 180
