"""The schemes `single-shaft` and `couple-shaft`: balancer shafts for any order."""

from __future__ import annotations

from ..engine.build import Engine
from .details import Detail
from .effects import Slot
from .fitting import Fitting
from .options import SchemeOptions
from .planes import (
    choose_plane,
    find_counterweight_planes,
    locate_force,
    read_two_planes,
)
from .reasons import explain_counterweights, explain_couple, explain_shaft
from .remedy import Remedy
from .residual import (
    BACKWARD_FORCE,
    BACKWARD_MOMENT,
    FORWARD,
    FORWARD_FORCE,
    FORWARD_MOMENT,
    ROLL,
    choose_residual,
)


def size_single_shaft(engine: Engine, options: SchemeOptions) -> Remedy:
    """One shaft at -N for the force of order N that turns against the crank; at N = 1
    counterweights take what turns with it.

    The axial distance of the shaft from the force leaves a couple, which the details state; unless
    a place is asked for, it stands where that couple is smallest.
    """
    residual = choose_residual(engine, options, "force", (-1,))
    fitting = Fitting.start(engine, "single-shaft", residual.order)
    if residual.order == 1:
        planes = find_counterweight_planes(engine, residual)
        weights = [Slot("counterweight", 1, 1, z) for z in planes]
        fitting = fitting.cancel(weights, FORWARD, explain_counterweights(residual))
    z = choose_plane(engine, options, residual, -1)
    slot = Slot("shaft", residual.order, -1, z, options.read_place())
    fitting = fitting.cancel([slot], [BACKWARD_FORCE], explain_shaft(residual, -1, 1))
    left = fitting.find_residual(residual.order)
    fitting = fitting.note(
        Detail("couple left", "moment", left.size(BACKWARD_MOMENT)),
        Detail("axial distance", "length", _round_off(z - locate_force(residual, -1))),
        Detail("roll left", "moment", left.size(ROLL)),
    )
    if residual.order > 1:
        fitting = fitting.note(Detail("force with crank left", "force", left.size(FORWARD_FORCE)))
    return fitting.remedy


def size_couple_shaft(engine: Engine, options: SchemeOptions) -> Remedy:
    """Shafts at +N and -N, each with two opposite eccentrics in two planes, for the moment of order
    N.
    """
    residual = choose_residual(engine, options, "moment")
    low, high = read_two_planes(engine, options)
    place = options.read_place()
    fitting = Fitting.start(engine, "couple-shaft", residual.order)
    for sense in (1, -1):
        slots = [Slot("shaft", residual.order, sense, z, place) for z in (low, high)]
        unbalance = residual.moment(sense) / (high - low)
        fitting = fitting.add(slots, (unbalance, -unbalance), explain_couple(residual, sense))
    left = fitting.find_residual(residual.order)
    return fitting.note(
        Detail("moment left", "moment", left.size(FORWARD_MOMENT, BACKWARD_MOMENT)),
        Detail("force left", "force", left.size(FORWARD_FORCE, BACKWARD_FORCE)),
    ).remedy


def _round_off(length: float) -> float:
    """A length in m; less than a nanometre is rounding."""
    return length if abs(length) > 1e-9 else 0.0
