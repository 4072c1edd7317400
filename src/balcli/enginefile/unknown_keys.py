"""Keys that no engine file has: what was probably meant, or what says it instead."""

from __future__ import annotations

from collections.abc import Collection

from ..errors import Problem
from .fields import nearest, printable
from .messages import (
    CHAPTER_LISTS,
    DEVICES,
    TABLES,
    TEXTS,
    import_tables,
    join_path,
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
# What is no key of an engine file by any name, and what to write instead
INSTEAD = {
    **dict.fromkeys(("cylinders", "count", "number_of_cylinders"), _COUNT),
    **dict.fromkeys(("radius", "crank_radius"), "give crank.stroke, twice the crank radius"),
}
_NEAR = 0.65  # of a key and one of its table that is meant: "damper" is no "name"
_NEAR_ELSEWHERE = 0.75


def describe_misplaced(path: str, key: str) -> Problem:
    """Return the mistake of a table of its own that stands within the one at `path`."""
    several = key in {**DEVICES, **CHAPTER_LISTS}
    head = f"[[{key}]]" if several else "[cylinder.3]" if key == "cylinder" else f"[{key}]"
    message = (
        f"{key} is a table of its own, not one within [{printable(name_heading(path))}]; write "
        f"{head} and its keys below it"
    )
    return Problem(join_path(path, [key]), message, meant=key)


def name_heading(path: str) -> str:
    """Return the name of a table in its heading: `operation.speed_ripple` of its second line,
    `operation.speed_ripple.2`.
    """
    return ".".join(part for part in path.split(".") if not part.isdecimal())


def suggest_own(key: str, own: Collection[str]) -> tuple[str, str]:
    """Return what to write instead of an unknown key, in words, and the key that was probably
    meant, or "".

    Args:
        key: as it is written.
        own: keys of its table.
    """
    if near := nearest(key, own, _NEAR):
        return f"did you mean {near}?", near
    return f"it has {', '.join(own)}" if own else "", ""


def suggest(key: str, own: Collection[str]) -> tuple[str, str]:
    """Return the same as `suggest_own` for a table of an engine file: synonyms and the tables that
    have the key count, too.
    """
    word = key.lower().replace("-", "_")
    if word in INSTEAD:
        return INSTEAD[word], ""
    synonyms = SYNONYMS.get(word, ())
    if meant := next((each for each in synonyms if each in own), ""):
        return f"did you mean {meant}?", meant
    if place := suggest_place(key):
        return place, ""
    hint, meant = suggest_own(key, own)
    if meant:
        return hint, meant
    keys = {each for table in import_tables().values() for each in table.model_fields}
    elsewhere = (*synonyms, nearest(key, sorted(keys), _NEAR_ELSEWHERE))
    return next(filter(None, map(suggest_place, elsewhere)), hint), ""


def suggest_place(key: str) -> str:
    """Return the tables of an engine file that have this key, in words: `bore belongs to [piston]`;
    empty if none has.
    """
    if key in TEXTS:
        return f"{key} stands at the head of the file, above all tables"
    having = [name for name, table in import_tables().items() if key in table.model_fields]
    # The parts of an engine first: a chapter may use the same word for something of its own
    names = [f"[{name}]" for name in having if name in TABLES] or [f"[{name}]" for name in having]
    return f"{key} belongs to {' or '.join(names)}" if names else ""
