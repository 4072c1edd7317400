"""Mistakes of an engine file in plain words: pydantic's findings translated."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from importlib import import_module
from typing import TYPE_CHECKING, get_args

from ..errors import Problem
from ..limits import MOST_LIST_VALUES, MOST_RIPPLES
from . import model
from .fields import counted, printable, shorten

if TYPE_CHECKING:
    from pydantic.fields import FieldInfo
    from pydantic_core import ErrorDetails

TEXTS = ("name", "source")
TABLES: dict[str, type[model.FileTable]] = {
    "crank": model.Crank,
    "rod": model.Rod,
    "piston": model.Piston,
    "layout": model.Layout,
    "bobweight": model.Bobweight,
    "operation": model.Operation,
    "frame": model.Frame,
}
# Tables that few engines have, or of chapters beyond balance: the module of each, imported for
# files that have the table. Its class is called like the key.
CHAPTERS = {
    "articulation": "articulation_tables",
    "gas": "gas_tables",
    "flywheel": "gas_tables",
    "bearing": "gas_tables",
    "torsion": "torsion_tables",
    "body": "mounting_tables",
}
CHAPTER_LISTS = {"mount": "mounting_tables", "point": "mounting_tables"}  # each several times
DEVICES: dict[str, type[model.FileTable]] = {
    "counterweight": model.Counterweight,
    "shaft": model.Shaft,
    "slider": model.Slider,
}
KNOWN = (*TEXTS, *TABLES, *CHAPTERS, "cylinder", *DEVICES, *CHAPTER_LISTS)


def import_table(key: str) -> type[model.FileTable]:
    """Return the table of a key; the module of a chapter is imported."""
    if key in TABLES or key in DEVICES:
        return (TABLES | DEVICES)[key]
    module = import_module(f"{__package__}.{(CHAPTERS | CHAPTER_LISTS)[key]}")
    return getattr(module, key.capitalize())


def import_tables() -> dict[str, type[model.FileTable]]:
    """Return all tables that stand once in a file, with those of chapters."""
    return TABLES | {key: import_table(key) for key in CHAPTERS}


def import_lists() -> dict[str, type[model.FileTable]]:
    """Return all tables that may stand several times in a file, with those of chapters."""
    return DEVICES | {key: import_table(key) for key in CHAPTER_LISTS}


def join_path(start: str, parts: Iterable[int | str]) -> str:
    """Return a dotted path: `a`, ("speed_ripple", 0, "order") -> `a.speed_ripple.1.order`: people
    count from 1. The path of the file itself is empty.
    """
    names = (str(part + 1) if isinstance(part, int) else printable(part) for part in parts)
    return ".".join(filter(None, [start, *names]))


def describe_finding(path: str, finding: ErrorDetails, table: type[model.FileTable]) -> Problem:
    """Return one finding of pydantic in words; a member of a list is named as `the 2nd value`.

    Args:
        path: of the table.
        finding: with the place of the key in it.
        table: what may stand there.
    """
    kind, loc, value = finding["type"], finding["loc"], finding["input"]
    field = find_inner_table(table, loc).keys().get(str(loc[-1])) if loc else None
    examples = list(field.examples or ()) if field else []
    place, shown = join_path(path, loc), shorten(value)
    if kind == "missing":
        example = shorten(examples[0]) if examples else "{ length = 200 }"
        return Problem.of_missing(place, f"give it, such as {loc[-1]} = {example}")
    if kind == "value_error":
        message = str(finding["ctx"]["error"])
    elif kind in ("too_short", "too_long"):
        message = _describe_length(value, finding["ctx"], field)
    elif kind == "tuple_type" and field and find_table(field.annotation):
        found = "is one of several" if isinstance(value, Mapping) else f"{shown} is no table"
        message = f"{found}; write [[{place}]] in double brackets"
    elif kind == "tuple_type":
        example = shorten(next((each for each in examples if isinstance(each, list)), [0, 180]))
        message = f"{shown} is not a list; write it in square brackets, such as {example}"
    elif kind.startswith("model_"):
        message = f"{shown} is not a table; write it in braces with its keys"
    else:
        message = f"{shown} does not fit here"
    if loc and isinstance(loc[-1], int) and not isinstance(value, Mapping):
        return Problem(join_path(path, loc[:-1]), f"the {ordinal(loc[-1] + 1)} value {message}")
    return Problem(place, message)


def find_inner_table(
    table: type[model.FileTable], loc: Sequence[str | int]
) -> type[model.FileTable]:
    """Return the table in which the last part of a place stands: `table`, or one within it."""
    for part in loc[:-1]:
        field = table.keys().get(str(part))
        table = table if field is None else find_table(field.annotation) or table
    return table


def find_table(annotation: object) -> type[model.FileTable] | None:
    """Return the table of which a field's type is made, alone or in a list; None: it is none."""
    if isinstance(annotation, type) and issubclass(annotation, model.FileTable):
        return annotation
    return next(filter(None, map(find_table, get_args(annotation))), None)


def _describe_length(
    value: list[object], context: Mapping[str, object], field: FieldInfo | None
) -> str:
    if not value:
        hint = "" if field is not None and field.is_required() else ", or leave the key out"
        return f"is an empty list; give at least one value{hint}"
    if (most := context.get("max_length")) in (MOST_LIST_VALUES, MOST_RIPPLES):
        return f"has {len(value)} values; at most {most} are taken"
    wanted = context.get("min_length") or context.get("max_length")
    what = field.description if field else None
    these = f": {what.partition(';')[0]}" if what else ""
    return f"{shorten(value)} has {counted(len(value), 'value')} where {wanted} are wanted{these}"


def ordinal(number: int) -> str:
    """1st, 2nd, 3rd, 4th ..."""
    if number % 100 in (11, 12, 13):
        return f"{number}th"
    suffix = {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{suffix}"
