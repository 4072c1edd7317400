"""Propose changes of one key with which every cylinder fires at its dead centre."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from ...core.phases import TURN
from ..parts import Parts
from .candidates import Candidate, Setting
from .fits import count_throws_from_first, find_missed
from .pins import (
    describe_pin_angle,
    list_with_common_pins,
    list_with_split_pins,
    may_fire_unevenly,
)
from .together import is_flat_two_stroke, list_intervals_of_crank
from .usual import Rows, write_rows

MOST_INTERVALS = 3  # largest number of lists of firing intervals in a hint


def describe_changes(
    parts: Parts, usual: Sequence[Candidate] = (), with_numbering: Rows | None = None
) -> str:
    """Return a sentence that proposes changes, to be added to a message: it begins with the full
    stop of the message. Return an empty text if no change helps.

    The first kind of change that helps is proposed: intervals that begin one firing later and a
    usual numbering, cylinders that fire together, other throws, and common pins or split pins.

    Args:
        parts: Stages of an engine whose firing order does not fit.
        usual: The same engine with usual numberings that fit, best first.
        with_numbering: Numbering that each change needs as well; None if it needs none.
    """
    if parts.varies:
        return ""
    beginning = "It fits"
    changes = [*map(str, _begin_later(parts))]
    changes += [f"layout.numbering = {write_rows(engine.numbering)}" for engine in usual[:1]]
    if not changes:
        changes = [*map(str, _find_together(parts))]
        beginning = "If cylinders fire together, it fits" if changes else beginning
    changes = changes or _describe_throws(parts) or _describe_pins(parts)
    if with_numbering is not None:
        numbering = f"layout.numbering = {write_rows(with_numbering)}"
        changes = [f"{numbering} and {change}" for change in changes]
    return f". {beginning} with {' or with '.join(changes)}" if changes else ""


def _begin_later(parts: Parts) -> Iterator[Setting]:
    """Yield the firing intervals of the file, begun one firing later, if they fit."""
    intervals = parts.model.layout.firing_intervals
    if intervals is not None:
        yield from _keep_fitting(parts, "layout.firing_intervals", [(*intervals[1:], intervals[0])])


def _find_together(parts: Parts) -> list[Setting]:
    """Return the firing intervals with cylinders that fire together, with which a four-stroke fits
    the throws of its file. Nothing is proposed if the file gives intervals.
    """
    layout = parts.model.layout
    if not parts.throws_given or layout.strokes == 2 or layout.firing_intervals is not None:
        return []
    path = "layout.firing_intervals"
    return _keep_fitting(parts, path, list_intervals_of_crank(parts))[:MOST_INTERVALS]


def _keep_fitting(
    parts: Parts, path: str, values: Iterable[float | Sequence[float]]
) -> list[Setting]:
    """Return the values of a key with which every cylinder fires at its dead centre."""
    settings = [Setting(path, value) for value in values]
    return [setting for setting in settings if not find_missed(Parts(setting.apply(parts.model)))]


def _describe_throws(parts: Parts) -> list[str]:
    """Return throws that fit: those of the file in the other direction of rotation, or those that
    the firing order needs. A flat two-stroke needs several cranks, so none is proposed.
    """
    given = parts.model.crank.throws
    if given is None:
        return []
    opposite = tuple(-throw % TURN for throw in given)
    turned = _keep_fitting(parts, "crank.throws", [opposite])
    if turned:
        return [f"{turned[0]} (angles count in the direction of rotation)"]
    free = Parts(parts.model.with_table("crank", throws=None))
    whole_order = len(parts.order or ()) == len(parts.plan.cells)
    if len(given) == 1 or not whole_order or is_flat_two_stroke(free):
        return []
    needed = count_throws_from_first(free)
    return [str(setting) for setting in _keep_fitting(parts, "crank.throws", [needed])]


def _describe_pins(parts: Parts) -> list[str]:
    """Return the firing intervals of common pins, and the splay of split pins, that fit. Neither
    is proposed against a key of the file.
    """
    if parts.model.crank.has("splay"):
        return []
    engine = Candidate(parts.model)
    common = list_with_common_pins([engine])[:1]
    split = list_with_split_pins([engine])
    changes = [str(setting) for other in (*common, *split) for setting in other.settings]
    if split and not common and may_fire_unevenly(parts):
        angle = describe_pin_angle(parts)
        changes.insert(0, f"the layout.firing_intervals of common pins ({angle})")
    return changes
