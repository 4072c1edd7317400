"""The largest of torsional vibration over a range of speeds, between its speeds as well.

To the speeds of the range come those at which an order meets a damped resonance, and those half its
width and its width away; every top that these speeds show and that may be the highest is then
approached by halving the intervals beside it, and by the vertex of the parabola through it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..core.peaks import find_swing, sum_amplitudes
from ..core.speeds import RPM
from ..core.vibration import ROUNDING, Real
from .modes import find_poles
from .motion import compute_curves, refuse_unbounded
from .system import TorsionalSystem

_SIDES = np.array([[-1], [-0.5], [0.5], [1]])  # of a resonance, in widths
_WIDE = 3.0  # steps of the speeds: of a wider resonance one of them shows 95 %
_HIGH = 0.5  # of the largest: a resonance as high may have a higher top beside it
_NEAR = 0.9  # of the largest value at the speeds looked at: a top beside them may exceed this
_CLOSER = 0.3  # of the rest to the largest value, from round to round
_ROUNDS = 7
_FLAT = 1e-8  # share of a top by which it stands out: a flatter one is found


class Largest(NamedTuple):
    """The largest values over a range of speeds.

    Attributes:
        rpm: (columns,) speeds at which they occur; columns as of `find_largest`.
        value: (columns,) the values.
        speeds: (all,) every speed that was looked at, rising.
    """

    rpm: Real
    value: Real
    speeds: Real


def find_largest(
    system: TorsionalSystem,
    rpm: Real,
    weights: Real | None = None,
    known: Real | None = None,
    *,
    together: bool = False,
) -> Largest:
    """Return where each column is largest, and how large, between the first and last of the speeds.

    The columns are half of peak to peak of the torque of each shaft (N m), half of the swing of the
    first node and of each pendulum (rad), and the heat of each damper (W).

    Args:
        system: With an excitation.
        rpm: (speeds,) rising.
        weights: (columns,) factor of each column; 0: it is not looked at. Default: 1.
        known: (speeds, columns) values at these speeds, where they are known.
        together: whether only the highest of all columns is wanted, which takes less time.

    Raises:
        BalcliError: nothing excites the system; an undamped mode is driven at its own frequency.
    """
    refuse_unbounded(system, rpm)
    columns = count_columns(system)
    weights = np.ones(columns) if weights is None else weights
    least = np.zeros(columns)

    def measure(some: Real) -> Real:
        return _measure(system, some, weights, least, together=together)

    speeds, values = rpm, measure(rpm) if known is None else known * weights
    more, width = find_resonances(system, rpm)
    for k in range(_ROUNDS):
        sides = rpm[:0]
        if len(more):
            least = values.max(axis=0)
            found = measure(more)
            speeds, places = np.unique(np.append(speeds, more), return_index=True)
            values = np.concatenate([values, found])[places]
        if len(more) and k == 0:  # beside high resonances there may be higher tops
            level = values.max() if together else values.max(axis=0)
            high = np.any((found >= _HIGH * level) & (found > 0), axis=1)
            sides = (more[high] + width[high] * _SIDES).ravel()
            sides = sides[(sides > rpm[0]) & (sides < rpm[-1])]
        near = 1 - (1 - _NEAR) * _CLOSER**k
        more = np.append(sides, _approach_tops(speeds, values, near, together=together))
    top = values.argmax(axis=0)
    return Largest(speeds[top], np.take_along_axis(values, top[None], axis=0)[0], speeds)


def count_columns(system: TorsionalSystem) -> int:
    """Return the number of columns of `find_largest`."""
    return len(system.shafts) + 1 + len(system.pendulums) + len(system.dampers)


def find_resonances(system: TorsionalSystem, rpm: Real) -> tuple[Real, Real]:
    """Return the speeds between the first and the last of a range at which an order meets a damped
    resonance, and how wide it is there, rpm, (resonances,) each; without those so wide that the
    speeds of the range show them.
    """
    if len(rpm) == 1:
        return rpm[:0], rpm[:0]
    of_all = None if system.pendulums else find_poles(system)  # else they differ by order
    found = []
    for order in system.require_excitation().orders.tolist():
        poles = find_poles(system, order) if of_all is None else of_all
        poles = poles[(poles.imag > 0) & (-poles.real > ROUNDING * np.abs(poles))]
        found.append(np.stack([poles.imag, -2 * poles.real]) / (RPM * order))
    at, width = np.concatenate(found, axis=1)
    steps = np.diff(rpm)[np.clip(np.searchsorted(rpm, at) - 1, 0, len(rpm) - 2)]
    there = (at > rpm[0]) & (at < rpm[-1]) & (width < _WIDE * steps)
    return at[there], width[there]


def _measure(
    system: TorsionalSystem, rpm: Real, weights: Real, least: Real, *, together: bool
) -> Real:
    """Return the columns (speeds, columns), weighted. A value that is clearly below the largest,
    at these speeds or known of others (columns,), may be replaced by the sum of the amplitudes of
    all orders: no curve swings farther.
    """
    phasors, heat = compute_curves(system, rpm)
    count, orders = phasors.shape[2], system.require_excitation().orders
    phasors = phasors * weights[:count]
    found = sum_amplitudes(phasors)

    def add_up(where: Real) -> None:
        found[where] = find_swing(orders, phasors[:, where]).half

    first = np.arange(len(rpm))[:, None] == found.argmax(axis=0)
    add_up(first)
    level = np.maximum(least[:count], np.where(first, found, 0).max(axis=0))
    add_up(~first & (found > 0) & (found >= _NEAR * (level.max() if together else level)))
    return np.concatenate([found, heat * weights[count:]], axis=1)


def _approach_tops(speeds: Real, values: Real, near: float, *, together: bool) -> Real:
    """Return speeds beside every top of a column that is near its highest, by a share of this: half
    way to the speeds before and after it, and the vertex of the parabola through the three.
    """
    level = values.max() if together else values.max(axis=0)
    padded = np.pad(values, ((1, 1), (0, 0)), constant_values=-1)
    tops = (values >= padded[:-2]) & (values > padded[2:])
    tops &= (values >= near * level) & (values > 0)
    at, column = np.nonzero(tops)
    at = np.clip(at, 1, max(len(speeds) - 2, 1))
    if len(speeds) < 3 or not len(at):
        return speeds[:0]
    around = np.add(at, [[-1], [0], [1]])
    (x0, x1, x2), (y0, y1, y2) = speeds[around], values[around, column]
    before, after = (y1 - y0) / (x1 - x0), (y2 - y1) / (x2 - x1)
    bend = np.where(after < before, (after - before) / (x2 - x0), -np.inf)
    vertex = np.clip((x0 + x1) / 2 - before / (2 * bend), x0, x2)
    sharp = y1 - np.minimum(y0, y2) > _FLAT * y1
    return np.unique(np.concatenate([x0 + x1, x1 + x2, 2 * vertex])[np.tile(sharp, 3)] / 2)
