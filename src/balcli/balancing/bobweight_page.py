"""The bobweight card as a page for the wall of a shop, 80 columns wide: masses in g and oz, each as
quantity x each = sum, then the counterweights to add and the holes to drill.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import wrap
from typing import TYPE_CHECKING

from ..analysis.devices_show import explain_holes, tell_rim
from ..errors import BalcliError, legible
from ..show.sheet import NAMELESS, capitalized, degrees, number, sentence
from ..show.units import IMPERIAL, SI, ShownUnit
from ..sizing.bobweights import NO_THROW
from ..sizing.factor import name_one_cylinder
from ..sizing.planes import find_unbalance

if TYPE_CHECKING:
    from ..file.model import Counterweight
    from ..sizing.bobweights import Bobweight, CardLine
    from ..sizing.workshop import Practical
    from .answer import Balance


WIDTH = 80
_RULE, _HEAVY = "─" * WIDTH, "═" * WIDTH
_INDENT = "  "
_NAMES = 56  # width of the first two columns
_WHERE = (
    "Angles from cylinder 1's crank pin in the sense of rotation, clockwise seen from the free end "
    "(front); z as in the engine file, + towards the flywheel."
)


def group_equal_pins(card: Sequence[Bobweight]) -> list[list[Bobweight]]:
    """Return groups of pins that have the same lines."""
    groups: dict[tuple[CardLine, ...], list[Bobweight]] = {}
    for bobweight in card:
        groups.setdefault(bobweight.lines, []).append(bobweight)
    return list(groups.values())


def name_pins(pins: Sequence[Bobweight]) -> str:
    """Return a name for pins, by the cylinders whose rods they carry: `pins 1+5, 2+6`."""
    names = ", ".join("+".join(map(str, pin.cylinders)) for pin in pins)
    return f"pin{'s' if len(pins) > 1 else ''} {names}"


def multiply(line: CardLine, unit: ShownUnit = SI.scales) -> str:
    """Return the terms of a line's sum: `2 × 775`, or `775 + 780`."""
    each = [number(unit.of(mass_g / 1e3)) for mass_g in line.each_g]
    if len(set(line.each_g)) == 1:
        return f"{len(each)} × {each[0]}"
    return " + ".join(each)


def percent(share: float) -> str:
    """Return a balance factor in percent, as shops write it."""
    return f"{number(100 * share)} %"


def write_page(result: Balance) -> str:
    """Return the page as text.

    Raises:
        BalcliError: The scheme has no card.
    """
    if not result.remedy.card:
        raise BalcliError(
            f"--format card: scheme {result.remedy.scheme} has no bobweight card; leave --scheme "
            "out, or choose --scheme factor"
        )
    return "\n".join(legible(line).rstrip() for line in _lines(result)) + "\n"


def _lines(result: Balance) -> Iterator[str]:
    engine, card = result.before.engine, result.remedy.card
    yield _HEAVY
    yield _row("BOBWEIGHT CARD", (engine.name or NAMELESS)[: WIDTH - 20])
    yield _HEAVY
    factor, rods = card[0].factor, len(card[0].cylinders)
    yield f"Balance factor    {percent(factor)} of all reciprocating mass on the pin"
    if rods > 1:
        yield f"                  = {percent(factor * rods)} of {name_one_cylinder(engine)}"
    for pins in group_equal_pins(card):
        yield ""
        yield from _weigh_pins(pins)
    yield ""
    yield from _correct(result)
    yield _RULE
    yield "Weighed by ____________________   Date ______________   Checked ________________"


