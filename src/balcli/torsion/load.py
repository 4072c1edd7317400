"""A file -> torsional system, whichever of both it describes: a chain, or an engine."""

from __future__ import annotations

from ..enginefile.toml_text import name_file, parse_toml, read_bytes
from .build_chain import build_chain
from .read_chain import read_chain_tables
from .system import TorsionalSystem


def load_system(path: str) -> TorsionalSystem:
    """The system of a file, or on standard input for "-".

    Raises:
        BalcliError: it cannot be read; all its mistakes.
    """
    name = name_file(path)
    data = parse_toml(read_bytes(path), name)
    return build_chain(read_chain_tables(data, name), name)
