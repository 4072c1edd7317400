"""JSON Schema of a file of runs, for editors that check and complete while one types."""

from __future__ import annotations

from typing import Any

from ..enginefile.schema import DIALECT, tidy_schema
from .model import Run, RunsFile


def describe_runs_file() -> dict[str, Any]:
    """JSON Schema (draft 2020-12): every key with description, unit, bounds and an example."""
    Run.model_rebuild()
    document: dict[str, Any] = tidy_schema(RunsFile.model_json_schema())
    return {
        "$schema": DIALECT,
        "$id": "urn:balcli:schema:runs-file",
        **document,
        "title": "balcli file of runs",
    }
