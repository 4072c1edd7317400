"""What can be varied of an engine file, and what can be asked of it, by their names."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from ..enginefile.fields import RIGID
from ..enginefile.model import EngineFile, FileTable, Override
from .parameters import find_numbers
from .quantities import NamedEngine, list_quantities


@dataclass(frozen=True)
class FileNumber:
    """A number of an engine file.

    Attributes:
        path: Dotted name, as `--vary` takes it.
        value: Value in its unit, or "rigid"; null: it is not in the file.
        unit: Unit of the value, as the file has it without one; empty: a plain number.
        meaning: Meaning in words.
    """

    path: str
    value: float | str | None
    unit: str
    meaning: str


@dataclass(frozen=True)
class NamedQuantity:
    """Quantities by a pattern.

    Attributes:
        name: N stands for an order, PART for a word of the meaning.
        unit: SI unit.
        meaning: Meaning in words.
    """

    name: str
    unit: str
    meaning: str


@dataclass(frozen=True, kw_only=True)
class NamedNumbers:
    """What can be varied of an engine file, and what can be asked of it.

    Attributes:
        format: Name and version of the document.
        engine: The engine.
        numbers: Numbers of the file.
        quantities: Quantities that it has.
    """

    format: Literal["balcli.numbers/1"] = "balcli.numbers/1"
    engine: NamedEngine
    numbers: tuple[FileNumber, ...]
    quantities: tuple[NamedQuantity, ...]


def name_numbers(model: EngineFile) -> NamedNumbers:
    """Return all that `sweep` can vary of a file and ask of it."""
    tables = dict(model.tables())
    return NamedNumbers(
        engine=NamedEngine(model.name),
        numbers=tuple(
            _describe(path, number.dimension.unit, tables)
            for path, number in find_numbers(model).items()
        ),
        quantities=tuple(
            NamedQuantity(form.pattern, form.unit, form.words) for form in list_quantities(model)
        ),
    )


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
