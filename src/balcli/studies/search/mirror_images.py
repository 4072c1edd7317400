"""Designs that are the same engine seen from its other end, or turning the other way."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from ...engine.layout import plan_cylinders
from ...enginefile.model import EngineFile
from .designs import Design, Found

SAME = 1e-9  # objectives of mirror images differ by less, relatively
Image = tuple[float, ...]


def drop_mirror_images(found: Iterable[Found], model: EngineFile) -> Iterator[Found]:
    """Without those that are mirror images of a better or equal one, and as good."""
    other_end = _find_other_end(model)
    seen: dict[Image, float] = {}
    for one in found:
        images = list(_find_images(one.design, other_end))
        known = [seen[image] for image in images if image in seen]
        if not any(abs(value - one.objective) <= SAME * abs(one.objective) for value in known):
            yield one
        seen |= dict.fromkeys(images, one.objective)


def _find_other_end(model: EngineFile) -> dict[int, int]:
    """Which cylinder stands where each one would, seen from the other end."""
    cells = plan_cylinders(model.crank, model.layout).cells
    numbers = {(cell.bank, cell.throw): cell.number for cell in cells}
    last = max(cell.throw for cell in cells)
    return {c.number: numbers.get((c.bank, last - c.throw), c.number) for c in cells}


def _find_images(design: Design, other_end: Mapping[int, int]) -> Iterator[Image]:
    """The design and its images: seen from the other end, turning the other way, and both."""
    if (order := design.firing_order) is not None:
        for row in (order, tuple(other_end[number] for number in order)):
            start = row.index(1)
            turned = row[start:] + row[:start]
            yield turned
            yield (turned[0], *reversed(turned[1:]))
    elif (throws := design.throws) is not None:
        for angles in (throws, throws[::-1]):
            for sign in (1, -1):
                turned_deg = ((sign * (angle - angles[0])) % 360.0 for angle in angles)
                yield tuple(round(angle, 6) % 360.0 for angle in turned_deg)
    else:
        angle = design.splay if design.bank_angle is None else design.bank_angle
        yield (round(angle or 0.0, 6),) if design.number is None else design.number[1:]
