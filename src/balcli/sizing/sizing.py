"""Size counterweights, balancer shafts and sliders by scheme (`size`)."""

from __future__ import annotations

import cmath
from collections.abc import Callable

from ..core.phasors import wrap_degrees
from ..engine.engine import Engine, Placed, refuse_geared
from ..errors import MOMENTS_UNKNOWN, ArgumentError, BalcliError
from .factor import size_by_factor
from .fitting import (
    Fitting,
    Slot,
    explain_counterweights,
    size_unbalances,
)
from .ladder import find_ladder
from .minimax import size_ellipse, size_minimax
from .options import SchemeOptions
from .planes import (
    SAME_PLACE,
    choose_plane,
    find_carriers,
    find_ends,
    find_length,
    measure_direction,
    read_planes,
)
from .remedy import Remedy
from .residual import (
    BACKWARD,
    FORCE,
    FORWARD_FORCE,
    NothingToBalanceError,
    OnlySmallError,
    Residual,
    choose_residual,
    find_residual,
    list_parts,
)
from .shafts import (
    size_compensator,
    size_couple_shaft,
    size_four_shaft,
    size_single_shaft,
    size_two_shaft,
)
from .single_cylinder import size_eccentric_slider, size_oldham
from .steps import add_at_throws, size_complete

_OF_ONE_CRANK = ("minimax", "ellipse", "eccentric-slider", "oldham")


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
            fitting = _size_on_crank(fitting, crank, options, residual)
    remedy = fitting.remedy
    if not remedy.devices and not remedy.note:  # only negligible weights
        raise NothingToBalanceError(_tell_not_needed(engine))
    return remedy


def _size_on_crank(
    fitting: Fitting, crank: Placed, options: SchemeOptions, residual: Residual
) -> Fitting:
    """Return the fitting with weights on a crank for the part that turns with this crank."""
    engine = fitting.engine
    parts = list_parts(crank.ratio)
    planes = find_ends(crank.engine) if options.planes is None else read_planes(engine, options)
    slots = [Slot.on_crank(crank, z) for z in planes]
    if len(slots) == 1 and engine.places_known:
        return _compromise(fitting, slots, residual)
    reason = explain_counterweights(residual, crank.ratio)
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
    what = "force or moment" if engine.places_known else "force"
    left = find_residual(engine, 1)
    against = any(left.parts[part] for part in BACKWARD)
    order = "The part of order 1 that turns with the crank" if against else "Order 1"
    return f"{order} is balanced already: counterweights change no free {what}"


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


def size_sliders(engine: Engine, options: SchemeOptions) -> Remedy:
    """Fit two reciprocating masses along the axes of the ellipse that the force of order n runs on.
    Their unbalances are `(|V+| + |V-|)/(n^2 omega^2)` and `||V+| - |V-||/(n^2 omega^2)`; V+ and V-
    are the rotating vectors of this force, with and against the crank, omega is the crank speed.

    By default, the sliders are where the larger of the two rotating forces acts.
    """
    residual = choose_residual(engine, options, ("force",))
    forward = residual.force(1)
    backward = residual.force(-1)
    stronger = 1 if abs(forward) >= abs(backward) else -1
    z = choose_plane(engine, options, residual, stronger)
    place = options.read_place()
    axis = float(wrap_degrees(measure_direction(cmath.sqrt(forward * backward)), 180))
    directions = (axis, axis + 90 if axis <= 0 else axis - 90)
    slots = [Slot("slider", residual.order, 0, z, place, direction) for direction in directions]
    fit = size_unbalances(slots, residual, FORCE)
    rounding = 2 * residual.noise[FORWARD_FORCE]
    unbalances = [u if abs(u) > rounding else 0j for u in fit.unbalances]
    fitting = Fitting.start(engine, "slider", residual.order)
    reason = (
        f"Order {residual.order} force: sliders driven at {residual.order} times crank speed along "
        "the axes of its ellipse cancel it (half axes |V+| + |V-| and ||V+| - |V-||)"
    )
    fitting = fitting.add(slots, unbalances, reason)
    return fitting.describe_left(residual.order, "moment_left_Nm").describe_roll(residual).remedy


def _size_auto(engine: Engine, options: SchemeOptions) -> Remedy:
    return find_ladder(engine, options.read_small()).fit()


def _size_step(engine: Engine, options: SchemeOptions) -> Remedy:
    return find_ladder(engine, options.read_small()).fit(options.step)


def _size_complete(engine: Engine, _: SchemeOptions) -> Remedy:
    return size_complete(engine)


SIZE: dict[str, Callable[[Engine, SchemeOptions], Remedy]] = {
    "auto": _size_auto,
    "complete": _size_complete,
    "step": _size_step,
    "counterweights": size_counterweights,
    "factor": size_by_factor,
    "minimax": size_minimax,
    "ellipse": size_ellipse,
    "single-shaft": size_single_shaft,
    "two-shaft": size_two_shaft,
    "four-shaft": size_four_shaft,
    "couple-shaft": size_couple_shaft,
    "compensator": size_compensator,
    "slider": size_sliders,
    "eccentric-slider": size_eccentric_slider,
    "oldham": size_oldham,
}


def size(engine: Engine, scheme: str = "auto", options: SchemeOptions | None = None) -> Remedy:
    """Return the devices that a scheme fits to an engine. If there is nothing to balance, the
    remedy has no devices, and a note gives the reason.

    Args:
        engine: One engine, not an array of variants.
        scheme: Name of a scheme in `SCHEMES`.
        options: Options of the scheme.

    Raises:
        BalcliError: The scheme is unknown, does not take an option, or cannot meet the options.
    """
    asked = options or SchemeOptions()
    asked.check(scheme)
    if scheme in _OF_ONE_CRANK:
        refuse_geared(engine)
    try:
        return SIZE[scheme](engine, asked)
    except NothingToBalanceError as reason:
        return Remedy(scheme, asked.order, note=reason.text, details=reason.details)
    except OnlySmallError as error:
        raise error.within(scheme) from None
