"""Size counterweights, balancer shafts and sliders by scheme (`size`)."""

from __future__ import annotations

import cmath
from collections.abc import Callable

from ..core.phasors import wrap_degrees
from ..engine.engine import Engine, refuse_geared
from .factor import size_by_factor
from .fitting import (
    Fitting,
    Slot,
    size_unbalances,
)
from .ladder import find_ladder
from .minimax import size_ellipse, size_minimax
from .options import SchemeOptions
from .placed_steps import fit_steps, size_complete
from .planes import (
    choose_plane,
    measure_direction,
)
from .remedy import Remedy
from .residual import (
    FORCE,
    FORWARD_FORCE,
    NothingToBalanceError,
    OnlySmallError,
    choose_residual,
)
from .shafts import (
    size_compensator,
    size_couple_shaft,
    size_four_shaft,
    size_single_shaft,
    size_two_shaft,
)
from .single_cylinder import size_eccentric_slider, size_oldham
from .weights import size_counterweights

_OF_ONE_CRANK = ("minimax", "ellipse", "eccentric-slider", "oldham")


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
    return fit_steps(engine, find_ladder(engine, options.read_small()), options)


def _size_step(engine: Engine, options: SchemeOptions) -> Remedy:
    return _size_auto(engine, options)


SIZE: dict[str, Callable[[Engine, SchemeOptions], Remedy]] = {
    "auto": _size_auto,
    "complete": size_complete,
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
