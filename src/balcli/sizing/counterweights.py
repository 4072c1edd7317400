"""The scheme `counterweights`: weights on the crankshaft for all of order 1 that turns with it."""

from __future__ import annotations

from ..engine.build import Engine
from ..errors import BalcliError
from .details import Detail
from .effects import Slot, size_unbalances
from .fitting import Fitting
from .options import SchemeOptions
from .planes import SAME_PLACE, find_counterweight_planes, read_planes
from .reasons import explain_counterweights
from .remedy import Remedy
from .residual import FORWARD, FORWARD_FORCE, FORWARD_MOMENT, NothingToBalanceError, Residual

NOT_NEEDED = (
    "there is no free force or moment of order 1 turning with the crank: no counterweight is needed"
)


def size_counterweights(engine: Engine, options: SchemeOptions) -> Remedy:
    """Counterweights for the force and the moment of order 1 that turn with the crank, in the
    planes asked for; in a single plane as well as it can be done.

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
        raise NothingToBalanceError(NOT_NEEDED)
    if options.planes is None:
        planes = find_counterweight_planes(engine, residual)
    else:
        planes = read_planes(engine, options)
    slots = [Slot("counterweight", 1, 1, z) for z in planes]
    if len(slots) > 1:
        remedy = fitting.cancel(slots, FORWARD, explain_counterweights(residual)).remedy
    else:
        remedy = _compromise(fitting, slots, residual)
    if not remedy.devices and not remedy.note:  # dust was left
        raise NothingToBalanceError(NOT_NEEDED)
    return remedy


def _compromise(fitting: Fitting, slots: list[Slot], residual: Residual) -> Remedy:
    """A weight in one plane, which cannot take a moment that acts elsewhere."""
    fit = size_unbalances(slots, residual, FORWARD)
    fitting = fitting.add(
        slots,
        fit.unbalances,
        "One plane takes the force and moment of order 1 turning with the crank as well as "
        "one can (least squares of force, and of moment over its arm)",
    )
    left = fitting.find_residual(1)
    fitting = fitting.add_details(
        Detail("force with crank left", "force", left.size(FORWARD_FORCE)),
        Detail("moment with crank left", "moment", left.size(FORWARD_MOMENT)),
    )
    return fitting.remedy._replace(note=SAME_PLACE if left.moment(1) else "")
