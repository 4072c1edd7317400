"""Why each order is balanced or is not: as sentences and as rows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from .figures import FigureRow, clean
from .sheet import Text

if TYPE_CHECKING:
    from ..forces.symmetry import Symmetry


UNITS = (
    "Fn: largest force of order n of one cylinder's reciprocating masses; a: distance of "
    "neighbouring throws; as built: with rotating masses and stagger."
)


def sheet_parts(why: Symmetry) -> Iterator[Text]:
    """One paragraph a reason and the orders that have it; then what its units mean."""
    units = (UNITS,) if any(reason.unit for reason in why.reasons) else ()
    yield Text("Why", (*why.sentences, *units))


def rows(why: Symmetry) -> Iterator[FigureRow]:
    """What decides and why, and what is left: in units of one cylinder's, and in the textbook's."""
    for reason in why.reasons:
        about = 0, reason.quantity, reason.order
        yield FigureRow(*about, "why", reason.verdict, "")
        yield FigureRow(*about, "why_size", clean(reason.size), "of one cylinder")
        if reason.reciprocating is not None:
            yield FigureRow(*about, "why_reciprocating", clean(reason.reciprocating), reason.unit)
            yield FigureRow(*about, "why_built", clean(reason.built), reason.unit)
    if why.scope:
        yield FigureRow(0, "scope", None, "why", why.scope, "")
    if why.firing:
        yield FigureRow(0, "firing", None, "why", why.firing, "")
