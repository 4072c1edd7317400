"""Compute balancer shafts for any order: the schemes `single-shaft` and `couple-shaft`, and the
schemes `two-shaft` and `four-shaft` with pairs of shafts that turn in opposite directions. The
scheme `compensator` has such pairs far from the engine, where their force makes a moment.

A shaft at +N turns with the crank at N times crank speed, a shaft at -N turns against it. In a
pair, shaft A turns against the crank and cancels V-, the vector of the force of order n that turns
against the crank; shaft B turns with the crank and cancels V+, the vector that turns with it. p_A
and p_B are the positions x + iy of the shafts from the crank axis, theta is the crank angle. The
shafts cause the roll `Re c e^{in theta}` with `c = i conj(p_B) V+ - i p_A conj(V-)`.
"""

from __future__ import annotations

import cmath
import math

from ..engine.engine import Engine
from ..errors import MOMENTS_UNKNOWN, ArgumentError, BalcliError
from .fitting import (
    Fitting,
    Slot,
    explain_shaft,
    tell_moment,
)
from .options import SchemeOptions
from .pairs import (
    Places,
    find_distance,
    find_moment_about_y,
    find_wanted_roll,
    place_forces,
    place_pair,
)
from .planes import (
    as_millimetres,
    choose_plane,
    find_carriers,
    locate_force,
    read_two_planes,
)
from .remedy import Remedy
from .residual import (
    BACKWARD,
    FORCE,
    NothingToBalanceError,
    Residual,
    choose_residual,
    find_residual,
    find_scales,
    find_size,
    is_small,
    refuse_small,
)
from .steps import add_at_ends, add_compensators

_ROUNDING_M = 1e-9


def size_single_shaft(engine: Engine, options: SchemeOptions) -> Remedy:
    """Fit one shaft at -N for the part of order N that turns against the crank; for N = 1 also
    counterweights for the part that turns with the crank.

    By default, one eccentric cancels the force. Its axial distance from the force leaves a
    longitudinal moment, which the details list. Unless a position is given, the eccentric is placed
    where this moment is smallest. Two eccentrics in given planes also cancel the moment.
    """
    two = options.planes is not None
    if two and options.position is not None:
        raise ArgumentError("{planes} and {position} both place the eccentrics: give one of them")
    residual = choose_residual(engine, options, ("force", "moment") if two else ("force",), (-1,))
    fitting = Fitting.start(engine, "single-shaft", residual.order)
    if residual.order == 1:
        fitting = add_at_ends(fitting, residual)
    planes: tuple[float, ...] = read_two_planes(engine, options) if two else ()
    planes = planes or (choose_plane(engine, options, residual, -1),)
    cure = "eccentrics in two planes cancel"
    stays = "" if two else tell_moment(residual, -1, planes[0], cure)
    slots = [Slot("shaft", residual.order, -1, z, options.read_place()) for z in planes]
    reason = explain_shaft(residual, -1, len(slots), stays)
    fitting = fitting.cancel(slots, BACKWARD[: len(slots)], reason)
    if not two:
        distance = planes[0] - locate_force(residual, -1)
        distance_mm = 1e3 * distance if abs(distance) > _ROUNDING_M else 0.0
        fitting = fitting.describe_left(residual.order, "moment_left_Nm")
        fitting = fitting.add_details(axial_distance_mm=distance_mm)
    fitting = fitting.describe_roll(residual)
    if residual.order > 1:
        fitting = fitting.describe_left(residual.order, "force_with_crank_left_N")
    return fitting.remedy


