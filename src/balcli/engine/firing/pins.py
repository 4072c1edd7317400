"""Engines that fit with common crank pins and uneven firing, or with split pins."""

from __future__ import annotations

from collections.abc import Iterable

from ...core.phases import TURN
from ..parts import Parts
from .candidates import Candidate, merge_same
from .common_pins import find_angle_between_banks, list_common_pin_intervals
from .fits import find_fitting_splay


def may_fire_unevenly(parts: Parts) -> bool:
    """Return whether the engine has two rods on each throw, and the file leaves throws and firing
    intervals open.
    """
    two_on_throw = parts.plan.banks == 2 and parts.plan.rods_on_throw == 2
    is_open = parts.model.crank.throws is None and parts.model.layout.firing_intervals is None
    return two_on_throw and is_open


def list_with_common_pins(candidates: Iterable[Candidate]) -> list[Candidate]:
    """Return the engines with the firing intervals of common pins with which they fit: the most
    even ones first, those that are better balanced before others that are as even.

    Args:
        candidates: The engine with its possible numberings.
    """
    uneven = [
        candidate.with_setting("layout.firing_intervals", intervals)
        for candidate in candidates
        if may_fire_unevenly(candidate.parts)
        for intervals in list_common_pin_intervals(candidate.parts)
    ]
    fitting = [candidate for candidate in uneven if candidate.fits()]
    engines = merge_same(sorted(fitting, key=_measure_unevenness))
    return sorted(engines, key=lambda engine: (_measure_unevenness(engine), *engine.rank))


def _measure_unevenness(engine: Candidate) -> float:
    """Return minus the smallest firing interval, deg: the larger this interval is, the more even is
    the firing. It is rounded, so that rounding errors do not decide.
    """
    return -round(min(engine.model.layout.firing_intervals or (0.0,)), 3)


def list_with_split_pins(candidates: Iterable[Candidate]) -> list[Candidate]:
    """Return the engines with the splay with which they fit, the better balanced first.

    Args:
        candidates: The engine with its possible numberings.
    """
    split = []
    for candidate in candidates:
        splay = find_fitting_splay(candidate.model)
        if splay is not None:
            split.append(candidate.with_setting("crank.splay", splay))
    return sorted(merge_same(split), key=lambda engine: engine.rank)


def describe_pin_angle(parts: Parts) -> str:
    """Return how far apart the two cylinders of a common pin fire, in words."""
    angle = find_angle_between_banks(parts)
    angles = [f"{angle:g}"]
    if parts.model.layout.strokes == 4:
        angles.append(f"{angle + TURN:g}")
    return f"the two cylinders of a pin fire {' or '.join(angles)} deg apart"
