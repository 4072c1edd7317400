"""Name the figures of a record: in words, by quantity, and by group (figures of one kind).

A figure has a path: the keys that lead to it from the top of the record, such as `orders`, `2`,
`force_N`, `major`. Members of lists are labelled by a key of theirs (order, mode, name), components
of vectors by their axis.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..core.records import find_unit, remove_unit
from ..forces.kinds import EVERY_KIND, TORQUE, TORQUE_TOTAL
from .records import FigurePath

_KINDS = {kind.key: kind.name for kind in EVERY_KIND.values()}
_NOUNS = {"orders": "order", "modes": "mode", "travel": "cylinder"}  # of the members of lists
ASSUMED = "assumed"  # key of the list of assumed values
# Quantities of figures in the part `torque`; all its other figures belong to `torque`.
_OF_TORQUE = {
    "mean_torque_Nm": "torque.mean",
    **dict.fromkeys(("max_Nm", "max_deg"), "torque.max"),
    **dict.fromkeys(("min_Nm", "min_deg"), "torque.min"),
    "fluctuation": "fluctuation",
}
# First words of the quantities of which a record has figures.
RECORDED_QUANTITIES = (
    *EVERY_KIND,
    *("peak", "fluctuation", "piston", "mode", "mount", "torsion"),
)


def list_figures(value: object, path: FigurePath = ()) -> Iterator[tuple[FigurePath, Any]]:
    """Yield all figures and texts of a record, or of a part of it, with their paths."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from list_figures(part, (*path, key))
    elif isinstance(value, list):
        for number, part in enumerate(value, 1):
            yield from list_figures(part, (*path, _label(part, number, path[-1])))
    else:
        yield path, value


def _label(member: object, number: int, key: str) -> str:
    """Return the label of a member of a list.

    Args:
        member: The member.
        number: Its number, from 1.
        key: Key of the list.
    """
    if key in ("forward", "backward"):
        return "xy"[number - 1]
    if not isinstance(member, dict):
        return str(number)
    if key == "criticals":
        return f"order {member['order']} mode {member['mode']}"
    if key == ASSUMED:
        names = [member["engine"], member["path"]] if "engine" in member else [member["path"]]
        return ".".join(names)
    label = member.get("name", member.get(_NOUNS.get(key, ""), number))
    return str(label)


def find_group(path: FigurePath) -> FigurePath:
    """Return the group of a figure: the part of the record, and the first key with a unit of size.
    An assumed value is a group by itself. The tolerance of a figure is a share of the largest
    figure of its group.
    """
    if ASSUMED in path:
        return path
    part = "orders" if path[0] == "peak" else path[0]
    return part, next((key for key in path if is_size(key)), path[-1])


def is_size(key: str) -> bool:
    """Return whether a key has a unit other than that of angles."""
    return find_unit(key) not in ("", "deg")


def find_unit_of(path: FigurePath) -> str:
    """Return the unit of a figure; empty if it has none."""
    return find_unit(path[-1]) or find_unit(find_group(path)[1])


def name_quantities(path: FigurePath) -> tuple[str, ...]:  # noqa: PLR0911 (one return for each form)
    """Return the names in [check.tolerance] that stand for a figure, from special to general: the
    name of an order (`force.2`), then that of all orders (`force`).
    """
    match path:
        case ("orders", order, key, *_) if key in _KINDS:
            kinds = [_KINDS[key]]
            if kinds == [TORQUE_TOTAL.name]:
                kinds.append(TORQUE.name)
            return (*(f"{kind}.{order}" for kind in kinds), *kinds)
        case ("peak", key):
            kind = remove_unit(key)
            return f"peak.{kind}", "peak", kind
        case ("torque", *_, key):
            return _OF_TORQUE.get(key, "torque"), "torque"
        case ("travel", cylinder, _):
            return f"piston.{cylinder}", "piston.stroke", "piston"
        case ("mounts", "modes", mode, _):
            return f"mode.{mode}", "mode"
        case ("mounts", "largest", name, _):
            return f"mount.{name}", "mount"
        case ("torsion", "modes", mode, _):
            return f"torsion.{mode}", "torsion"
        case ("torsion", *_):
            return ("torsion",)
    return ()


def name_cause(path: FigurePath) -> str:
    """Return the quantity of a figure, or the part of the record that has it, for summaries."""
    if path[0] == "engine":  # name, number of cylinders, displacement
        return remove_unit(path[1])
    return next((_KINDS[key] for key in path if key in _KINDS), path[0])


def describe_figure(path: FigurePath) -> str:
    """Return the name of a figure in words, such as `order 2 force major`."""
    if ASSUMED in path:
        return " ".join(path[:-1])
    words: list[str] = []
    for parent, key in zip(("", *path), path, strict=False):
        if key in _NOUNS:
            continue
        noun = _NOUNS.get(parent)
        words += [noun] if noun else []
        name = remove_unit(key).replace("_", " ")
        if not words or words[-1] != name:
            words.append(name)
    return " ".join(words)
