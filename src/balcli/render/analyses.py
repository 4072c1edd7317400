"""Analyses of several engines, one after the other.

What is for people takes a dozen modules that JSON and CSV do without, and these some that a sheet
does without: each imports its own.
"""

from __future__ import annotations

from typing import Any

from ..results.analysis import Analysis
from .csv import Rows, name_cell
from .formats import Renderer
from .sheet import Sheet
from .units import System
from .view import NamedResult


def sheet(one: NamedResult[Analysis], system: System) -> Sheet:
    """What a person reads of it."""
    from . import analysis

    return analysis.sheet(one.result, system, one.view)


def document(one: NamedResult[Analysis]) -> dict[str, Any]:
    """`balcli.analysis/1`."""
    from . import analysis_document

    return analysis_document.document(one.result)


def rows(one: NamedResult[Analysis], system: System) -> Rows:
    """CSV: the rows of the analysis, each after the engine's name."""
    from . import analysis_document

    devices = "sizing" in one.view.parts
    header, lines = analysis_document.rows(one.result, system, devices=devices)
    return Rows(("engine", *header), ((name_cell(one.name), *line) for line in lines))


RENDERER = Renderer(sheet=sheet, document=document, rows=rows)
