"""Show the force of one cylinder by order next to the figures of textbooks, which keep two terms of
the series of the piston acceleration.
"""

from collections.abc import Iterator
from typing import NamedTuple

from ..forces.kinds import FORCE
from ..forces.symmetry import TextbookUnits
from ..show.sheet import UNKNOWN, Column, Grid, number, order_name, size_text
from ..show.units import System

_NAMES = {1.0: "1 (primary)", 2.0: "2 (secondary)"}
_TERMS = (
    "Order 1 (once per revolution) is called primary, order 2 secondary. m: reciprocating mass; r: "
    "crank radius; λ: crank radius over rod length."
)
_ROUNDING = 1e-9  # a smaller share of a force is rounding
_SERIES = "A2 = λ + λ³/4 + 15λ⁵/128 + …"


class _Line(NamedTuple):
    """Largest force of one order, N: exact, and in textbooks."""

    order: float
    exact: float
    book: float


def one_cylinder_grids(units: TextbookUnits, system: System) -> Iterator[Grid]:
    """Yield a table of the largest force of one cylinder by order: exact, and as textbooks compute
    it; nothing if no force of the orders is known.

    Args:
        units: Units of textbooks, which are these forces.
        system: System of units.
    """
    lines = []
    for order in map(float, units.orders):
        exact = units.size(FORCE, order)
        if exact > 0:
            lines.append(_Line(order, exact, _find_textbook_force(units, order)))
    if not lines:
        return
    unit = system.force.fit(units.force)
    names = [_NAMES.get(line.order, order_name(line.order)) for line in lines]
    columns = [
        Column("order", names, words=True),
        Column("An", [number(line.exact / units.force) for line in lines]),
        Column(f"Fn, {unit.name}", [number(unit.of(line.exact)) for line in lines]),
        Column(f"textbooks, {unit.name}", [number(unit.of(line.book)) for line in lines]),
        Column("they miss", [_tell_missing(line) for line in lines]),
    ]
    who = "one cylinder" if units.equal else f"cylinder {units.cylinder}"
    title = f"Largest force of {who} by order, Fn = An m r ω²"
    yield Grid(title, columns, _explain(units, system))


def _find_textbook_force(units: TextbookUnits, order: float) -> float:
    """Return the largest force of an order in textbooks, N: m r ω², m r ω² λ, then none."""
    return units.force * {1.0: 1.0, 2.0: units.crank_ratio}.get(order, 0.0)


def _tell_missing(line: _Line) -> str:
    """Return the share of the exact force that textbooks miss; a dash if they miss nothing."""
    missing = (line.exact - line.book) / line.exact
    return f"{number(100 * missing, 2)} %" if abs(missing) > _ROUNDING else UNKNOWN


def _explain(units: TextbookUnits, system: System) -> str:
    """Return a note on the terms, and on the reasons for which the exact figures differ."""
    lines = [_TERMS]
    if units.crank_ratio:
        secondary = size_text(_find_textbook_force(units, 2.0), system.force)
        lines.append(
            f"Textbooks end the series {_SERIES} after its first term, so that F2 = m r ω² λ = "
            f"{secondary} (λ = {number(units.crank_ratio)}); here it is exact."
        )
    if units.offset:
        lines.append("The piston pin is offset, which changes all orders and adds odd ones.")
    return "\n".join(lines)
