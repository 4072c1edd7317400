"""Check that the [[web]] tables of a file fit its crank."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from ..errors import Problem
from ..file.fields import counted, join_words
from ..file.model import EngineFile
from ..file.web_tables import VARIABLE
from .parts import Parts
from .webs.build import WEBS_ON_THROW, assign_tables, take_pin

_SAME_DEG = 1e-9
_SAME_MM = 1e-6


def check_webs(parts: Parts) -> Iterator[Problem]:
    """Check that the crank has webs of its own for every throw, and that they can be built."""
    model = parts.model
    if not model.web:
        return
    for number, table in enumerate(model.web, 1):
        for fault in table.find_faults():
            path = f"web.{number}.{fault.key}" if fault.key else f"web.{number}"
            yield Problem(path, fault.message)
    yield from _check_crank(parts)
    take_pin(model)
    assign_tables(parts.model, parts.plan.throws)
    yield from _check_varied(parts)


def list_fixed(model: EngineFile, paths: Iterable[str]) -> list[str]:
    """Return those figures of webs and pins that cannot vary: all but dimensions of webs with an
    outline.

    Args:
        model: Engine file with [[web]].
        paths: Dotted names of figures of the file.
    """
    return [path for path in paths if _is_fixed(model, path)]


def _is_fixed(model: EngineFile, path: str) -> bool:
    if path.startswith(("bearing.", "crank.stroke", "crank.throw_mass")):
        return True
    if not path.startswith("web."):
        return False
    _, number, key = f"{path}..".split(".")[:3]
    table = model.web[int(number) - 1]
    given = getattr(table, key, None)
    is_number = isinstance(given, float) and not table.is_open(key)
    return table.is_weighed or key not in VARIABLE or not is_number


def _check_varied(parts: Parts) -> Iterator[Problem]:
    """Check that no figures of webs and pins vary that cannot."""
    varied = parts.figures.find_varied("bearing.", "crank.", "web.")
    if fixed := list_fixed(parts.model, varied):
        message = (
            f"[[web]] is computed for the figures of the file, but for {join_words(VARIABLE)} of "
            "webs with an outline; give each value a file of its own"
        )
        yield Problem(fixed[0], message)


def _check_crank(parts: Parts) -> Iterator[Problem]:
    model = parts.model
    if model.crank.has("throw_mass"):
        message = "it follows from [[web]]; remove one of them"
        yield Problem("crank.throw_mass", message)
    if model.layout.rotary:
        yield Problem("layout.rotary", "[[web]] is for cranks that turn; leave one of them out")
    if model.locomotive is not None:
        yield Problem("locomotive", "[[web]] is not for locomotives; leave one of them out")
    if np.any(np.asarray(parts.figures.take("crank.splay", model.crank.splay)) != 0):
        message = "[[web]] is for throws with one pin; leave out splay or [[web]]"
        yield Problem("crank.splay", message)


def check_web_places(parts: Parts) -> Iterator[Problem]:
    """Check that throws with webs have places of their own, and one pin and stroke each."""
    model = parts.model
    if not model.web:
        return
    places = np.sort(1e3 * parts.places.pins, axis=0)
    if len(places) > 1 and np.any(np.diff(places, axis=0) < _SAME_MM):
        key = "positions" if model.crank.positions is not None else "spacing"
        message = (
            f"[[web]] needs {counted(len(places), 'throw')} at places of their own; give {key}"
        )
        yield Problem(f"crank.{key}", message)
    for cell in parts.plan.cells:
        first = next(c.number for c in parts.plan.cells if c.throw == cell.throw)
        leads = parts.pins.leads_deg
        apart = float(np.max(np.abs(np.asarray(leads[cell.number] - leads[first]))))
        if apart > _SAME_DEG:
            message = "[[web]] is for throws with one pin; leave it out, or [[web]]"
            yield Problem(f"cylinder.{cell.number}.throw", message)
        if parts.override(cell.number, "stroke") is not None:
            message = "[[web]] takes the stroke of the throw; leave it out, or [[web]]"
            yield Problem(f"cylinder.{cell.number}.stroke", message)
    yield from _check_strokes(parts)


def _check_strokes(parts: Parts) -> Iterator[Problem]:
    """Check that all throws of a table have one stroke."""
    strokes: dict[int, float] = {}
    for web, table in assign_tables(parts.model, parts.plan.throws).items():
        stroke = float(np.max(np.asarray(parts.throw_strokes[(web - 1) // WEBS_ON_THROW])))
        if abs(strokes.setdefault(table, stroke) - stroke) > _SAME_MM:
            told = f"web {web} has a stroke of {stroke:g} mm, and others of web.{table} have "
            told += f"{strokes[table]:g} mm; give each stroke a [[web]] table with webs"
            yield Problem("crank.stroke", told)
            return
