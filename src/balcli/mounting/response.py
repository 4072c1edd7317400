"""An engine that runs on its mounts: forces on them and motion of points, order by order and added
up in time, at every speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.close_peaks import find_highest
from ..core.peaks import find_longest, largest_of_ellipse
from ..core.rigid_body import (
    apply_couplings,
    carry_points,
    couple_mounts,
    damping_matrix,
    load_at_centre,
    mass_matrix,
    stiffness_matrix,
)
from ..core.speeds import RPM
from ..core.telling import Tell, tell_nobody
from ..core.vibration import (
    UNDAMPED,
    Complex,
    Real,
    UndampedResonanceError,
    find_resonances,
    frequencies,
    solve_response,
)
from ..engine.arrays import find_first_largest
from ..engine.build import NONE_SILENT, Engine, SilentCylinders
from ..engine.positions import MOMENTS_UNKNOWN
from ..errors import BalcliError
from ..forces.in_time import compute_spectra_in_time
from ..forces.orders import choose_orders, find_relevant_orders, list_gas_orders, merge_orders
from ..forces.spectrum import Spectra, compute_spectra
from ..limits import MOST_MOUNT_RESULTS
from .build import MountedBody
from .modes import BodyModes
from .motions import ROLL

_KINDS = ("force", "moment", "roll")
_SPEEDS_AT_A_TIME = 512  # whose curves are sampled together
_BESIDE = np.array([-0.5, -0.25, 0, 0.25, 0.5])  # speeds looked at about a resonance, in widths
_NEAR = 0.8  # of the highest at the speeds looked at: what a peak beside them may exceed


@dataclass(frozen=True, eq=False)
class BodyLoads:
    """What an engine does to the body, by order.

    Attributes:
        orders: (orders,), all above 0.
        inertia: (orders, 6) force (N) and moment about the centre of gravity (N m) at `omega`; they
            grow with the square of the speed.
        omega: rad/s, mean over the time, as all speeds here are.
        gas: (orders, 6), the same at every speed: what the gas torque leaves as roll; None where
            the file says nothing of gas.
        mean: N m about the crankshaft's axis on the body, steady: the reaction to a constant load,
            which takes the mean of the gas torque over the crank angle, at uneven speed too, less
            the share that goes into friction, for that acts between parts of the body.
        silent: cylinders of the engine that do not fire.
    """

    orders: Real
    inertia: Complex
    omega: float
    gas: Complex | None = None
    mean: float = 0.0
    silent: SilentCylinders = NONE_SILENT

    def at(self, omega: Real) -> Complex:
        """(orders, *speeds, 6) at speeds (rad/s, any shape)."""
        square = (np.asarray(omega) / self.omega) ** 2
        shape = (len(self.orders), *(1,) * square.ndim, 6)
        inertia = self.inertia.reshape(shape) * square[..., None]
        return np.asarray(inertia if self.gas is None else inertia + self.gas.reshape(shape))

    @property
    def there(self) -> NDArray[np.bool_]:
        """(orders,): which orders have any load."""
        parts = [self.inertia] if self.gas is None else [self.inertia, self.gas]
        return np.any(np.concatenate(parts, axis=1), axis=1)


class Meeting(NamedTuple):
    """An order that meets a mode: which mode (from 0), order, and crank speed (rad/s)."""

    mode: int
    order: float
    omega: float

    @property
    def speed_rpm(self) -> float:
        return self.omega / RPM


class LargestAmplitude(NamedTuple):
    """The largest value over all speeds.

    Attributes:
        value: N or m, of all orders together.
        omega: rad/s, where it is reached.
        order: which is the largest there by itself.
        alone: N or m, that order's own.
        mode: whose motion makes most of that, from 0.
    """

    value: float
    omega: float
    order: float
    alone: float
    mode: int

    @property
    def speed_rpm(self) -> float:
        return self.omega / RPM


@dataclass(frozen=True, eq=False)
class MountingResponse:
    """Of the body to its engine; speeds in rad/s.

    Attributes:
        loads: on the body. omega: (speeds,).
        force: (orders, speeds, mounts) N, the largest of each order, of the body on its mounts.
        force_peak: (speeds, mounts) N, of all orders, over the cycle.
        motion: (orders, speeds, points) m. motion_peak: (speeds, points) m.
        free, passed: (orders, speeds, 6) amplitudes of the load about the centre of gravity, of the
            engine on the body and of the body on the ground: N, N m.
        worst_force: of each mount. worst_motion: of each point.
        body: (orders, speeds, 6) motion of the centre of gravity, m and rad.
    """

    loads: BodyLoads
    omega: Real
    force: Real
    force_peak: Real
    motion: Real
    motion_peak: Real
    free: Real
    passed: Real
    worst_force: tuple[LargestAmplitude, ...]
    worst_motion: tuple[LargestAmplitude, ...]
    body: Complex

    @property
    def speeds_rpm(self) -> Real:
        """(speeds,); short decimals as they were asked for, which rad/s keep but for rounding."""
        rpm = self.omega / RPM
        short = np.round(rpm, 9)
        return np.where(short * RPM == self.omega, short, rpm)


def find_loads(engine: Engine, centre: Real, orders: Real | None = None) -> BodyLoads:
    """Free forces and moments of an engine as a load on the body, about its centre of gravity.

    Args:
        engine: without trailing axes.
        centre: (3,) m. orders: default: all that are considerable.

    Raises:
        BalcliError: the file does not say where the throws stand.
    """
    if not engine.places_known:
        raise BalcliError(MOMENTS_UNKNOWN)
    of_gas = () if engine.gas is None else list_gas_orders(engine)
    wanted = merge_orders(find_relevant_orders(engine), of_gas) if orders is None else orders
    kinds = _KINDS if engine.gas is None else (*_KINDS, "gas")
    found, turns = _compute_spectra(engine, wanted[wanted > 0], kinds)
    if orders is None:
        found = found.select_orders(choose_orders(found, engine))
    reference = np.array([float(value) for value in engine.reference_m])
    inertia = _find_load(found, reference, centre)
    loads = BodyLoads(found.orders, inertia, turns * float(engine.omega))
    if engine.gas is not None:
        gas = np.zeros_like(inertia)
        gas[:, ROLL] = -found["gas"].x
        indicated = compute_spectra(engine, [0.0], ["gas"])["gas"].x[0].real
        efficiency = engine.mechanical_efficiency or 1.0
        mean = -efficiency * float(indicated)
        loads = replace(loads, gas=gas, mean=mean, silent=engine.silent)
    return loads if orders is not None else _leave_out_none(loads)


def _compute_spectra(engine: Engine, orders: Real, kinds: Sequence[str]) -> tuple[Spectra, float]:
    """By orders of the time, and how much faster than over the angle the crank turns over time."""
    if not engine.ripple:
        return compute_spectra(engine, orders, kinds), 1.0
    return compute_spectra_in_time(engine, np.asarray(orders, float), kinds)


def _leave_out_none(loads: BodyLoads) -> BodyLoads:
    """Without orders that have no load, as far as some have."""
    there = loads.there
    if not there.any():
        return loads
    gas = None if loads.gas is None else loads.gas[there]
    return replace(loads, orders=loads.orders[there], inertia=loads.inertia[there], gas=gas)


def _find_load(found: Spectra, reference: Real, centre: Real) -> Complex:
    """(orders, 6): force, and moment about the centre of gravity."""
    along = np.zeros(len(found.orders), complex)
    force = np.stack([found["force"].x, found["force"].y, along], axis=-1)
    moment = np.stack([found["moment"].x, found["moment"].y, found["roll"].x], axis=-1)
    return load_at_centre(force, moment, reference, centre)


class _Couplings(NamedTuple):
    """Matrices of a body on its mounts, and what its motion does at places: forces of mounts (N),
    then motion of points (m), each a curve of three components.

    Attributes:
        stiffness, damping, mass: (6, 6) about the centre of gravity.
        direct: (curves, 3, 6) for a unit of each motion of the body.
        by_speed: (curves, 3, 6) for a unit of each of its speeds.
    """

    stiffness: Complex
    damping: Real
    mass: Real
    direct: Complex
    by_speed: Real

    @classmethod
    def of(cls, mounted: MountedBody) -> _Couplings:
        body, mounts = mounted.body, mounted.dynamic
        springs, dashpots = couple_mounts(body, mounts)
        points = carry_points(mounted.points, body.centre)
        return cls(
            stiffness_matrix(body, mounts),
            damping_matrix(body, mounts),
            mass_matrix(body),
            np.concatenate([springs, points]),
            np.concatenate([dashpots, np.zeros_like(points)]),
        )

    def select(self, curves: Sequence[int] | NDArray[np.intp]) -> _Couplings:
        """Return the couplings of some of the curves."""
        return self._replace(direct=self.direct[curves], by_speed=self.by_speed[curves])

    def move(self, loads: BodyLoads, omega: Real) -> Complex:
        """Return the motion (orders, *speeds, 6) of the body at speeds (rad/s, any shape)."""
        w = frequencies(loads.orders, omega)
        try:
            return solve_response(self.stiffness, self.damping, self.mass, w, loads.at(omega))
        except UndampedResonanceError as error:  # resonances are refused before
            raise BalcliError(
                f"at {error.frequency / (2 * np.pi):.4g} Hz the motion of the body is lost in "
                "rounding errors, so far apart are stiffness and damping of the mounts: is damping "
                "in N s/mm?"
            ) from None

    def read_all(self, frequency: Real, motion: Complex) -> Complex:
        """Return all curves (*frequency, curves, 3) of a motion (*frequency, 6)."""
        direct, by_speed = (apply_couplings(one, motion) for one in (self.direct, self.by_speed))
        return direct + 1j * frequency[..., None, None] * by_speed

    def read_each(self, frequency: Real, motion: Complex, curve: NDArray[np.intp]) -> Complex:
        """Return the curve (some,) at each place of the last axis: (*frequency, 3) of a motion
        (*frequency, 6), both with a last axis (some,) of frequencies.
        """
        direct, by_speed = (
            np.einsum("sij,...sj->...si", one[curve], motion)
            for one in (self.direct, self.by_speed)
        )
        return direct + 1j * frequency[..., None] * by_speed

    def find_peaks(self, loads: BodyLoads, omega: Real) -> Real:
        """Return the longest that each curve is, (speeds, curves), some speeds at a time."""
        parts: list[Real] = [np.zeros((0, len(self.direct)))]
        for start in range(0, len(omega), _SPEEDS_AT_A_TIME):
            some = omega[start : start + _SPEEDS_AT_A_TIME]
            curves = self.read_all(frequencies(loads.orders, some), self.move(loads, some))
            parts.append(find_longest(loads.orders, curves).value)
        return np.concatenate(parts)


def respond(
    mounted: MountedBody, modes: BodyModes, loads: BodyLoads, omega: Real, tell: Tell = tell_nobody
) -> MountingResponse:
    """Return the response at every order and speed.

    Args:
        omega: (speeds,) rad/s, rising.
        tell: is called with 1 when all speeds are done.

    Raises:
        BalcliError: too many results; an undamped mode that the engine drives at its own frequency
            within the range of speeds, with mode, order and speed.
    """
    _refuse_too_many(loads, omega, mounted)
    refuse_mount_resonance(modes, loads, omega)
    couplings, count = _Couplings.of(mounted), len(mounted.names)
    motion = couplings.move(loads, omega)
    curves = couplings.read_all(frequencies(loads.orders, omega), motion)
    free, peak = loads.at(omega), find_longest(loads.orders, curves).value
    tell(1.0)
    arms = carry_points(mounted.dynamic.at, mounted.body.centre)
    passed = np.einsum("pij,nspi->nsj", arms, curves[:, :, :count])
    by_order = largest_of_ellipse(curves)
    worst = _find_worst(couplings, modes, loads, omega, peak)
    return MountingResponse(
        loads,
        omega,
        by_order[:, :, :count],
        peak[:, :count],
        by_order[:, :, count:],
        peak[:, count:],
        np.abs(free),
        np.abs(passed),
        worst[:count],
        worst[count:],
        motion,
    )


def _refuse_too_many(loads: BodyLoads, omega: Real, mounted: MountedBody) -> None:
    count = len(loads.orders) * len(omega) * (len(mounted.names) + len(mounted.point_names))
    if count > MOST_MOUNT_RESULTS:
        raise BalcliError(
            f"{len(loads.orders)} orders at {len(omega)} speeds of {len(mounted.names)} mounts and "
            f"{len(mounted.point_names)} points are {count} results, and at most "
            f"{MOST_MOUNT_RESULTS} are computed; take fewer --speeds or --orders"
        )


def refuse_mount_resonance(modes: BodyModes, loads: BodyLoads, omega: Real) -> None:
    """Nothing, unless the engine drives an undamped mode at its own frequency within the range.

    Raises:
        BalcliError: it does, with mode, order and speed.
    """
    met = find_resonances(modes.modes, modes.loss, loads.orders, omega, loads.at(omega))
    if not met:
        return
    first = min(met, key=lambda one: one.speed)
    mode = modes.six[first.mode]
    raise BalcliError(
        f"mode {first.mode + 1} ({mode.motion}, {mode.hertz:.4g} Hz) is not damped, and order "
        f"{first.order:g} drives it at {first.speed / RPM:.6g} rpm, where its motion has no "
        "bound; give the mounts a loss, such as loss = 0.1, or a range without that speed"
    )


def find_largest_amplitudes(
    mounted: MountedBody,
    modes: BodyModes,
    loads: BodyLoads,
    omega: Real,
    curves: Sequence[int],
) -> tuple[LargestAmplitude, ...]:
    """Return the largest value of some curves over a range of speeds (rad/s, rising), as `respond`
    has them.

    Args:
        curves: numbers of forces of mounts, from 0, then of motion of points, after the mounts.

    Raises:
        BalcliError: an undamped mode that is driven within the range.
    """
    refuse_mount_resonance(modes, loads, omega)
    couplings = _Couplings.of(mounted).select(curves)
    return _find_worst(couplings, modes, loads, omega, couplings.find_peaks(loads, omega))


def find_meetings(modes: BodyModes, loads: BodyLoads, omega: Real) -> tuple[Meeting, ...]:
    """Orders that meet modes within a range of speeds (rad/s, rising), by mode and order."""
    met = [
        Meeting(k, float(order), mode.omega / float(order))
        for k, mode in enumerate(modes.six)
        for order in loads.orders[loads.there]
    ]
    return tuple(one for one in met if omega[0] <= one.omega <= omega[-1])


def _find_worst(
    couplings: _Couplings, modes: BodyModes, loads: BodyLoads, omega: Real, peaks: Real
) -> tuple[LargestAmplitude, ...]:
    """Return the highest value of each curve (speeds, curves) of peaks, closer than the speeds are:
    every peak that may be the highest is approached. Where damping is little, a resonance is
    narrower than their step: the speeds at which an order meets a mode are looked at as well, and
    speeds next to them as far as the resonance is wide.
    """
    met = [one for one in find_meetings(modes, loads, omega) if modes.loss[one.mode] > UNDAMPED]
    at_modes, loss = np.array([(one.omega, modes.loss[one.mode]) for one in met]).reshape(-1, 2).T
    about = (at_modes * (1 + loss * _BESIDE[:, None])).ravel()
    about = np.setdiff1d(about[(about > omega[0]) & (about < omega[-1])], omega)
    heights = np.concatenate([peaks, couplings.find_peaks(loads, about)])
    rising = np.argsort(np.concatenate([omega, about]))
    speeds, heights = np.concatenate([omega, about])[rising], heights[rising]

    def read(at: Real, curve: NDArray[np.intp]) -> tuple[Complex, Complex]:
        motion = couplings.move(loads, at)
        return motion, couplings.read_each(frequencies(loads.orders, at), motion, curve)

    def judge(at: Real, curve: NDArray[np.intp]) -> Real:
        return find_longest(loads.orders, read(at, curve)[1]).value

    best, _ = find_highest(judge, speeds, heights, heights.max(axis=0), _NEAR)
    each = np.arange(len(best))
    motion, own = read(best, each)
    value, alone = find_longest(loads.orders, own).value, largest_of_ellipse(own)
    leading = find_first_largest(alone)
    orders, shapes = loads.orders[leading], modes.modes.shapes
    shares = (shapes @ couplings.mass @ motion[leading, each].T)[..., None] * shapes[:, None]
    every = np.broadcast_to(orders * best, shares.shape[:2])
    mode = find_first_largest(np.linalg.norm(couplings.read_each(every, shares, each), axis=-1))
    return tuple(
        LargestAmplitude(
            float(value[k]),
            float(best[k]),
            float(orders[k]),
            float(alone[leading[k], k]),
            int(mode[k]),
        )
        for k in range(len(best))
    )