def size_couple_shaft(engine: Engine, options: SchemeOptions) -> Remedy:
    """Fit shafts at +N and -N for the moment of order N. Each shaft has two opposite eccentrics in
    two planes. If the moment turns in only one direction, fit only one shaft. For N = 1, the part
    of order 1 that turns with a crank is cancelled by counterweights in its end planes.
    """
    residual = choose_residual(engine, options, ("moment",))
    low, high = read_two_planes(engine, options)
    fitting = Fitting.start(engine, "couple-shaft", residual.order)
    senses = {sense for sense in (-1, 1) if residual.moment(sense)}
    if residual.order == 1:
        on_cranks = senses.intersection(find_carriers(engine))
        for sense in sorted(on_cranks, reverse=True):
            fitting = add_at_ends(fitting, residual, sense)
        senses -= on_cranks
    at = options.at or ()
    if len(at) > len(senses):
        shafts = {0: "no shaft", 1: "one shaft", 2: "two shafts"}
        raise ArgumentError(
            "{at}: this moment takes {shafts}; give no further places", shafts=shafts[len(senses)]
        )
    moment = residual._replace(parts={**residual.parts, **dict.fromkeys(FORCE, 0j)})
    against_first = sorted(senses)
    placed = [*zip(against_first, (*at, 0j, 0j), strict=False)]
    for sense, place in reversed(placed):
        slots = [Slot("shaft", residual.order, sense, z, place) for z in (low, high)]
        unbalance = residual.moment(sense) / (high - low)
        reason = explain_shaft(moment, sense, len(slots))
        fitting = fitting.add(slots, (unbalance, -unbalance), reason)
    return fitting.describe_left(residual.order, "moment_left_Nm", "force_left_N").remedy


def size_two_shaft(engine: Engine, options: SchemeOptions) -> Remedy:
    """Fit shafts at +N and -N for the force of order N. They are placed such that they add no roll,
    or (option `roll`) such that no inertia roll remains.
    """
    try:
        residual = choose_residual(engine, options, ("force",))
    except NothingToBalanceError as reason:
        if options.roll:
            raise ArgumentError("{reason}; leave out {roll}", reason=reason.text) from None
        raise
    fitting = Fitting.start(engine, "two-shaft", residual.order)
    if residual.order == 1:
        fitting = fitting.balance_rotating()
        residual = fitting.find_residual(1)
        if not residual.size(*FORCE):  # no reciprocating mass: counterweights suffice
            return fitting.remedy
    return _add_pair(fitting, residual, options).remedy


def size_compensator(engine: Engine, options: SchemeOptions) -> Remedy:
    """Fit compensators, at one place or fore and aft, for the moment of order N about y, which the
    forces along x make. Each compensator is a pair of equal masses at +N and -N that make a force
    along x.

    If `m` is the amplitude of this moment, a single compensator at z makes the force `-m/(z -
    z_ref)`, where z_ref is the z of the point of reference. The first of two compensators, at
    z1, makes the force `-m/(z1 - z2)`, the second, at z2, the opposite force.
    """
    if options.position is None:
        raise ArgumentError("{scheme} compensator: give {position} Z, or Z,Z for fore and aft")
    if not engine.places_known:
        raise BalcliError(MOMENTS_UNKNOWN)
    order = options.order or 2
    position = options.position
    places = position if isinstance(position, tuple) else (position,)
    residual = find_residual(engine, order)
    moment = find_moment_about_y(residual)
    if not moment:
        raise NothingToBalanceError(f"Order {order} has no moment about y: nothing to compensate")
    forces = place_forces(-moment, places, residual.reference.z)
    fitting = Fitting.start(engine, "compensator", order)
    fitting = add_compensators(fitting, residual, places, options.read_place())
    newtons = residual.newtons_per_kg_m
    left = find_moment_about_y(fitting.find_residual(order))
    return fitting.remedy.add_details(
        moment_before_Nm=abs(moment) * newtons,
        moment_after_Nm=abs(left) * newtons,
        moment_left_per_degree_Nm=2 * math.sin(math.radians(0.5)) * abs(moment) * newtons,
        force_introduced_N=abs(sum(forces.values())) * newtons,
        compensators=[
            {"position_mm": as_millimetres(z), "force_N": abs(force) * newtons}
            for z, force in forces.items()
        ],
    )


