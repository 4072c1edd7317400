"""Pictures by matplotlib, and the names of the pages that an engine has."""

from collections.abc import Sequence

from ...enginefile.fields import nearest
from ...errors import BalcliError

OF_GAS = ("pressure", "p-v", "torque", "pin", "main")
OF_TORSION = ("modes", "campbell", "response", "waterfall")
PAGES = (
    *("overview", "all", "polar", "orders", "spectrum", "curves", "factor", "bank", "inner"),
    *OF_GAS,
    *OF_TORSION,
)


def check_page(what: str, known: Sequence[str] = PAGES) -> str:
    """Return the name of a page; raise BalcliError if it is not among the known ones."""
    if what not in known:
        near = nearest(what, known)
        hint = f"; did you mean {near}?" if near else ""
        raise BalcliError(f'--what "{what[:60]}": choose from {", ".join(known)}{hint}')
    return what
