"""Compute the vibration of an engine that runs on its mounts: forces on mounts and motion of points
at every speed, order by order and with all orders added with their phases.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.peaks import find_highest, find_longest, largest_of_ellipse
from ..core.phases import RPM
from ..core.vibration import (
    UNDAMPED,
    Complex,
    Indices,
    Real,
    UndampedResonanceError,
    find_resonances,
    solve_response,
)
from ..engine.engine import Engine
from ..engine.figures import find_first_largest
from ..errors import ArgumentError, BalcliError
from ..file.fields import order_number
from ..forces.kinds import FREE
from ..forces.spectrum import compute_spectra, follow_gas, list_gas_orders
from ..limits import HIGHEST_GAS_ORDER_UNASKED, HIGHEST_ORDER_UNASKED, MOST_MOUNT_RESULTS
from ..show.figures import silent_entries
from .build import BodyModes, MountedBody
from .loads import BodyLoads, find_gas_reaction, find_loads, list_gas_kinds
from .records import (
    BodyResponse,
    ForceOfOrder,
    MetMode,
    MotionOfOrder,
    MountForce,
    Passed,
    PointMotion,
    WorstForce,
    WorstMotion,
)
from .rigid_body import ROLL, carry_points, couple_mounts, drop_rounding

_BESIDE = np.array([-0.5, -0.25, 0, 0.25, 0.5])  # speeds added around a resonance, in its widths
RESONANT = 0.05  # an order is in resonance within this relative distance from a mode's frequency
_PART = 0.25  # least share of the largest order's value at which a resonance is reported
_AT = 1e-9  # relative difference below which speeds are equal
_BEYOND = 1e-4  # most that neglected higher orders add up to, as a share of the largest order
_LOOKED_AT = 24  # number of speeds at which this sum is computed
# Peaks between two speeds are searched next to values above this share of the highest.
_NEAR = 0.8
_OF_MOUNT: tuple[type, type, type] = (MountForce, ForceOfOrder, WorstForce)
_OF_POINT: tuple[type, type, type] = (PointMotion, MotionOfOrder, WorstMotion)
_COMPONENTS = tuple(kind.key_along(axis) for kind in FREE for axis in "xyz")


class RunningBody(NamedTuple):
    """A body on its mounts, shaken by an engine. Its curves over the speed are the forces of the
    mounts (N), then the motions of the points (m); each has three components.

    Attributes:
        modes: Equations of motion and natural modes.
        loads: Load of the engine.
        couplings: Curves for a unit of each of the body's 6 motions and of each of its 6
            velocities, shape (curves, 3, 12).
    """

    modes: BodyModes
    loads: BodyLoads
    couplings: Complex

    @classmethod
    def choose(
        cls,
        mounted: MountedBody,
        modes: BodyModes,
        engine: Engine,
        omega: Real,
        orders: Real | None = None,
        *,
        ranged: bool = True,
    ) -> RunningBody:
        """Return the running body with the curves of all mounts and points.

        By default it has all orders that contribute to the curves. Gas orders above
        HIGHEST_GAS_ORDER_UNASKED are added as far as the sum of an order and all higher ones
        exceeds _BEYOND times the largest amplitude of an order, in any curve at any examined speed.

        Args:
            mounted: Body on its mounts.
            modes: Equations of motion and modes of the body.
            engine: Engine that shakes the body.
            omega: Rising speeds, rad/s, shape (speeds,).
            orders: Orders of the load; default: all that contribute.
            ranged: Whether the speeds represent a whole range, so that resonances between them
                count.

        Raises:
            BalcliError: An undamped mode is driven; see `refuse_resonance`.
        """
        centre = mounted.body.centre
        running = cls(modes, find_loads(engine, centre, orders), _couple(mounted))
        if orders is not None or running.loads.gas is None:
            return running
        running.refuse_resonance(omega, ranged=ranged)
        every = list_gas_orders(engine, HIGHEST_ORDER_UNASKED)
        rows = np.linspace(0, len(omega) - 1, _LOOKED_AT).round().astype(int)
        some = np.unique(omega[rows])
        own = largest_of_ellipse(running.read(running.move(some)[..., None, :])).max(axis=0)

        def find_torque(own: Engine) -> NDArray[np.complex128]:
            found = compute_spectra(own, every, list_gas_kinds(own))
            return np.asarray(find_gas_reaction(found).x, complex)

        gas = follow_gas(engine, find_torque)
        roll = np.eye(6)[ROLL] * gas.torque(some / RPM)[..., None]
        sizes = largest_of_ellipse(running.read(running.follow(every, some, roll)[..., None, :]))
        beyond = sizes[::-1].cumsum(axis=0)[::-1]  # sum of an order and all higher ones
        needed = (beyond > _BEYOND * own).any(axis=(1, 2))
        highest = every[needed].max(initial=HIGHEST_GAS_ORDER_UNASKED)
        if highest > HIGHEST_GAS_ORDER_UNASKED:
            loads = find_loads(engine, centre, gas_orders=list_gas_orders(engine, highest))
            running = running._replace(loads=loads)
        return running

    def move(self, omega: Real) -> Complex:
        """Return the motion of the body and its velocity, shape (orders, *speeds, 12).

        Args:
            omega: Speeds, rad/s, any shape.
        """
        return self.follow(self.loads.orders, omega, self.loads.at(omega))

    def follow(self, orders: Real, omega: Real, load: Complex) -> Complex:
        """Return the motion of the body and its velocity under a load (orders, *speeds, 6)."""
        w = np.multiply.outer(orders, omega)
        own = self.modes
        try:
            motion = solve_response(own.stiffness, own.damping, own.mass, w, load)
        except UndampedResonanceError as error:  # true resonances were rejected before
            hertz = error.frequency / (2 * np.pi)
            message = f"at {hertz:.4g} Hz the body's motion cannot be computed"
            raise BalcliError(f"{message}; is the damping of all mounts in N s/mm?") from None
        return _with_rate(motion, w)

    def read(self, motion: Complex, curve: Indices | slice = slice(None)) -> Complex:
        """Return the curves, shape (..., curves, 3), for a motion and its velocity, shape (...,
        curves, 12) or (..., 1, 12).
        """
        return np.asarray(np.einsum("cij,...cj->...ci", self.couplings[curve], motion))

    def find_peaks(self, omega: Real) -> Real:
        """Return the largest length of each curve over the cycle, shape (speeds, curves)."""
        curves = self.read(self.move(omega)[..., None, :])
        return find_longest(self.loads.orders, curves).value

    def refuse_resonance(self, omega: Real, *, ranged: bool = True) -> bool:
        """Raise BalcliError if an order drives an undamped mode at the mode's natural frequency at
        one of the rising speeds (rad/s), or between two of them if they are a range. Return whether
        the motion is bounded at all speeds between the first and the last.
        """
        modes = self.modes
        loads = self.loads
        driven = find_resonances(modes.modes, modes.loss, loads.orders, omega, loads.at(omega))
        met = [one for one in driven if ranged or np.abs(omega / one.speed - 1).min() < _AT]
        if met:
            first = min(met, key=lambda one: one.speed)
            mode = modes.each[first.mode]
            raise BalcliError(
                f"mode {first.mode + 1} ({mode.motion}, {mode.frequency_Hz:.4g} Hz) is not damped, "
                f"and order {first.order:g} drives it at {first.speed / RPM:.6g} rpm, where its "
                "motion has no bound; give the mounts a loss, such as loss = 0.1, or a range "
                "without that speed"
            )
        return not driven


def trace_peaks(mounted: MountedBody, modes: BodyModes, loads: BodyLoads, speeds_rpm: Real) -> Real:
    """Return the largest length of each curve over the cycle: forces of the mounts, N, then motions
    of the points, m; shape (speeds, curves).

    Args:
        mounted: Body on its mounts.
        modes: Its equations of motion.
        loads: Load of the engine.
        speeds_rpm: Speeds, shape (speeds,).
    """
    running = RunningBody(modes, loads, _couple(mounted))
    return running.find_peaks(speeds_rpm * RPM)


def _couple(mounted: MountedBody) -> Complex:
    """Return the couplings of a `RunningBody`."""
    mounts = np.concatenate(couple_mounts(mounted.body, mounted.dynamic), axis=-1)
    points = carry_points(mounted.points, mounted.body.centre)
    return np.concatenate([mounts, np.concatenate([points, 0 * points], axis=-1)])


def list_meetings(modes: BodyModes, loads: BodyLoads, rpm: Real) -> list[tuple[int, float, float]]:
    """Return (mode, order, speed) wherever an order meets a mode within the range of rising speeds
    (rpm), sorted by mode and order. Modes count from 0; speeds are in rpm.
    """
    orders = loads.orders[loads.there]
    met = np.divide.outer(modes.modes.omega, orders) / RPM
    k, n = np.nonzero((met >= rpm[0]) & (met <= rpm[-1]))
    return list(zip(k.tolist(), orders[n].tolist(), met[k, n].tolist(), strict=True))


def find_worst(
    running: RunningBody, omega: Real, peaks: Real, *, between: bool = True
) -> tuple[Real, Real]:
    """Return the speed (rad/s) at which each curve is highest, and its value there, shape (curves,)
    each. The speed may lie between the given speeds.

    Every peak that may be the highest is refined. Since a resonance with little damping may be
    narrower than the step of the speeds, the speeds at which an order meets a mode are added, with
    further speeds within the width of the resonance.

    Args:
        running: Running body with its curves.
        omega: Speeds, rad/s, rising, shape (speeds,).
        peaks: Largest length of each curve over the cycle at these speeds, shape (speeds, curves).
        between: Whether to search between these speeds as well.
    """
    if not between:
        return omega[peaks.argmax(axis=0)], peaks.max(axis=0)
    loss = running.modes.loss
    met = list_meetings(running.modes, running.loads, omega / RPM)
    about = [rpm * RPM * (1 + loss[k] * _BESIDE) for k, _, rpm in met if loss[k] > UNDAMPED]
    near = np.array(about).ravel()
    near = np.setdiff1d(near[(near > omega[0]) & (near < omega[-1])], omega)
    speeds = np.concatenate([omega, near])
    rising = np.argsort(speeds)
    heights = np.concatenate([peaks, running.find_peaks(near)])[rising]

    def judge(at: Real, curve: Indices) -> Real:
        curves = running.read(running.move(at), curve)
        return find_longest(running.loads.orders, curves).value

    return find_highest(judge, speeds[rising], heights, heights.max(axis=0), _NEAR)


def _find_causes(
    running: RunningBody, omega: Real
) -> Iterator[tuple[float, float, int, MetMode | None]]:
    """Yield for each curve, at its own speed (rad/s, shape (curves,)), the largest single order,
    its value (N or m), the number (from 0) of the mode that contributes most to it, and the
    resonance: the largest of the orders that meet a mode at this speed, or None.
    """
    own = running.modes
    orders = running.loads.orders
    motion = running.move(omega)
    alone = largest_of_ellipse(running.read(motion))
    w = np.multiply.outer(orders, omega)
    shapes = own.modes.shapes
    amplitudes = motion[..., :6] @ (shapes @ own.mass).T  # (orders, curves, modes)
    shares = np.moveaxis(amplitudes[..., None] * shapes, 2, 0)
    modes = find_first_largest(np.linalg.norm(running.read(_with_rate(shares, w)), axis=-1))
    near = np.abs(own.modes.omega[modes] / w - 1) <= RESONANT
    for k, sizes in enumerate(alone.T):
        first = int(find_first_largest(sizes))
        large = near[:, k] & (sizes >= _PART * sizes[first])
        cause = int(find_first_largest(np.where(large, sizes, 0)))
        mode = int(modes[cause, k])
        rpm = float(own.modes.omega[mode] / orders[cause] / RPM)
        met = MetMode(order_number(orders[cause]), mode + 1, rpm) if large[cause] else None
        order = order_number(orders[first])
        yield order, float(sizes[first]), int(modes[first, k]), met


def _with_rate(motion: Complex, w: Real) -> Complex:
    """Return motions (..., 6) at frequencies w (rad/s) followed by their velocities, (..., 12)."""
    return np.concatenate([motion, 1j * w[..., None] * motion], axis=-1)


def respond(
    mounted: MountedBody, running: RunningBody, rpm: Real, *, ranged: bool = True
) -> BodyResponse:
    """Return the response at every order and speed.

    Args:
        mounted: Body on its mounts.
        running: The body with the load of the engine.
        rpm: Rising speeds, shape (speeds,).
        ranged: Whether the speeds represent a whole range, so that resonances between them count.

    Raises:
        BalcliError: There are too many results, or an order drives an undamped mode at the mode's
            natural frequency at one of the speeds or within their range.
    """
    loads = running.loads
    mounts = mounted.names
    points = mounted.point_names
    omega = rpm * RPM
    count = len(loads.orders) * len(rpm) * (len(mounts) + len(points))
    if count > MOST_MOUNT_RESULTS:
        raise ArgumentError(
            "{order_count} orders at {speed_count} speeds of {mounts} mounts and {points} points "
            "are {count} results, and at most {most} are computed; take fewer {speeds} or {orders}",
            order_count=len(loads.orders),
            speed_count=len(rpm),
            mounts=len(mounts),
            points=len(points),
            count=count,
            most=MOST_MOUNT_RESULTS,
        )
    bounded = running.refuse_resonance(omega, ranged=ranged)
    motion = running.move(omega)
    curves = running.read(motion[..., None, :])
    peak = find_longest(loads.orders, curves).value
    at, highest = find_worst(running, omega, peak, between=bounded)
    numbers = [order_number(order) for order in loads.orders]
    scale = np.repeat([1.0, 1e3], [len(mounts), len(points)])  # N, and m to mm
    by_order = scale * largest_of_ellipse(curves)
    peak = scale * peak
    highest = scale * highest
    places = []
    causes = zip((*mounts, *points), _find_causes(running, at), strict=True)
    for k, (name, (order, alone, *others)) in enumerate(causes):
        place, of_order, largest = _OF_MOUNT if k < len(mounts) else _OF_POINT
        of_orders = tuple(of_order(n, by_order[row, :, k]) for row, n in enumerate(numbers))
        figures = (highest[k].item(), float(at[k] / RPM), order, float(scale[k] * alone))
        worst = largest(*figures, *others)
        places.append(place(name, of_orders, peak[:, k], worst))
    arms = carry_points(mounted.dynamic.at, mounted.body.centre)
    on_mounts = np.abs(np.einsum("pij,nspi->nsj", arms, curves[:, :, : len(mounts)]))
    rigid = np.abs(loads.at(omega))
    arm = float(np.abs(arms).max(initial=1.0))
    return BodyResponse(
        **silent_entries(loads.silent),
        orders=numbers,
        speeds_rpm=rpm,
        imep_Pa=loads.gas.imep(loads.to_crank_rpm(omega)) if loads.gas and loads.law else None,
        mounts=tuple(places[: len(mounts)]),
        points=tuple(places[len(mounts) :]),
        passed=tuple(
            Passed(number, _name_components(rigid[n], arm), _name_components(on_mounts[n], arm))
            for n, number in enumerate(numbers)
        ),
        loads=loads,
        body=motion[..., :6],
    )


def _name_components(load: Real, arm: float) -> dict[str, Real]:
    """Return the amplitudes of the components of a load (speeds, 6), by speed. Components that are
    only rounding errors are left out; the rounding of moments depends on `arm`, the longest arm of
    the forces (m).
    """
    force, moment = (part.max(axis=1, keepdims=True) for part in (load[:, :3], load[:, 3:]))
    size = np.repeat(np.hstack([force, np.maximum(moment, arm * force)]), 3, axis=1)
    load = drop_rounding(load, size)
    return {key: load[:, k] for k, key in enumerate(_COMPONENTS) if load[:, k].any()}
