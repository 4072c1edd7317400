"""Arrangements of an engine that a search finds, and engine files with them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from ...engine.build import build
from ...engine.layout import plan_cylinders
from ...engine.load import parse
from ...enginefile.edit import set_keys
from ...enginefile.model import EngineFile
from ...errors import BalcliError, InputError

PATHS = {
    "throws": "crank.throws",
    "firing_order": "layout.firing_order",
    "bank_angle": "layout.bank_angle",
    "splay": "crank.splay",
}
NOTE = "found by balcli"
SAME = 1e-9  # relative difference of the objectives of mirror images


class Design(NamedTuple):
    """One arrangement; None: as the file has it.

    Attributes:
        firing_order: numbers of the cylinders.
        throws: angles along the crank, deg.
        bank_angle, splay: deg.
        numbers: other numbers of the file by dotted name.
    """

    firing_order: tuple[int, ...] | None = None
    throws: tuple[float, ...] | None = None
    bank_angle: float | None = None
    splay: float | None = None
    numbers: Mapping[str, float] = {}

    def given(self) -> dict[str, float | list[float] | list[int]]:
        """Return what differs from the file, by key, as JSON has it."""
        named = {k: v for k, v in self._asdict().items() if k != "numbers" and v is not None}
        return {k: list(v) if isinstance(v, tuple) else v for k, v in named.items()} | dict(
            self.numbers
        )

    def changes(self) -> dict[str, Any]:
        """Return the same by dotted keys, as `engine.vary.vary_engine` takes them."""
        changed: dict[str, Any] = {PATHS.get(key, key): v for key, v in self.given().items()}
        if self.firing_order is not None:
            changed["layout.firing_intervals"] = None
        return changed


class Found(NamedTuple):
    """One arrangement, the value of its objective, and its figures by name of quantity."""

    design: Design
    objective: float
    figures: Mapping[str, float]


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
    if (order := design.firing_order) is not None:
        for row in (order, tuple(other_end[number] for number in order)):
            start = row.index(1)
            turned = row[start:] + row[:start]
            yield turned
            yield (turned[0], *reversed(turned[1:]))
    elif (throws := design.throws) is not None:
        for angles in (throws, throws[::-1]):
            for sign in (1, -1):
                from_first = ((sign * (angle - angles[0])) % 360.0 for angle in angles)
                yield tuple(round(angle, 6) % 360.0 for angle in from_first)


def write_design(text: bytes, design: Design, name: str = "") -> str:
    """Return the text of an engine file, comments included, with a design; a firing order that no
    longer fits is left out.

    Args:
        text: of the file.
        name: of the file; files that it names are beside it.

    Raises:
        BalcliError: the engine needs the firing order, or the design has other numbers.
    """
    if design.numbers:
        settings = ", ".join(f"{path} = {best:.9g}" for path, best in design.numbers.items())
        raise BalcliError(
            f"--write takes throws, firing orders and angles; write {settings} by hand"
        )
    new = text.decode("utf-8-sig")
    for key, value in design.given().items():
        table, _, last = PATHS[key].partition(".")
        new = set_keys(new, table, {last: value}, NOTE)
    if design.firing_order is not None:
        new = set_keys(new, "layout", {"firing_intervals": None}, NOTE)
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
