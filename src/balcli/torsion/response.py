"""Forced vibration at speeds: torque of every shaft, added up in time, with stress and heat; and
the largest values over a range of speeds.

Largest values between the given speeds are found as well. Speeds at which an order meets a damped
resonance are added, and speeds half its width and its width away. Every peak at these speeds that
may be the highest is then refined by halving the intervals next to it, and by the vertex of the
parabola through it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, NamedTuple

import numpy as np

from ..core.peaks import find_swing, sum_amplitudes
from ..core.phases import RPM
from ..core.records import HIDDEN
from ..core.vibration import ROUNDING, Complex, Real
from ..file.fields import order_number
from ..process import Tell, tell_nobody
from .modes import find_poles
from .motion import compute_curves, refuse_unbounded, stress_by_torque
from .system import TorsionalSystem

_SIDES = np.array([[-1], [-0.5], [0.5], [1]])  # of a resonance, in widths
_WIDE = 3.0  # steps of the speeds: of a wider resonance one of them shows 95 %
_HIGH = 0.5  # of the largest: a resonance as high may have a higher top beside it
_NEAR = 0.9  # of the largest value at the speeds looked at: a top beside them may exceed this
_CLOSER = 0.3  # of the rest to the largest value, from round to round
_ROUNDS = 7
_FLAT = 1e-4  # share of a top by which it stands out: a flatter one is a parabola
_FOUND = 1e-10  # share of a top by which the vertex of the parabola is above it


class Largest(NamedTuple):
    """The largest values over a range of speeds.

    Attributes:
        rpm: (columns,) speeds at which they occur; columns as of `find_largest`.
        value: (columns,) the values.
    """

    rpm: Real
    value: Real


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
    free end and of each pendulum (rad), and the heat of each damper (W).

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
    return Largest(speeds[values.argmax(axis=0)], values.max(axis=0))


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

    first = (np.arange(len(rpm))[:, None] == found.argmax(axis=0)) & (found > 0)
    add_up(first)
    level = np.maximum(least[:count], np.where(first, found, 0).max(axis=0))
    add_up(~first & (found > 0) & (found >= _NEAR * (level.max() if together else level)))
    return np.concatenate([found, heat * weights[count:]], axis=1)


def _approach_tops(speeds: Real, values: Real, near: float, *, together: bool) -> Real:
    """Return new speeds next to every peak of a column that is within a share of its highest: the
    middles of both adjacent intervals, and the vertex of the parabola through the three speeds.
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
    higher = -bend * (vertex - x1) ** 2 > _FOUND * y1
    return np.unique(np.stack([x0 + x1, x1 + x2, 2 * vertex])[np.stack([sharp, sharp, higher])] / 2)


_HALVINGS = 24  # of an interval of speeds in which a limit is passed
_SAMPLES = 1 << 22  # of curves over a cycle: progress is reported after these


@dataclass(frozen=True)
class OrderTorque:
    """Torque of one order.

    Attributes:
        order: Order of the excitation.
        amplitude_Nm: Amplitude of the torque.
    """

    order: float
    amplitude_Nm: float


@dataclass(frozen=True, kw_only=True)
class WorstTorque:
    """Largest vibratory torque of a shaft over the range of speeds, between the speeds as well.

    Attributes:
        speed_rpm: Speed at which it occurs.
        half_peak_to_peak_Nm: Half of peak to peak.
        stress_Pa: Stress there; left out without a diameter.
        orders: Torque by order.
    """

    speed_rpm: float
    half_peak_to_peak_Nm: float
    stress_Pa: float | None = None
    orders: tuple[OrderTorque, ...]

    @property
    def sum_of_amplitudes_Nm(self) -> float:
        """Sum of the amplitudes of all orders."""
        return sum(each.amplitude_Nm for each in self.orders)


@dataclass(frozen=True, eq=False, kw_only=True)
class ShaftResponse:
    """Vibratory torque of a shaft.

    Attributes:
        name: Name of the shaft.
        half_peak_to_peak_Nm: Half of peak to peak, by speed.
        sum_of_amplitudes_Nm: Sum of the amplitudes of all orders, by speed.
        stress_Pa: Stress by half of peak to peak, by speed; left out without a diameter.
        worst: Largest torque over the range of speeds.
        amplitudes_Nm: Torque by order and speed.
    """

    name: str
    half_peak_to_peak_Nm: Real
    sum_of_amplitudes_Nm: Real
    stress_Pa: Real | None = None
    worst: WorstTorque
    amplitudes_Nm: Annotated[Real, HIDDEN]


