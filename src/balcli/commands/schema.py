"""`balcli schema`"""

from __future__ import annotations

import json
from enum import StrEnum
from typing import Annotated, Any

import typer

from ..documents.names import DOCUMENTS
from ..enginefile.fields import suggest_nearest
from ..errors import BalcliError
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
        File | None,
        typer.Argument(
            show_default="engine",
            help="engine: the engine file; field: runs of a rotor on a machine; torsion: a chain "
            "of inertias and shafts.",
        ),
    ] = None,
    of: Annotated[
        str | None,
        typer.Option(
            "--of",
            metavar="RESULT",
            show_default=False,
            help=f"Of a result as JSON instead: {', '.join(DOCUMENTS)}.",
        ),
    ] = None,
    output: Output = None,
) -> None:
    """Print the JSON Schema of the engine file, a file of runs or a chain file, for editors; or of
    what a command prints as JSON.

    \b
    Examples:
      balcli schema -o balcli.schema.json
      balcli schema --of analysis
    """
    require_ending(output, ".json")
    described = _describe_file(kind or File.ENGINE) if of is None else _describe_result(of, kind)
    emit(json.dumps(described, indent=2, ensure_ascii=False), output)


def _describe_file(kind: File) -> dict[str, Any]:
    from ..enginefile.schema import describe_engine_file, describe_file  # pydantic
    from ..enginefile.shafting import Damper
    from ..field_balancing.model import Run, RunsFile
    from ..torsion.chain_file import ChainFile
    from ..torsion.read_chain import LISTS

    match kind:
        case File.ENGINE:
            return describe_engine_file()
        case File.FIELD:
            return describe_file(RunsFile, [Run], "runs-file", "balcli file of runs")
        case File.TORSION:
            return describe_file(ChainFile, [Damper, *LISTS], "chain-file", "balcli chain file")


def _describe_result(name: str, kind: File | None) -> dict[str, Any]:
    if kind is not None:
        raise BalcliError(f"--of {name}: is of a result; leave {kind} out, which is a file")
    if name not in DOCUMENTS:
        hint = suggest_nearest(name, DOCUMENTS, f"there are {', '.join(DOCUMENTS)}")
        raise BalcliError(f"--of {name[:60]}: there is no such result; {hint}")
    from ..documents.schema import describe_document  # pydantic

    return describe_document(name)
