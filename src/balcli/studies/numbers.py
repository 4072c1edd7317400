"""The command `balcli numbers`, which lists the numbers of an engine file that can vary, and its
quantities.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from ..shell.file_names import text_format
from ..shell.inputs import read_engine
from ..shell.options import EnginePath, FormatOption, Output
from ..shell.output import refuse_overwriting, show
from ..show.formats import Renderer, Rows
from ..show.sheet import NAMELESS, UNKNOWN, Grid, Sheet
from ..show.units import System

if TYPE_CHECKING:
    from .quantities import FileNumber, NamedNumbers


_OF_CYLINDER = re.compile(r"cylinder\.\d+\.")


def sheet(result: NamedNumbers, _system: System) -> Sheet:
    """Return both lists with one row for each name. Keys of single cylinders that the file does not
    give share one row for all cylinders.
    """
    rows = dict.fromkeys(_list_rows(result.numbers))
    numbers = Grid(
        "Numbers: sweep --vary NAME=VALUES",
        ("name", "value", "unit", "meaning"),
        tuple(rows),
        words=(0, 2, 3),
        note="–: not in the file; N stands for the number of a cylinder.",
    )
    quantities = Grid(
        "Quantities: --quantity NAME,... (or search --minimise)",
        ("name", "unit", "meaning"),
        tuple((q.name, q.unit, q.meaning) for q in result.quantities),
        words=(0, 1, 2),
        note="N stands for an order or a number, PART for one of the words after the colon.",
    )
    return Sheet(result.engine.name or NAMELESS, (numbers, quantities))


def _list_rows(numbers: Iterable[FileNumber]) -> Iterator[tuple[str, str, str, str]]:
    """Yield the rows of the numbers; for lists, only the first member has its meaning."""
    before = ""
    for number in numbers:
        stem = number.path.rstrip("0123456789")
        meaning = "" if stem == before and stem.endswith(".") else number.meaning
        before = stem
        if number.value is not None:
            value = number.value if isinstance(number.value, str) else f"{number.value:.12g}"
            yield number.path, value, number.unit, meaning
        else:
            yield _OF_CYLINDER.sub("cylinder.N.", number.path), UNKNOWN, number.unit, meaning


def rows(result: NamedNumbers, _system: System) -> Rows:
    """Return CSV with one name in each line; quantities have no value."""
    return Rows(
        ("kind", "name", "value", "unit", "meaning"),
        [
            *(("number", n.path, n.value, n.unit, n.meaning) for n in result.numbers),
            *(("quantity", q.name, None, q.unit, q.meaning) for q in result.quantities),
        ],
    )


RENDERER = Renderer(sheet=sheet, rows=rows)


def numbers(path: EnginePath, form: FormatOption = None, output: Output = None) -> None:
    """List the numbers of an engine file that can vary, and its quantities: names for `sweep`,
    `search` and `scatter`, with values, units and meanings.

    \b
    Examples:
      balcli numbers v8.toml
      balcli numbers v8.toml --format csv
    """
    refuse_overwriting(reads=[path], writes={"--output": output})
    form = text_format(output, form)
    from .quantities import name_numbers

    show([name_numbers(read_engine(path, asked=()).model)], RENDERER, form, output)
