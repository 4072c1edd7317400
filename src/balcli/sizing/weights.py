"""Size counterweights in given planes: the scheme `counterweights`."""

from __future__ import annotations

from ..engine.engine import Engine, Placed, refuse_geared
from ..errors import MOMENTS_UNKNOWN, ArgumentError, BalcliError
from .fitting import (
    Fitting,
    Slot,
    explain_counterweights,
    size_unbalances,
)
from .options import SchemeOptions
from .planes import SAME_PLACE, explain_ends, find_carriers, find_ends, find_length, read_planes
from .remedy import Remedy
from .residual import BACKWARD, NothingToBalanceError, Residual, find_residual, list_parts
from .steps import add_at_throws


def size_counterweights(engine: Engine, options: SchemeOptions) -> Remedy:
    """Fit counterweights in the given planes for the force and moment of order 1 that turn with the
    crank. In a single plane, the weight is a compromise between force and moment. If moments are
    not known, only the force is cancelled.

    Raises:
        BalcliError: An order other than 1 is given, or the planes cannot take the moment.
        NothingToBalanceError: No part of order 1 turns with the crank.
    """
    if options.order not in (None, 1):
        raise BalcliError(f"order {options.order}: counterweights cancel only order 1; use shafts")
    fitting = Fitting.start(engine, "counterweights", 1)
    residual = fitting.find_residual(1)
    if options.planes == "throws":
        return _size_at_throws(fitting)
    for sense, crank in find_carriers(engine).items():
        if any(residual.parts[part] for part in list_parts(sense)):
            fitting = add_weights(fitting, crank, options, residual)
    remedy = fitting.remedy
    if not remedy.devices and not remedy.note:  # only negligible weights
        raise NothingToBalanceError(_tell_not_needed(engine))
    return remedy


def add_weights(
    fitting: Fitting, crank: Placed, options: SchemeOptions, residual: Residual
) -> Fitting:
    """Return the fitting with weights on a crank for the part that turns with this crank.

    Args:
        fitting: Devices so far.
        crank: The crank, moved to its position along z.
        options: Options, of which `planes` counts.
        residual: Residual of order 1.
    """
    engine = fitting.engine
    parts = list_parts(crank.ratio)
    planes = find_ends(crank.engine) if options.planes is None else read_planes(engine, options)
    slots = [Slot.on_crank(crank, z) for z in planes]
    if len(slots) == 1 and engine.places_known:
        return _compromise(fitting, slots, residual)
    places = explain_ends(crank.engine) if options.planes is None else ""
    reason = explain_counterweights(residual, crank.ratio, places)
    return fitting.cancel(slots, parts if len(slots) > 1 else parts[:1], reason)


def _size_at_throws(fitting: Fitting) -> Remedy:
    """Return weights at every throw.

    Raises:
        BalcliError: Positions of several throws are not known.
        NothingToBalanceError: No throw needs a weight.
    """
    engine = fitting.engine
    refuse_geared(engine)
    if not engine.places_known and len(engine.throws_m) > 1:
        raise ArgumentError("{planes} throws: {unknown}", unknown=MOMENTS_UNKNOWN)
    remedy = add_at_throws(fitting).remedy
    if not remedy.devices:
        raise NothingToBalanceError("Forces turning with the crank are balanced already")
    return remedy


def _tell_not_needed(engine: Engine) -> str:
    free_parts = "force or moment" if engine.places_known else "force"
    left = find_residual(engine, 1)
    against = any(left.parts[part] for part in BACKWARD)
    order = "The part of order 1 that turns with the crank" if against else "Order 1"
    return f"{order} is balanced already: counterweights change no free {free_parts}"


def _compromise(fitting: Fitting, slots: list[Slot], residual: Residual) -> Fitting:
    """Fit a weight in one plane, which cannot cancel a moment that acts elsewhere.

    In a plane near the point of reference, a weight against the moment would cause a far larger
    force. The moment is therefore divided by at least the longest arm of the engine.
    """
    engine = fitting.engine
    parts = list_parts(slots[0].sense)
    ends = (abs(z - residual.reference.z) for z in find_length(engine))
    fit = size_unbalances(slots, residual, parts, max(float(engine.cylinders.radius.max()), *ends))
    fitting = fitting.add(
        slots,
        fit.unbalances,
        "Best weight in one plane for the force and moment of order 1 turning with the crank "
        "(least squares of the force, and of the moment divided by the longest arm in the engine, "
        "at least the crank radius)",
    )
    fitting = fitting.describe_left(1, "force_with_crank_left_N", "moment_with_crank_left_Nm")
    stays = fitting.remedy.details["moment_with_crank_left_Nm"]
    return fitting._replace(remedy=fitting.remedy._replace(note=SAME_PLACE if stays else ""))
