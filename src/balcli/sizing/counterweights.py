"""The scheme `counterweights`: weights on the crankshaft for all of order 1 that turns with it."""

from __future__ import annotations

from ..engine.build import Engine
from ..errors import BalcliError
from .effects import Slot, size_unbalances
from .fitting import Fitting
from .options import SchemeOptions
from .planes import SAME_PLACE, find_counterweight_planes, find_length, read_planes
from .reasons import explain_counterweights
from .remedy import Remedy
from .residual import FORWARD, FORWARD_FORCE, FORWARD_MOMENT, NothingToBalanceError, Residual


def size_counterweights(engine: Engine, options: SchemeOptions) -> Remedy:
    """Counterweights for the force and the moment of order 1 that turn with the crank, in the
    planes asked for; in a single plane as well as it can be done, or, where moments are not known,
    for the force alone.

    Raises:
        BalcliError: another order is asked for, or the planes cannot take the moment.
        NothingToBalanceError: nothing of order 1 turns with the crank.
    """
    if options.order not in (None, 1):
        raise BalcliError(
            f"order {options.order} cannot be cancelled by anything on the crankshaft, which turns "
            "at order 1: use a shaft scheme"
        )
    fitting = Fitting.start(engine, "counterweights", 1)
    residual = fitting.find_residual(1)
    if not any(residual.parts[part] for part in FORWARD):
        raise NothingToBalanceError(_tell_not_needed(engine))
    if options.planes is None:
        planes = find_counterweight_planes(engine, residual)
    else:
        planes = read_planes(engine, options)
    slots = [Slot("counterweight", 1, 1, z) for z in planes]
    if len(slots) > 1 or not engine.places_known:
        parts = FORWARD if len(slots) > 1 else [FORWARD_FORCE]
        remedy = fitting.cancel(slots, parts, explain_counterweights(residual)).remedy
    else:
        remedy = _compromise(fitting, slots, residual)
    if not remedy.devices and not remedy.note:  # dust was left
        raise NothingToBalanceError(_tell_not_needed(engine))
    return remedy


def _tell_not_needed(engine: Engine) -> str:
    what = "force or moment" if engine.places_known else "force"
    return f"there is no free {what} of order 1 turning with the crank: no counterweight is needed"


def _compromise(fitting: Fitting, slots: list[Slot], residual: Residual) -> Remedy:
    """A weight in one plane, which cannot take a moment that acts elsewhere.

    A plane near the point of reference has hardly an arm there: a weight for the moment would leave
    a far larger force, so that the moment counts by the engine's arms, too.
    """
    fit = size_unbalances(slots, residual, FORWARD, _find_engine_arm(fitting.engine, residual))
    fitting = fitting.add(
        slots,
        fit.unbalances,
        "One plane takes the force and moment of order 1 turning with the crank as well as "
        "one can (least squares of force, and of moment over the longest arm of weight, rods and "
        "crank radius)",
    )
    left = fitting.find_residual(1)
    fitting = fitting.add_details(
        force_with_crank_left_N=left.size(FORWARD_FORCE),
        moment_with_crank_left_Nm=left.size(FORWARD_MOMENT),
    )
    return fitting.remedy._replace(note=SAME_PLACE if left.moment(1) else "")


def _find_engine_arm(engine: Engine, residual: Residual) -> float:
    """How far the engine goes from the point of reference along the crank, m; the crank radius at
    the least.
    """
    ends = (abs(z - residual.reference.z) for z in find_length(engine))
    return max(float(engine.cylinders.radius), *ends)
