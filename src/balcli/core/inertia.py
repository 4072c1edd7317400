"""Cylinders and balancing devices -> free forces and moments by order, at a steady crank speed of 1 rad/s.

Cylinder i of bank b has its pin at `pin_i` (degrees after cylinder 1's pin) and its axis at `axis_b`. A local harmonic
`Re c e^{i n psi}`, `psi = theta + axis_1 + pin_i - axis_b`, of a force along the axis gives

    forward_n  = 1/2 e^{+i n axis_1} sum_b e^{i (1-n) axis_b} S_b,      S_b = sum over its cylinders of c_i e^{i n pin_i}
    backward_n = 1/2 e^{-i n axis_1} sum_b e^{i (1+n) axis_b} conj(S_b)

so each bank is summed once, and what a sweep does not change is not computed again. Arrays: order first, cylinder (or
bank) next, then any trailing axes; an axis along which nothing varies has length 1. SI units.
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .harmonics import Harmonics, Series
from .linkage import Linkage
from .phasors import EPS, Array, Complex, Phasors, unit

_SUM = 8 * EPS              # rounding error of a sum, per term and size of the terms
_TURN = np.pi * EPS         # rounding error of an angle in the file (half an ulp of 360 deg), which order n multiplies


@dataclass(frozen=True)
class Cylinders:
    """All cylinders of an engine, sorted by bank: bank b has the rows from `starts[b]` on.

    Attributes:
        axis_deg: shape (banks, *trailing), cylinder axes from x.
        pin_deg: shape (cylinders, *trailing), crank pins from cylinder 1's pin, in the sense of rotation.
        starts: shape (banks,).
        first: bank of cylinder 1.
        z: shape (cylinders, *trailing), m.
        radius: crank radius, m.
        lam, eps: shape (cylinders or 1, *trailing), crank radius and offset over rod length.
        reciprocating, rotating: masses at the piston pin and at the crank pin, kg.
        couple: `H` of the rods, kg m2 (THEORY: what two point masses lack of the rod's moment of inertia, with the sign changed).
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
    def angle_deg(self) -> Array:
        """Each cylinder's own crank angle at crank angle 0 (`phi` in THEORY 1), deg, shape (cylinders, *trailing)."""
        axis = np.repeat(self.axis_deg, np.diff([*self.starts, self.count]), axis=0)
        return np.asarray(self.axis_deg[self.first] + self.pin_deg - axis)

    @property
    def offset(self) -> Array:
        """Offset of the piston-pin path, m."""
        return self.eps * self.radius / self.lam


@dataclass(frozen=True)
class Device:
    """Counterweight, balancer shaft or slider: mass x radius (kg m) that turns at `order`, with and against the crank."""

    order: int
    forward: complex
    backward: complex
    place: complex          # x + iy of its axis, m
    z: float                # m


class Loads:
    """Free forces and moments of cylinders and devices per square of the crank speed, each computed when it is asked for.

    Args:
        cylinders, devices: what moves.
        reference: x + iy (m) and z (m) of the point of reference.
        orders: shape (orders,), ascending.
        harmonics: of the cylinders' mechanisms for these orders.
    """

    def __init__(self, cylinders: Cylinders, devices: tuple[Device, ...], reference: tuple[complex, float],
                 orders: Array, harmonics: Harmonics) -> None:
        self._cylinders, self._devices, self._harmonics = cylinders, devices, harmonics
        self._place, self._z_ref = reference
        self._orders = orders
        self._n = orders.reshape(-1, *(1,) * cylinders.pin_deg.ndim)

    @cached_property
    def force(self) -> Phasors:
        """N s2; `F = m_rec r (cos psi + ...) + m_rot r e^{i psi}` of each cylinder, turned by its axis."""
        return self._add(self._forces(None), *self._of_devices)

    @cached_property
    def moment(self) -> Phasors:
        """N m s2 as `M_x + i M_y = i sum (z - z_ref) F`."""
        arms = (device.z - self._z_ref for device in self._devices)
        return 1j * self._add(self._forces(self._cylinders.z), *(z * f for z, f in zip(arms, self._of_devices, strict=True)))

    @cached_property
    def couple(self) -> Phasors:
        """Free transverse couple about z, N m s2: `H sum D_k sin k psi - m_rec e (-s'')` and the forces' arms in x and y."""
        c = self._cylinders
        own = c.couple * self._harmonics.rod + -(c.reciprocating * c.offset * c.radius) * self._harmonics.piston
        if (curve := self._harmonics.curve) is not None:
            own += (self._curving * c.radius) * curve.couple
        total = self._about_z(own)
        if self._place:
            total += self._forces(None).about(-self._place)
        return self._add(total, *(f.about(d.place - self._place) for d, f in zip(self._devices, self._of_devices, strict=True)))

    @cached_property
    def torque(self) -> Phasors:
        """Inertia torque on the crank, N m s2: `-1/2 dI/dtheta`, `I = m_rec s'^2 + m_rot r^2 - H beta'^2`."""
        rate = -0.5j * self._n
        return self._about_z(Series(rate * self._inertia.c, np.abs(rate) * self._inertia.noise))

    @property
    def mean_inertia(self) -> Array:
        """Mean over a revolution of I, kg m2 (needs order 0)."""
        return self._total(self._inertia.c[self._orders == 0].real[0] + self._cylinders.rotating * self._cylinders.radius**2)

    @property
    def mean_momentum(self) -> Array:
        """Mean moment of momentum of the cylinders about z at speed 1, kg m2: that of masses and rods that turn."""
        c, h = self._cylinders, self._harmonics
        mean = c.rotating * c.radius**2 - c.couple * h.turns
        return self._total(mean if h.curve is None else mean + self._curving * c.radius * h.curve.momentum)

    @cached_property
    def _inertia(self) -> Series:
        c, h = self._cylinders, self._harmonics
        own = (c.reciprocating * c.radius**2) * h.kinetic + -c.couple * h.rod_kinetic
        return own if h.curve is None else own + (self._curving * c.radius) * h.curve.kinetic

    @property
    def _curving(self) -> Array:
        """Masses on the linkage's curves times crank radius."""
        c = self._cylinders
        return np.zeros(1) if c.linkage is None else c.linkage.mass * c.radius

    @cached_property
    def _of_devices(self) -> list[Phasors]:
        """Force of each device."""
        def rows(device: Device, vector: complex) -> Complex:
            return np.where(self._n[:, 0] == device.order, device.order**2 * np.asarray(vector), 0)
        return [Phasors(self._orders, a := rows(d, d.forward), b := rows(d, d.backward), _SUM * (np.abs(a) + np.abs(b)))
                for d in self._devices]

    @staticmethod
    def _add(total: Phasors, *more: Phasors) -> Phasors:
        for one in more:
            total += one
        return total

    # -------------------------------------------------------------- sums over the cylinders
    @cached_property
    def _turned(self) -> Complex:
        """e^{i n pin}, shape (orders, cylinders, *trailing)."""
        return unit(self._n * self._cylinders.pin_deg)

    def _forces(self, z: Array | None) -> Phasors:
        """Forces of all cylinders, or with their arms along z."""
        c = self._cylinders
        along = (c.reciprocating * c.radius) * self._harmonics.piston
        if (curve := self._harmonics.curve) is not None:
            along += self._curving * curve.along
        banks, noise = self._bank_sums(along, z)
        ahead = astern = banks
        if curve is not None:
            across, more = self._bank_sums(self._curving * curve.across, z)
            ahead, astern, noise = banks + 1j * across, banks - 1j * across, noise + more
        lead = self._n * c.axis_deg[c.first]
        forward = (unit(lead + (1 - self._n) * c.axis_deg) * ahead).sum(axis=1) / 2
        backward = (unit((1 + self._n) * c.axis_deg - lead) * np.conj(astern)).sum(axis=1) / 2
        turning, error = self._rotating(z)
        return Phasors(self._orders, forward + turning, backward, noise / 2 + error)

    def _rotating(self, z: Array | None) -> tuple[Complex, Array]:
        """Forward vectors of the masses at the crank pins, which are all of order 1."""
        c = self._cylinders
        first = self._n == 1
        if not first.any() or not np.any(c.rotating):
            return np.zeros(1, complex), np.zeros(1)
        vectors = c.rotating * c.radius * np.where(first, self._turned, 0)
        if z is not None:
            vectors = self._arms(z) * vectors
        scale = np.abs(vectors).sum(axis=1)
        return (unit(c.axis_deg[c.first]) * vectors.sum(axis=1)), (c.count * _SUM + _TURN) * scale

    def _about_z(self, series: Series) -> Phasors:
        """Sum over the cylinders of scalars."""
        c = self._cylinders
        banks, noise = self._bank_sums(series, None)
        total = (unit(self._n * (c.axis_deg[c.first] - c.axis_deg)) * banks).sum(axis=1)
        return Phasors.real(self._orders, total, noise)

    def _total(self, values: Array) -> Array:
        """Sum over the cylinders of one value each."""
        shape = np.broadcast_shapes(self._cylinders.pin_deg.shape, values.shape)
        return np.asarray(np.broadcast_to(values, shape).sum(axis=0))

    def _arms(self, z: Array) -> Array:
        return z - self._z_ref

    def _bank_sums(self, series: Series, z: Array | None) -> tuple[Complex, Array]:
        """S_b, shape (orders, banks, *trailing), and the rounding error of their sum, shape (orders, *trailing)."""
        c = self._cylinders
        turned, size = self._turned, np.ones(1)
        if z is not None:
            arms = self._arms(z)
            turned, size = arms * turned, np.abs(z) + abs(self._z_ref)
        shape = np.broadcast_shapes(series.c.shape, (1, *np.shape(size)))

        def total(parts: Array) -> Array:
            summed: Array = np.broadcast_to(parts, shape).sum(axis=1) * (c.count / shape[1])
            return summed
        noise = (c.count * _SUM + _TURN * self._n[:, 0]) * total(np.abs(series.c) * size)
        if np.any(series.noise):
            noise = noise + total(series.noise * size)
        if series.c.shape[1] == 1:                                          # equal cylinders: their phases are summed once
            return series.c * np.add.reduceat(turned, c.starts, axis=1), noise
        return np.add.reduceat(series.c * turned, c.starts, axis=1), noise
