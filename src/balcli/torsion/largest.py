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

_SIDES = np.array([[-1], [-0.5], [0], [0.5], [1]])  # of a resonance, in widths
_NEAR = 0.9  # of the largest value at the speeds looked at: a top beside them may exceed this
_ROUNDS = 7
_CLOSE = 1e-8  # speeds that differ by a smaller share are not taken apart


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
    more = find_resonant_speeds(system, rpm) if len(rpm) > 1 else rpm[:0]
    for _ in range(_ROUNDS):
        if not len(more):
            break
        least = values.max(axis=0)
        speeds, values = np.append(speeds, more), np.concatenate([values, measure(more)])
        speeds, places = np.unique(speeds, return_index=True)
        values = values[places]
        more = _approach_tops(speeds, values, together=together)
    top = values.argmax(axis=0)
    return Largest(speeds[top], np.take_along_axis(values, top[None], axis=0)[0], speeds)


def count_columns(system: TorsionalSystem) -> int:
    """Return the number of columns of `find_largest`."""
    return len(system.shafts) + 1 + len(system.pendulums) + len(system.dampers)


def find_resonant_speeds(system: TorsionalSystem, rpm: Real) -> Real:
    """Return speeds (rpm) about those at which an order meets a damped resonance, as far as they
    lie between the first and the last of a range.
    """
    orders = system.require_excitation().orders
    of_all = None if system.pendulums else find_poles(system)  # else they differ by order
    found = [rpm[:0]]
    for order in orders:
        poles = find_poles(system, float(order)) if of_all is None else of_all
        poles = poles[(poles.imag > 0) & (-poles.real > ROUNDING * np.abs(poles))]
        about = (poles.imag - 2 * poles.real * _SIDES).ravel() / (RPM * order)
        found.append(about[(about > rpm[0]) & (about < rpm[-1])])
    return np.concatenate(found)


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


def _approach_tops(speeds: Real, values: Real, *, together: bool) -> Real:
    """Return speeds beside every top of a column that may be its highest: half way to those before
    and after it, and the vertex of the parabola through the three.
    """
    level = values.max() if together else values.max(axis=0)
    padded = np.pad(values, ((1, 1), (0, 0)), constant_values=-1)
    tops = (
        (values >= padded[:-2]) & (values > padded[2:]) & (values >= _NEAR * level) & (values > 0)
    )
    at, column = np.nonzero(tops)
    at = np.clip(at, 1, max(len(speeds) - 2, 1))
    if len(speeds) < 3 or not len(at):
        return speeds[:0]
    (x0, x1, x2), (y0, y1, y2) = (
        (speeds[at + k] for k in (-1, 0, 1)),
        (values[at + k, column] for k in (-1, 0, 1)),
    )
    before, after = (y1 - y0) / (x1 - x0), (y2 - y1) / (x2 - x1)
    bend = np.where(after < before, (after - before) / (x2 - x0), -np.inf)
    vertex = np.clip((x0 + x1) / 2 - before / (2 * bend), x0, x2)
    wide = x2 - x0 > _CLOSE * x1
    return np.unique(np.concatenate([x0 + x1, x1 + x2, 2 * vertex])[np.tile(wide, 3)] / 2)
