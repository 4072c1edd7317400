"""Why a device is fitted, in one sentence: what it cancels, and why nothing less will do. Sizes
stand in the tables, in the reader's units.
"""

from __future__ import annotations

from .residual import Residual


def explain_counterweights(residual: Residual) -> str:
    """Of weights for the part of order 1 that turns with the crank."""
    both = residual.force(1) and residual.moment(1)
    return (
        f"{_name(residual, 1)} turning with the crank: counterweights turn with it too and cancel "
        f"{'both' if both else 'it'}"
    )


def explain_shaft(residual: Residual, sense: int, count: int) -> str:
    """Of this many eccentrics on one shaft that take all that turns in this sense."""
    two = "eccentrics in two planes" if residual.force(sense) else "two opposite eccentrics"
    return (
        f"{_name(residual, sense)} turning {_turning(sense)} the crank: nothing on the crankshaft "
        f"can cancel it; {'one eccentric' if count == 1 else two} on a shaft at "
        f"{sense * residual.order:+d} times crank speed can"
    )


def explain_one_eccentric(
    residual: Residual, sense: int, whole: bool, more: str, halves: bool = False
) -> str:
    """Of one eccentric for the force that turns in this sense, or of two halves of it.

    Args:
        whole: whether it takes the moment that turns so, too.
        more: what would take the moment that stays otherwise.
    """
    what = _name(residual, sense) if whole else f"Order {residual.order} force"
    by_weights = "the scheme counterweights would cancel it without a shaft"
    on_crank = "nothing on the crankshaft can cancel it"
    reason = (
        f"{what} turning {_turning(sense)} the crank: "
        f"{by_weights if sense * residual.order == 1 else on_crank}; one "
        f"eccentric on a shaft at {sense * residual.order:+d} times crank speed can"
    )
    if halves:
        reason += ", in two halves on opposite sides of the crank so that no roll is added"
    return reason if whole else f"{reason}; a moment stays, which {more}"


def explain_couple(residual: Residual, sense: int) -> str:
    """Of two opposite eccentrics for the moment that turns in this sense."""
    needless = "; the scheme counterweights would do so without a shaft"
    return (
        f"Order {residual.order} moment turning {_turning(sense)} the crank: two opposite "
        f"eccentrics on a shaft at {sense * residual.order:+d} times crank speed make the opposite "
        "moment and no force, wherever the shaft stands"
        f"{needless if sense * residual.order == 1 else ''}"
    )


def explain_sliders(residual: Residual) -> str:
    """Of two sliders for the force."""
    return (
        f"Order {residual.order} force: sliders driven at {residual.order} times crank speed along "
        "the axes of its ellipse, of sizes |V+| + |V-| and ||V+| - |V-||"
    )


def _name(residual: Residual, sense: int) -> str:
    """What turns at this order in this sense."""
    force = "force" if residual.force(sense) else ""
    moment = "moment" if residual.moment(sense) else ""
    return f"Order {residual.order} {' and '.join(filter(None, (force, moment)))}"


def _turning(sense: int) -> str:
    return "with" if sense > 0 else "against"
