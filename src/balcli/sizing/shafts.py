"""Schemes with balancer shafts and sliders, for any order that they can turn at."""

from __future__ import annotations

import cmath
import math
from typing import Any

from ..core.phasors import reduced
from ..engine.build import Engine
from ..errors import BalcliError
from . import planes
from .auto import why_shaft, why_weights
from .effects import Part, Rest, Slot, solve
from .fitting import BACKWARD, FORWARD, SAME_PLACE, Fitting
from .options import NoNeedError, Wish, chosen
from .remedy import Remedy, degrees

ROLL = Part("roll", 0)


def single_shaft(engine: Engine, wish: Wish) -> Remedy:
    """One shaft at -N for the part that turns against the crank; at N = 1 counterweights take the
    other part.

    Its axial distance from the force leaves a couple, which the details state; by default it stands
    where that is smallest.
    """
    left = chosen(engine, wish, "force", (-1,))
    fitting = Fitting.of(engine, "single-shaft", left.order)
    if left.order == 1:
        slots = [Slot("counterweight", 1, 1, z) for z in _weight_planes(engine, left)]
        fitting = fitting.cancel(slots, FORWARD, why_weights(left))
    place = _only(wish)
    slot = Slot("shaft", left.order, -1, _along(engine, wish, left, -1), place)
    fitting = fitting.cancel([slot], BACKWARD[:1], why_shaft(left, -1, 1))
    rest = fitting.rest(left.order)
    kept = (
        {}
        if left.order == 1
        else {"force_with_crank_left_N": abs(rest.at("force", 1)) * rest.newton}
    )
    return fitting.note(
        couple_left_Nm=abs(rest.at("moment", -1)) * rest.newton,
        axial_distance_mm=1e3 * _distance(left, slot.z),
        roll_left_Nm=abs(rest.parts[ROLL]) * rest.newton,
        **kept,
    ).remedy


def two_shaft(engine: Engine, wish: Wish) -> Remedy:
    """Shafts at +N and -N for the force of order N, placed such that no roll is added, or such that
    none is left (`roll`).
    """
    try:
        left = chosen(engine, wish, "force")
    except NoNeedError as reason:
        if wish.roll:
            raise BalcliError(
                f"{reason}; shafts without unbalance can do nothing about the roll"
            ) from None
        raise
    return _pair(Fitting.of(engine, "two-shaft", left.order), left, wish).remedy


def four_shaft(engine: Engine, wish: Wish) -> Remedy:
    """Shafts at +1, -1, +2 and -2 for the forces of orders 1 and 2."""
    fitting = Fitting.of(engine, "four-shaft")
    there = [
        left for left in map(fitting.rest, (1, 2)) if any(left.at("force", s) for s in (1, -1))
    ]
    if not there:
        raise NoNeedError(
            "there is no free force of orders 1 and 2: nothing to balance; couple-shaft takes "
            "moments"
        )
    for left in there:
        fitting = _pair(fitting, left, wish)
    return fitting.remedy


def couple_shaft(engine: Engine, wish: Wish) -> Remedy:
    """Shafts at +N and -N, each with two opposite eccentrics in two planes, for the moment of order
    N.
    """
    left = chosen(engine, wish, "moment")
    low, high = _two_planes(engine, wish)
    place = _only(wish)
    fitting = Fitting.of(engine, "couple-shaft", left.order)
    for sense in (1, -1):
        couple = left.at("moment", sense) / (high - low)
        if couple:
            slots = [Slot("shaft", left.order, sense, z, place) for z in (low, high)]
            fitting = fitting.add(slots, (couple, -couple), _why_couple(left, sense))
    rest = fitting.rest(left.order)
    return fitting.note(
        moment_left_Nm=sum(abs(rest.at("moment", s)) for s in (1, -1)) * rest.newton,
        force_left_N=sum(abs(rest.at("force", s)) for s in (1, -1)) * rest.newton,
    ).remedy


