"""Write messages for mistakes in an engine file: pydantic's findings in plain words, and remedies
for unknown keys. Recognize the kinds of files by their top-level keys.

Chapters are tables of one subject, such as torsion (`names.CHAPTERS`). Most of their modules are
imported only for files that have these tables.
"""

from __future__ import annotations

from collections.abc import Collection, Container, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, get_args

from ..errors import OtherKindError, Problem
from ..names import CHAPTER_LISTS, CHAPTERS, import_name
from . import model
from .fields import counted, nearest, printable, shorten
from .table import FileTable, KeyDocument, document_keys

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails


TEXTS = ("name", "source")


TABLES = ("crank", "rod", "piston", "crosshead", "layout", "bobweight", "operation", "frame")
DEVICES = ("counterweight", "shaft", "slider")
KNOWN = (*TEXTS, *TABLES, *CHAPTERS, "cylinder", *DEVICES, *CHAPTER_LISTS)
# Keys allowed in a file with [[engine]]; all other keys belong in the files that [[engine]] names
_OF_WHOLE = (
    "operation",
    "frame",
    "flywheel",
    "body",
    *DEVICES,
    "engine",
    "mount",
    "point",
    "check",
)
BESIDE_ENGINES = (*TEXTS, *_OF_WHOLE)


def import_table(key: str) -> type[FileTable]:
    """Return the class of the table with this key; the module of a chapter is imported first."""
    place = (CHAPTERS | CHAPTER_LISTS).get(key)
    table: type[FileTable] = getattr(import_name(place) if place else model, key.capitalize())
    return table


def import_tables() -> dict[str, type[FileTable]]:
    """Return the classes of all tables that a file can have only once, with those of chapters."""
    return {key: import_table(key) for key in (*TABLES, *CHAPTERS)}


def join_path(start: str, parts: Iterable[int | str]) -> str:
    """Return a dotted path: `a.speed_ripple.1.order` for `a` and ("speed_ripple", 0, "order"). In
    paths, members of lists count from 1. The path of the file itself is empty.

    Args:
        start: Path of the table.
        parts: Keys, and indices in lists from 0.
    """
    names = (str(part + 1) if isinstance(part, int) else printable(part) for part in parts)
    return ".".join(filter(None, [start, *names]))


def describe_finding(path: str, finding: ErrorDetails, table: type[FileTable]) -> Problem:
    """Return the message for a finding of pydantic.

    Args:
        path: Path of the table.
        finding: Finding, with the place of the key in the table.
        table: Class of the table.
    """
    kind = finding["type"]
    loc = finding["loc"]
    value = finding["input"]
    inner = find_inner_table(table, loc)
    key = str(loc[-1]) if loc else ""
    field = inner.keys().get(key)
    document = document_keys(inner).get(key, KeyDocument())
    place = join_path(path, loc)
    shown = shorten(value)
    if kind == "missing":
        example = "{ length = 200 }" if document.example is None else shorten(document.example)
        return Problem.of_missing(place, f"give it, such as {key} = {example}")
    if kind == "value_error":
        message = "; ".join(finding["ctx"]["error"].args)
    elif kind in ("too_short", "too_long"):
        bounds = {"too_short": ("at least", "min_length"), "too_long": ("at most", "max_length")}
        most, bound = bounds[kind]
        meaning = document.description.partition(";")[0]
        message = f"{shown} has {counted(len(value), 'value')}; give {most} {finding['ctx'][bound]}"
        message += f": {meaning}" if meaning else ""
    elif kind == "tuple_type" and field and find_table(field.annotation):
        fault = (
            "may be given several times" if isinstance(value, Mapping) else f"{shown} is no table"
        )
        message = f"{fault}; write [[{place}]] in double brackets"
    elif kind == "tuple_type":
        example = shorten(document.example or [0, 180])
        message = f"{shown} is not a list; write it in square brackets, such as {example}"
    else:
        message = f"{shown} is not a table; write it in braces with its keys"
    return Problem(place, message)


def find_inner_table(table: type[FileTable], loc: Sequence[str | int]) -> type[FileTable]:
    """Return the table that holds the last part of a place: `table`, or one within it.

    Args:
        table: Table at the start of the place.
        loc: Keys, and indices in lists.
    """
    for part in loc[:-1]:
        field = table.keys().get(str(part))
        table = table if field is None else find_table(field.annotation) or table
    return table


def find_table(annotation: object) -> type[FileTable] | None:
    """Return the class of the table in a field's type (a table, or a list of tables); None if the
    field has another type.
    """
    if isinstance(annotation, type) and issubclass(annotation, FileTable):
        return annotation
    return next(filter(None, map(find_table, get_args(annotation))), None)


SHARED = {"name", "source", "shaft"}  # keys of an engine file that other kinds may have


class FileKind(NamedTuple):
    """A kind of file.

    Attributes:
        name: Name of the kind.
        reader: The command that reads this kind, with the verb, such as "balcli field reads".
        keys: Top-level keys that only this kind has.
    """

    name: str
    reader: str
    keys: frozenset[str]


