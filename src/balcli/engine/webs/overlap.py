"""Warn of webs that stand where the file has a main bearing."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ...core.phasors import Figure
from ...file.doubt import Doubt
from .build import CrankWeb, Webs

if TYPE_CHECKING:
    from ...file.gas_tables import Bearing

_ROUNDING_MM = 1e-6  # a smaller overlap is rounding
_DEPENDS_ON = ("bearing.main_positions", "bearing.main_width", "bearing.pin_length")


def doubt_overlaps(webs: Webs, bearing: Bearing | None) -> Iterator[Doubt]:
    """Yield a warning for the web that reaches farthest into a main bearing, if one does.

    Args:
        webs: Webs of a crankshaft, not of variants of it.
        bearing: Table of its bearings; their width counts as 0 if the table does not give it.
    """
    if bearing is None or bearing.main_positions is None:
        return
    width = bearing.main_width or 0.0
    farthest = _ROUNDING_MM
    doubt = None
    for web in webs.webs:
        for place in bearing.main_positions:
            reach = (1e3 * web.body.thickness + width) / 2 - abs(_take_place_mm(web.z) - place)
            if reach > farthest:
                farthest = reach
                doubt = _doubt_overlap(web, place, width)
    if doubt is not None:
        yield doubt


def _take_place_mm(place_m: Figure) -> float:
    return 1e3 * float(place_m)


def _doubt_overlap(web: CrankWeb, place: float, width: float) -> Doubt:
    """Return the warning of a web that overlaps the main bearing at a place; lengths in mm."""
    thickness = 1e3 * web.body.thickness
    start = _take_place_mm(web.z) - thickness / 2
    ends = f"z = {start:.5g} to {start + thickness:.5g} mm"
    wide = f", {width:g} mm wide" if width else ""
    message = (
        f"{thickness:.5g} mm; web {web.number} ({ends}) overlaps the main bearing at {place:g} mm"
        f"{wide}; check thickness, main_positions and pin_length"
    )
    return Doubt(f"web.{web.table}.thickness", message, _DEPENDS_ON)