def slider(engine: Engine, wish: Wish) -> Remedy:
    """Two reciprocating masses along the axes of the ellipse of order N: `m r = (|V+| +- |V-|) /
    (n^2 omega^2)`.
    """
    left = chosen(engine, wish, "force")
    forward, backward = left.at("force", 1), left.at("force", -1)
    axis = float(reduced(degrees(cmath.sqrt(forward * backward)), 180))
    z, place = _along(engine, wish, left, 1 if abs(forward) >= abs(backward) else -1), _only(wish)
    slots = [
        Slot("slider", left.order, 0, z, place, direction)
        for direction in (axis, axis + 90 if axis <= 0 else axis - 90)
    ]
    reason = (
        f"Order {left.order} force: sliders driven at "
        f"{left.order} times crank speed along the axes of its ellipse, of sizes |V+| + |V-| and "
        "||V+| - |V-||"
    )
    fit = solve(slots, left, (FORWARD[0], BACKWARD[0]))
    there = [u if abs(u) > 2 * left.noise[FORWARD[0]] else 0j for u in fit.unbalances]
    fitting = Fitting.of(engine, "slider", left.order).add(slots, there, reason)
    return fitting.note(**_left(fitting.rest(left.order))).remedy


# ------------------------------------------------------------------ a pair of shafts
def _pair(fitting: Fitting, left: Rest, wish: Wish) -> Fitting:
    """Shafts at +N and -N for the force of this order; where one part is missing, one shaft, or two
    halves of it.
    """
    places = _places(left, wish)
    for sense in (-1, 1):
        if left.at("force", sense):
            z = _along(fitting.engine, wish, left, sense)
            share = 1 / len(places[sense])
            for place in places[sense]:
                slot = Slot("shaft", left.order, sense, z, place)
                fitting = fitting.add(
                    [slot],
                    [-left.at("force", sense) * share],
                    _why_pair(left, sense, len(places[sense])),
                )
    rest = fitting.rest(left.order)
    return fitting.note(
        **{
            f"order_{left.order}": {
                **_geometry(places),
                **_left(rest),
                "roll_before_Nm": abs(left.parts[ROLL]) * left.newton,
            }
        }
    )


def _places(left: Rest, wish: Wish) -> dict[int, tuple[complex, ...]]:
    """Where the shafts of each sense stand: `p_B = conj(p_A) V-/conj(V+)` adds no roll (A turns
    against the crank).
    """
    forward, backward = left.at("force", 1), left.at("force", -1)
    at = wish.at or ()
    if len(at) > 2:
        raise BalcliError(
            "--at: a pair of shafts has two places, first that of the shaft turning against the "
            "crank"
        )
    if not (forward and backward):
        if wish.roll:
            raise BalcliError(_one_sided(left))
        sense = 1 if forward else -1
        return {sense: (at[0], -at[0]) if at and at[0] else (0j,)}
    if wish.roll and len(at) == 2:
        raise BalcliError(
            "--roll zero fixes the place of the second shaft; give one --at, or two without --roll"
        )
    if len(at) == 2:
        return {-1: (at[0],), 1: (at[1],)}
    roll = left.parts[ROLL] + _moved(left) if wish.roll else 0j
    if wish.roll and not at:
        return _nearest(forward, backward, roll)
    first = at[0] if at else 0j
    return {-1: (first,), 1: (_second(first, forward, backward, roll),)}


def _second(first: complex, forward: complex, backward: complex, roll: complex) -> complex:
    """Place of the shaft turning with the crank, such that both together add minus the roll given
    (docs/theory.md where that is 0).

    The devices' roll is `Re c e^{in theta}` with `c = i conj(p_B) V+ - i p_A conj(V-)`, which is to
    be `-roll`.
    """
    return ((1j * roll + first * backward.conjugate()) / forward).conjugate()


def _nearest(forward: complex, backward: complex, roll: complex) -> dict[int, tuple[complex, ...]]:
    """The places nearest to the crank that make the roll vanish: least squares of one equation in
    p_A and conj(p_B).
    """
    size = abs(forward) ** 2 + abs(backward) ** 2
    wanted = 1j * roll  # conj(p_B) V+ - p_A conj(V-)
    return {
        -1: (-wanted * backward / size,),
        1: ((wanted * forward.conjugate() / size).conjugate(),),
    }


