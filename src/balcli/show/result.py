"""Define the base class of all results, with a summary, text, HTML for notebooks, and export as
dict, rows, DataFrame or Parquet file.

The renderer of each kind of result is in the package of its chapter and is imported when it is
first needed (`names.RENDERERS`).
"""

from __future__ import annotations

import math
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..core.records import Node
from ..errors import ArgumentError, BalcliError, check_type
from ..files import replacing
from ..names import RENDERERS, import_name
from ..version import __version__
from .formats import Columnar, Columns, Renderer, Rows, Values, stamp
from .sheet import Column, Grid, Sheet, number
from .table import write_text
from .units import SI, SYSTEMS, System

if TYPE_CHECKING:
    import pandas

    from ..file.doubt import Doubt

ENDS = 5  # number of rows that are shown at each end of a long table


class Result:
    """A result that can be kept, shown and exported."""

    @property
    def summary(self) -> str:
        """Summary of the result, in a few words."""
        return ""

    @property
    def doubts(self) -> tuple[Doubt, ...]:
        """Warnings of possible but unlikely figures, which commands print on standard error.
        Warnings on the engine file belong to the engine.
        """
        return ()

    def __repr__(self) -> str:
        return f"<{' '.join(filter(None, (type(self).__name__, self.summary)))}>"

    def _repr_html_(self) -> str:
        """Return the sheet of the result as HTML, for a notebook."""
        from .notebook import html_text  # only notebooks need it

        return html_text(_make_sheet(self, SI), self.doubts)

    def text(self, width: int | None = None, units: Literal["si", "imperial"] = "si") -> str:
        """Return the tables that the command prints, as far as they were asked for. Long series,
        such as those of `curves` and `sweep`, have only their first and last rows.

        Args:
            width: Number of characters in a line, such as 80: a wider table is divided into
                several; None: no table is divided.
            units: "si" or "imperial"; series are always in SI units.

        Raises:
            BalcliError: The width is less than 1, or there is no such system of units.
            TypeError: An argument has the wrong type.
        """
        check_type("width", width, (int, np.integer, NoneType), "give a whole number, such as 80")
        check_type("units", units, str, 'give "si" or "imperial"')
        if width is not None and width < 1:
            raise ArgumentError("{width}: {value}; give a whole number from 1", value=width)
        if units not in SYSTEMS:
            choices = ", ".join(SYSTEMS)
            raise ArgumentError(
                "{units} {value!r}: choose from {choices}", value=units, choices=choices
            )
        return write_text([_make_sheet(self, SYSTEMS[units])], width).rstrip("\n")

    def to_dict(self) -> Node:
        """Return the command's JSON document (docs/json.md) as a dict; keys contain SI units."""
        return stamp(find_renderer(self).document(self))

    def rows(self) -> list[Node]:
        """Return one dict for each row, for a DataFrame of any library. All have the same keys;
        missing values are None.
        """
        lists = {}
        for name, values in list_columns(self).values.items():
            lists[name] = values.tolist() if isinstance(values, np.ndarray) else values
        lines = zip(*lists.values(), strict=True)
        return [dict(zip(lists, map(_none_for_nan, line), strict=True)) for line in lines]

    def to_pandas(self) -> pandas.DataFrame:
        """Return the rows as a DataFrame. `attrs["units"]` has the units of columns, unless they
        are in the names or in a column `unit`.

        Raises:
            BalcliError: Pandas is not installed.
        """
        try:
            import pandas
        except ImportError:
            raise BalcliError("to_pandas() needs pandas: pip install pandas") from None
        columns = list_columns(self)
        frame = pandas.DataFrame(dict(columns.values))
        frame.attrs["units"] = dict(columns.units)
        return frame

    def to_parquet(self, path: str | Path) -> None:
        """Write the rows into a Parquet file; each column has its unit in the metadata.

        Raises:
            BalcliError: Pyarrow is not installed, or the file cannot be written.
        """
        try:
            import pyarrow
            from pyarrow import parquet
        except ImportError:
            raise BalcliError("to_parquet() needs pyarrow: pip install balcli[scale]") from None
        columns = list_columns(self)
        arrays = []
        fields = []
        for name, values in columns.values.items():
            array = pyarrow.array(values, from_pandas=True)
            arrays.append(array)
            unit = {"unit": columns.units.get(name, "")}
            fields.append(pyarrow.field(name, array.type, metadata=unit))
        about = {"balcli.version": __version__, "balcli.result": type(self).__name__}
        table = pyarrow.table(arrays, schema=pyarrow.schema(fields, metadata=about))
        with replacing(Path(path)) as place:
            parquet.write_table(table, place)


