"""Names of the pages of pictures that an engine has; loads no library."""

from __future__ import annotations

from collections.abc import Sequence

from ..errors import BalcliError
from ..file.fields import nearest

OF_GAS = ("pressure", "p-v", "torque", "pin", "main")
OF_PARTS = ("piston", "journals")
OF_TORSION = ("modes", "campbell", "response", "waterfall")
PAGES = (
    *("overview", "all", "polar", "orders", "spectrum", "curves"),  # those of a balance
    *("ladder", "factor", "bank", "inner"),
    *OF_PARTS,
    *OF_GAS,
    *OF_TORSION,
)


def check_page(what: str, known: Sequence[str] = PAGES) -> str:
    """Return the name of a page.

    Args:
        what: The name as given.
        known: Names of the pages that there are.

    Raises:
        BalcliError: The name is none of these.
    """
    if what not in known:
        near = nearest(what, known)
        hint = f"; did you mean {near}?" if near else ""
        raise BalcliError(f'--what "{what[:60]}": choose from {", ".join(known)}{hint}')
    return what
