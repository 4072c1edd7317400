"""What can be varied of an engine file, and what can be asked of it, by their names."""

from __future__ import annotations

import math
from typing import NamedTuple

from ..enginefile.fields import RIGID
from ..enginefile.model import EngineFile, FileTable, Override
from .parameters import find_numbers
from .quantities import list_quantities
from .quantity_names import Form


class FileNumber(NamedTuple):
    """A number of a file.

    Attributes:
        path: dotted name, as `--vary` takes it.
        value: in its bare unit, or "rigid"; None: it is not in the file.
        unit: of the value, as the file has it without one; empty: a plain number.
        meaning: in words.
    """

    path: str
    value: float | str | None
    unit: str
    meaning: str


class NamedNumbers(NamedTuple):
    """Of one file: its numbers, and the quantities that it has."""

    engine: str
    numbers: tuple[FileNumber, ...]
    quantities: tuple[Form, ...]


def name_numbers(model: EngineFile) -> NamedNumbers:
    """All that `sweep` can vary of a file and ask of it."""
    tables = dict(model.tables())
    numbers = tuple(
        _describe(path, number.dimension.unit, tables)
        for path, number in find_numbers(model).items()
    )
    return NamedNumbers(model.name, numbers, tuple(list_quantities(model)))


def _describe(path: str, unit: str, tables: dict[str, FileTable]) -> FileNumber:
    """A number found by its path: first the table of that name, then its keys and places."""
    parts = path.split(".")
    heads = (".".join(parts[:k]) for k in range(len(parts) - 1, 0, -1))
    head = next((name for name in heads if name in tables), "")
    if not head:  # of a cylinder that does not differ from the others
        return FileNumber(path, None, unit, Override.keys()[parts[-1]].description or "")
    found: object = tables[head]
    meaning = ""
    for part in parts[head.count(".") + 1 :]:
        if isinstance(found, FileTable):
            meaning = found.keys()[part].description or ""
            found = getattr(found, part)
        elif isinstance(found, tuple):
            found = found[int(part) - 1]
    value = float(found) if isinstance(found, int | float) else None
    return FileNumber(path, RIGID if value == math.inf else value, unit, meaning)
