"""Make an SVG smaller without a visible difference: coordinates to a tenth of a point, lines
without the points that lie on them, no ids that nothing refers to.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

_DIGITS = 1  # decimals of coordinates, which are points (1/72 in)
_TOLERANCE = 0.1  # largest distance of a point that is left out from its line, points
_NUMBER = re.compile(r"-?\d+\.\d+(?:e-?\d+)?")
_COMMAND = re.compile(r"([MLHVCSQTAZz])([^A-Za-z]*)")
_COORDINATES = re.compile(r' (?:x|y|x1|y1|x2|y2|cx|cy|width|height|transform)="[^"]*"')

Point = tuple[float, float]


def slim_svg(svg: str) -> str:
    """Return the SVG with fewer letters."""
    svg = re.sub(r' d="([^"]*)"', lambda found: f' d="{slim_path(found[1])}"', svg)
    svg = _COORDINATES.sub(lambda found: _round_numbers(found[0]), svg)
    svg = _drop_ids(svg)
    svg = re.sub(r">\s+<", "><", svg)
    return _slim_styles(svg)


def _slim_styles(svg: str) -> str:
    """Return the SVG without spaces in its styles; texts stay."""
    return re.sub(r'style="[^"]*"', lambda found: re.sub(r"([;:]) +", r"\1", found[0]), svg)


def _drop_ids(svg: str) -> str:
    """Return the SVG without ids that nothing refers to."""
    wanted = {*re.findall(r'href="#([^"]+)"', svg), *re.findall(r"url\(#([^)]+)\)", svg)}
    return re.sub(r' id="([^"]*)"', lambda found: found[0] if found[1] in wanted else "", svg)


def _round_numbers(text: str) -> str:
    """Return the text with its decimal fractions rounded."""
    return _NUMBER.sub(lambda found: _write_number(float(found[0])), text)


def _write_number(value: float) -> str:
    """Return a coordinate, without zeros that say nothing."""
    text = f"{value:.{_DIGITS}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


# ------------------------------------------------------------------ paths
def slim_path(path: str) -> str:
    """Return the data of a path with rounded coordinates. Lines lose the points that lie on them;
    a path with curves is only rounded.
    """
    commands = _COMMAND.findall(path)
    if any(letter not in "MLZz" for letter, _ in commands):
        return "".join(letter + _round_numbers(" ".join(rest.split())) for letter, rest in commands)
    written = []
    line: list[Point] = []
    for letter, rest in commands:
        if letter in "MZz":
            written.append(_write_line(line))
            line = []
        if letter in "Zz":
            written.append("z")
        else:
            values = [float(number) for number in rest.replace(",", " ").split()]
            line += zip(values[::2], values[1::2], strict=True)
    written.append(_write_line(line))
    return "".join(written)


def _write_line(line: Sequence[Point]) -> str:
    """Return a line as a path: its start, and steps from point to point."""
    if not line:
        return ""
    kept = np.round(simplify_line(np.array(line), _TOLERANCE), _DIGITS)
    start = " ".join(map(_write_number, kept[0]))
    steps = [" ".join(map(_write_number, step)) for step in np.diff(kept, axis=0)]
    relative = " ".join(steps).replace(" -", "-")
    return f"M{start}l{relative}" if steps else f"M{start}"


def simplify_line(points: np.ndarray, tolerance: float) -> np.ndarray:
    """Return a line without the points that are closer to it than the tolerance (Ramer 1972,
    Douglas and Peucker 1973).

    Args:
        points: Points of the line, shape (points, 2).
        tolerance: Largest distance of a point that is left out.
    """
    kept = np.zeros(len(points), bool)
    kept[[0, -1]] = True
    parts = [(0, len(points) - 1)]
    while parts:
        first, last = parts.pop()
        if last - first < 2:
            continue
        distances = _find_distances(points[first : last + 1])
        farthest = int(distances.argmax())
        if distances[farthest] > tolerance:
            kept[first + farthest] = True
            parts += [(first, first + farthest), (first + farthest, last)]
    return points[kept]


def _find_distances(points: np.ndarray) -> np.ndarray:
    """Return the distance of each point from the line between the first and the last one."""
    start = points[0]
    along = points[-1] - start
    square = float(along @ along)
    beside = points - start
    share = np.clip(beside @ along / square, 0.0, 1.0) if square else np.zeros(len(points))
    return np.hypot(*(beside - share[:, None] * along).T)
