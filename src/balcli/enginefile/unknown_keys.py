"""Keys that no engine file has: what was probably meant, or what says it instead."""

from __future__ import annotations

from collections.abc import Collection

from .fields import nearest
from .messages import (
    TABLES,
    TEXTS,
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
# What is no key of an engine file by any name, and what to write instead
INSTEAD = {
    **dict.fromkeys(("cylinders", "count", "number_of_cylinders"), _COUNT),
    **dict.fromkeys(("radius", "crank_radius"), "give crank.stroke, twice the crank radius"),
}
_NEAR = 0.65  # of a key and one of its table that is meant: "damper" is no "name"
_NEAR_ELSEWHERE = 0.75


def name_heading(path: str) -> str:
    """Return the name of a table in its heading: `operation.speed_ripple` of its second line,
    `operation.speed_ripple.2`.
    """
    return ".".join(part for part in path.split(".") if not part.isdecimal())


def suggest(key: str, own: Collection[str], *, is_engine: bool = True) -> tuple[str, str]:
    """Return what to write instead of an unknown key, in words, and the key that was probably
    meant, or "".

    Args:
        key: as it is written.
        own: keys of its table.
        is_engine: whether the table is of an engine file, which has hints and other tables.
    """
    word = key.lower().replace("-", "_")
    if is_engine and word in INSTEAD:
        return INSTEAD[word], ""
    synonyms = SYNONYMS.get(word, ())
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
    """Return the tables of an engine file that have this key, in words: `bore belongs to [piston]`;
    empty if none has.
    """
    if key in TEXTS:
        return f"{key} stands at the head of the file, above all tables"
    having = [name for name, table in import_tables().items() if key in table.model_fields]
    # The parts of an engine first: a chapter may use the same word for something of its own
    names = [f"[{name}]" for name in having if name in TABLES] or [f"[{name}]" for name in having]
    return f"{key} belongs to {' or '.join(names)}" if names else ""
