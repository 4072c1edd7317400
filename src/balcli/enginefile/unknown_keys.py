"""Keys that no engine file has: what was probably meant, or what says it instead."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from typing import Any, NamedTuple

from ..errors import Problem
from ..limits import MOST_MISTAKES_SHOWN
from . import model
from .fields import nearest, printable
from .messages import (
    CHAPTER_LISTS,
    CHAPTERS,
    DEVICES,
    KNOWN,
    TABLES,
    TEXTS,
    import_lists,
    import_tables,
)

# What people call a key, and keys that mean it; the first that a table has
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
    "weight": ("mass", "piston_mass"),
    "piston": ("piston_mass",),
    "order": ("firing_order",),
    "lambda": ("ratio",),
    "j": ("inertia", "throw_inertia"),
    "k": ("stiffness", "throw_stiffness"),
    "file": ("indicator",),
}
_COUNT = (
    "the number of cylinders follows from throws and banks; give every throw its angle, such as "
    "crank.throws = [0, 180, 180, 0]"
)
_WHEEL_OF_TORSION = ("torsion", "flywheel")  # one of its parts: `torsion` reads no [flywheel]
_PART = "what turns with the crankshaft is a [[torsion.rear]] or a [[torsion.front]]"
# What is no key of an engine file by any name, and what to write instead
INSTEAD = {
    **dict.fromkeys(("cylinders", "count", "number_of_cylinders"), _COUNT),
    **dict.fromkeys(("radius", "crank_radius"), "give crank.stroke, twice the crank radius"),
    **dict.fromkeys(
        ("power", "torque"), "power and torque follow from gas.imep and operation.speed"
    ),
    **dict.fromkeys(
        ("overbalance", "balance_factor", "factor"),
        "did you mean balcli balance FILE --factor 51%?",
    ),
    **dict.fromkeys(("unit", "units"), 'a unit stands with its figure, such as "3.5 in"'),
}


class UnknownKey(NamedTuple):
    """A key that there is not.

    Attributes:
        path: of the table in which it stands; empty for the file itself.
        key: as it is written.
        table: what may stand in that table; None for the file itself, and for a table that no
            engine file has.
        holds_table: whether a table stands there.
    """

    path: str
    key: str
    table: type[model.FileTable] | None
    holds_table: bool = False

    @property
    def is_misplaced(self) -> bool:
        """Whether it is a table of its own, written within another one where it does not count."""
        if (self.path, self.key) == _WHEEL_OF_TORSION:
            return False
        return bool(self.path) and self.holds_table and self.key in {*KNOWN} - {*TEXTS}


def find_unknown_keys(data: Mapping[str, Any]) -> Iterator[UnknownKey]:
    """Keys of the file itself that no engine file has.

    Of a table such as `[engine]`, which is like none that there is, each of its keys: they have
    their places elsewhere.
    """
    strangers = [key for key in data if key not in KNOWN]
    for count, key in enumerate(strangers):
        inside = data[key] if isinstance(data[key], Mapping) else {}
        shown = count < MOST_MISTAKES_SHOWN  # of the others only how many there are is told
        if inside and not (shown and (key.lower() in INSTEAD or _find_own(key, KNOWN))):
            for inner, value in inside.items():
                yield UnknownKey(key, inner, None, isinstance(value, Mapping))
        else:
            yield UnknownKey("", key, None)


def describe_unknown_key(unknown: UnknownKey) -> tuple[Problem, str]:
    """An unknown key in words, and the path of the key that was probably meant, or ""."""
    path, key, table, _ = unknown
    if unknown.is_misplaced:
        return Problem(f"{path}.{printable(key)}", _tell_own_table(path, key)), key
    first = path.partition(".")[0]
    start = f"{path}." if path else ""
    own = list(table.model_fields) if table else [] if path else list(KNOWN)
    hint, meant = _suggest(first, key, own)
    if not path:
        told = f"unknown key in an engine file; {hint}"
    elif table:
        told = f"unknown key in [{_name_heading(path)}]; {hint}"
    else:
        told = f"there is no table [{printable(first)}]{'; ' if hint else ''}{hint}"
    return Problem(start + printable(key), told), start + meant if meant else ""


def _tell_own_table(path: str, key: str) -> str:
    """Of a table that stands within the one at a path."""
    several = key in {**DEVICES, **CHAPTER_LISTS}
    head = f"[[{key}]]" if several else "[cylinder.3]" if key == "cylinder" else f"[{key}]"
    within = printable(_name_heading(path))
    return (
        f"{key} is a table of its own, not one within [{within}]; write {head} and its keys below "
        "it"
    )


def _name_heading(path: str) -> str:
    """`operation.speed_ripple` of its second line, `operation.speed_ripple.2`."""
    return ".".join(part for part in path.split(".") if not part.isdecimal())


def suggest_place(key: str) -> str:
    """The tables of an engine file that have this key, in words: `bore belongs to [piston]`; empty
    if none has.
    """
    if key in TEXTS:
        return f"{key} stands at the head of the file, above all tables"
    tables = import_tables()
    having = [name for name, table in tables.items() if key in table.model_fields]
    # The parts of an engine first: a chapter may use the same word for something of its own
    of_engine = [name for name in having if name in TABLES]
    names = [f"[{name}]" for name in of_engine or having]
    if not names:
        lists = import_lists().items()
        names = [f"[[{name}]]" for name, table in lists if key in table.model_fields]
    return f"{key} belongs to {' or '.join(names)}" if names else ""


def _suggest(first: str, key: str, own: list[str]) -> tuple[str, str]:
    """Return what to write instead of a key in a table (its name, its keys), in words; and the key
    of the same table that was probably meant, or "".
    """
    if (first, key) == _WHEEL_OF_TORSION:
        return _PART, ""
    of_engine = first not in {*DEVICES, *CHAPTERS, *CHAPTER_LISTS}
    if of_engine and key.lower() in INSTEAD:
        return INSTEAD[key.lower()], ""
    if meant := _find_own(key, own):
        return f"did you mean {meant}?", meant
    listed = f"it has {', '.join(own)}" if own else ""
    return suggest_place(key) or _suggest_elsewhere(key) or listed, ""


def _find_own(key: str, own: Iterable[str]) -> str:
    """Return the key of this table that was probably meant; empty if there is none, or if it is
    spelt as a key of another table.
    """
    if synonym := _find_synonym(key, own):
        return synonym
    belongs = suggest_place(key)
    return "" if belongs and "[[" not in belongs else nearest(key, own)


def _find_synonym(key: str, own: Iterable[str]) -> str:
    """Return the key of this table that means what others call so; empty if there is none."""
    meant = SYNONYMS.get(key.lower().replace("-", "_"), ())
    return next(filter(set(own).__contains__, meant), "")


def _suggest_elsewhere(key: str) -> str:
    """Return a table whose key others call so or is spelt nearly so, in words; else empty."""
    for find in (_find_synonym, partial(nearest, cutoff=0.75)):
        for name, table in import_tables().items():
            if meant := find(key, table.model_fields):
                return f"did you mean {meant} of [{name}]?"
    return ""
