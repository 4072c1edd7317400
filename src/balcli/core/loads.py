"""Compute free forces and moments of cylinders and balancing devices, order by order, at a steady
crank speed.

Masses and harmonics give the loads of each cylinder in its own frame. `Phases` turns them into the
axes of the engine and sums them over the cylinders; `Loads` adds the devices. docs/theory.md
derives the formulas. Axes of arrays: orders, cylinders, then any others, which are called trailing
(variants, for instance). All units are SI.

Symbols: m_rec and m_rot are the masses at the piston pin and at the crank pin, r is the crank
radius, e the offset, s the distance of the piston pin from the crank axis along the cylinder, beta
the angle of the rod, H the attribute `Cylinders.couple`, and psi the crank angle from the
cylinder's axis. A prime is a derivative by the crank angle.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property, reduce
from operator import add
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .cylinders import Cylinders, Device
from .mechanisms.closed_form import Harmonics, Series
from .phases import Phases
from .phasors import Array, Complex, Figure, Phasors, put_together

# Error of a device whose unbalance, angle (deg) and position have twelve significant digits in its
# file, relative to its force: what it cancels except for this rounding is balanced.
_WRITTEN = 2e-11


@dataclass(frozen=True, eq=False)
class Loads:
    """Free forces and moments at a steady crank speed, each computed when it is first used.

    Attributes:
        cylinders: Cylinders of the engine.
        devices: Balancing devices.
        place: Position x + iy of the point of reference, m.
        z: Position z of the point of reference, m.
        phases: Phases of the cylinders for the wanted orders. `SeparatePhases` give the loads of
            each cylinder instead of their sums.
        harmonics: Harmonics of the cylinders' mechanisms for these orders.
        square: Square of the crank speed, rad2/s2.
    """

    cylinders: Cylinders
    devices: tuple[Device, ...]
    place: complex | Complex
    z: Figure
    phases: Phases
    harmonics: Harmonics
    square: Figure

    @property
    def force(self) -> Phasors:
        """Free force by order, N, shape (orders, *trailing)."""
        return sum(self._of_devices, self.phases.add_vectors(self._pulls))

    @property
    def moment(self) -> Phasors:
        """Free moment by order, N m, as `M_x + i M_y = i sum (z - z_ref) F`."""
        z = self.cylinders.z
        total = self.phases.add_vectors(self._pulls, z - self.z, np.abs(z) + abs(self.z))
        for device, force in zip(self.devices, self._of_devices, strict=True):
            total += (device.z - self.z) * force
        return 1j * total

    @property
    def couple(self) -> Phasors:
        """Free transverse couple about z, N m. It is the sum of the rods' `H (-beta'')`, of the
        pistons' forces times their offsets, `-m_rec e (-s'')`, of the couples of a linkage's
        masses, and of the moments of forces that act away from the point of reference.
        """
        c = self.cylinders
        harmonics = self.harmonics
        square = self.square
        series = []
        if np.count_nonzero(c.couple):
            series.append((c.couple * square) * harmonics["rod"])
        if np.count_nonzero(c.offset) and _has_pistons(c):
            arms = c.reciprocating * c.offset * c.radius * square
            series.append(-arms * harmonics["piston"])
        if c.linkage is not None:
            series.append((c.linkage.mass * c.radius**2 * square) * harmonics["couple"])
        own = map(self.phases.add_scalars, series or [Series(np.zeros_like(self.phases.n))])
        total = reduce(add, own)
        if np.count_nonzero(self.place):
            total += self.phases.add_vectors(self._pulls).about(-self.place)
        for device, force in zip(self.devices, self._of_devices, strict=True):
            total += force.about(device.place - self.place)
        return total

    @property
    def torque(self) -> Phasors:
        """Inertia torque on the crank, N m: `-1/2 dI/dtheta` times the squared speed, with the
        cylinders' moment of inertia I about the crank.
        """
        inertia = self._inertia
        n = self.phases.n
        rate: Complex = np.asarray(-0.5j * n, np.complex128)
        return self.phases.add_scalars(Series(rate * inertia.c, 0.5 * n * inertia.noise))

    @property
    def mean_inertia(self) -> Array:
        """Mean moment of inertia over a revolution, times the squared speed, N m. The orders must
        include 0.
        """
        c = self.cylinders
        changing = self._inertia.c[self.phases.orders == 0].real[0]
        mean = changing + c.rotating * c.radius**2 * self.square
        return self.phases.add_figures(mean[None])[0]

    @property
    def mean_momentum(self) -> Array:
        """Mean moment of momentum of the cylinders about z, times the speed, N m, with rotating
        masses, rods of rotary engines, and masses of a linkage. The orders must include 0.
        """
        c = self.cylinders
        mean = c.rotating * c.radius**2 * self.square
        if c.linkage is not None:
            mean = mean - c.linkage.turning * c.couple * self.square  # rods of a rotary engine
            on_curves = c.linkage.mass * c.radius**2 * self.square
            mean = mean + on_curves * self.harmonics["swirl"].c[0].real
        return self.phases.add_figures(mean[None])[0]

    @cached_property
    def _pulls(self) -> Series:
        """Force of each cylinder in its own frame, N, in the form that `Phases.add_vectors` needs:
        `-m_rec s'' + m_rot r e^{i psi}` times the squared speed, plus the force of a linkage's
        masses.
        """
        c = self.cylinders
        phases = self.phases
        square = self.square
        along = Series(np.zeros_like(phases.n))
        if _has_pistons(c):
            along = (c.reciprocating * c.radius * square / 2) * self.harmonics["piston"]
        turning = (phases.n == 1) * (c.rotating * (c.radius * square))
        forward: Array | Complex = along.c + turning
        mirrored = along.c
        error = phases.rounding * (np.abs(along.c) + turning) + along.noise
        if c.linkage is not None:
            half = c.linkage.mass * c.radius * square / 2
            x = half * self.harmonics["along"]
            y = half * self.harmonics["across"]
            across: Complex = np.asarray(1j * y.c, np.complex128)
            forward = forward + (x.c + across)
            mirrored = mirrored + (x.c - across)
            error = error + phases.rounding * (np.abs(x.c) + np.abs(y.c)) + (x.noise + y.noise)
        return Series(put_together(forward, mirrored), error)

    @cached_property
    def _inertia(self) -> Series:
        return find_inertia(self.cylinders, self.harmonics, self.square)

    @cached_property
    def _of_devices(self) -> list[Phasors]:
        n = self.phases.n[:, 0]
        return [find_device_force(device, n, self.square) for device in self.devices]


def find_device_force(device: Device, n: Array, square: Figure) -> Phasors:
    """Return the force of a device, N.

    Args:
        device: Counterweight, shaft or slider.
        n: Orders as a column, shape (orders, 1, 1, ...).
        square: Square of the crank speed, rad2/s2.
    """
    size = (n == device.order) * (device.order**2 * square)
    forward = size * device.forward
    backward = size * device.backward
    noise = _WRITTEN * (np.abs(forward) + np.abs(backward))
    return Phasors.of(n.reshape(-1), forward, backward, noise)


def find_device_forces(devices: Sequence[Device], n: Array, square: Figure) -> Phasors:
    """Return the forces of devices of one engine, N, phasors of shape (orders, devices).

    Args:
        devices: Counterweights, shafts and sliders.
        n: Orders, shape (orders,).
        square: Square of the crank speed, rad2/s2.
    """
    order = np.array([device.order for device in devices], float)
    forward = np.array([device.forward for device in devices], complex)
    backward = np.array([device.backward for device in devices], complex)
    size = (n[:, None] == order) * (order**2 * square)
    noise = _WRITTEN * size * (np.abs(forward) + np.abs(backward))
    return Phasors.of(n, size * forward, size * backward, noise)


# ------------------------------------------------------------------ one cylinder in its own frame
class Turning(NamedTuple):
    """Inertia beyond the crank pins that turns with the crank.

    Attributes:
        momentum: Its moment of momentum times the speed, N m.
        energy: Twice its kinetic energy, N m.
    """

    momentum: Figure
    energy: Figure


def _find_no_mean(_loads: Loads, _turning: Turning) -> Figure:
    return 0.0


def _find_mean_momentum(loads: Loads, turning: Turning) -> Figure:
    return loads.mean_momentum + turning.momentum


def _find_mean_energy(loads: Loads, turning: Turning) -> Figure:
    return (loads.mean_inertia + turning.energy) / 2


class LoadForm(NamedTuple):
    """How a load is computed; the attribute of `Loads` with its name has its phasors.

    Attributes:
        series: Names of the series of mechanisms (`closed_form.SERIES`) that it needs.
        find_mean: Function that returns the mean of the momentum or energy of which it is the
            derivative, which matters at uneven speed (`speed_ripple.apply_speed`).
        of_energy: Whether it is the derivative of an energy by the crank angle, as a torque is;
            otherwise of a momentum.
    """

    series: frozenset[str]
    find_mean: Callable[[Loads, Turning], Figure] = _find_no_mean
    of_energy: bool = False


_SHAKING = frozenset({"piston", "along", "across"})
LOADS = {
    "force": LoadForm(_SHAKING),
    "moment": LoadForm(_SHAKING),
    "couple": LoadForm(_SHAKING | {"rod", "couple", "swirl"}, _find_mean_momentum),
    "torque": LoadForm(
        frozenset({"kinetic", "rod_kinetic", "energy"}), _find_mean_energy, of_energy=True
    ),
}


def find_needed_series(cylinders: Cylinders, parts: Iterable[str], *, uneven: bool) -> set[str]:
    """Return the names of the series of mechanisms (`closed_form.SERIES`) that these loads need.

    Args:
        cylinders: Cylinders of the engine.
        parts: Names of loads, keys of `LOADS`.
        uneven: Whether the crank speed is uneven, which needs the mean moment of momentum.
    """
    c = cylinders
    needed: set[str] = set().union(*(LOADS[name].series for name in parts))
    if not np.count_nonzero(c.couple):
        needed -= {"rod", "rod_kinetic"}
    if not _has_pistons(c):
        needed -= {"piston", "kinetic"}
    return needed if uneven else needed - {"swirl"}


def _has_pistons(c: Cylinders) -> bool:
    """Return whether masses move along cylinder axes; those of a linkage move on other curves."""
    return c.linkage is None or bool(np.count_nonzero(c.reciprocating))


def find_inertia(cylinders: Cylinders, harmonics: Harmonics, square: Figure) -> Series:
    """Return the varying part of each cylinder's moment of inertia about the crank, times the
    squared speed, N m: `m_rec s'^2 - H beta'^2`, plus the contribution of a linkage's
    masses.

    Args:
        cylinders: Cylinders of the engine.
        harmonics: Series of the cylinders' mechanisms.
        square: Square of the crank speed, rad2/s2, shape (*trailing).
    """
    c = cylinders
    parts = []
    if _has_pistons(c):
        parts.append((c.reciprocating * c.radius**2 * square) * harmonics["kinetic"])
    if c.linkage is not None:
        parts.append((c.linkage.mass * c.radius**2 * square) * harmonics["energy"])
    if np.count_nonzero(c.couple):
        parts.append(-(c.couple * square) * harmonics["rod_kinetic"])
    return reduce(add, parts)


# ------------------------------------------------------------------ loads along a shaft
def share_by_lever(places: Array, planes: Array) -> Array:
    """Return the share of each load that each plane carries, by the lever rule, shape (planes,
    loads). The two planes next to a load share it. A load beyond the first or last plane is
    shared by the two planes nearest to it, with shares below 0 and above 1. A single plane carries
    every load.

    Args:
        places: Positions of the loads, m, shape (loads,).
        planes: Positions of the planes, m, shape (planes,), ascending, all different.
    """
    if len(planes) == 1:
        return np.ones((1, len(places)))
    left, right_share = _find_planes_beside(places, planes)
    shares = np.zeros((len(planes), len(places)))
    loads = np.arange(len(places))
    shares[left, loads] += 1 - right_share
    shares[left + 1, loads] += right_share
    return shares


def sum_by_lever(loads: Phasors, places: Array, planes: Array) -> Phasors:
    """Return the load of each plane by the lever rule, phasors (orders, planes). Sums below their
    rounding error are set to 0. The time is proportional to the number of loads.

    Args:
        loads: Phasors of shape (orders, loads).
        places: As for `share_by_lever`.
        planes: As for `share_by_lever`.
    """
    if len(planes) == 1:
        return sum_weighted(loads, np.ones((1, len(places))))
    left, right_share = _find_planes_beside(places, planes)
    plane = np.concatenate([left, left + 1])
    share = np.concatenate([1 - right_share, right_share])
    noise = np.broadcast_to(loads.noise, loads.vectors.shape[1:])
    shared = np.concatenate([loads.vectors, loads.vectors], axis=-1) * share
    shared_noise = np.concatenate([noise, noise], axis=-1) * np.abs(share)
    sums = _sum_groups(shared, plane, len(planes))
    return Phasors(loads.orders, sums, _sum_groups(shared_noise, plane, len(planes))).drop_noise()


def _find_planes_beside(places: Array, planes: Array) -> tuple[NDArray[np.intp], Array]:
    """Return the first of the two planes that share each load, and the share of the second."""
    left = np.clip(np.searchsorted(planes, places, side="right") - 1, 0, len(planes) - 2)
    return left, (places - planes[left]) / (planes[left + 1] - planes[left])


def _sum_groups(values: NDArray[Any], group: NDArray[np.intp], count: int) -> NDArray[Any]:
    """Return the sums along the last axis of the values of each of `count` groups."""
    by_group = np.argsort(group, kind="stable")
    starts = np.flatnonzero(np.diff(group[by_group], prepend=-1))
    sums = np.zeros((*values.shape[:-1], count), values.dtype)
    sums[..., group[by_group][starts]] = np.add.reduceat(values[..., by_group], starts, axis=-1)
    return sums


def sum_weighted(loads: Phasors, weights: Array) -> Phasors:
    """Return weighted sums of loads; sums below their rounding error are set to 0.

    Args:
        loads: Phasors of shape (orders, loads).
        weights: Weights, shape (sums, loads), or (loads,) for a single sum.
    """
    noise = loads.noise @ np.abs(weights).T
    # Real products use a faster routine than a product of complex vectors with real weights.
    real = loads.vectors.real @ weights.T
    imaginary = loads.vectors.imag @ weights.T
    return Phasors(loads.orders, real + 1j * imaginary, noise).drop_noise()


class SectionLoads(NamedTuple):
    """Loads that sections of a shaft carry, phasors of shape (orders, sections).

    Attributes:
        shear: Sums of the loads on the free-end side of each section, N.
        arms: Sums of these loads times their distance `z - section`, N m.
    """

    shear: Phasors
    arms: Phasors


def sum_to_sections(loads: Phasors, z: Array, sections: Array) -> SectionLoads:
    """Return the loads that each section carries; sums below their rounding error are set to 0.

    Args:
        loads: Phasors of shape (orders, loads).
        z: Axial positions of the loads, m, shape (loads,). A load at a section counts.
        sections: Axial positions of the sections, m, shape (sections,).
    """
    from_free_end = np.argsort(z, kind="stable")
    places = z[from_free_end]
    vectors = loads.vectors[..., from_free_end]
    noise = np.broadcast_to(loads.noise, loads.vectors.shape[1:])[:, from_free_end]
    counts = np.searchsorted(places, sections, side="right")
    force = _sum_first(vectors, counts)
    force_noise = _sum_first(noise, counts)
    moment = _sum_first(vectors * places, counts)
    moment_noise = _sum_first(noise * np.abs(places), counts)
    return SectionLoads(
        Phasors(loads.orders, force, force_noise).drop_noise(),
        Phasors(
            loads.orders,
            moment - sections * force,
            moment_noise + np.abs(sections) * force_noise,
        ).drop_noise(),
    )


def _sum_first(values: NDArray[Any], counts: NDArray[np.intp]) -> NDArray[Any]:
    """Return the sums of the first `counts` values along the last axis."""
    sums = np.zeros((*values.shape[:-1], values.shape[-1] + 1), values.dtype)
    np.cumsum(values, axis=-1, out=sums[..., 1:])
    return sums[..., counts]


def find_ahead(z: Array, sections: Array) -> Array:
    """Return, for each section, 1 for the places at the section or on its free-end side, and 0 for
    all other places, shape (sections, places).

    Args:
        z: Axial positions of the places, m, shape (places,).
        sections: Axial positions of the sections, m, shape (sections,).
    """
    return (z <= sections[:, None]).astype(float)


def find_arms(z: Array, sections: Array) -> Array:
    """Return `z - section` for the places on the free-end side of each section, and 0 for all other
    places, m, shape (sections, places).

    Args:
        z: Axial positions of the places, m, shape (places,).
        sections: Axial positions of the sections, m, shape (sections,).
    """
    return find_ahead(z, sections) * (z - sections[:, None])