def _make_sheet(result: Result, system: System) -> Sheet:
    """Return the sheet of a result; if its renderer has no sheet, the ends of its columns."""
    renderer = find_renderer(result)
    if isinstance(renderer, Renderer):
        return renderer.sheet(result, system)
    return Sheet(repr(result)[1:-1], (_outline(list_columns(result)),))


def _outline(columns: Columns) -> Grid:
    """Return a table of the first and last rows of columns."""
    outlined = []
    length = 0
    for name, values in columns.values.items():
        unit = columns.units.get(name)
        head = f"{name}, {unit}" if unit else name
        outlined.append(Column(head, _write_ends(values)))
        length = len(values)
    return Grid("", outlined, f"{length} rows")


def _write_ends(values: Values) -> list[str]:
    """Return the first and last values of a column, or all values if there are few."""
    if len(values) <= 2 * ENDS:
        return [number(value) for value in values]
    return [*map(number, values[:ENDS]), "...", *map(number, values[-ENDS:])]


def find_renderer(result: Result) -> Columnar[Result]:
    """Return the renderer of a result."""
    return import_name(f"{RENDERERS[type(result).__name__]}:RENDERER")


def _none_for_nan(value: object) -> object:
    return None if isinstance(value, float) and math.isnan(value) else value


def list_columns(result: Result) -> Columns:
    """Return the columns of a result: those of its renderer, or those of its CSV."""
    renderer = find_renderer(result)
    if renderer.columns is None and isinstance(renderer, Renderer):
        columns = _read_columns(renderer.rows(result, SI))
    elif renderer.columns is not None:
        columns = renderer.columns(result)
    filled = {name: _fill_gaps(values) for name, values in columns.values.items()}
    return columns._replace(values=filled)


def _fill_gaps(column: Values) -> Values:
    """Return numbers with gaps as an array with nan. From a list with None, other libraries would
    make columns of objects, with which they cannot compute.
    """
    if isinstance(column, np.ndarray) or None not in column:
        return column
    if any(isinstance(value, str) for value in column):
        return column
    return np.array(column, float)


def _read_columns(rows: Rows) -> Columns:
    """Return rows of CSV as columns of one type each. Words in a column of numbers go into a second
    column, whose name ends in `_text`.
    """
    lines = list(rows.lines)
    values: dict[str, Values] = {}
    for k, head in enumerate(rows.header):
        name = f"{head} ({k + 1})" if head in values else head  # an engine may be called "order"
        cells = [line[k] for line in lines]
        numbers = list(map(_number, cells))
        words = list(map(_word, cells))
        wordy = any(word is not None for word in words)
        if not wordy or any(number is not None for number in numbers):
            values[name] = numbers
        if wordy:
            values[f"{name}_text" if name in values else name] = words
    return Columns(values)


def _number(cell: object) -> float | None:
    """Return a cell as a number; None if it is not a number."""
    if isinstance(cell, (int, float)) and not isinstance(cell, bool):
        return float(cell)
    return None


def _word(cell: object) -> str | None:
    """Return a cell as text; None for a number and an empty cell."""
    if isinstance(cell, bool):
        return str(cell).lower()
    if isinstance(cell, str) and cell:
        return cell
    return None