def size_four_shaft(engine: Engine, options: SchemeOptions) -> Remedy:
    """Fit shafts at +1, -1, +2 and -2 for the forces of orders 1 and 2."""
    fitting = Fitting.start(engine, "four-shaft").balance_rotating()
    residuals = [fitting.find_residual(order) for order in (1, 2)]
    scales = find_scales(engine)
    least = options.read_small()
    forces = [one for one in residuals if not is_small(find_size(one, FORCE, scales), least)]
    if not forces and any(one.size(*FORCE) for one in residuals):
        raise refuse_small(FORCE, residuals, scales, least)
    if not forces:
        raise NothingToBalanceError("there is no free force of orders 1 and 2: nothing to balance")
    for residual in forces:
        fitting = _add_pair(fitting, residual, options)
    return fitting.remedy


def _add_pair(fitting: Fitting, residual: Residual, options: SchemeOptions) -> Fitting:
    """Return the fitting with shafts at +N and -N for the force of this order. If the force turns
    in only one direction, add one shaft, or its two halves.
    """
    places = _choose_places(residual, options)
    for sense, standing in places.items():
        z = choose_plane(fitting.engine, options, residual, sense)
        slots = [Slot("shaft", residual.order, sense, z, place) for place in standing]
        stays = tell_moment(residual, sense, z, "needs eccentrics in two planes")
        reason = explain_shaft(residual, sense, 1, stays, halves=len(slots) > 1)
        share = -residual.force(sense) / len(slots)
        fitting = fitting.add(slots, [share] * len(slots), reason)
    group = f"order_{residual.order}"
    fitting = fitting.add_details(group, **_describe_places(places))
    distance = find_distance(residual, places) if options.roll else None
    if distance is not None:
        fitting = fitting.add_details(group, distance_mm=1e3 * distance)
    fitting = fitting.describe_left(residual.order, "moment_left_Nm", group=group)
    return fitting.describe_roll(residual, group)


def _choose_places(residual: Residual, options: SchemeOptions) -> Places:
    """Return the positions of the shafts for each direction of rotation. Positions that are not
    given are chosen such that the pair adds no roll, or (option `roll`) such that no roll remains.

    A force that turns in only one direction needs one shaft on the crank axis, or two half shafts:
    one at the given position, one opposite to it.
    """
    at = options.at or ()
    forward = residual.force(1)
    backward = residual.force(-1)
    if len(at) > 2:
        raise ArgumentError(
            "{at}: a pair of shafts has two places; the first is for the shaft against the crank"
        )
    if not (forward and backward):
        if options.roll:
            way = "with" if forward else "against"
            raise ArgumentError(
                "order {order}: its force turns only {way} the crank, so one shaft cancels it; "
                "leave out {roll}",
                order=residual.order,
                way=way,
            )
        place = at[0] if at else 0j
        sense = 1 if forward else -1
        return {sense: (place, -place) if place else (0j,)}
    if len(at) == 2 and options.roll:
        raise ArgumentError("{roll} zero places the second shaft; give one {at}")
    if len(at) == 2:
        return {-1: (at[0],), 1: (at[1],)}
    wanted = find_wanted_roll(residual) if options.roll else 0j
    return place_pair(residual, wanted, at[0] if at else None)


def _describe_places(places: Places) -> dict[str, float]:
    """Return the distance from the crank axis, and the direction, of the shaft for each direction
    of rotation, and the ratio of the two distances (shaft with the crank over shaft against it).
    """
    details = {}
    for sense, name in ((1, "with_crank"), (-1, "against_crank")):
        for place in places.get(sense, ())[:1]:
            details[f"radius_{name}_mm"] = 1e3 * abs(place)
            if place:  # a shaft on the crank axis has no direction
                details[f"direction_{name}_deg"] = math.degrees(cmath.phase(place))
    if len(places) == 2 and (against := abs(places[-1][0])):
        details["radius_ratio"] = abs(places[1][0]) / against
    return details
