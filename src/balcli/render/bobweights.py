"""The bobweight card: pins that are alike together, quantity x each = sum."""

from __future__ import annotations

from collections.abc import Sequence

from ..sizing.scheme_figures import Bobweight, CardLine
from .sheet import number


def group_equal_pins(card: Sequence[Bobweight]) -> list[list[Bobweight]]:
    """Pins with the same lines, together."""
    groups: dict[tuple[CardLine, ...], list[Bobweight]] = {}
    for bobweight in card:
        groups.setdefault(bobweight.lines, []).append(bobweight)
    return list(groups.values())


def name_pins(pins: Sequence[Bobweight]) -> str:
    """Pins by the cylinders whose rods they carry: `pins 1+5, 2+6`."""
    names = ", ".join("+".join(map(str, pin.cylinders)) for pin in pins)
    return f"pin{'s' if len(pins) > 1 else ''} {names}"


def multiply(line: CardLine) -> str:
    """How the sum of a line comes about: `2 × 775`, or `775 + 780`."""
    if len(set(line.each_g)) == 1:
        return f"{len(line.each_g)} × {number(line.each_g[0])}"
    return " + ".join(map(number, line.each_g))


def percent(share: float) -> str:
    """A balance factor as shops say it."""
    return f"{number(100 * share, 4)} %"
