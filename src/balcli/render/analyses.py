"""Analyses of several engines, one after the other.

What is for people takes a dozen modules that JSON and CSV do without, and these some that a sheet
does without: each imports its own.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from ..results.analysis import Analysis
from .csv import Rows, name_cell
from .sheet import Sheet
from .units import System
from .view import IN_BRIEF, View


class NamedAnalysis(NamedTuple):
    """One of several analyses.

    Attributes:
        name: of the engine, by which its rows are told from those of the others.
        view: what of it a sheet shows.
    """

    name: str
    result: Analysis
    view: View = IN_BRIEF


def sheet(one: NamedAnalysis, system: System) -> Sheet:
    """What a person reads of it."""
    from . import analysis

    return analysis.sheet(one.result, system, one.view)


def document(one: NamedAnalysis) -> dict[str, Any]:
    """`balcli.analysis/1`."""
    from . import analysis_document

    return analysis_document.document(one.result)


def rows(one: NamedAnalysis, system: System) -> Rows:
    """CSV: the rows of the analysis, each after the engine's name."""
    from . import analysis_document

    header, lines = analysis_document.rows(one.result, system)
    return Rows(("engine", *header), ((name_cell(one.name), *line) for line in lines))
