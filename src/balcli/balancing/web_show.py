"""Show fitted webs: what was wanted of each, what does not fit, and what would help."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from ..analysis.records import WebPart
from ..analysis.web_parts import WebRow, group_webs, write_ranges
from ..core.outline import find_direction
from ..show.sheet import UNKNOWN, Column, Grid, number, size_text
from ..show.units import SI, System
from ..sizing.remedy import WebCure
from .answer import Balance

_ROUNDING = 1e-9  # share of the wanted unbalance
_CURES_NOTE = (
    "Each alone would make what is missing. Pin bore: through the pin and both webs of the throw, "
    "fits up to half the diameter of the pin. Lightening: mass to take from the web at the crank "
    "radius. Heavy metal: a slug of tungsten through the counterweight, 3 mm inside its rim."
)


def lay_out_fitted(result: Balance, system: System) -> Iterator[Grid]:
    """Yield a table of the fitted webs, and one of what would help where they do not fit."""
    if not result.remedy.webs:
        return
    rows = _list_rows(result)
    unit = system.unbalance.fit(max(row.part.wanted_kg_m or 0.0 for row in rows))
    columns = [
        Column("web", [write_ranges(row.webs) for row in rows], words=True),
        Column(f"wanted, {unit.name}", [number(unit.of(r.part.wanted_kg_m or 0.0)) for r in rows]),
        Column("at, deg", [number(row.part.wanted_own_deg) for row in rows]),
    ]
    note = "Wanted: unbalance of the whole web."
    if any(row.part.missing_kg_m is not None for row in rows):
        note += " Room and missing: of its counterweight."
        for head, key in (("room for", "room_kg_m"), ("missing", "missing_kg_m")):
            sizes = [getattr(row.part, key) for row in rows]
            cells = [UNKNOWN if size is None else number(unit.of(size)) for size in sizes]
            columns.append(Column(f"{head}, {unit.name}", cells))
    across = [_measure_across(row.part) for row in rows]
    if any(across):
        columns.append(Column(f"across, {unit.name}", [number(unit.of(size)) for size in across]))
        note += " Across: what the given angle of the counterweight leaves."
    yield Grid("Fitted webs", columns, note)
    helps = []
    for row in rows:
        for cure in row.part.remedies or ():
            fits = {None: UNKNOWN, True: "yes", False: "no"}[cure.enough]
            size = _tell_size(cure, system) or UNKNOWN
            helps.append((write_ranges(row.webs), cure.remedy, size, fits))
    if helps:
        heads = [Column(head, words=True) for head in ("web", "remedy", "size", "fits")]
        yield Grid.of_rows("What would help", heads, helps, _CURES_NOTE)


def _measure_across(part: WebPart) -> float:
    """Return the part of the wanted unbalance that the given angle of a counterweight leaves, kg m;
    0 for a web without enough room.
    """
    if part.missing_kg_m is not None or not part.wanted_kg_m:
        return 0.0
    wanted = part.wanted_kg_m * find_direction(part.wanted_own_deg or 0.0)
    left = abs(wanted - part.unbalance_kg_m * find_direction(part.unbalance_own_deg or 0.0))
    return left if left > _ROUNDING * part.wanted_kg_m else 0.0


def _list_rows(result: Balance) -> list[WebRow]:
    """Return the fitted webs, equal ones as one row."""
    fitted = {web.web for web in result.remedy.webs}
    return group_webs(part for part in result.parts.webs or () if part.web in fitted)


def _tell_size(cure: WebCure, system: System) -> str:
    """Return the figures of a remedy in words; empty if none is large enough."""
    sizes = []
    for metres in (cure.diameter_m, cure.radius_m):
        if metres is not None:
            sizes.append(f"{number(system.length.of(metres))} {system.length.name}")
    if cure.mass_kg is not None:
        sizes.append(size_text(cure.mass_kg, system.mass))
    return ", ".join(sizes)


def tell_misfits(result: Balance) -> str:
    """Return in words which webs have no room for their counterweights, and what would help."""
    keys = {web.web: web.key for web in result.remedy.webs}
    lines: list[str] = []
    for row in _list_rows(result):
        if row.part.missing_kg_m is not None:
            lines += _tell_misfit(row, keys[row.webs[0]])
    return "\n".join(lines)


def _tell_misfit(row: WebRow, key: str) -> Iterable[str]:
    """Yield the lines on webs without enough room.

    Args:
        row: Webs that are alike.
        key: Key of their table that is fitted.
    """
    missing = row.part.missing_kg_m or 0.0
    needed = missing + (row.part.room_kg_m or 0.0)
    webs = f"webs {write_ranges(row.webs)}" if len(row.webs) > 1 else f"web {row.webs[0]}"
    sizes = [f"{number(1e6 * size)} g·mm" for size in (missing, needed)]
    yield f"{webs}: {sizes[0]} of {sizes[1]} do not fit in {_tell_room(row.part, key)}; what helps:"
    for cure in row.part.remedies or ():
        words = {None: "", True: ", which fits", False: ", which does not fit"}[cure.enough]
        size = _tell_size(cure, SI)
        yield f"  {cure.remedy} {size}{words}" if size else f"  {cure.remedy}: none is large enough"


def _tell_room(part: WebPart, key: str) -> str:
    """Return in words the room in which a counterweight does not fit."""
    if part.opening_deg is None or part.outer_radius_m is None:
        return "the room of the web, which has none for a counterweight at this angle"
    if key == "thickness":
        return f"a thickness of {number(1e3 * part.thickness_m)} mm"
    opening = number(part.opening_deg)
    return f"an opening of {opening} deg and a radius of {number(1e3 * part.outer_radius_m)} mm"