def _moved(left: Rest) -> complex:
    """What the roll gains if it is taken about the crank axis instead of the point of reference."""
    p = left.arm[0]
    return -1j * (p.conjugate() * left.at("force", 1) - p * left.at("force", -1).conjugate())


def _one_sided(left: Rest) -> str:
    part = "with" if left.at("force", 1) else "against"
    return (
        f"order {left.order}: its force turns {part} the crank alone, so that one shaft takes it "
        "and none is left to be placed "
        "for the roll; leave out --roll"
    )


def _geometry(places: dict[int, tuple[complex, ...]]) -> dict[str, Any]:
    """Distance from the crank axis and direction of the shafts, and the ratio of the radii (with
    the crank : against).
    """
    found: dict[str, Any] = {}
    for sense, name in ((1, "with_crank"), (-1, "against_crank")):
        for place in places.get(sense, ())[:1]:
            found |= {
                f"radius_{name}_mm": abs(place) * 1e3,
                f"direction_{name}_deg": math.degrees(cmath.phase(place)),
            }
    if len(places) == 2 and (against := abs(places[-1][0])):
        found["radius_ratio"] = abs(places[1][0]) / against
    return found


def _why_pair(left: Rest, sense: int, count: int) -> str:
    halves = (
        ", in two halves on opposite sides of the crank so that no roll is added"
        if count == 2
        else ""
    )
    return why_shaft(left, sense, 1) + halves


def _why_couple(left: Rest, sense: int) -> str:
    turning = "with" if sense > 0 else "against"
    return (
        f"Order {left.order} moment turning {turning} the crank: two "
        f"opposite eccentrics on a shaft at {sense * left.order:+d} times crank speed make the "
        "opposite moment and no force"
    )


def _left(rest: Rest) -> dict[str, float]:
    """Moments and roll that remain at this order."""
    return {
        "moment_left_Nm": sum(abs(rest.at("moment", s)) for s in (1, -1)) * rest.newton,
        "roll_left_Nm": abs(rest.parts[ROLL]) * rest.newton,
    }


# ------------------------------------------------------------------ places along the crank
def _along(engine: Engine, wish: Wish, left: Rest, sense: int) -> float:
    """z as asked for, or where the force acts, as near as the engine's length allows."""
    if wish.position is not None:
        return wish.position
    bounds = planes.length(engine)
    found = planes.single(left, sense, bounds)
    if found is not None:
        return found
    z = left.arm[1] + (left.at("moment", sense) / left.at("force", sense)).real
    return round(min(max(z, bounds[0]), bounds[1]), 9)


def _distance(left: Rest, z: float) -> float:
    """From the point along the crank where the force against it acts to z; less than a nanometre is
    rounding.
    """
    found = z - left.arm[1] - (left.at("moment", -1) / left.at("force", -1)).real
    return found if abs(found) > 1e-9 else 0.0


def _weight_planes(engine: Engine, left: Rest) -> tuple[float, ...]:
    where = planes.of_part(engine, left, 1)
    return planes.ends(engine) if where and len(set(engine.throws_m)) > 1 else where


def _two_planes(engine: Engine, wish: Wish) -> tuple[float, float]:
    if wish.planes is None or wish.planes == "ends":
        low, high = planes.ends(engine)
    elif isinstance(wish.planes, tuple) and len(wish.planes) == 2:
        low, high = wish.planes
    else:
        raise BalcliError(
            "--planes: opposite eccentrics stand in two planes; give ends, or two places along z "
            "in mm, such as -200,200"
        )
    if low == high:
        raise BalcliError(f"--planes: {SAME_PLACE}")
    return low, high


def _only(wish: Wish) -> complex:
    if wish.at is not None and len(wish.at) > 1:
        raise BalcliError("--at: this scheme has one place; give it once")
    return wish.at[0] if wish.at else 0j


__all__ = ["couple_shaft", "four_shaft", "single_shaft", "slider", "two_shaft"]
