"""The scheme `minimax`: the counterweight that makes the largest force over a revolution as small
as possible; and the scheme `ellipse`: the counterweight that leaves the force of order 1 a wanted
direction and shape.

Seen from the turning crank, the force F (a complex number; theta: crank angle) is the closed curve
`F e^{-i theta}`, and a counterweight shifts this curve. So the best weight moves the centre of the
smallest enclosing circle to the origin. The circle is found by exchange: take the smallest circle
around a few points of the curve, which can only be too small; add the points of the curve that are
farthest from its centre; repeat until no point is farther away than the radius. The radius sought
lies between that of the last circle and the distance of the farthest point; their difference bounds
the error.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np

from ..core.peaks import find_near_peaks
from ..core.phasors import EPS, Complex, Phasors, unit
from ..core.vibration import Real
from ..engine.engine import Engine
from ..errors import ArgumentError
from .factor import find_curve, find_factor_peaks
from .fitting import Fitting, Slot, size_unbalances
from .options import SchemeOptions
from .planes import (
    SAME_PLACE,
    measure_direction,
    read_planes,
    read_position,
)
from .remedy import Remedy, remove_counterweights
from .residual import FORWARD, FORWARD_FORCE, NothingToBalanceError

_SAME = 8 * EPS  # radii that differ by up to this share of the sum of all amplitudes are equal
_TOUCHING = 1e-11  # share of the radius by which a reported point may lie inside the circle
_APART = 1e-3  # rad; angles closer together are one peak
_FIXED = 1e-9  # share of the radius by which a point that fixes a circle may lie inside it
_ROUNDS = 60


class Circle(NamedTuple):
    """Smallest circle around a curve.

    Attributes:
        centre: Centre x + iy, in the unit of the curve.
        radius: Largest distance of the curve from the centre.
        theta: Angles (rad, ascending) at which the curve touches the circle.
        excess: Upper bound of the difference between the radius and the smallest possible one; 0 if
            it is no more than `noise`.
        noise: Rounding error of the radius.
    """

    centre: complex
    radius: float
    theta: Real
    excess: float
    noise: float = 0.0


def enclose_curve(curve: Phasors) -> Circle:
    """Return the smallest circle around the curve `F e^{-i theta}` (see the module).

    Args:
        curve: Phasors of the force F: whole orders, 1 included, of one engine, not of variants.
    """
    present = np.flatnonzero((curve.major != 0) | (curve.orders == 1))
    if not np.any(curve.major):
        return Circle(0j, 0.0, np.zeros(0), 0.0)
    curve = Phasors(curve.orders[present], curve.vectors[:, present], np.zeros(1))
    noise = _SAME * float(curve.major.sum())
    best = _reach(curve, complex(curve.forward[curve.orders == 1].sum()))
    theta = best.theta
    lower = 0.0
    for _ in range(_ROUNDS):
        points = _seen(curve, theta)
        centre, fixing = enclose_points(points)
        lower = max(lower, float(np.abs(points[fixing] - centre).max()))
        trial = _reach(curve, centre)
        best = min(best, trial, key=lambda circle: circle.radius)
        if best.radius - lower <= noise:
            break
        theta = np.concatenate([theta[fixing], trial.theta])
    on = np.abs(_seen(curve, best.theta) - best.centre) >= best.radius * (1 - _TOUCHING) - noise
    excess = best.radius - lower
    return best._replace(theta=best.theta[on], excess=excess * (excess > noise), noise=noise)


def enclose_points(points: Complex) -> tuple[complex, list[int]]:
    """Return the centre of the smallest circle around some points, and the indices of the (at most
    three) points that fix it. All circles through three points, or with two points as a diameter,
    are tried.
    """
    triples = np.array([*combinations_with_replacement(range(len(points)), 3)])
    a, b, c = points[triples].T
    middle = (a + c) / 2
    b = b - a
    c = c - a
    across = 2 * (b.conj() * c).imag
    rise = 1j * (b * np.abs(c) ** 2 - c * np.abs(b) ** 2)
    with np.errstate(all="ignore"):  # three points in line have no circle
        centres = np.where(across, a + rise / across, middle)
        farthest = np.abs(points[:, None] - centres).max(axis=0)
        fixed = np.abs(a - centres) >= farthest * (1 - _FIXED)  # no point is outside
    best = int(np.where(fixed, farthest, np.inf).argmin())
    return complex(centres[best]), sorted({*triples[best].tolist()})


def _reach(curve: Phasors, centre: complex) -> Circle:
    """Return the smallest circle around a curve with this centre, and the angles of its farthest
    points.
    """
    forward = np.where(curve.orders == 1, curve.forward - centre, curve.forward)
    difference = Phasors.of(curve.orders, forward, curve.backward, curve.noise)
    if not np.any(difference.vectors):
        return Circle(centre, 0.0, np.zeros(1), np.inf)
    theta = find_near_peaks(difference)
    first = np.diff(theta, prepend=theta[-1] - 2 * np.pi) > _APART
    theta = theta[first] if np.any(first) else theta[:1]
    return Circle(centre, float(np.abs(difference.values(theta)).max()), theta, np.inf)


def _seen(curve: Phasors, theta: Real) -> Complex:
    """Return the curve as seen from the crank, at angles (rad)."""
    return curve.values(theta) * np.exp(-1j * theta)


_LEFT = 1e-9  # if a larger share remains, these planes cannot take the moment


def size_minimax(engine: Engine, options: SchemeOptions) -> Remedy:
    """Return the counterweight that moves the centre of the smallest circle around `F e^{-i theta}`
    to the origin (docs/theory.md).

    By default this is one weight in the middle of the throws. In given planes, the weights also
    cancel the moment that turns with the crank.

    Raises:
        BalcliError: The given planes cannot take the moment.
        NothingToBalanceError: No weight makes the largest force smaller.
    """
    fitting = Fitting.start(engine, "minimax", 1)
    force = find_curve(fitting.engine, "force")
    named = "all orders"
    if options.orders is not None:
        orders = sorted({1, *options.orders})
        force = force.select_orders(force.orders[np.isin(force.orders, orders)])
        named = (
            f"orders {', '.join(f'{order:g}' for order in orders)} (each exact: F2 has A2, not λ)"
        )
    circle = enclose_curve(force)
    newtons_per_kg_m = float(engine.omega) ** 2
    noise = fitting.find_residual(1).noise[FORWARD_FORCE] * newtons_per_kg_m
    centred = abs(circle.centre) <= max(noise, circle.noise)
    nothing_gained = (
        "no counterweight makes the largest force smaller: the smallest circle around "
        "the force as seen from the crank has its centre at 0"
    )
    if centred and options.planes is None:
        raise NothingToBalanceError(nothing_gained)
    unbalance = 0j if centred else -circle.centre / newtons_per_kg_m
    slots, unbalances = _split(engine, options, fitting, unbalance)
    reason = (
        f"The largest force over a revolution, {named}, becomes as small as a "
        "counterweight can make it (smallest circle around the force as seen from the crank)"
    )
    fitting = fitting.add(slots, unbalances, reason)
    reached = np.sort(np.round(np.degrees(circle.theta), 9) % 360)
    left = force.values(np.radians(reached)) - circle.centre * unit(reached)
    error = circle.excess / circle.radius if circle.radius else 0.0
    remedy = fitting.remedy.add_details(
        peak_force_N=circle.radius,
        reached_deg=reached.tolist(),
        direction_deg=[measure_direction(complex(vector)) for vector in left],
        relative_error_bound=error,
    )
    if options.orders is None:
        remedy = remedy.add_details(**_compare_with_half(fitting.engine, circle))
    return remedy if remedy.devices else remedy._replace(note=nothing_gained)


def size_ellipse(engine: Engine, options: SchemeOptions) -> Remedy:
    """Return the counterweight with which the force of order 1 runs on an ellipse whose major axis
    has the given direction, and whose axes have the given ratio (Wang, conclusion 5).

    A counterweight changes only V+, the rotating vector that turns with the crank; V- turns against
    it. The major axis lies at (arg V+ + arg V-)/2; the half axes are |V-| + |V+| and |V-| - |V+|.
    The other solution, |V+| > |V-|, has larger axes.

    Raises:
        BalcliError: Direction or ratio is missing, or the given planes cannot take the moment.
        NothingToBalanceError: No force turns against the crank.
    """
    if options.direction is None or options.ratio is None:
        raise ArgumentError(
            "ellipse: give {direction} and {ratio} of the force to leave, such as 90 and 50%"
        )
    fitting = Fitting.start(engine, "ellipse", 1)
    residual = fitting.find_residual(1)
    against = residual.force(-1)
    if not against:
        raise NothingToBalanceError(
            "no force of order 1 turns against the crank, so it runs on a circle, and "
            "counterweights can cancel all of it"
        )
    with_crank = against.conjugate() * unit(2 * options.direction)
    wanted = complex(with_crank) * (1 - options.ratio) / (1 + options.ratio)
    slots, unbalances = _split(engine, options, fitting, wanted - residual.force(1))
    largest = 2 * abs(against) / (1 + options.ratio) * residual.newtons_per_kg_m
    reason = (
        "The force of order 1 keeps its part that turns against the crank. The weight sets the "
        "other part so that the ellipse has the wanted direction and ratio of axes"
    )
    fitting = fitting.add(slots, unbalances, reason)
    return fitting.remedy.add_details(
        order_1_largest_N=largest, order_1_smallest_N=largest * options.ratio
    )


def _split(
    engine: Engine, options: SchemeOptions, fitting: Fitting, unbalance: complex
) -> tuple[Sequence[Slot], Sequence[complex]]:
    """Return slots and unbalances (kg m) that add up to this unbalance: in one plane, or in the
    given planes such that they also cancel the moment of order 1 that turns with the
    crank.
    """
    if options.planes is None:
        middle = float(engine.throws_m.min() + engine.throws_m.max()) / 2
        return [Slot("counterweight", 1, 1, read_position(options, middle))], [unbalance]
    slots = [Slot("counterweight", 1, 1, z) for z in read_planes(engine, options)]
    residual = fitting.find_residual(1)
    wanted = residual._replace(parts={**residual.parts, FORWARD_FORCE: -unbalance})
    fit = size_unbalances(slots, wanted, FORWARD)
    if fit.left > _LEFT:
        raise ArgumentError("{planes}: {same}", same=SAME_PLACE)
    return slots, fit.unbalances


def _compare_with_half(engine: Engine, circle: Circle) -> dict[str, float]:
    """Return the largest force with counterweights of factor 0.5 instead of those of the file, and
    by which share of this force the radius of `circle` is smaller; empty for a rotary engine, which
    has no factor.
    """
    if engine.rotary:
        return {}
    half = find_factor_peaks(remove_counterweights(engine), 0.5).peak_force_N
    gain = 1 - circle.radius / half if abs(half - circle.radius) > circle.noise else 0.0
    return {"factor_half_peak_N": half, "improvement": gain}
