"""Read indicator cards: cylinder pressures over the volume or the stroke, in CSV files.

The smallest and the largest value of the first column are the two dead centres, so that its unit
and offset do not matter. Between rows the pressure is linear in the volume, as on the card: the
mean pressure is the area of the polygon over its width.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..core.cylinder_pressure import GasPiston
from ..core.phasors import Array
from ..core.piecewise import PiecewiseCurve, resolved
from ..errors import BalcliError
from ..file.csv_columns import NumberColumns
from ..file.fields import counted
from ..file.gas_tables import Gas


class _Row(NamedTuple):
    """A row of a card: its share of the way from the smallest to the largest value, the pressure
    (Pa) and the line in the file.
    """

    share: float
    pressure: float
    line: int


class _Stroke(NamedTuple):
    """Rows of one stroke, from one dead centre to the other, and the angles of its ends, rad."""

    rows: list[_Row]
    start: float
    end: float


def draw_card(
    gas: Gas,
    name: str,
    columns: NumberColumns,
    pressure: Array,
    piston: GasPiston,
    strokes: int,
    *,
    from_volume: bool,
    crank_end: bool,
) -> PiecewiseCurve:
    """Return the pressure over the cycle angle, Pa.

    Args:
        gas: Table of the engine file that describes the card.
        name: Name of the card's file.
        columns: Columns of the file: volume, travel or stroke, then pressure.
        pressure: Absolute pressures of the rows, Pa.
        piston: Kinematics of the cylinder.
        strokes: 4 or 2.
        from_volume: Whether the first column is the volume of this end; otherwise it is the travel
            from the outer dead centre.
        crank_end: Whether the end is the one towards the crank.

    Raises:
        BalcliError: The first mistake in the file, with its line number.
    """
    values = np.array(columns.column(0))
    width = float(np.ptp(values)) if len(values) else 0.0
    if not width:
        raise BalcliError(f"{name}: has no two different values; give rows of a closed loop")
    shares = (values - values.min()) / width
    each = zip(shares.tolist(), pressure.tolist(), columns.lines, strict=True)
    stroke_rows = _split_strokes(name, [_Row(*row) for row in each])
    if len(stroke_rows) != strokes:
        superfluous = stroke_rows[strokes:]
        line = superfluous[0][0].line if superfluous else columns.lines[-1]
        raise BalcliError(
            f"{name}: line {line}: the card has {counted(len(stroke_rows), 'stroke')}; a cycle has "
            f"{strokes}, from the smallest value to the largest and back"
        )
    from_inner = from_volume and crank_end  # the smallest value is at the inner dead centre
    first = piston.bottom if from_inner else 0.0
    if gas.zero == "gas-exchange":
        first += 2 * np.pi
    spans = [piston.bottom, 2 * np.pi - piston.bottom]
    if from_inner:
        spans.reverse()
    edges = first + np.append(0.0, np.cumsum(np.resize(spans, strokes)))
    paths = [
        _Stroke(rows, float(start), float(end))
        for rows, start, end in zip(stroke_rows, edges[:-1], edges[1:], strict=True)
    ]

    def find_pressure(angle: Array) -> Array:
        travel = piston.travel(angle) / piston.stroke
        place = 1 - travel if from_inner else travel
        pressures = np.empty_like(place)
        for k, path in enumerate(paths):
            inside = (angle >= path.start) & (angle < path.end)
            order = 1 if k % 2 == 0 else -1
            across = np.array([row.share for row in path.rows])[::order]
            along = np.array([row.pressure for row in path.rows])[::order]
            pressures[inside] = np.interp(place[inside], across, along)
        return pressures

    breaks = [edges]
    for path in paths:
        inner = [row.share for row in path.rows[1:-1] if 0 < row.share < 1]
        turn = 2 * np.pi * np.floor(path.start / (2 * np.pi) + 1e-9)
        upward = path.start - turn > piston.bottom / 2
        travels = [1 - share if from_inner else share for share in inner]
        stroke = float(piston.stroke)
        angles = [piston.angle_of(travel * stroke, upward=upward) for travel in travels]
        breaks.append(turn + np.array(angles))
    return resolved(find_pressure, np.unique(np.concatenate(breaks)))


def _split_strokes(name: str, rows: list[_Row]) -> list[list[_Row]]:
    """Return the rows of each stroke, with the dead centres at both ends.

    Raises:
        BalcliError: The first row is not at the smallest value, a value turns back between the dead
            centres, or a stroke has no row besides its beginning.
    """
    first = rows[0]
    if first.share != 0:
        raise BalcliError(
            f"{name}: line {first.line}: the first row is not at the smallest value; begin there"
        )
    strokes = [[first]]
    for row in rows[1:]:
        stroke = strokes[-1]
        before = stroke[-1]
        target = len(strokes) % 2  # share at the end of this stroke
        if before.share == target and len(stroke) > 1:  # its end is the beginning of the next
            strokes.append([row if row.share == before.share else before])
            if row.share != before.share:
                strokes[-1].append(row)
            continue
        if before.share == row.share and len(stroke) == 1:
            strokes[-1] = [row]  # a jump at the dead centre: the stroke begins after it
            continue
        if (row.share - before.share) * (1 if target else -1) < 0:
            raise BalcliError(
                f"{name}: line {row.line}: the value turns back between the dead centres; a card "
                "has one loop for each turn of the crank, with rows in the order of time"
            )
        stroke.append(row)
    return _close(name, strokes, first)


def _close(name: str, strokes: list[list[_Row]], first: _Row) -> list[list[_Row]]:
    """Return the strokes with the end of the last one: the first row of the card, unless the last
    row is at the same dead centre.

    Raises:
        BalcliError: The last stroke has no row besides its beginning.
    """
    last = strokes[-1]
    at_start = last[-1].share == 0
    if at_start and len(last) == 1 and len(strokes) > 1:  # a jump at the end of the cycle
        return strokes[:-1]
    if len(last) == 1 or last[-1].share == len(strokes) % 2 == 1:
        raise BalcliError(
            f"{name}: line {last[-1].line}: no row follows in the stroke that begins here; give "
            "the whole loop"
        )
    if not at_start and len(strokes) % 2 == 0:
        last.append(first)
    return strokes
