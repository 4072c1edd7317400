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
    TORSION = "torsion"


def schema(
    kind: Annotated[
        File,
        typer.Argument(
            help="engine: the engine file; field: runs of a rotor on a machine; torsion: a chain "
            "of inertias and shafts."
        ),
    ] = File.ENGINE,
    output: Output = None,
) -> None:
    """Print the JSON Schema of the engine file, a file of runs or a chain file, for editors."""
    require_ending(output, ".json")
    from ..enginefile.schema import describe_engine_file  # pydantic
    from ..field_balancing.schema import describe_runs_file
    from ..torsion.schema import describe_chain_file

    describe = {
        File.ENGINE: describe_engine_file,
        File.FIELD: describe_runs_file,
        File.TORSION: describe_chain_file,
    }
    emit(json.dumps(describe[kind](), indent=2, ensure_ascii=False), output)
