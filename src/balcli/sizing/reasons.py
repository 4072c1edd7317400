"""Why a device is fitted, in one sentence: what it cancels, and why nothing less will do. Sizes
stand in the tables, in the reader's units.
"""

from __future__ import annotations

from .residual import BACKWARD, FORWARD, Residual


def explain_counterweights(residual: Residual) -> str:
    """Return why weights are fitted for the part of order 1 that turns with the crank."""
    both = "both" if residual.force(1) and residual.moment(1) else "it"
    turn = "counterweights turn with it too and cancel"
    return f"{_name(residual, 1)} turning with the crank: {turn} {both}"


def explain_shaft(residual: Residual, sense: int, count: int) -> str:
    """Return why this many eccentrics on one shaft take all that turns in this sense."""
    what = "eccentrics in two planes" if residual.force(sense) else "two opposite eccentrics"
    what = "one eccentric" if count == 1 else what
    return (
        f"{_name(residual, sense)} turning {_turning(sense)} the crank: nothing on the crankshaft "
        f"can cancel it; {what} {_on_shaft(residual, sense)} can"
    )


def explain_one_eccentric(
    residual: Residual, sense: int, whole: bool, more: str, halves: bool = False
) -> str:
    """Return why one eccentric is fitted for the force that turns in this sense, or two halves.

    Args:
        residual: What is left at the order.
        sense: Sense of rotation: 1 with the crank, -1 against it.
        whole: Whether it takes the moment that turns so, too.
        more: What would take the moment that stays otherwise.
        halves: Whether it is divided.
    """
    what = _name(residual, sense) if whole else f"Order {residual.order} force"
    why = "nothing on the crankshaft can cancel it"
    if sense * residual.order == 1:
        why = "the scheme counterweights would cancel it without a shaft"
    reason = (
        f"{what} turning {_turning(sense)} the crank: {why}; "
        f"one eccentric {_on_shaft(residual, sense)} can"
    )
    if halves:
        reason += ", in two halves on opposite sides of the crank so that no roll is added"
    return reason if whole else f"{reason}; a moment stays, which {more}"


def explain_couple(residual: Residual, sense: int) -> str:
    """Return why two opposite eccentrics are fitted for the moment that turns in this sense."""
    needless = "; the scheme counterweights would do so without a shaft"
    return (
        f"Order {residual.order} moment turning {_turning(sense)} the crank: two opposite "
        f"eccentrics {_on_shaft(residual, sense)} make the opposite moment and no force, wherever "
        f"the shaft stands{needless * (sense * residual.order == 1)}"
    )


def explain_sliders(residual: Residual) -> str:
    """Return why two sliders are fitted for the force."""
    return (
        f"Order {residual.order} force: sliders driven at {residual.order} times crank speed along "
        "the axes of its ellipse, of sizes |V+| + |V-| and ||V+| - |V-||"
    )


def _name(residual: Residual, sense: int) -> str:
    """Return what turns at this order in this sense."""
    kinds = [part.kind for part in (FORWARD if sense > 0 else BACKWARD) if residual.parts[part]]
    return f"Order {residual.order} {' and '.join(kinds)}"


def _on_shaft(residual: Residual, sense: int) -> str:
    return f"on a shaft at {sense * residual.order:+d} times crank speed"


def _turning(sense: int) -> str:
    return "with" if sense > 0 else "against"
