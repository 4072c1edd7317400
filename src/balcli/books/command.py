"""The commands `balcli tables` and `balcli layouts`."""

from __future__ import annotations

from typing import Annotated, Literal

import typer

from ..limits import HIGHEST_POWER
from ..shell.file_names import text_format
from ..shell.options import FormatOption, Output
from ..shell.output import show
from ..shell.values import as_bare_angles, optional


def complete_tables(incomplete: str) -> list[str]:
    """Return the names of tables and sources that begin with this text."""
    from . import answer as registry
    from .sources import SOURCES

    names = (*registry.NAMES, *(source.key for source in SOURCES))
    return [name for name in names if name.startswith(incomplete)]


Name = Annotated[
    str | None,
    typer.Argument(
        metavar="NAME",
        help="Name of a table, or of a source (liu, 刘先志); without it, all tables are listed.",
        show_default=False,
        autocompletion=complete_tables,
    ),
]
Errata = Annotated[
    bool, typer.Option("--errata", help="List wrong figures, equations and sentences by class.")
]
Kind = Annotated[
    Literal["misprint", "rounding", "approximation", "method", "error", "copy"] | None,
    typer.Option(help="List only errata of this class.", show_default=False),
]
Lambda = Annotated[
    str | None, optional("0.20:0.40:0.01", "Other crank ratios; as a list: 0.25,1/3.", "--lambda")
]
Angle = Annotated[
    str | None, optional("0:180:5", "Other crank or bank angles (degrees).", "--angle")
]
Power = Annotated[
    int | None, optional("N", "Highest power in `series`; default: 12.", min=0, max=HIGHEST_POWER)
]


def tables(
    name: Name = None,
    errata: Errata = False,
    kind: Kind = None,
    lambda_: Lambda = None,
    angle: Angle = None,
    power: Power = None,
    form: FormatOption = None,
    output: Output = None,
) -> None:
    """Recompute the coefficient tables printed in five books and papers; list their errata by
    class, also errata of equations and text; list published problems with balcli's answers.

    \b
    Examples:
      balcli tables tsinghua-1-2
      balcli tables liu
      balcli tables --errata liu
      balcli tables --errata --kind misprint
      balcli tables published
      balcli tables --errata --format json
    """
    form = text_format(output, form)
    from . import answer, show as pages
    from .sources import find_source

    angles = angle and as_bare_angles("angle", angle)
    if errata or kind:
        errors = answer.select_errata(name, lambda_, angles, power)
        if kind:
            errors = [(table, error) for table, error in errors if error.category == kind]
        show([errors], pages.ERRATA, form, output)
        return
    source = find_source(name) if name else None
    if source is not None and not (lambda_ or angles or power):
        show([answer.select_source(source)], pages.SOURCE, form, output)
        return
    chosen = answer.select_tables(name, lambda_, angles, power)
    if name:
        own = {"layouts": pages.LAYOUTS, "published": pages.PUBLISHED}
        show(chosen, own.get(name, pages.RENDERER), form, output)
    else:
        show([chosen], pages.TABLE_LIST, form, output)


def layouts(form: FormatOption = None, output: Output = None) -> None:
    """Free forces and moments of common engines at a glance, as multiples of one cylinder's force.

    \b
    Examples:
      balcli layouts
      balcli layouts --format markdown
    """
    tables("layouts", form=form, output=output)
