"""Read the outline of a web from a DXF file, as group codes (text DXF of any release).

A DXF file is a list of pairs of lines: a whole number (the group code) and a value. Code 0 begins
an entity, 10 and 20 are x and y, 40 is a radius, 42 the bulge of a polyline's edge, and bit 1 of
code 70 marks a closed polyline (Autodesk, "DXF Reference").
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from ...core.outline import Circle, Vertex
from ...errors import BalcliError
from ...file.toml import read_bytes

WANTED = "give a closed polyline of lines and arcs"
_POLYLINES = ("POLYLINE", "LWPOLYLINE")
_LOOSE = ("SPLINE", "ELLIPSE", "LINE", "ARC")  # entities that may be part of an outline
_IN_MM = {0: 1.0, 1: 25.4, 4: 1.0}  # millimetres in a unit of $INSUNITS
_MOST_VERTICES = 10_000


class Drawing(NamedTuple):
    """An outline and the holes in it, mm."""

    outline: tuple[Vertex, ...]
    holes: tuple[Circle, ...]


class _Entity(NamedTuple):
    """An entity of a DXF file: its type, and its group codes with their values."""

    kind: str
    groups: list[tuple[int, str]]

    def find(self, code: int, default: float = 0.0) -> float:
        """Return the number with a group code."""
        return next((float(value) for key, value in self.groups if key == code), default)


class _Polyline(NamedTuple):
    is_closed: bool
    vertices: list[Vertex]


def read_drawing(path: Path) -> Drawing:
    """Return outline and holes of a DXF file, in mm.

    Raises:
        BalcliError: The file cannot be read, or does not have exactly one closed polyline; the
            message names the file and the entity.
    """
    text = read_bytes(path).decode("latin-1")
    try:
        pairs = [(int(code), value.strip()) for code, value in _pair_lines(text)]
        scale = _find_scale(path.name, pairs)
        entities = list(_list_entities(pairs))
        return _build_drawing(path.name, entities, scale)
    except ValueError:
        raise BalcliError(f"{path.name}: is not a text DXF file; {WANTED}") from None


def _pair_lines(text: str) -> Iterator[tuple[str, str]]:
    """Yield each group code with its value, as text."""
    lines = text.splitlines()
    yield from zip(lines[::2], lines[1::2], strict=False)


def _find_scale(name: str, pairs: list[tuple[int, str]]) -> float:
    """Return the millimetres in a unit of the drawing; `name`: name of the file, for messages.

    Raises:
        ValueError: $INSUNITS is no number.
        BalcliError: It is a unit other than millimetres and inches.
    """
    for pair, (_, text) in pairwise(pairs):
        if pair == (9, "$INSUNITS"):
            unit = int(text)
            if unit not in _IN_MM:
                told = f"{name}: $INSUNITS is {unit}; draw in millimetres (4) or inches (1)"
                raise BalcliError(told)
            return _IN_MM[unit]
    return 1.0


def _list_entities(pairs: list[tuple[int, str]]) -> Iterator[_Entity]:
    """Yield the entities of the section ENTITIES; of a file without sections, all entities."""
    entity = _Entity("", [])
    section = ""
    for code, value in pairs:
        if code == 0:
            if section in ("", "ENTITIES") and entity.kind:
                yield entity
            if value == "ENDSEC":
                section = ""
            entity = _Entity(value, [])
        else:
            if entity.kind == "SECTION" and code == 2:
                section = value
            entity.groups.append((code, value))


def _build_drawing(name: str, entities: list[_Entity], scale: float) -> Drawing:
    """Return the drawing of these entities; `name`: name of the file, for messages."""
    polylines: list[_Polyline] = []
    holes = []
    for entity in entities:
        if entity.kind in _LOOSE:
            raise BalcliError(f"{name}: has a {entity.kind}; {WANTED}")
        if entity.kind in _POLYLINES:
            polylines.append(_Polyline(int(entity.find(70)) & 1 == 1, _list_vertices(entity)))
        elif entity.kind == "VERTEX" and polylines:
            polylines[-1].vertices.append(_read_vertex(entity))
        elif entity.kind == "CIRCLE":
            x, y, radius = (scale * entity.find(code) for code in (10, 20, 40))
            holes.append(Circle(x, y, radius))
    if len(polylines) != 1:
        raise BalcliError(f"{name}: has {len(polylines) or 'no'} POLYLINE or LWPOLYLINE; {WANTED}")
    (polyline,) = polylines
    if not polyline.is_closed:
        raise BalcliError(f"{name}: its POLYLINE is open; {WANTED}")
    if not 2 <= len(polyline.vertices) <= _MOST_VERTICES:
        count = len(polyline.vertices)
        told = f"{name}: its POLYLINE has {count} vertices; give 2 to {_MOST_VERTICES}"
        raise BalcliError(told)
    outline = [Vertex(scale * x, scale * y, bulge) for x, y, bulge in polyline.vertices]
    return Drawing(tuple(outline), tuple(holes))


def _list_vertices(entity: _Entity) -> list[Vertex]:
    """Return the vertices of an LWPOLYLINE, which has them within itself."""
    vertices: list[Vertex] = []
    if entity.kind != "LWPOLYLINE":
        return vertices
    for code, value in entity.groups:
        if code == 10:
            vertices.append(Vertex(float(value), 0.0))
        elif code == 20 and vertices:
            vertices[-1] = vertices[-1]._replace(y=float(value))
        elif code == 42 and vertices:
            vertices[-1] = vertices[-1]._replace(bulge=float(value))
    return vertices


def _read_vertex(entity: _Entity) -> Vertex:
    """Return the VERTEX of a POLYLINE."""
    return Vertex(entity.find(10), entity.find(20), entity.find(42))
