"""Forced vibration at speeds: torque of every shaft, added up in time, and what follows from it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.peaks import find_swing, sum_amplitudes
from ..core.telling import Tell, tell_nobody
from ..core.vibration import Real
from .largest import LargestVibration, find_largest_vibration, find_resonant_speeds
from .motion import (
    move,
    refuse_too_many,
    refuse_torsional_resonance,
    split_speeds,
    stress_by_torque,
)
from .system import TorsionalSystem

_HALVINGS = 24  # of an interval of speeds in which a limit is passed


class TorsionResponse(NamedTuple):
    """Forced vibration.

    Attributes:
        speeds_rpm: (speeds,).
        orders: (orders,).
        torque: (speeds, shafts) half peak to peak of the vibratory torque, N m.
        sums: (speeds, shafts) sum of the amplitudes of all orders, N m.
        stress: (speeds, shafts) Pa, nan where a shaft has no diameter.
        free_end: (speeds,) half swing of the first node, rad.
        pendulums: (speeds, pendulums) half swing of each against its node, rad.
        amplitudes: (orders, speeds, shafts) torque by order, N m.
        swings: (orders, speeds) amplitude of the first node by order, rad.
        heat: (speeds, dampers) W, rings of oil first, then of rubber.
        dampers: names of their nodes.
        worst: also between the speeds.
    """

    speeds_rpm: Real
    orders: Real
    torque: Real
    sums: Real
    stress: Real
    free_end: Real
    pendulums: Real
    amplitudes: Real
    swings: Real
    heat: Real
    dampers: tuple[str, ...]
    worst: LargestVibration


def find_response(
    system: TorsionalSystem, speeds_rpm: Real, tell: Tell = tell_nobody
) -> TorsionResponse:
    """Vibration at speeds (speeds,), rising.

    Args:
        tell: is told which share of the speeds is done.

    Raises:
        BalcliError: nothing excites it; an undamped mode is driven at its own frequency.
    """
    refuse_too_many(system, len(speeds_rpm))
    refuse_torsional_resonance(system, speeds_rpm)
    parts, orders = [], system.require_excitation().orders
    for some in split_speeds(system, speeds_rpm, samples=16 * (orders.max() + 1)):
        parts.append(_summarise(system, orders, speeds_rpm[some]))
        tell(some.stop / len(speeds_rpm))
    joined = map(np.concatenate, zip(*parts, strict=True))
    torque, sums, free_end, pendulums, amplitudes, swings, heat = joined
    known = np.column_stack([torque, free_end, pendulums])
    return TorsionResponse(
        speeds_rpm,
        orders,
        torque,
        sums,
        torque * stress_by_torque(system),
        free_end,
        pendulums,
        np.swapaxes(amplitudes, 0, 1),
        swings.T,
        heat,
        system.dampers,
        find_largest_vibration(system, speeds_rpm, known, heat),
    )


def _summarise(system: TorsionalSystem, orders: Real, rpm: Real) -> tuple[Real, ...]:
    """What `find_response` puts together, each with the speeds first."""
    motion = move(system, rpm)
    swing, shafts = find_swing(orders, motion.curves).half, len(system.shafts)
    return (
        swing[:, :shafts],
        sum_amplitudes(motion.torque),
        swing[:, shafts],
        swing[:, shafts + 1 :],
        np.abs(motion.torque.swapaxes(0, 1)),
        np.abs(motion.angle[:, :, 0].T),
        motion.heat.sum(axis=0),
    )


def find_barred(
    system: TorsionalSystem, response: TorsionResponse, criticals_rpm: Real
) -> tuple[tuple[float, float], ...] | None:
    """Ranges of speed (rpm) in which a limit of the file is passed; None where it has none that can
    be judged: of a stress, where no shaft has a diameter.

    Between the speeds of the response its worst, those of criticals and damped resonances are
    looked at, too, and the middle between two that pass it; the ends of a range are found by
    halving.
    """
    if not _weigh_limits(system).any():
        return None
    known = response.speeds_rpm
    resonant, width = find_resonant_speeds(system, known)
    worst = [*response.worst.speeds_rpm, response.worst.swing_rpm]
    about = np.concatenate([worst, criticals_rpm, resonant, resonant - width, resonant + width])
    between = np.setdiff1d(about[(about > known[0]) & (about < known[-1])], known)
    speeds = np.concatenate([known, between])
    swings = np.column_stack([response.torque, response.free_end])
    here = np.any(swings * _weigh_limits(system) > 1, axis=1)
    above = np.concatenate([here, _pass_limits(system, between)])
    rising = np.argsort(speeds)
    speeds, above = speeds[rising], above[rising]
    gaps = np.flatnonzero(above[1:] & above[:-1])  # such as between two resonances
    middle = (speeds[gaps] + speeds[gaps + 1]) / 2
    speeds = np.insert(speeds, gaps + 1, middle)
    above = np.insert(above, gaps + 1, _pass_limits(system, middle))
    changes = np.flatnonzero(above[1:] != above[:-1])
    low, high, upward = speeds[changes], speeds[changes + 1], above[changes + 1]
    for _ in range(_HALVINGS if len(changes) else 0):
        middle = (low + high) / 2
        passed = _pass_limits(system, middle) == upward
        low, high = np.where(passed, low, middle), np.where(passed, middle, high)
    ends = (low + high) / 2
    starts = [*speeds[:1][above[:1]].tolist(), *ends[upward].tolist()]
    stops = [*ends[~upward].tolist(), *speeds[-1:][above[-1:]].tolist()]
    return tuple(zip(starts, stops, strict=True))


def _pass_limits(system: TorsionalSystem, rpm: Real) -> NDArray[np.bool_]:
    """Whether a limit is passed at each speed (speeds,); only curves are added up in time whose
    amplitudes together pass it.
    """
    passed, weights = np.zeros(len(rpm), bool), _weigh_limits(system)
    orders = system.require_excitation().orders
    for some in split_speeds(system, rpm):
        curves = move(system, rpm[some]).curves[:, :, : len(weights)] * weights
        most, here = sum_amplitudes(curves), passed[some]
        first = most.argmax(axis=1)[:, None] == np.arange(most.shape[1])
        for which in (first, ~first):  # one curve mostly tells
            speed, curve = np.nonzero(which & (most > 1) & ~here[:, None])
            if len(speed):
                swings = find_swing(orders, curves[:, speed, curve]).half
                here[speed[swings > 1]] = True
    return passed


def _weigh_limits(system: TorsionalSystem) -> Real:
    """What makes shares of a limit of the torques of all shafts and the swing of the first node
    (shafts + 1,); 0 where there is none.
    """
    stress = np.nan_to_num(stress_by_torque(system)) / (system.limit_pa or np.inf)
    return np.append(stress, 1 / (system.angle_limit or np.inf))
