"""Names of the pages of pictures, for options and completion; no library is loaded."""

from __future__ import annotations

from collections.abc import Sequence

from ..errors import ArgumentError
from ..file.fields import nearest

OF_GAS = ("pressure", "p-v", "torque", "pin", "main")
OF_PARTS = ("stars", "piston", "journals", "webs")
OF_TORSION = ("modes", "campbell", "response", "waterfall")
DRAWING = ".dxf"  # ending of a file with outlines of webs
PAGES = (
    *("overview", "all", "polar", "orders", "spectrum", "curves"),  # also pages for a Balance
    *("ladder", "factor", "bank", "inner"),
    *OF_PARTS,
    *OF_GAS,
    *OF_TORSION,
)


def check_page(what: str, known: Sequence[str] = PAGES) -> str:
    """Return the name of a page.

    Args:
        what: Name from the user.
        known: Names of the existing pages.

    Raises:
        ArgumentError: There is no page of this name.
    """
    if what not in known:
        near = nearest(what, known)
        hint = f"; did you mean {near}?" if near else ""
        raise ArgumentError(
            '{what} "{page}": choose from {known}{hint}',
            page=what[:60],
            known=", ".join(known),
            hint=hint,
        )
    return what
