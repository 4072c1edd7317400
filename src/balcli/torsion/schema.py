"""JSON Schema of a chain file, for editors that check and complete while one types."""

from __future__ import annotations

from ..enginefile.schema import Node, describe_file
from ..enginefile.shafting import Damper
from .chain_file import ChainFile
from .read_chain import LISTS


def describe_chain_file() -> Node:
    """Every key of a chain file."""
    return describe_file(ChainFile, [Damper, *LISTS], "chain-file", "balcli chain file")
