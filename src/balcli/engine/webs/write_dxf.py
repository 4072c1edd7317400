"""Write the outline of a web as a DXF file of release 12, which every CAD program opens.

The file has what `dxf.read_drawing` reads: one closed POLYLINE with bulges on the layer WEB, a
CIRCLE on the layer HOLE for each hole, and on the layer SLUG for each hole with a slug. Lengths are
in mm. (Release 12 has no header variable for the unit; a comment names it.)
"""

from __future__ import annotations

from collections.abc import Iterator

from ...core.outline import Circle, Vertex
from .bodies import MM, WebShape

OUTLINE = "WEB"
HOLE = "HOLE"
SLUG = "SLUG"
_COLOURS = {OUTLINE: 7, HOLE: 1, SLUG: 3}  # colour numbers: white, red, green
_COMMENT = (
    "mm; origin: crank axis; x: to the crank pin; y: 90 deg ahead in the direction of rotation"
)
_DECIMALS = 12  # of a length in mm; less is rounding

_Group = tuple[int, object]  # a group code and its value


def write_drawing(shape: WebShape) -> str:
    """Return the text of a DXF file with the outline and the holes of a web."""
    groups = [
        (999, _COMMENT),
        *_open_section("HEADER"),
        (9, "$ACADVER"),
        (1, "AC1009"),
        (0, "ENDSEC"),
        *_open_section("TABLES"),
        *_list_layers(),
        (0, "ENDSEC"),
        *_open_section("ENTITIES"),
        *_list_polyline(shape.outline),
    ]
    for circle, density in zip(shape.holes, shape.hole_densities, strict=True):
        groups += _list_circle(circle, SLUG if density else HOLE)
    groups += [(0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code}\n{value}\n" for code, value in groups)


def _open_section(name: str) -> list[_Group]:
    return [(0, "SECTION"), (2, name)]


def _list_layers() -> Iterator[_Group]:
    """Yield the table of layers, and the line type that they need."""
    yield from [(0, "TABLE"), (2, "LTYPE"), (70, 1)]
    yield from [(0, "LTYPE"), (2, "CONTINUOUS"), (70, 0), (3, "Solid line")]
    yield from [(72, 65), (73, 0), (40, 0.0), (0, "ENDTAB")]
    yield from [(0, "TABLE"), (2, "LAYER"), (70, len(_COLOURS))]
    for name, colour in _COLOURS.items():
        yield from [(0, "LAYER"), (2, name), (70, 0), (62, colour), (6, "CONTINUOUS")]
    yield (0, "ENDTAB")


def _list_polyline(outline: tuple[Vertex, ...]) -> Iterator[_Group]:
    """Yield a closed polyline: code 66 announces its vertices, and bit 1 of code 70 closes it."""
    yield from [(0, "POLYLINE"), (8, OUTLINE), (66, 1), (70, 1), *_list_place(0.0, 0.0)]
    for x, y, bulge in outline:
        yield from [(0, "VERTEX"), (8, OUTLINE), *_list_place(x, y), (42, float(bulge))]
    yield from [(0, "SEQEND"), (8, OUTLINE)]


def _list_circle(circle: Circle, layer: str) -> Iterator[_Group]:
    radius = (40, _as_written(circle.radius))
    yield from [(0, "CIRCLE"), (8, layer), *_list_place(circle.x, circle.y), radius]


def _list_place(x: float, y: float) -> list[_Group]:
    return [(10, _as_written(x)), (20, _as_written(y)), (30, 0.0)]


def _as_written(metres: float) -> float:
    """Return a length in mm without its rounding errors."""
    return round(metres / MM, _DECIMALS) + 0.0
