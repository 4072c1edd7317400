"""Arrangements of an engine that a search finds, and engine files with them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple, TypeAlias

from ...engine.build import build
from ...engine.layout import plan_cylinders
from ...engine.parse import parse
from ...enginefile.edit import set_keys
from ...enginefile.model import EngineFile
from ...errors import BalcliError, InputError

# One arrangement: what differs from the file, by key: a key of PATHS, or the dotted name of a
# number. Throws (deg) and firing orders are lists.
Design: TypeAlias = Mapping[str, Any]
PATHS = {
    "throws": "crank.throws",
    "firing_order": "layout.firing_order",
    "bank_angle": "layout.bank_angle",
    "splay": "crank.splay",
}
NOTE = "found by balcli"
SAME = 1e-9  # relative difference of the objectives of mirror images


class Found(NamedTuple):
    """One arrangement, the value of its objective, and its figures by name of quantity."""

    design: Design
    objective: float
    figures: Mapping[str, float]


def list_changes(design: Design) -> dict[str, Any]:
    """Return a design by dotted keys, as `engine.vary.vary_engine` takes them."""
    changed = {PATHS.get(key, key): value for key, value in design.items()}
    return changed | ({"layout.firing_intervals": None} if "firing_order" in design else {})


def drop_mirror_images(found: Iterable[Found], model: EngineFile) -> Iterator[Found]:
    """Yield the arrangements without those that are an earlier one seen from the other end of the
    crank, or turning the other way, with the same objective.
    """
    cells = plan_cylinders(model.crank, model.layout).cells
    numbers = {(cell.bank, cell.throw): cell.number for cell in cells}
    last = max(cell.throw for cell in cells)
    other_end = {c.number: numbers.get((c.bank, last - c.throw), c.number) for c in cells}
    seen: dict[tuple[float, ...], float] = {}
    for one in found:
        images = list(_find_images(one.design, other_end))
        known = [seen[image] for image in images if image in seen]
        if not any(abs(value - one.objective) <= SAME * abs(one.objective) for value in known):
            yield one
        seen |= dict.fromkeys(images, one.objective)


def _find_images(design: Design, other_end: Mapping[int, int]) -> Iterator[tuple[float, ...]]:
    """Yield a firing order or throws, their mirror images from the other end and in the other
    sense of rotation, and both.
    """
    if (order := design.get("firing_order")) is not None:
        for row in (order, [other_end[number] for number in order]):
            start = row.index(1)
            turned = row[start:] + row[:start]
            yield tuple(turned)
            yield (1, *reversed(turned[1:]))
    elif (throws := design.get("throws")) is not None:
        for angles in (throws, throws[::-1]):
            for sign in (1, -1):
                from_first = ((sign * (angle - angles[0])) % 360.0 for angle in angles)
                yield tuple(round(angle, 6) % 360.0 for angle in from_first)


def write_design(text: bytes, design: Design, name: str = "") -> str:
    """Return the text of an engine file, comments included, with a design; a firing order that no
    longer fits is left out.

    Args:
        text: Text of the file.
        design: Throws, a firing order or angles.
        name: Name of the file; files that it names are in the same folder.

    Raises:
        BalcliError: The engine needs the firing order, or the design has other numbers.
    """
    if any(key not in PATHS for key in design):
        settings = ", ".join(f"{path} = {best:.9g}" for path, best in design.items())
        raise BalcliError(
            f"--write takes throws, firing orders and angles; write {settings} by hand"
        )
    new = text.decode("utf-8-sig")
    for path, value in list_changes(design).items():
        table, _, last = path.partition(".")
        new = set_keys(new, table, {last: value}, NOTE)
    if not _is_engine(new, name):
        new = set_keys(new, "layout", {"firing_order": None, "firing_intervals": None}, NOTE)
        if not _is_engine(new, name):
            raise BalcliError(
                "--write: the firing order of the file does not fit what was found, and [gas] "
                "needs one: look for it by --over firing_order, or leave [gas] out"
            )
    return new


def _is_engine(text: str, name: str) -> bool:
    try:
        build(parse(text, name))
    except InputError:
        return False
    return True