@dataclass(frozen=True)
class WorstSwing:
    """Largest swing over the range of speeds, between the speeds as well.

    Attributes:
        speed_rpm: Speed at which it occurs.
        half_swing_deg: Half of peak to peak.
    """

    speed_rpm: float
    half_swing_deg: float


@dataclass(frozen=True)
class WorstHeat:
    """Largest power that a damper turns to heat, over the range of speeds.

    Attributes:
        speed_rpm: Speed at which it occurs.
        heat_W: Power.
    """

    speed_rpm: float
    heat_W: float


@dataclass(frozen=True, eq=False)
class DamperHeat:
    """Power that a damper turns to heat.

    Attributes:
        node: Name of the node that carries the damper.
        heat_W: Power by speed.
        worst: Largest power over the range of speeds.
    """

    node: str
    heat_W: Real
    worst: WorstHeat


@dataclass(frozen=True, eq=False)
class PendulumSwing:
    """Swing of pendulums against their node.

    Attributes:
        node: Name of the node that carries them.
        half_swing_deg: Half of peak to peak, by speed.
        worst: Largest swing over the range of speeds.
    """

    node: str
    half_swing_deg: Real
    worst: WorstSwing


@dataclass(frozen=True, eq=False, kw_only=True)
class TorsionResponse:
    """Forced vibration over speeds.

    Attributes:
        speeds_rpm: Speeds.
        shafts: Torque of each shaft.
        free_end_deg: Half of the swing of the free end, by speed.
        free_end_worst: Largest swing of the free end.
        dampers: Heat of dampers, rings in oil first; left out without any.
        pendulums: Swing of pendulums; left out without any.
        orders: Orders of the excitation.
        swings_deg: Amplitude of the free end by order and speed.
        worst_swings_deg: Amplitude of the free end by order, where it swings most.
    """

    speeds_rpm: Real
    shafts: tuple[ShaftResponse, ...]
    free_end_deg: Real
    free_end_worst: WorstSwing
    dampers: tuple[DamperHeat, ...] | None = None
    pendulums: tuple[PendulumSwing, ...] | None = None
    orders: Annotated[Real, HIDDEN]
    swings_deg: Annotated[Real, HIDDEN]
    worst_swings_deg: Annotated[Real, HIDDEN]


def find_response(
    system: TorsionalSystem, speeds_rpm: Real, tell: Tell = tell_nobody
) -> TorsionResponse:
    """Return the vibration at speeds.

    Args:
        system: With an excitation.
        speeds_rpm: (speeds,) rising.
        tell: Called with the share of the speeds that is done.

    Raises:
        BalcliError: nothing excites the system; an undamped mode is driven at its own frequency.
    """
    refuse_unbounded(system, speeds_rpm)
    orders = system.require_excitation().orders
    phasors, heat = compute_curves(system, speeds_rpm)
    swings = _add_up(orders, phasors, tell)
    largest = find_largest(system, speeds_rpm, known=np.concatenate([swings, heat], axis=1))
    at, value = largest.rpm.tolist(), largest.value.tolist()
    end = len(system.shafts)
    there, _ = compute_curves(system, largest.rpm[: end + 1])
    by_order = np.abs(there[:, range(end + 1), range(end + 1)])  # of each curve where it is largest
    named_orders = list(map(order_number, orders.tolist()))
    shafts = []
    for k, name in enumerate(system.shafts):
        by_torque = None if (section := system.sections[k]) is None else section.stress_by_torque
        amplitudes = np.abs(phasors[:, :, k])
        worst = WorstTorque(
            speed_rpm=at[k],
            half_peak_to_peak_Nm=value[k],
            stress_Pa=None if by_torque is None else value[k] * by_torque,
            orders=tuple(map(OrderTorque, named_orders, by_order[:, k].tolist())),
        )
        shaft = ShaftResponse(
            name=name,
            half_peak_to_peak_Nm=swings[:, k],
            sum_of_amplitudes_Nm=amplitudes.sum(axis=0),
            stress_Pa=None if by_torque is None else swings[:, k] * by_torque,
            worst=worst,
            amplitudes_Nm=amplitudes,
        )
        shafts.append(shaft)

    worst_swings = list(map(WorstSwing, at, np.degrees(largest.value).tolist()))
    pendulums = tuple(
        PendulumSwing(system.nodes[each.node], np.degrees(swings[:, k]), worst_swings[k])
        for k, each in enumerate(system.pendulums, end + 1)
    )
    worst_heat = list(map(WorstHeat, at, value))[swings.shape[1] :]
    names = (name.removesuffix(" ring") for name in system.dampers)
    dampers = tuple(map(DamperHeat, names, heat.T, worst_heat))
    return TorsionResponse(
        speeds_rpm=speeds_rpm,
        shafts=tuple(shafts),
        free_end_deg=np.degrees(swings[:, end]),
        free_end_worst=worst_swings[end],
        dampers=dampers or None,
        pendulums=pendulums or None,
        orders=orders,
        swings_deg=np.degrees(np.abs(phasors[:, :, end])),
        worst_swings_deg=np.degrees(by_order[:, end]),
    )


