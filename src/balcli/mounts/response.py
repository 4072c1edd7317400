"""An engine that runs on its mounts: forces on them and motion of points, order by order and added
up in time, at every speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

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
from ..engine.figures import find_first_largest
from ..errors import BalcliError
from ..limits import MOST_MOUNT_RESULTS
from .build import BodyModes, MountedBody
from .loads import BodyLoads
from .records import (
    BodyResponse,
    ForceOfOrder,
    MotionOfOrder,
    MountForce,
    Passed,
    PointMotion,
    WorstForce,
    WorstMotion,
)
from .rigid_body import carry_points, couple_mounts

_BESIDE = np.array([-0.5, -0.25, 0, 0.25, 0.5])  # speeds looked at about a resonance, in widths
_NEAR = 0.8  # of the highest at the speeds looked at: what a peak beside them may exceed
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
    def of(cls, mounted: MountedBody, modes: BodyModes, loads: BodyLoads) -> RunningBody:
        """Return the running body with the curves of all mounts and points."""
        mounts = np.concatenate(couple_mounts(mounted.body, mounted.dynamic), axis=-1)
        points = carry_points(mounted.points, mounted.body.centre)
        still = np.concatenate([points, np.zeros_like(points)], axis=-1)
        return cls(modes, loads, np.concatenate([mounts, still]))

    def select(self, curves: Sequence[int]) -> RunningBody:
        """Return the running body with some of its curves."""
        return self._replace(couplings=self.couplings[curves])

    def move(self, omega: Real) -> Complex:
        """Return the motion of the body and its rate, shape (orders, *speeds, 12).

        Args:
            omega: Speeds, rad/s, any shape.
        """
        w, own = frequencies(self.loads.orders, omega), self.modes
        try:
            motion = solve_response(
                own.stiffness, own.damping, own.mass, w, self.loads.at(np.asarray(omega))
            )
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

    def refuse_resonance(self, omega: Real) -> None:
        """Raise BalcliError if the engine drives an undamped mode at its own frequency in the range
        of speeds (rad/s, rising), with mode, order and speed.
        """
        modes, loads = self.modes, self.loads
        met = find_resonances(modes.modes, modes.loss, loads.orders, omega, loads.at(omega))
        if met:
            first = min(met, key=lambda one: one.speed)
            motion, hertz = modes.motions[first.mode], modes.hertz[first.mode]
            raise BalcliError(
                f"mode {first.mode + 1} ({motion}, {hertz:.4g} Hz) is not damped, and order "
                f"{first.order:g} drives it at {first.speed / RPM:.6g} rpm, where its motion has "
                "no bound; give the mounts a loss, such as loss = 0.1, or a range without that "
                "speed"
            )


def list_meetings(modes: BodyModes, loads: BodyLoads, rpm: Real) -> list[tuple[int, float, float]]:
    """Return modes (from 0), orders that meet them within a range of speeds (rpm, rising), and
    the speeds (rpm) at which they do, by mode and order.
    """
    met = [
        (k, float(order), float(natural / order) / RPM)
        for k, natural in enumerate(modes.modes.omega)
        for order in loads.orders[loads.there]
    ]
    return [each for each in met if rpm[0] <= each[2] <= rpm[-1]]


class Worst(NamedTuple):
    """The largest value of each curve over all speeds, shape (curves,).

    Attributes:
        value: Largest value, all orders together, N or m.
        omega: Speed at which it is reached, rad/s.
        order: Largest single order at this speed.
        alone: Value of this order, N or m.
        mode: Number of the mode that makes most of it, from 0.
    """

    value: Real
    omega: Real
    order: Real
    alone: Real
    mode: Indices


def find_worst(running: RunningBody, omega: Real, peaks: Real) -> Worst:
    """Return the highest value of each curve, between the given speeds as well.

    Every peak that may be the highest is approached. A resonance with little damping is narrower
    than the step of the speeds: the speeds at which an order meets a mode are looked at as well,
    and speeds next to them as far as the resonance is wide.

    Args:
        omega: Speeds, rad/s, rising, shape (speeds,).
        peaks: Largest lengths over the cycle at these speeds, shape (speeds, curves).
    """
    modes, orders = running.modes, running.loads.orders
    met = list_meetings(modes, running.loads, omega / RPM)
    lossy = [(rpm * RPM, modes.loss[k]) for k, _, rpm in met if modes.loss[k] > UNDAMPED]
    at, loss = np.array(lossy).reshape(-1, 2).T
    about = (at * (1 + loss * _BESIDE[:, None])).ravel()
    about = np.setdiff1d(about[(about > omega[0]) & (about < omega[-1])], omega)
    speeds = np.concatenate([omega, about])
    rising = np.argsort(speeds)
    heights = np.concatenate([peaks, running.find_peaks(about)])[rising]

    def judge(at: Real, curve: Indices) -> Real:
        return find_longest(orders, running.read(running.move(at), curve)).value

    best, value = find_highest(judge, speeds[rising], heights, heights.max(axis=0), _NEAR)
    each, motion = np.arange(len(best)), running.move(best)
    alone = largest_of_ellipse(running.read(motion))
    leading = find_first_largest(alone)
    shapes = modes.modes.shapes
    shares = (shapes @ modes.mass @ motion[leading, each, :6].T)[..., None] * shapes[:, None]
    of_modes = running.read(_with_rate(shares, orders[leading] * best))
    mode = find_first_largest(np.linalg.norm(of_modes, axis=-1))
    return Worst(value, best, orders[leading], alone[leading, each], mode)


def _with_rate(motion: Complex, w: Real) -> Complex:
    """Return motions, shape (..., 6), at frequencies w (rad/s), with their rates, (..., 12)."""
    return np.concatenate([motion, 1j * w[..., None] * motion], axis=-1)


def plain_order(order: float) -> float:
    """Return an order for documents: a whole one as an int."""
    return int(order) if order == int(order) else float(order)


def respond(mounted: MountedBody, running: RunningBody, omega: Real) -> BodyResponse:
    """Return the response at every order and speed.

    Args:
        omega: Speeds, rad/s, rising, shape (speeds,).

    Raises:
        BalcliError: There are too many results; the engine drives an undamped mode at its own
            frequency within the range of speeds.
    """
    loads, mounts, points = running.loads, mounted.names, mounted.point_names
    orders = loads.orders
    count = len(orders) * len(omega) * (len(mounts) + len(points))
    if count > MOST_MOUNT_RESULTS:
        raise BalcliError(
            f"{len(orders)} orders at {len(omega)} speeds of {len(mounts)} mounts and "
            f"{len(points)} points are {count} results, and at most {MOST_MOUNT_RESULTS} are "
            "computed; take fewer --speeds or --orders"
        )
    running.refuse_resonance(omega)
    motion = running.move(omega)
    curves = running.read(motion[..., None, :])
    by_order, peak = largest_of_ellipse(curves), find_longest(orders, curves).value
    worst = find_worst(running, omega, peak)
    numbers = [plain_order(order) for order in orders]

    kinds: list[tuple[Any, Any, Any, float]] = [
        *[(MountForce, ForceOfOrder, WorstForce, 1.0)] * len(mounts),
        *[(PointMotion, MotionOfOrder, WorstMotion, 1e-3)] * len(points),
    ]
    places = []
    for k, (name, kind) in enumerate(zip((*mounts, *points), kinds, strict=True)):
        place, of_order, largest, unit = kind
        each = (of_order(n, by_order[row, :, k] / unit) for row, n in enumerate(numbers))
        value, at, order, alone, mode = (column[k].item() for column in worst)
        highest = largest(value / unit, at / RPM, plain_order(order), alone / unit, mode)
        places.append(place(name, tuple(each), peak[:, k] / unit, highest))
    arms = carry_points(mounted.dynamic.at, mounted.body.centre)
    on_mounts = np.abs(np.einsum("pij,nspi->nsj", arms, curves[:, :, : len(mounts)]))
    rigid, rpm = np.abs(loads.at(omega)), omega / RPM
    short = np.round(rpm, 9)  # as speeds were given, which rad/s keep but for rounding
    return BodyResponse(
        no_gas_in=loads.silent.without_gas or None,
        no_burning_in=loads.silent.without_burning or None,
        speeds_rpm=np.where(short * RPM == omega, short, rpm),
        mounts=tuple(places[: len(mounts)]),
        points=tuple(places[len(mounts) :]),
        passed=tuple(
            Passed(number, _name_components(rigid[n]), _name_components(on_mounts[n]))
            for n, number in enumerate(numbers)
        ),
        loads=loads,
        body=motion[..., :6],
    )


def _name_components(load: Real) -> dict[str, Real]:
    """Return the amplitudes by speed of a load (speeds, 6), as far as there is any."""
    return {key: load[:, k] for k, key in enumerate(_COMPONENTS) if load[:, k].any()}
