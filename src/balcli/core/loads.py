"""Cylinders and balancing devices -> free forces and moments by order, at a steady crank speed.

Cylinder i of bank b has its pin at `pin_i` (degrees after cylinder 1's pin) and its axis at
`axis_b`. A local harmonic `Re c e^{i n psi}`, `psi = theta + axis_1 + pin_i - axis_b`, of a force
along the axis gives

    forward_n  = 1/2 e^{+i n axis_1} sum_b e^{i (1-n) axis_b} S_b,      S_b = sum over its cylinders
    of c_i e^{i n pin_i} backward_n = 1/2 e^{-i n axis_1} sum_b e^{i (1+n) axis_b} conj(S_b)

so each bank is summed once, and what a sweep does not change is not computed again. Arrays: order
first, cylinder (or bank) next, then any trailing axes; an axis along which nothing varies has
length 1. SI units.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import groupby
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .mechanisms.harmonics import Harmonics, Series
from .phasors import EPS, Array, Complex, Phasors, unit

if TYPE_CHECKING:
    from .mechanisms.linkage import Linkage

_SUM = 8 * EPS  # rounding error of a sum, per term and size of the terms
_KEPT = 1 << 16  # orders x cylinders of which the phases are kept
_TURN = (
    np.pi * EPS
)  # rounding error of an angle in the file (half an ulp of 360 deg), which order n multiplies


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
        couple: `H` of the rods, kg m2 (docs/theory.md: what two point masses lack of the rod's
        moment of inertia, with the sign changed).
        linkage: of cylinders that are more than slider-cranks; its masses come on top of these.
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


class Device(NamedTuple):
    """Counterweight, balancer shaft or slider: mass x radius (kg m) that turns at `order`, with and
    against the crank.

    `rank` is the order in which devices are summed: 0 counterweights, 1 shafts, 2 sliders, as an
    engine file has them.
    """

    order: int
    forward: Any  # complex, or arrays of variants
    backward: Any
    place: Any  # x + iy of its axis, m
    z: Any  # m
    rank: int = 3


def turning(d: Device, n: Array, square: Any) -> Phasors:
    """Force of a device, for orders n, shape (orders, *trailing), and the square of the crank
    speed.
    """
    size = (n == d.order) * (d.order**2 * square)
    forward, backward = size * d.forward, size * d.backward
    return Phasors(n.reshape(-1), forward, backward, _SUM * (np.abs(forward) + np.abs(backward)))


class Loads:
    """Free forces and moments of cylinders and devices at a steady crank speed, each computed when
    it is asked for.

    Args:
        cylinders, devices: what moves.
        reference: x + iy (m) and z (m) of the point of reference.
        orders: shape (orders,), ascending.
        harmonics: of the cylinders' mechanisms for these orders.
        square: of the crank speed, rad2/s2.
        apart: not summed: what each cylinder does by itself, shape (orders, cylinders); for engines
        without devices and trailing axes.
    """

    def __init__(
        self,
        cylinders: Cylinders,
        devices: tuple[Device, ...],
        reference: tuple[Any, Any],
        orders: Array,
        harmonics: Harmonics,
        square: Any,
        *,
        apart: bool = False,
    ) -> None:
        self._cylinders, self._devices, self._harmonics = cylinders, devices, harmonics
        self._place, self._z_ref = reference
        self._orders, self._square, self._apart = orders, square, apart
        small = cylinders.pin_deg.ndim == 1 and len(orders) * cylinders.count <= _KEPT
        self._phases = _kept(cylinders, orders.tobytes()) if small else _Phases(cylinders, orders)
        self._n, self._once, self._rounding = (
            self._phases.n,
            self._phases.once,
            self._phases.rounding,
        )
        self._of_devices = [turning(device, self._n[:, 0], square) for device in devices]

    @property
    def force(self) -> Phasors:
        """N; `F = m_rec r (cos psi + ...) + m_rot r e^{i psi}` of each cylinder, turned by its
        axis.
        """
        return sum(self._of_devices, self._forces())

    @property
    def moment(self) -> Phasors:
        """N m as `M_x + i M_y = i sum (z - z_ref) F`."""
        of_cylinders = self._forces(self._cylinders.z - self._z_ref)
        arms = (device.z - self._z_ref for device in self._devices)
        return 1j * sum(
            (arm * f for arm, f in zip(arms, self._of_devices, strict=True)), of_cylinders
        )

    @property
    def couple(self) -> Phasors:
        """Free transverse couple about z, N m: `H sum D_k sin k psi - m_rec e (-s'')` and the
        forces' arms in x and y.
        """
        c = self._cylinders
        nothing = np.zeros(
            (len(self._n), c.count) if self._apart else self._n.shape[:1] + self._n.shape[2:]
        )
        total = Phasors(self._orders, nothing, nothing, nothing)
        if np.count_nonzero(c.couple):
            total += self._about_z((c.couple * self._square) * self._harmonics.rod)
        if np.count_nonzero(c.eps):
            total += self._about_z(
                -(c.reciprocating * c.offset * c.radius * self._square) * self._harmonics.piston
            )
        if (curve := self._harmonics.curve) is not None:
            total += self._about_z((self._on_curve * c.radius) * curve.couple)
        if np.count_nonzero(self._place):
            total += self._forces().about(-self._place)
        return sum(
            (
                f.about(d.place - self._place)
                for d, f in zip(self._devices, self._of_devices, strict=True)
            ),
            total,
        )

    @property
    def torque(self) -> Phasors:
        """Inertia torque on the crank, N m: `-1/2 dI/dtheta`, `I = m_rec s'^2 + m_rot r^2 - H
        beta'^2`.
        """
        rate = -0.5j * self._n
        return self._about_z(Series(rate * self._inertia.c, abs(rate) * self._inertia.noise))

    @property
    def mean_inertia(self) -> Array:
        """Mean over a revolution of I (needs order 0) times the square of the speed, N m."""
        c = self._cylinders
        mean = self._inertia.c[self._orders == 0].real[0] + c.rotating * c.radius**2 * self._square
        return self._total(mean[None], self._once)[0]

    @property
    def mean_momentum(self) -> Array:
        """Mean moment of momentum of the cylinders about z times the speed, N m: that of masses and
        rods that turn.
        """
        c, h = self._cylinders, self._harmonics
        mean = (c.rotating * c.radius**2 - c.couple * h.turns) * self._square
        return self._total(
            (mean if h.curve is None else mean + self._on_curve * c.radius * h.curve.momentum)[
                None
            ],
            self._once,
        )[0]

    @cached_property
    def _inertia(self) -> Series:
        c, h = self._cylinders, self._harmonics
        own = (c.reciprocating * c.radius**2 * self._square) * h.kinetic
        if h.curve is not None:
            own += (self._on_curve * c.radius) * h.curve.kinetic
        return (
            own + -(c.couple * self._square) * h.rod_kinetic if np.count_nonzero(c.couple) else own
        )

    @property
    def _on_curve(self) -> Array:
        """What a linkage's masses on their curves weigh in forces: mass x radius x square of the
        speed, N.
        """
        c = self._cylinders
        return np.zeros(1) if c.linkage is None else c.linkage.mass * c.radius * self._square

    # -------------------------------------------------------------- sums over the cylinders
    @cached_property
    def _pull(self) -> tuple[Complex, Complex, Array]:
        """Forward vector and conjugate of the backward vector of each cylinder's force in its own
        frame, N, and their rounding error.

        Shapes (orders, cylinders or 1, *trailing).
        """
        c = self._cylinders
        along = (c.reciprocating * c.radius * self._square / 2) * self._harmonics.piston
        turning = (self._n == 1) * (c.rotating * (c.radius * self._square))
        forward, mirrored = along.c + turning, along.c
        error = self._rounding * (np.abs(along.c) + turning) + along.noise
        if (curve := self._harmonics.curve) is None:
            return forward, mirrored, error
        x, y = (self._on_curve / 2) * curve.along, (self._on_curve / 2) * curve.across
        error = error + self._rounding * (np.abs(x.c) + np.abs(y.c)) + (x.noise + y.noise)
        return forward + (x.c + 1j * y.c), mirrored + (x.c - 1j * y.c), error

    def _forces(self, arms: Array | None = None) -> Phasors:
        """Sum over the cylinders of their forces, or of these (real) multiples of them."""
        forward, mirrored, error = self._pull
        size = self._once if arms is None else np.abs(self._cylinders.z) + abs(self._z_ref)
        return Phasors(
            self._orders,
            self._sum(forward, arms, "ahead"),
            self._sum(mirrored, arms, "astern").conj(),
            self._total(error, size),
        )

    def _about_z(self, series: Series) -> Phasors:
        """Sum over the cylinders of scalars."""
        error = self._rounding * np.abs(series.c) + series.noise
        return Phasors.real(
            self._orders, self._sum(series.c, None, "scalar"), self._total(error, self._once)
        )

    def _sum(self, vectors: Complex | Array, arms: Array | None, side: str) -> Complex:
        """`sum over banks of axes * sum over its cylinders of arms * vectors * e^{i n pin}`; equal
        vectors are taken out of the sum.
        """
        if self._apart:
            return self._phases.apart(side, vectors if arms is None else arms * vectors)
        if vectors.shape[1] > 1:
            return self._phases.summed(side, vectors if arms is None else arms * vectors)
        return vectors[:, 0] * (
            self._phases.whole(side) if arms is None else self._phases.summed(side, arms[None])
        )

    def _total(self, values: Array, size: Array) -> Array:
        """Sum over the cylinders of `values * size`, shape (orders, *trailing); a single row of
        values stands for all cylinders.
        """
        if self._apart:
            return values * size
        return (
            values[:, 0] * np.add.reduce(size, axis=0)
            if values.shape[1] == 1
            else np.add.reduce(values * size, axis=1)
        )


class _Phases:
    """What the sums need of the geometry and the orders alone."""

    def __init__(self, cylinders: Cylinders, orders: Array) -> None:
        axis, pin = cylinders.axis_deg, cylinders.pin_deg
        self.n = orders.reshape(-1, *(1,) * pin.ndim)  # before cylinders and trailing axes
        self.once = np.ones((cylinders.count, *(1,) * (pin.ndim - 1)))
        self.rounding = (
            cylinders.count * _SUM + _TURN * self.n
        )  # of a sum over cylinders, relative to its terms
        self._axis, self._apart = axis, self.n * (axis - axis[cylinders.first])
        self._starts, self._whole = cylinders.starts, dict[str, Complex]()
        rows = [
            _narrow(row) for row in pin
        ]  # a sweep of one throw leaves the others where they are
        still = np.array([row.size == 1 for row in rows]).reshape(self.once.shape)
        first = pin[(slice(None), *(slice(1),) * (pin.ndim - 1))]
        self._still = unit(self.n * first) * still  # e^{i n pin}, (orders, cylinders, *trailing)
        self._moving = self._distinct({k: row for k, row in enumerate(rows) if row.size > 1})

    def _distinct(self, pins: Mapping[int, Array]) -> dict[int, Complex]:
        """`e^{i n pin}` of the cylinders whose pins vary, by row, computed once for those on one
        throw; shapes (orders, *trailing).
        """
        found: dict[int, Complex] = {}
        for k, pin in pins.items():
            twin = next((other for other in found if np.array_equal(pins[other], pin)), None)
            found[k] = unit(self.n[:, 0] * pin) if twin is None else found[twin]
        return found

    def summed(self, side: str, factors: Complex | Array) -> Complex:
        """`sum over banks of axes * sum over its cylinders of factors * e^{i n pin}`, shape
        (orders, *trailing).
        """
        axes: Complex = getattr(self, side)
        total: Complex = np.add.reduce(
            axes * np.add.reduceat(factors * self._still, self._starts, axis=1), axis=1
        )
        for bank, rows in groupby(
            self._moving, lambda k: int(np.searchsorted(self._starts, k, "right")) - 1
        ):
            total = total + axes[:, bank] * sum(factors[:, k] * self._moving[k] for k in rows)
        return total

    def whole(self, side: str) -> Complex:
        """The same without factors, once for all."""
        if side not in self._whole:
            self._whole[side] = self.summed(side, np.ones((1, *self.once.shape)))
        return self._whole[side]

    def apart(self, side: str, factors: Complex | Array) -> Complex:
        """The terms of this sum, shape (orders, cylinders), of an engine without trailing axes."""
        counts = np.diff([*self._starts, len(self.once)])
        return np.repeat(getattr(self, side), counts, axis=1) * (factors * self._still)

    @cached_property
    def _sides(self) -> Complex:
        """Turn of each bank's forward and backward vectors: `e^{i (axis -+ n (axis - axis_1))}`,
        (2, orders, banks, *trailing).
        """
        return unit(np.array((self._axis - self._apart, self._axis + self._apart)))

    @property
    def ahead(self) -> Complex:
        return self._sides[0]

    @cached_property
    def astern(self) -> Complex:
        """Conjugate, as the sum that it turns."""
        return self._sides[1].conj()

    @cached_property
    def scalar(self) -> Complex:
        """Turn of each bank's scalars: `e^{-i n (axis - axis_1)}`, (orders, banks, *trailing)."""
        return unit(-self._apart)


@lru_cache(maxsize=16)
def _kept(cylinders: Cylinders, orders: bytes) -> _Phases:
    """Phases of the last engines: another speed, another mass or a device fitted changes none of
    them.
    """
    return _Phases(cylinders, np.frombuffer(orders))


def _narrow(values: Array) -> Array:
    """The same without repetition: axes along which nothing changes get length 1."""
    for axis, length in enumerate(values.shape):
        if length > 1 and (values == (first := values.take([0], axis))).all():
            values = first
    return values
