"""An engine that runs on its mounts: forces on them and motion of points, order by order and added
up in time, at every speed.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..core.extrema import find_highest
from ..core.peaks import find_longest, largest_of_ellipse
from ..core.phases import RPM
from ..core.vibration import (
    UNDAMPED,
    Complex,
    Indices,
    Real,
    UndampedResonanceError,
    find_resonances,
    frequencies,
    solve_response,
)
from ..engine.engine import Engine
from ..engine.figures import find_first_largest
from ..errors import BalcliError
from ..file.fields import order_number
from ..forces.spectrum import compute_spectra, list_gas_orders
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

_BESIDE = np.array([-0.5, -0.25, 0, 0.25, 0.5])  # speeds looked at about a resonance, in widths
RESONANT = 0.05  # distance of the frequency of an order from that of the mode that it meets
_PART = 0.25  # of the largest order at a speed: what a resonance there must have to be named
_AT = 1e-9  # of a speed: those that differ by less are the same
_BEYOND = 3e-4  # of the largest order: what all higher orders may add
_LOOKED_AT, _FREQUENCIES, _WIDE = 24, 800, 1.02  # speeds, frequencies, ratio of neighbours at least
_NEAR = 0.8  # of the highest at the speeds looked at: what a peak beside them may exceed
_OF_MOUNT: tuple[type, type, type] = (MountForce, ForceOfOrder, WorstForce)
_OF_POINT: tuple[type, type, type] = (PointMotion, MotionOfOrder, WorstMotion)
_COMPONENTS = (*(f"force_{axis}_N" for axis in "xyz"), *(f"moment_{axis}_Nm" for axis in "xyz"))


class RunningBody(NamedTuple):
    """A body on its mounts that an engine shakes. Its curves are the forces of mounts (N) and after
    them the motion of points (m), of three components each.

    Attributes:
        modes: Equations of motion and natural modes.
        loads: Load of the engine.
        couplings: Curves for a unit of each motion of the body and of each of its speeds, shape
            (curves, 3, 12).
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

        Without `orders`, it has all that contribute to the response: gas orders that are higher
        than the usual ones count where all of these together may exceed _BEYOND of the largest
        order of some curve at some speed.

        Args:
            mounted: Body on its mounts.
            modes: Its equations of motion and modes.
            engine: Engine that shakes it.
            omega: Range of speeds, rad/s, rising, shape (speeds,).
            orders: Orders of the load.
            ranged: Whether the speeds stand for all between the first and the last.

        Raises:
            BalcliError: As of `refuse_resonance`.
        """
        centre = mounted.body.centre
        mounts = np.concatenate(couple_mounts(mounted.body, mounted.dynamic), axis=-1)
        points = carry_points(mounted.points, centre)
        couplings = np.concatenate([mounts, np.concatenate([points, 0 * points], axis=-1)])
        running = cls(modes, find_loads(engine, centre, orders), couplings)
        if orders is not None or not running.loads.fired:
            return running
        running.refuse_resonance(omega, ranged=ranged)
        every = list_gas_orders(engine, HIGHEST_ORDER_UNASKED)
        rows = np.linspace(0, len(omega) - 1, _LOOKED_AT).round().astype(int)
        some = np.unique(omega[rows])
        own = largest_of_ellipse(running.read(running.move(some)[..., None, :])).max(axis=0)
        found = compute_spectra(engine, every, list_gas_kinds(engine))
        roll = np.abs(find_gas_reaction(found).x)
        sizes = roll[:, None, None] * running.bound_response(every, some)
        beyond = sizes[::-1].cumsum(axis=0)[::-1]  # of an order and all higher ones
        needed = (beyond > _BEYOND * own).any(axis=(1, 2))
        highest = every[needed].max(initial=HIGHEST_GAS_ORDER_UNASKED)
        if highest > HIGHEST_GAS_ORDER_UNASKED:
            loads = find_loads(engine, centre, gas_orders=list_gas_orders(engine, highest))
            running = running._replace(loads=loads)
        return running

    def bound_response(self, orders: Real, omega: Real) -> Real:
        """Return the largest length of each curve for a roll moment of 1 N m of each order, shape
        (orders, speeds, curves), at a speed or between it and its neighbours, resonances included.
        """
        own, places = self.modes, np.multiply.outer(orders, omega).ravel()
        w = np.geomspace(places.min(), places.max(), _FREQUENCIES)
        natural = own.modes.omega[own.loss > UNDAMPED]
        w = np.union1d(w, natural)
        motion = solve_response(own.stiffness, own.damping, own.mass, w, np.eye(6)[ROLL])
        sizes = largest_of_ellipse(self.read(_with_rate(motion, w)[:, None, :]))
        reach = float((omega[1:] / omega[:-1]).max(initial=_WIDE))
        low, high = np.searchsorted(w, places / reach), np.searchsorted(w, places * reach)
        ends = np.stack([low, np.maximum(high, low + 1)], axis=1).ravel()
        padded = np.concatenate([sizes, np.zeros((2, sizes.shape[1]))])
        highest = np.maximum.reduceat(padded, ends)[::2]
        return highest.reshape(len(orders), len(omega), -1)

    def move(self, omega: Real) -> Complex:
        """Return the motion of the body and its rate, shape (orders, *speeds, 12).

        Args:
            omega: Speeds, rad/s, any shape.
        """
        w, own, load = frequencies(self.loads.orders, omega), self.modes, self.loads.at(omega)
        try:
            motion = solve_response(own.stiffness, own.damping, own.mass, w, load)
        except UndampedResonanceError as error:  # resonances are refused before
            raise BalcliError(
                f"at {error.frequency / (2 * np.pi):.4g} Hz the motion of the body is lost in "
                "rounding errors, so far apart are stiffness and damping of the mounts: is damping "
                "in N s/mm?"
            ) from None
        return _with_rate(motion, w)

    def read(self, motion: Complex, curve: Indices | slice = slice(None)) -> Complex:
        """Return curves, shape (..., curves, 3), of a motion with its rate, shape (..., curves, 12)
        or (..., 1, 12).
        """
        return np.asarray(np.einsum("cij,...cj->...ci", self.couplings[curve], motion))

    def find_peaks(self, omega: Real) -> Real:
        """Return the largest length of each curve over the cycle, shape (speeds, curves)."""
        curves = self.read(self.move(omega)[..., None, :])
        return find_longest(self.loads.orders, curves).value

    def refuse_resonance(self, omega: Real, *, ranged: bool = True) -> bool:
        """Raise BalcliError if the engine drives an undamped mode at its own frequency at some of
        these speeds (rad/s, rising), or between them if they are a range, with mode, order and
        speed. Return whether the motion has a bound at all speeds between them.
        """
        modes, loads = self.modes, self.loads
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


def list_meetings(modes: BodyModes, loads: BodyLoads, rpm: Real) -> list[tuple[int, float, float]]:
    """Return modes (from 0), orders that meet them within a range of speeds (rpm, rising), and
    the speeds (rpm) at which they do, by mode and order.
    """
    orders = loads.orders[loads.there]
    met = np.divide.outer(modes.modes.omega, orders) / RPM
    k, n = np.nonzero((met >= rpm[0]) & (met <= rpm[-1]))
    return list(zip(k.tolist(), orders[n].tolist(), met[k, n].tolist(), strict=True))


def find_worst(
    running: RunningBody, omega: Real, peaks: Real, *, between: bool = True
) -> tuple[Real, Real]:
    """Return the speed (rad/s) at which each curve is highest and its value there, shape (curves,),
    between the given speeds as well.

    Every peak that may be the highest is approached. A resonance with little damping is narrower
    than the step of the speeds: the speeds at which an order meets a mode are looked at as well,
    and speeds next to them as far as the resonance is wide.

    Args:
        running: Running body with its curves.
        omega: Speeds, rad/s, rising, shape (speeds,).
        peaks: Largest lengths over the cycle at these speeds, shape (speeds, curves).
        between: Whether to look between the speeds.
    """
    if not between:
        return omega[peaks.argmax(axis=0)], peaks.max(axis=0)
    loss, met = running.modes.loss, list_meetings(running.modes, running.loads, omega / RPM)
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
    """Yield for each curve at its own speed (rad/s), shape (curves,): the largest single order, its
    value (N or m), the number of the mode that makes most of it, from 0, and the order with the
    largest amplitude of those that meet a mode there, None where none does.
    """
    own, orders, motion = running.modes, running.loads.orders, running.move(omega)
    alone, w = largest_of_ellipse(running.read(motion)), frequencies(orders, omega)
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
    """Return motions, shape (..., 6), at frequencies w (rad/s), with their rates, (..., 12)."""
    return np.concatenate([motion, 1j * w[..., None] * motion], axis=-1)


def respond(
    mounted: MountedBody, running: RunningBody, rpm: Real, *, ranged: bool = True
) -> BodyResponse:
    """Return the response at every order and speed.

    Args:
        mounted: Body on its mounts.
        running: The same with the load of the engine.
        rpm: Speeds, rising, shape (speeds,).
        ranged: Whether they stand for all speeds between the first and the last.

    Raises:
        BalcliError: There are too many results; the engine drives an undamped mode at its own
            frequency at one of the speeds, or within their range.
    """
    loads, mounts, points = running.loads, mounted.names, mounted.point_names
    omega = rpm * RPM
    count = len(loads.orders) * len(rpm) * (len(mounts) + len(points))
    if count > MOST_MOUNT_RESULTS:
        raise BalcliError(
            f"{len(loads.orders)} orders at {len(rpm)} speeds of {len(mounts)} mounts and "
            f"{len(points)} points are {count} results, and at most {MOST_MOUNT_RESULTS} are "
            "computed; take fewer --speeds or --orders"
        )
    bounded = running.refuse_resonance(omega, ranged=ranged)
    motion = running.move(omega)
    curves = running.read(motion[..., None, :])
    peak = find_longest(loads.orders, curves).value
    at, highest = find_worst(running, omega, peak, between=bounded)
    numbers = [order_number(order) for order in loads.orders]
    scale = np.repeat([1.0, 1e3], [len(mounts), len(points)])  # N, and mm of m
    by_order, peak, highest = scale * largest_of_ellipse(curves), scale * peak, scale * highest
    places = []
    causes = zip((*mounts, *points), _find_causes(running, at), strict=True)
    for k, (name, (order, alone, *others)) in enumerate(causes):
        place, of_order, largest = _OF_MOUNT if k < len(mounts) else _OF_POINT
        each = tuple(of_order(n, by_order[row, :, k]) for row, n in enumerate(numbers))
        figures = (highest[k].item(), float(at[k] / RPM), order, float(scale[k] * alone))
        worst = largest(*figures, *others)
        places.append(place(name, each, peak[:, k], worst))
    arms = carry_points(mounted.dynamic.at, mounted.body.centre)
    on_mounts = np.abs(np.einsum("pij,nspi->nsj", arms, curves[:, :, : len(mounts)]))
    rigid, arm = np.abs(loads.at(omega)), float(np.abs(arms).max(initial=1.0))
    return BodyResponse(
        **silent_entries(loads.silent),
        orders=numbers,
        speeds_rpm=rpm,
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
    """Return the amplitudes by speed of a load (speeds, 6), as far as there is more than rounding;
    the forces have arms (m) up to this.
    """
    force, moment = (part.max(axis=1, keepdims=True) for part in (load[:, :3], load[:, 3:]))
    size = np.repeat(np.hstack([force, np.maximum(moment, arm * force)]), 3, axis=1)
    load = drop_rounding(load, size)
    return {key: load[:, k] for k, key in enumerate(_COMPONENTS) if load[:, k].any()}
