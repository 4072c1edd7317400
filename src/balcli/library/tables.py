"""`balcli.tables`"""

from __future__ import annotations

from types import NoneType

from ..errors import check_type
from ..limits import HIGHEST_POWER
from ..printed_tables.recomputed import Table
from ..printed_tables.registry import NAMES, recompute
from .arguments import check_count, tell_arguments


@tell_arguments(**{"lambda": "ratios", "angle": "angles"})
def tables(
    name: str, *, ratios: str | None = None, angles: str | None = None, power: int | None = None
) -> Table:
    """A printed coefficient table, recomputed, beside its print.

    Args:
        name: of the table, such as "tsinghua-1-2" or "series"; the message for one that is not
            there has them all, and so has `balcli tables`.
        ratios: other crank ratios (crank radius over rod length) than the printed ones, where the
            table has them as columns, such as "0.20:0.40:0.01" or "0.25,1/3".
        angles: other crank angles, deg, likewise.
        power: highest power of the crank ratio in "series", 0 to 200.

    Returns:
        The table: `exact` cells as `columns` name them, the `printed` texts, and `errata`, every
        printed figure that is not the exact one rounded.

    Raises:
        BalcliError: there is no such table, with the nearest name; a range that it does not take.
        TypeError: the name or a range is no text, the power no whole number.

    Example:
        >>> tables("tsinghua-1-2").errata
    """
    check_type("tables", name, str, f"give the name of a table, such as {NAMES[1]!r}")
    check_type("ratios", ratios, (str, NoneType), 'give a text, such as "0.20:0.40:0.01"')
    check_type("angles", angles, (str, NoneType), 'give a text, such as "0:180:5"')
    highest = None if power is None else check_count("power", power, 0, HIGHEST_POWER)
    return recompute(name, ratios, angles, highest)
