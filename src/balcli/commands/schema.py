"""`balcli schema`"""

from __future__ import annotations

import json
from enum import StrEnum
from typing import Annotated

import typer

from .file_names import require_ending
from .options import Output
from .output import emit


class File(StrEnum):
    """Files that have a schema."""

    ENGINE = "engine"
    FIELD = "field"


def schema(
    kind: Annotated[
        File, typer.Argument(help="engine: the engine file; field: runs of a rotor on a machine.")
    ] = File.ENGINE,
    output: Output = None,
) -> None:
    """Print the JSON Schema of the engine file, or of a file of runs, for editors."""
    require_ending(output, ".json")
    from ..enginefile.schema import schema as describe_engine_file  # pydantic
    from ..field_balancing.schema import describe_runs_file

    describe = describe_engine_file if kind is File.ENGINE else describe_runs_file
    emit(json.dumps(describe(), indent=2, ensure_ascii=False), output)