# ------------------------------------------------------------------ what to weigh
def _weigh_pins(pins: Sequence[Bobweight]) -> Iterator[str]:
    """Yield the lines of one bobweight, for all equal pins."""
    one = pins[0]
    yield from wrap(capitalized(name_pins(pins)), WIDTH)
    yield _line("", "quantity × each", "g", "oz")
    yield _RULE
    for kind, total in (("Rotating", one.rotating_g), ("Reciprocating", one.reciprocating_g)):
        yield kind
        for line in one.lines:
            if line.rotates == (kind == "Rotating") and line.sum_g:
                part, how = _INDENT + line.part, multiply(line)
                if len(part) + len(how) >= _NAMES:
                    how = f"{len(line.each_g)}, weighed one by one"
                yield _line(part, how, *_weight(line.sum_g))
        yield _line(f"{_INDENT}{kind.lower()} sum", "=", *_weight(total))
    share = f"{number(one.reciprocating_g)} × {percent(one.factor)}"
    yield _line(f"{_INDENT}balanced share", share, *_weight(one.factor * one.reciprocating_g))
    yield _HEAVY
    each = f"{len(pins)} alike" if len(pins) > 1 else ""
    yield _line("BOBWEIGHT (rotating + share)", each, *_weight(one.bobweight_g))
    yield _HEAVY
    if one.throw_g:
        yield _line("throw itself, at the crank radius", "", *_weight(one.throw_g))
        yield _line("counterweight opposite", "", *_weight(one.bobweight_g + one.throw_g))
    else:
        yield from wrap(f"The throw itself {NO_THROW}.", WIDTH)


# ------------------------------------------------------------------ what to do
def _correct(result: Balance) -> Iterator[str]:
    """Yield the lines of every counterweight to add, with holes and permitted residuals if
    wanted.
    """
    remedy = result.remedy
    weights = remedy.counterweights
    if not weights:
        yield sentence(remedy.note)
        return
    there = "STILL MISSING ON THE CRANKSHAFT" if remedy.needs else "COUNTERWEIGHTS"
    yield _line(there, "at, deg", "g·mm", "oz·in")
    yield _RULE
    for k, (weight, figures) in enumerate(zip(weights, result.practical, strict=True), 1):
        yield from _correct_plane(k, weight, figures, result)
    if result.tools.drill is not None:
        sizes = dict.fromkeys(_show_length(each.radius_mm, 4, 3) for each in result.practical)
        told = [f"Holes: radial, {tell_rim(result.tools, ', '.join(sizes))} inwards."]
        told += explain_holes(result.practical, result.tools, SI.length)
        yield from wrap(" ".join(told), WIDTH)
    if remedy.note:
        yield from wrap(sentence(remedy.note), WIDTH)
    yield from wrap(_WHERE, WIDTH)
    speed = f"{number(float(result.before.engine.speed_rpm))} rpm"
    if (permitted := result.permitted) is not None:
        grade = f"G {permitted.grade:g}, {permitted.mass_kg:g} kg"
        yield f"Permitted by ISO 21940-11, {grade}, {speed}."


def _correct_plane(
    k: int, weight: Counterweight, figures: Practical, result: Balance
) -> Iterator[str]:
    place = f"{k}  z = {_show_length(weight.position, None, 4)}"
    yield _line(f"{place}: add at", degrees(weight.angle), *_unbalance(find_unbalance(weight)))
    drill, depth = result.tools.drill, figures.drill_depth_mm
    if figures.holes is not None and depth is not None and drill is not None:
        size = _show_length(1e3 * drill, None, 3)
        what = "drill" if result.tools.slug is None else "slugs"
        told = f"{figures.holes} × {size}, {_show_length(depth, 3, 3)} deep"
        yield f"   {what} at {degrees(figures.hole_angle_deg or 0.0)} deg: {told}"
    if result.permitted is not None:
        yield _line("   may be left", "", *_unbalance(result.permitted.each_g_mm / 1e6))


# ------------------------------------------------------------------ figures in their columns
def _line(name: str, how: str, grams: str, ounces: str) -> str:
    return f"{name}{how:>{_NAMES - len(name)}}{grams:>13}{ounces:>11}"


def _row(left: str, right: str) -> str:
    return f"{left}{right:>{WIDTH - len(left)}}"


def _weight(grams: float) -> tuple[str, str]:
    return f"{grams:.1f}", f"{IMPERIAL.scales.of(grams / 1e3):.2f}"


def _unbalance(kg_m: float) -> tuple[str, str]:
    return f"{1e6 * kg_m:.0f}", f"{IMPERIAL.unbalance.of(kg_m):.2f}"


def _show_length(millimetres: float, digits: int | None, digits_in: int) -> str:
    inches = IMPERIAL.length.of(millimetres / 1e3)
    return f"{number(millimetres, digits)} mm ({number(inches, digits_in)} in)"
