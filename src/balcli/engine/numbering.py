"""Warn of firing that is allowed and unlikely."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ..core.phases import TURN
from ..file.doubt import Doubt
from ..file.firing_order import write_order
from ..file.model import EngineFile
from ..limits import SMALL
from .firing.candidates import Candidate
from .firing.fits import count_throws_from_first, list_gaps
from .firing.together import describe_together, list_together
from .firing.usual import list_tiers, write_rows
from .layout import TOLERANCE_DEG, bank_angles
from .parts import Parts

# ------------------------------------------------------------------ what is allowed and unlikely
USUAL_ORDERS = {
    4: "1-3-4-2 or 1-2-4-3",
    5: "1-2-4-5-3 or 1-3-5-4-2",
    6: "1-5-3-6-2-4 or 1-4-2-6-3-5",
    8: "1-6-2-5-8-3-7-4, or 1-5-2-6-4-8-3-7 with two cranks of fours at 90 deg",
}
USUAL_FLAT_ORDERS = {
    4: "1-4-3-2 bank by bank, 1-3-2-4 with odd numbers in one bank",
    6: "1-6-2-4-3-5 bank by bank, 1-6-3-2-5-4 or 1-4-5-2-3-6 with odd numbers in one bank",
}


def doubt_firing(model: EngineFile) -> Iterator[Doubt]:
    """Yield warnings of unlikely firing: a less usual numbering was inferred, nobody builds the
    crank for this order, or with these throws all cylinders fire within one of two revolutions.
    Without a firing order, warn of a splay with the wrong sign.
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
            told = (
                f"is not given; {write_rows(rows)} is used, with which the firing order fits; add "
                "this key if it is right"
            )
            yield Doubt("layout.numbering", told)
    order = write_order(parts.order)
    if parts.throws_given:
        gaps = list_gaps(parts)
        together = list_together(parts)
        if layout.firing_intervals is None and together:
            told = (
                f"{describe_together(together)} with these crank.throws; if that is right, give "
                f"layout.firing_intervals = [{_join(gaps)}]"
            )
            yield Doubt("layout.firing_order", told, ("crank.throws",))
        if layout.firing_intervals is None and len(gaps) > 2 and max(gaps) > TURN + TOLERANCE_DEG:
            told = (
                f"{order} has the intervals {_join(gaps)} deg with these crank.throws; if that is "
                f"right, give layout.firing_intervals = [{_join(gaps)}]"
            )
            yield Doubt("layout.firing_order", told, ("crank.throws",))
    elif layout.firing_intervals is None and layout.strokes == 4:
        usual = _find_usual_orders(parts)
        if usual:
            listed = _join(count_throws_from_first(parts))
            told = (
                f"{order} needs the throws {listed}, which nobody builds; usual is {usual}; if "
                "this order is right, give crank.throws"
            )
            yield Doubt("layout.firing_order", told)


def _doubt_splay(model: EngineFile) -> Iterator[Doubt]:
    """Yield a warning if split pins leave a backward vector of order 1 that the opposite splay
    would balance.
    """
    splay = model.crank.splay
    opposite = model.with_table("crank", splay=-splay)
    here, there = (Candidate(each).backward_share for each in (model, opposite))
    if there < SMALL <= here:
        told = (
            f"with {splay:g} deg, the part of order 1 that turns against the crank is "
            f"{100 * here:.3g} % of one cylinder's first order, and {100 * there:.3g} % with "
            f"{-splay:g} deg; change the sign, or give layout.firing_order"
        )
        yield Doubt("crank.splay", told)


def _find_usual_orders(parts: Parts) -> str:
    """Return usual firing orders if nobody builds the crank of this engine, else an empty text.
    Usual cranks of in-line engines are symmetrical end for end, have one of the usual orders of
    five cylinders, or are two cranks of fours at 90 deg. In a flat engine, pins of neighbouring
    cylinders are 180 deg apart.
    """
    throws = count_throws_from_first(parts)
    plan = parts.plan
    angles = [*map(float, bank_angles(parts.model.layout, parts.figures))]
    if plan.banks == 1:
        order = parts.order or ()
        turned = "-".join(map(str, order[order.index(1) :] + order[: order.index(1)]))
        built = len(throws) % 2 or throws == throws[::-1]
        if len(throws) == 5:
            built = turned in USUAL_ORDERS[5]
        if len(throws) == 8 and not built:  # two cranks of in-line fours in series, at 90 deg
            fours = [[round((t - one[0]) % TURN) for t in one] for one in (throws[:4], throws[4:])]
            across = round(abs(throws[4] - 180)) == 90
            built = across and fours == [[0, 180, 180, 0]] * 2
        return "" if built else USUAL_ORDERS.get(len(throws), "")
    if plan.banks > 2 or plan.rods_on_throw > 1 or not _are_opposite(*angles):
        return ""
    built = all(map(_are_opposite, throws[::2], throws[1::2]))
    return "" if built else USUAL_FLAT_ORDERS.get(len(throws), "")


def _are_opposite(first: float, second: float) -> bool:
    return abs((second - first) % TURN - 180) <= TOLERANCE_DEG


def _join(numbers: Iterable[float]) -> str:
    return ", ".join(f"{number:.6g}" for number in numbers)