def _add_up(orders: Real, phasors: Complex, tell: Tell) -> Real:
    """Return half of peak to peak (speeds, curves) of phasors (orders, speeds, curves)."""
    speeds, curves = phasors.shape[1:]
    step = max(int(_SAMPLES / (curves * 32 * orders.max())), 1)
    found = np.zeros((speeds, curves))
    for start in range(0, speeds, step):
        some = slice(start, min(start + step, speeds))
        found[some] = find_swing(orders, phasors[:, some]).half
        tell(some.stop / speeds)
    return found


# ------------------------------------------------------------------ barred speeds
_FINE = 0.003  # of a speed: steps in which a range is looked through for barred speeds
_CLOSE = 0.9  # of a limit: a top or valley so near to it at these speeds may pass it between them
_GOLDEN = (5**0.5 - 1) / 2
_NARROWINGS = 26  # by the golden section: of 0.6 % of a speed 2e-8 is left
_AT_ONCE = 256  # speeds


def find_barred(system: TorsionalSystem, rpm: Real) -> tuple[tuple[float, float], ...] | None:
    """Return ranges of speed (rpm) in which a limit of the file is passed, between the first and
    the last of rpm (speeds,); None without a limit that can be judged: a stress limit needs a shaft
    with a diameter.

    The speeds examined depend only on the ends of the range: fine steps, resonances, the highest
    points of peaks below a limit and the lowest points of valleys above it. The ends of a barred
    range are found by halving.
    """
    stress = np.nan_to_num(stress_by_torque(system)) / (system.limit_pa or np.inf)
    weights = np.append(stress, 1 / (system.angle_limit or np.inf))
    if not weights.any():
        return None
    orders = system.require_excitation().orders

    def measure(some: Real) -> Real:
        """Return the largest of what has a limit, over this, at speeds; 0 where it is far below."""
        found = np.zeros(len(some))
        for start in range(0, len(some), _AT_ONCE):
            part = slice(start, start + _AT_ONCE)
            curves = compute_curves(system, some[part])[0][:, :, : len(weights)] * weights
            speed, curve = np.nonzero(sum_amplitudes(curves) > _CLOSE)
            if len(speed):
                half = find_swing(orders, curves[:, speed, curve]).half
                np.maximum.at(found[part], speed, half)
        return found

    steps = max(math.ceil(math.log(rpm[-1] / rpm[0]) / _FINE), 1) if len(rpm) > 1 else 0
    grid = np.geomspace(rpm[0], rpm[-1], steps + 1)
    at, width = find_resonances(system, grid)
    speeds = np.unique(np.clip([*grid, *at, *(at + width * _SIDES).ravel()], rpm[0], rpm[-1]))
    values = measure(speeds)
    inner, before, after = values[1:-1], values[:-2], values[2:]
    tops = (inner >= before) & (inner >= after) & (inner > _CLOSE) & (inner <= 1)
    valleys = (inner <= before) & (inner <= after) & (inner > 1) & (inner < 1 / _CLOSE)
    places = np.flatnonzero(tops | valleys)
    sign = np.where(tops[places], 1, -1)
    low, high = speeds[places], speeds[places + 2]
    for _ in range(_NARROWINGS if len(places) else 0):
        left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
        upward = sign * (measure(right) - measure(left)) > 0
        low, high = np.where(upward, left, low), np.where(upward, high, right)
    speeds = np.unique(np.append(speeds, (low + high) / 2))
    above = measure(speeds) > 1
    changes = np.flatnonzero(above[1:] != above[:-1])
    low, high, upward = speeds[changes], speeds[changes + 1], above[changes + 1]
    for _ in range(_HALVINGS if len(changes) else 0):
        middle = (low + high) / 2
        same = (measure(middle) > 1) == upward
        low, high = np.where(same, low, middle), np.where(same, middle, high)
    ends = (low + high) / 2
    starts = [*speeds[:1][above[:1]].tolist(), *ends[upward].tolist()]
    stops = [*ends[~upward].tolist(), *speeds[-1:][above[-1:]].tolist()]
    return tuple(zip(starts, stops, strict=True))
