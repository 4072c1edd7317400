"""The schemes `single-shaft` and `couple-shaft`: balancer shafts for any order."""

from __future__ import annotations

from collections.abc import Sequence

from ..engine.build import Engine
from ..errors import BalcliError
from .effects import Slot
from .fitting import Fitting
from .options import SchemeOptions
from .planes import (
    choose_plane,
    find_counterweight_planes,
    locate_force,
    read_two_planes,
    takes_moment,
)
from .reasons import explain_counterweights, explain_couple, explain_one_eccentric, explain_shaft
from .remedy import Remedy
from .residual import (
    BACKWARD,
    BACKWARD_FORCE,
    BACKWARD_MOMENT,
    FORWARD,
    FORWARD_FORCE,
    FORWARD_MOMENT,
    Residual,
    choose_residual,
)

_ROUNDING_M = 1e-9


def size_single_shaft(engine: Engine, options: SchemeOptions) -> Remedy:
    """One shaft at -N for what of order N turns against the crank; at N = 1 counterweights take
    what turns with it.

    One eccentric takes the force; its axial distance from the force leaves a couple, which the
    details state, and unless a place is asked for, it stands where that couple is smallest. Two, in
    the planes asked for, take the moment as well.
    """
    two = options.planes is not None
    if two and options.position is not None:
        raise BalcliError("--planes and --position both say where along the shaft: give one")
    residual = choose_residual(engine, options, ("force", "moment") if two else ("force",), (-1,))
    fitting = Fitting.start(engine, "single-shaft", residual.order, residual.note)
    if residual.order == 1:
        planes = find_counterweight_planes(engine, residual)
        weights = [Slot("counterweight", 1, 1, z) for z in planes]
        fitting = fitting.cancel(weights, FORWARD, explain_counterweights(residual))
    if two:
        fitting = _add_two_eccentrics(fitting, residual, options)
    else:
        fitting = _add_one_eccentric(fitting, residual, options)
    fitting = fitting.describe_roll(residual)
    if residual.order > 1:
        left = fitting.find_residual(residual.order)
        fitting = fitting.add_details(force_with_crank_left_N=left.size(FORWARD_FORCE))
    return fitting.remedy


def _add_one_eccentric(fitting: Fitting, residual: Residual, options: SchemeOptions) -> Fitting:
    z = choose_plane(fitting.engine, options, residual, -1)
    slot = Slot("shaft", residual.order, -1, z, options.read_place())
    more = "eccentrics in two planes take, too"
    reason = explain_one_eccentric(residual, -1, takes_moment(residual, -1, z), more)
    fitting = fitting.cancel([slot], [BACKWARD_FORCE], reason)
    left, distance = fitting.find_residual(residual.order), z - locate_force(residual, -1)
    return fitting.add_details(
        couple_left_Nm=left.size(BACKWARD_MOMENT),
        axial_distance_mm=1e3 * (distance if abs(distance) > _ROUNDING_M else 0.0),
    )


def _add_two_eccentrics(fitting: Fitting, residual: Residual, options: SchemeOptions) -> Fitting:
    planes, place = read_two_planes(fitting.engine, options), options.read_place()
    slots = [Slot("shaft", residual.order, -1, z, place) for z in planes]
    return fitting.cancel(slots, BACKWARD, explain_shaft(residual, -1, 2))


def size_couple_shaft(engine: Engine, options: SchemeOptions) -> Remedy:
    """Shafts at +N and -N, each with two opposite eccentrics in two planes, for the moment of order
    N; where it turns in one sense alone, one of them.
    """
    residual = choose_residual(engine, options, ("moment",))
    low, high = read_two_planes(engine, options)
    places = _read_places(options, [sense for sense in (-1, 1) if residual.moment(sense)])
    fitting = Fitting.start(engine, "couple-shaft", residual.order, residual.note)
    for sense in sorted(places, reverse=True):
        slots = [Slot("shaft", residual.order, sense, z, places[sense]) for z in (low, high)]
        unbalance = residual.moment(sense) / (high - low)
        fitting = fitting.add(slots, (unbalance, -unbalance), explain_couple(residual, sense))
    left = fitting.find_residual(residual.order)
    return fitting.add_details(
        moment_left_Nm=left.size(FORWARD_MOMENT, BACKWARD_MOMENT),
        force_left_N=left.size(FORWARD_FORCE, BACKWARD_FORCE),
    ).remedy


def _read_places(options: SchemeOptions, senses: Sequence[int]) -> dict[int, complex]:
    """Where the shafts of these senses stand, as asked for in this order; what is not said is free,
    and counts as on the crank axis.
    """
    at = options.at or ()
    if len(at) > len(senses):
        told = "two shafts" if len(senses) == 2 else "one shaft"
        raise BalcliError(f"--at: this moment takes {told}; give no more places")
    return {sense: at[k] if k < len(at) else 0j for k, sense in enumerate(senses)}
