"""Engine file -> engine: read, checked against the rules, built; every mistake at once, each by its
path in the file and with what would be right.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..enginefile.model import EngineFile
from ..enginefile.plain_tables import take_tables
from ..enginefile.toml_text import name_file
from ..errors import naming_file
from .build import Engine, build
from .parse import parse_tables

_WANTED = "give the path of an engine file, the text of one, or a dict of its tables"


def load(source: str | Path | Mapping[str, Any]) -> Engine:
    """The engine that a file, a text or a dict describes, ready to analyse.

    Args:
        source: the path of an engine file, "-" for standard input; or its content: a text of
            several lines (TOML), or a dict of its tables, such as `{"crank": {"stroke": 90},
            "rod": {"length": 150}, "piston": {"mass": 0.5}}`. Bare numbers are mm, kg, degrees,
            rpm; a text bears its own unit ("3.5 in"); None counts as not given.

    Raises:
        BalcliError: there is nothing to read.
        InputError: every mistake of the file.
        TypeError: the source is none of these.

    Example:
        >>> engine = load("v8.toml")
    """
    return build_tables(*take_tables("load", source, _WANTED))


def build_tables(tables: Mapping[str, Any], name: str) -> Engine:
    """The engine that the tables of a file describe; `name` is that of the file, beside which those
    stand that it names, or empty.

    Raises:
        InputError: every mistake of the tables.
    """
    model = parse_tables(tables, name)
    with naming_file(name):
        return build(model)


def build_named(model: EngineFile, path: str | Path) -> Engine:
    """The engine of a model from the file at a path ("-": standard input).

    Raises:
        InputError: what does not fit together in this file.
    """
    with naming_file(name_file(path)):
        return build(model)