ENGINE = FileKind("an engine file", "balcli analyze and others read", frozenset(KNOWN) - SHARED)
RUNS = FileKind("a file of runs", "balcli field reads", frozenset({"planes", "run"}))
CHAIN = FileKind("a chain file", "balcli torsion reads", frozenset({"node", "excitation"}))


def refuse_other_kind(head: Container[str], file: str, *wanted: FileKind) -> None:
    """Raise an error if the top-level keys of a file show that it is of another kind. In that case
    a list of all its mistakes would not help.

    Args:
        head: Top-level keys of the file.
        file: Name of the file.
        wanted: Kinds that can be read here.

    Raises:
        OtherKindError: The file is of another kind; the error names it and the command that reads
            it.
    """
    matching = [kind for kind in (ENGINE, RUNS, CHAIN) if any(key in head for key in kind.keys)]
    if len(matching) == 1 and matching[0] not in wanted:
        names = " or ".join(kind.name for kind in wanted)
        message = f"is {matching[0].name}, which {matching[0].reader}; give {names}"
        raise OtherKindError([Problem("", message)], file)


# Other words for keys, and the keys that they may mean; messages propose the first key in the list
# that the table has.
SYNONYMS = {
    "conrod": ("rod",),
    "connecting_rod": ("rod",),
    "rpm": ("speed",),
    "pin_offset": ("splay", "offset"),
    "pin_angles": ("throws",),
    "crank_angles": ("throws",),
    "angles": ("throws", "banks"),
    "phase": ("throws", "angle"),
    "bore_spacing": ("spacing",),
    "bank": ("bank_angle",),
    "vee_angle": ("bank_angle",),
    "angle": ("bank_angle", "throws"),
    "diameter": ("bore",),
    "piston": ("piston_mass",),
    "weight": ("mass", "piston_mass"),
    "order": ("firing_order",),
    "lambda": ("ratio",),
    "j": ("inertia", "throw_inertia"),
    "k": ("stiffness", "throw_stiffness"),
    "file": ("indicator",),
    "radius": ("knuckle_radius",),
}
_COUNT = (
    "the number of cylinders follows from throws and banks; give every throw its angle, such as "
    "crank.throws = [0, 180, 180, 0]"
)
# Words that are no keys of an engine file, and what to write instead.
INSTEAD = {
    **dict.fromkeys(("cylinders", "count", "number_of_cylinders"), _COUNT),
    **dict.fromkeys(("radius", "crank_radius"), "give crank.stroke, twice the crank radius"),
}
# Least similarity (1: equal) of an unknown key to a proposed key of the same or of another table
_NEAR = 0.65
_NEAR_ELSEWHERE = 0.75


def format_heading(path: str) -> str:
    """Return the heading of the table with this path: `[rod]`, `[[shaft]]` for `shaft.2`,
    `[cylinder.3]`, `[check.limits]`.
    """
    if path == "cylinder" or path.startswith("cylinder."):
        return f"[{path if '.' in path else 'cylinder.3'}]"
    if path.startswith("check.limits."):  # the rest is the name of a quantity
        return "[check.limits]"
    name = ".".join(part for part in path.split(".") if not part.isdecimal())
    several = path[-1:].isdecimal() or name in DEVICES or name in CHAPTER_LISTS
    return f"[[{name}]]" if several else f"[{name}]"


def suggest(key: str, own: Collection[str], *, is_engine: bool = True) -> tuple[str, str]:
    """Return the remedy for an unknown key, in words, and the key that was probably meant ("" if
    no key is similar).

    Args:
        key: Key as it is written.
        own: Keys of the table in which it is written.
        is_engine: Whether the table is in an engine file, for which there are more hints.
    """
    word = key.lower().replace("-", "_")
    synonyms = SYNONYMS.get(word, ())
    if is_engine and word in INSTEAD and "knuckle_radius" not in own:
        return INSTEAD[word], ""
    if meant := next((each for each in synonyms if each in own), ""):
        return f"did you mean {meant}?", meant
    if is_engine and (place := suggest_place(key)):
        return place, ""
    if near := nearest(key, own, _NEAR):
        return f"did you mean {near}?", near
    listed = f"it has {', '.join(own)}" if own else ""
    if not is_engine:
        return listed, ""
    keys = {each for table in import_tables().values() for each in table.model_fields}
    elsewhere = (*synonyms, nearest(key, sorted(keys), _NEAR_ELSEWHERE))
    return next(filter(None, map(suggest_place, elsewhere)), listed), ""


def suggest_place(key: str) -> str:
    """Return in words which tables of an engine file have this key: `bore belongs to [piston]`;
    empty if no table has it.
    """
    if key in TEXTS:
        return f"{key} belongs at the head of the file, above all tables"
    having = [name for name, table in import_tables().items() if key in table.model_fields]
    # Tables of chapters are named only if no other table has the key: in a chapter, the same key
    # may have another meaning.
    names = [f"[{name}]" for name in having if name in TABLES] or [f"[{name}]" for name in having]
    return f"{key} belongs to {' or '.join(names)}" if names else ""
