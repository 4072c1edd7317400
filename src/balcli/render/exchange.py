"""Answers for other libraries: documents, rows, and columns for pandas and Parquet."""

from __future__ import annotations

import math
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import BalcliError
from ..files import replacing
from ..result import Result
from ..version import __version__
from .csv import Column, Columns, Rows
from .formats import Columnar, Renderer
from .json import stamp
from .units import SI

# Which module shows a kind of answer: its document, and its columns or the rows of its CSV.
RENDERERS = {
    "Analysis": "analysis_document",
    "Balance": "balance",
    "Combined": "two_engines",
    "Comparison": "comparison",
    "Curves": "curves",
    "FieldBalance": "field_balancing",
    "MountReport": "mounts",
    "Scatter": "scatter",
    "Search": "search",
    "Swept": "sweep",
    "Table": "printed_table",
    "TorqueAnalysis": "torque",
    "TorsionAnalysis": "torsion",
}
INSTALLED_BY = {"pandas": "pandas", "pyarrow": "balcli[scale]"}


def find_renderer(result: Result) -> Columnar[Any]:
    """Return what shows an answer."""
    module = import_module(f".{RENDERERS[type(result).__name__]}", __package__)
    renderer: Columnar[Any] = module.RENDERER
    return renderer


def describe(result: Result) -> dict[str, Any]:
    """The JSON document of an answer."""
    found: dict[str, Any] = stamp(find_renderer(result).document(result))
    return found


def list_rows(result: Result) -> list[dict[str, Any]]:
    """One dict a row."""
    found = list_columns(result).values
    lists = [v.tolist() if isinstance(v, np.ndarray) else v for v in found.values()]
    lines = zip(*lists, strict=True)
    return [dict(zip(found, map(_none_for_nan, line), strict=True)) for line in lines]


def _none_for_nan(value: Any) -> Any:
    return None if isinstance(value, float) and math.isnan(value) else value


def list_columns(result: Result) -> Columns:
    """The columns of an answer: those that its renderer names, or those of its CSV."""
    renderer = find_renderer(result)
    if renderer.columns is None and isinstance(renderer, Renderer):
        found = _read_columns(renderer.rows(result, SI))
    elif renderer.columns is not None:
        found = renderer.columns(result)
    return found._replace(values={k: _fill_gaps(column) for k, column in found.values.items()})


def _fill_gaps(column: Column) -> Column:
    """Numbers among which some are missing as an array with nan: of a list with None other
    libraries make objects, with which nothing can be computed.
    """
    if isinstance(column, np.ndarray) or None not in column:
        return column
    return column if any(isinstance(value, str) for value in column) else np.array(column, float)


def _read_columns(rows: Rows) -> Columns:
    """Rows of CSV as columns of one type each: words among numbers get a column of their own, with
    `_text` after its name.
    """
    lines = list(rows.lines)
    values: dict[str, Column] = {}
    for k, head in enumerate(rows.header):
        name = f"{head} ({k + 1})" if head in values else head  # an engine may be called "order"
        cells = [line[k] for line in lines]
        numbers = [_number(cell) for cell in cells]
        words = [_word(cell) for cell in cells]
        if any(number is not None for number in numbers):
            values[name] = numbers
        if any(word is not None for word in words):
            values[f"{name}_text" if name in values else name] = words
        if name not in values:
            values[name] = numbers  # nothing in it
    return Columns(values)


def _number(cell: Any) -> float | None:
    """A cell as a number; None if it is none."""
    return float(cell) if isinstance(cell, (int, float)) and not isinstance(cell, bool) else None


def _word(cell: Any) -> str | None:
    """A cell as text; None for a number, and where nothing is said."""
    if isinstance(cell, bool):
        return str(cell).lower()
    return cell if isinstance(cell, str) and cell else None


# ------------------------------------------------------------------ other libraries
def import_library(name: str, method: str) -> Any:
    """A library that balcli does without unless it is asked for.

    Raises:
        BalcliError: it is not there, with what to install.
    """
    try:
        return import_module(name)
    except ImportError:
        top = name.partition(".")[0]
        wanted = INSTALLED_BY[top]
        raise BalcliError(f"{method} needs {top}: pip install {wanted}") from None


def make_frame(result: Result) -> Any:
    """A DataFrame of pandas."""
    pandas = import_library("pandas", "to_pandas()")
    found = list_columns(result)
    frame = pandas.DataFrame(dict(found.values))
    frame.attrs["units"] = dict(found.units)
    return frame


def write_parquet(result: Result, path: str | Path) -> None:
    """A Parquet file, which takes its place when it is whole; errors as of `replacing`."""
    parquet = import_library("pyarrow.parquet", "to_parquet()")
    pyarrow = import_library("pyarrow", "to_parquet()")
    found = list_columns(result)
    arrays = [pyarrow.array(column, from_pandas=True) for column in found.values.values()]
    fields = [
        pyarrow.field(name, array.type, metadata={"unit": found.units.get(name, "")})
        for name, array in zip(found.values, arrays, strict=True)
    ]
    about = {"balcli.version": __version__, "balcli.result": type(result).__name__}
    table = pyarrow.table(arrays, schema=pyarrow.schema(fields, metadata=about))
    with replacing(Path(path)) as place:
        parquet.write_table(table, place)
