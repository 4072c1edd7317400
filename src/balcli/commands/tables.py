"""`balcli tables`: the printed coefficient tables, recomputed."""
from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Annotated, assert_never

import typer

from .options import Format, FormatOption, Output
from .output import emit

if TYPE_CHECKING:
    from ..render.sheet import Sheet

Name = Annotated[str | None, typer.Argument(help="Which table; without it, all are listed.", show_default=False)]
Errata = Annotated[bool, typer.Option("--errata", help="List every printed figure that is not the exact one rounded.")]
Lam = Annotated[str | None, typer.Option("--lambda", metavar="0.20:0.40:0.01", show_default=False,
                                            help="Other crank ratios than the printed ones; or a list 0.25,1/3.")]
Angle = Annotated[str | None, typer.Option("--angle", metavar="0:180:5", show_default=False,
                                              help="Other crank angles (degrees).")]
Power = Annotated[int | None, typer.Option(min=0, max=200, show_default=False,
                                              help="Highest power of lambda in `series`; default 12.")]
Digits = Annotated[int | None, typer.Option(min=0, max=17, show_default=False,
                                               help="Decimals; default: as printed (JSON and CSV: all).")]


def tables(name: Name = None, errata: Errata = False, lam: Lam = None, angle: Angle = None, power: Power = None,
           digits: Digits = None, form: FormatOption = Format.TABLE, output: Output = None) -> None:
    """The printed coefficient tables of five books and papers, recomputed, and every misprint in them."""
    from ..render import printed
    from ..tables import select
    shown = select(name, lam, angle, power)
    if name and not errata:
        as_json, as_csv = partial(printed.table_json, shown[0]), partial(printed.table_csv, shown[0], digits)
        as_sheet = partial(printed.table_sheet, shown[0], digits)
    elif errata:
        as_json, as_csv = partial(printed.errata_json, shown), partial(printed.errata_csv, shown)
        as_sheet = partial(printed.errata_sheet, shown)
    else:
        as_json, as_csv = partial(printed.names_json, shown), partial(printed.names_csv, shown)
        as_sheet = partial(printed.names_sheet, shown)
    emit(_text(form, as_json, as_csv, as_sheet, output is not None), output)


def _text(form: Format, as_json: Callable[[], str], as_csv: Callable[[], str], as_sheet: Callable[[], Sheet],
          into_file: bool) -> str:
    """One of three ways to write a result."""
    match form:
        case Format.JSON:
            return as_json()
        case Format.CSV:
            return as_csv()
        case Format.MARKDOWN:
            from ..render.markdown import markdown
            return markdown([as_sheet()])
        case Format.TABLE:
            from ..render.table import terminal
            return terminal([as_sheet()], into_file=into_file)
        case _:
            assert_never(form)
