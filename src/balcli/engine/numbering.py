"""Warn of firing orders, throws and splays that are allowed and unlikely."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ..core.phases import TURN
from ..file.doubt import Doubt
from ..file.firing_order import write_order
from ..file.model import EngineFile
from ..limits import SMALL
from .firing.candidates import Candidate, join_numbers
from .firing.fits import count_throws_from_first, list_gaps
from .firing.together import describe_together, list_together
from .firing.usual import list_tiers, write_rows
from .layout import TOLERANCE_DEG, bank_angles
from .parts import Parts

USUAL_ORDERS_OF_FIVE = ((1, 2, 4, 5, 3), (1, 3, 5, 4, 2))
USUAL_ORDERS = {  # in words, by the number of throws
    4: "1-3-4-2 or 1-2-4-3",
    5: " or ".join(map(write_order, USUAL_ORDERS_OF_FIVE)),
    6: "1-5-3-6-2-4 or 1-4-2-6-3-5",
    8: "1-6-2-5-8-3-7-4, or 1-5-2-6-4-8-3-7 with two cranks of fours at 90 deg",
}
USUAL_FLAT_ORDERS = {
    4: "1-4-3-2 bank by bank, 1-3-2-4 with odd numbers in one bank",
    6: "1-6-2-4-3-5 bank by bank, 1-6-3-2-5-4 or 1-4-5-2-3-6 with odd numbers in one bank",
}


def doubt_firing(model: EngineFile) -> Iterator[Doubt]:
    """Yield warnings of unlikely firing: a less usual numbering was inferred, nobody builds the
    crank for this order, or with these throws cylinders fire together, or all of them within one of
    two revolutions. Without a firing order, warn of a splay with the wrong sign.
    """
    parts = Parts(model)
    if parts.order is None:
        yield from _doubt_splay(model) if model.crank.splay else ()
        return
    layout = model.layout
    plan = parts.plan
    if layout.numbering is not None and not layout.has("numbering"):
        rows = layout.numbering
        if rows != next(list_tiers(plan, radial=layout.radial is not None))[0]:
            message = (
                f"is not given; {write_rows(rows)} is used, with which the firing order fits; add "
                "this key if it is right"
            )
            yield Doubt("layout.numbering", message)
    order = write_order(parts.order)
    if parts.throws_given:
        gaps = list_gaps(parts)
        together = list_together(parts)
        if layout.firing_intervals is None and together:
            message = (
                f"{describe_together(together)} with these crank.throws; if that is right, give "
                f"layout.firing_intervals = [{join_numbers(gaps)}]"
            )
            yield Doubt("layout.firing_order", message, ("crank.throws",))
        if layout.firing_intervals is None and len(gaps) > 2 and max(gaps) > TURN + TOLERANCE_DEG:
            message = (
                f"{order} has the intervals {join_numbers(gaps)} deg with these crank.throws; if "
                f"that is right, give layout.firing_intervals = [{join_numbers(gaps)}]"
            )
            yield Doubt("layout.firing_order", message, ("crank.throws",))
    elif layout.firing_intervals is None and layout.strokes == 4:
        usual = _find_usual_orders(parts)
        if usual:
            listed = join_numbers(count_throws_from_first(parts))
            message = (
                f"{order} needs the throws {listed}, which nobody builds; usual is {usual}; if "
                "this order is right, give crank.throws"
            )
            yield Doubt("layout.firing_order", message)


def _doubt_splay(model: EngineFile) -> Iterator[Doubt]:
    """Yield a warning if split pins leave a backward vector of order 1 that the opposite splay
    would balance.
    """
    splay = model.crank.splay
    opposite = model.with_table("crank", splay=-splay)
    share = Candidate(model).backward_share
    share_of_opposite = Candidate(opposite).backward_share
    if share_of_opposite < SMALL <= share:
        message = (
            f"with {splay:g} deg, the part of order 1 that turns against the crank is "
            f"{100 * share:.3g} % of one cylinder's first order, and "
            f"{100 * share_of_opposite:.3g} % with {-splay:g} deg; change the sign, or give "
            "layout.firing_order"
        )
        yield Doubt("crank.splay", message)


def _find_usual_orders(parts: Parts) -> str | None:
    """Return the usual firing orders in words if nobody builds the crank of this engine; None if
    the crank is built, or if no orders are known as usual for this number of cylinders.
    """
    throws = count_throws_from_first(parts)
    plan = parts.plan
    if plan.banks == 1:
        is_built = _is_built_in_line(throws, parts.order or ())
        return None if is_built else USUAL_ORDERS.get(len(throws))
    angles = [*map(float, bank_angles(parts.model.layout, parts.figures))]
    if plan.banks > 2 or plan.rods_on_throw > 1 or not _are_opposite(*angles):
        return None
    is_built = all(map(_are_opposite, throws[::2], throws[1::2]))  # flat: pins of neighbours
    return None if is_built else USUAL_FLAT_ORDERS.get(len(throws))


def _is_built_in_line(throws: Sequence[float], order: Sequence[int]) -> bool:
    """Return whether makers build the crank of an in-line engine: with an even number of throws, it
    is symmetrical end for end, or has the throws of two fours at 90 deg; with five throws, it has
    one of the usual orders. Other odd numbers are not judged.

    Args:
        throws: Angle of each throw from the first one, deg.
        order: Firing order.
    """
    if len(throws) == 5:
        from_first = (*order[order.index(1) :], *order[: order.index(1)])
        return from_first in USUAL_ORDERS_OF_FIVE
    if len(throws) % 2 or throws == throws[::-1]:
        return True
    return len(throws) == 8 and _are_two_fours(throws)


def _are_two_fours(throws: Sequence[float]) -> bool:
    """Return whether eight throws are those of two in-line fours in series, at 90 deg."""
    if round(abs(throws[4] - 180)) != 90:
        return False
    for four in (throws[:4], throws[4:]):
        if [round((throw - four[0]) % TURN) for throw in four] != [0, 180, 180, 0]:
            return False
    return True


def _are_opposite(first: float, second: float) -> bool:
    return abs((second - first) % TURN - 180) <= TOLERANCE_DEG
