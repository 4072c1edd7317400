"""`balcli tables`: from the options to one text."""
from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .tables import Options, Table

FORMATS = ("table", "json", "csv", "markdown")


def text(name: str | None, *, errata: bool = False, lam: str | None = None, angle: str | None = None,
         power: int | None = None, digits: int | None = None, form: str = "table",
         width: int | None = None, colour: bool = False) -> str:
    """What the command prints: a table, its errata, or (without a name) the list of tables or all errata.

    Raises:
        BalcliError: no such table, no such range, or an option that this table does not take.
    """
    from .render import printed
    from .tables import NAMES, recompute
    options = _options(lam, angle, power)
    shown = [recompute(name, options)] if name else [recompute(n) for n in NAMES]
    if name and not errata:
        return _table(shown[0], digits, form, width, colour)
    head, rows, as_json = (
        (printed.ERRATA, printed.errata_rows, printed.errata_json) if errata else
        (printed.NAMES, printed.names_rows, printed.names_json))
    match form:
        case "json":
            return as_json(shown)
        case "csv":
            return printed.list_csv(head, rows(shown))
        case "markdown":
            return printed.list_markdown(head, rows(shown))
        case _:
            return printed.list_text(head, rows(shown), width=width, colour=colour)


def _table(table: Table, digits: int | None, form: str, width: int | None, colour: bool) -> str:
    from .render import printed
    match form:
        case "json":
            return printed.as_json(table)
        case "csv":
            return printed.as_csv(table, digits)
        case "markdown":
            return printed.as_markdown(table, digits)
        case _:
            return printed.as_text(table, digits, width=width, colour=colour)


def _options(lam: str | None, angle: str | None, power: int | None) -> Options:
    from .tables import Options
    from .tables.ranges import crank_ratios, headings
    return Options(crank_ratios(lam) if lam else None, headings(angle, "--angle") if angle else None, power)
