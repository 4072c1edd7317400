"""Analyses of several engines, one after the other."""

from __future__ import annotations

from typing import Any, NamedTuple

from ..results.analysis import Analysis
from . import analysis
from .csv import Rows, name_cell
from .sheet import Sheet
from .units import System


class NamedAnalysis(NamedTuple):
    """One of several analyses.

    Attributes:
        name: of the engine, by which its rows are told from those of the others.
        view: what of it a sheet shows.
    """

    name: str
    result: Analysis
    view: analysis.View = analysis.IN_BRIEF


def sheet(one: NamedAnalysis, system: System) -> Sheet:
    """What a person reads of it."""
    return analysis.sheet(one.result, system, one.view)


def document(one: NamedAnalysis) -> dict[str, Any]:
    """`balcli.analysis/1`."""
    return analysis.document(one.result)


def rows(one: NamedAnalysis, system: System) -> Rows:
    """CSV: the rows of the analysis, each after the engine's name."""
    header, lines = analysis.rows(one.result, system)
    return Rows(("engine", *header), ((name_cell(one.name), *line) for line in lines))
