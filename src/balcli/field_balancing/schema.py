"""JSON Schema of a file of runs, for editors that check and complete while one types."""

from __future__ import annotations

from ..enginefile.schema import Node, describe_file
from .model import Run, RunsFile


def describe_runs_file() -> Node:
    """Every key of a file of runs."""
    return describe_file(RunsFile, [Run], "runs-file", "balcli file of runs")
