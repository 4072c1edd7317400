"""JSON Schema of a chain file, for editors that check and complete while one types."""

from __future__ import annotations

from typing import Any

from ..enginefile.model import FileTable
from ..enginefile.schema import DIALECT, tidy_schema
from ..enginefile.shafting import Damper
from .chain_file import ChainFile
from .read_chain import LISTS


def describe_chain_file() -> dict[str, Any]:
    """JSON Schema (draft 2020-12): every key with description, unit, bounds and an example."""
    tables: tuple[type[FileTable], ...] = (Damper, *LISTS)
    for table in tables:
        table.model_rebuild()
    document: dict[str, Any] = tidy_schema(ChainFile.model_json_schema())
    return {
        "$schema": DIALECT,
        "$id": "urn:balcli:schema:chain-file",
        **document,
        "title": "balcli chain file",
    }
