"""Which formats there are, and which renderer makes each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import StrEnum
from typing import TYPE_CHECKING, Any, assert_never

if TYPE_CHECKING:
    from ..field_balancing.balance import FieldBalance
    from ..results.analysis import Analysis
    from ..results.balance import Balance
    from ..results.two_engines import Combined
    from .sheet import Sheet
    from .units import System


class Format(StrEnum):
    """How a result is written."""

    TABLE = "table"
    JSON = "json"
    CSV = "csv"
    MARKDOWN = "markdown"


class Units(StrEnum):
    """Units of tables, CSV and Markdown; JSON stays SI."""

    SI = "si"
    IMPERIAL = "imperial"


def render(
    form: Format,
    *,
    sheets: Callable[[], list[Sheet]],
    documents: Callable[[], Sequence[Any]],
    rows: Callable[[], str],
    into_file: bool = False,
) -> str:
    """Text of a result in one format; only what that format needs is made (JSON imports no
    table).
    """
    match form:
        case Format.TABLE:
            from .table import terminal

            return terminal(sheets(), into_file=into_file)
        case Format.MARKDOWN:
            from .markdown import markdown

            return markdown(sheets())
        case Format.CSV:
            return rows()
        case Format.JSON:
            from .json import dumps

            return "\n".join(map(dumps, documents()))
        case _:
            assert_never(form)


def analyses(
    results: Sequence[Analysis],
    names: Sequence[str],
    form: Format,
    units: Units,
    *,
    into_file: bool = False,
    plot: bool = False,
) -> str:
    """Analyses, one after the other; JSON is one document a line.

    Args:
        names: of the engines, by which the rows of CSV are told apart.
        plot: with pictures, if a person looks at a terminal.
    """

    def sheets() -> list[Sheet]:
        from .analysis import sheet
        from .table import seen

        pictures = plot and form is Format.TABLE and seen(into_file)
        return [sheet(result, _system(units), pictures=pictures) for result in results]

    def documents() -> list[Any]:
        from .json import analysis

        return [analysis(result) for result in results]

    def rows() -> str:
        from .csv import analyses

        return analyses(results, names, _system(units))

    return render(form, sheets=sheets, documents=documents, rows=rows, into_file=into_file)


def _system(units: Units) -> System:
    from .units import SYSTEMS

    return SYSTEMS[units]


def balances(result: Balance, form: Format, units: Units, *, into_file: bool = False) -> str:
    """One balance."""
    from . import csv, json

    system = _system(units)

    def sheets() -> list[Sheet]:
        from .balance import sheet

        return [sheet(result, system)]

    return render(
        form,
        sheets=sheets,
        documents=lambda: [json.balance(result)],
        rows=lambda: csv.balances(result, system),
        into_file=into_file,
    )


def sums(result: Combined, form: Format, units: Units, *, into_file: bool = False) -> str:
    """Two engines on one frame."""
    from . import csv
    from . import two_engines as combined

    system = _system(units)
    return render(
        form,
        sheets=lambda: [combined.sheet(result, system)],
        documents=lambda: [combined.document(result)],
        rows=lambda: csv.sums(result, system),
        into_file=into_file,
    )


def fields(result: FieldBalance, form: Format, *, into_file: bool = False) -> str:
    """One rotor on the machine, in the units of its file."""
    from . import csv
    from . import field_balancing as field

    return render(
        form,
        sheets=lambda: [field.sheet(result)],
        documents=lambda: [field.document(result)],
        rows=lambda: csv.write(field.HEADER, field.rows(result)),
        into_file=into_file,
    )
