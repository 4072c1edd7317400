"""Forced vibration over a range of speeds: torque of every shaft, added up in time, and what
follows from it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ..core.close_peaks import find_peaks_between, mark_high_peaks
from ..core.cycle_peaks import find_swing, sum_amplitudes
from ..core.singular_values import Complex, Real
from ..core.sorted_sets import sort_distinct, sort_others
from ..core.telling import Tell, tell_nobody
from ..core.torsional_modes import chain_loss, find_chain_modes
from ..core.torsional_response import respond_chain
from ..core.vibration import UndampedResonanceError, find_resonances, frequencies
from ..enginefile.units import RPM
from ..errors import BalcliError
from ..limits import MOST_TORSION_TORQUES
from .modes import find_poles
from .system import Excitation, TorsionalSystem

_AT_A_TIME = 1 << 20  # samples of a cycle, of all shafts and speeds, that are computed together
_ROUNDS = 12  # in which the speeds are looked at, those with the largest amplitudes first
_NEAR = 0.9  # of the largest at the speeds looked at: what a peak beside them may exceed
_BESIDE = np.array([-1, 0, 1])  # speeds looked at about a resonance, in widths
_WIDE = 3.0  # steps of the speeds: of a wider resonance one of them shows 95 %
_UNDAMPED = 1e-9  # a pole with a smaller share of damping is rounding
_HALVINGS = 24  # of an interval of speeds in which a limit is passed


class Worst(NamedTuple):
    """The largest between the first and last of the speeds, however narrow its resonance.

    Attributes:
        speeds_rpm: (shafts,), at which the torque of each shaft is largest.
        torque: (shafts,) half peak to peak there, N m.
        sums: (shafts,) sum of the amplitudes of all orders there, N m.
        stress: (shafts,) Pa, nan where a shaft has no diameter.
        amplitudes: (orders, shafts) torque by order there, N m.
        swing_rpm, free_end: where the first node swings most, and half of that swing, rad.
    """

    speeds_rpm: Real
    torque: Real
    sums: Real
    stress: Real
    amplitudes: Real
    swing_rpm: float
    free_end: float


class Response(NamedTuple):
    """Forced vibration.

    Attributes:
        speeds_rpm: (speeds,).
        orders: (orders,).
        torque: (speeds, shafts) half peak to peak of the vibratory torque, N m.
        sums: (speeds, shafts) sum of the amplitudes of all orders, N m.
        stress: (speeds, shafts) Pa, nan where a shaft has no diameter.
        free_end: (speeds,) half swing of the first node, rad.
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
    amplitudes: Real
    swings: Real
    heat: Real
    dampers: tuple[str, ...]
    worst: Worst


class ChainMotion(NamedTuple):
    """Angles (orders, speeds, nodes) and torques (orders, speeds, shafts) by order, complex, and
    power lost in dampers (orders, speeds, dampers).
    """

    angle: Complex
    torque: Complex
    heat: Real


def find_response(
    system: TorsionalSystem,
    excitation: Excitation,
    speeds_rpm: Real,
    tell: Tell = tell_nobody,
) -> Response:
    """Vibration at speeds (speeds,), rising.

    Args:
        excitation: by which; that of the system, or some of its orders.
        tell: is told which share of the speeds is done.

    Raises:
        BalcliError: an undamped mode is driven at its own frequency.
    """
    _refuse_too_many(len(excitation.orders), len(speeds_rpm), len(system.shafts))
    _refuse_resonance(system, excitation, speeds_rpm)
    parts = []
    for some in _split(system, excitation, speeds_rpm):
        parts.append(_summarise(system, excitation, speeds_rpm[some]))
        tell(some.stop / len(speeds_rpm))
    joined = [
        np.concatenate(each, axis=axis)
        for each, axis in zip(zip(*parts, strict=True), _AXES, strict=True)
    ]
    torque, sums, free_end, amplitudes, swings, heat = joined
    names = (*(system.nodes[ring.node] for ring in system.rings), *system.nodes[system.last + 1 :])
    return Response(
        speeds_rpm,
        excitation.orders,
        torque,
        sums,
        torque * stress_by_torque(system),
        free_end,
        amplitudes,
        swings,
        heat,
        names,
        _find_worst(system, excitation, speeds_rpm, np.column_stack([torque, free_end])),
    )


def _find_worst(
    system: TorsionalSystem, excitation: Excitation, speeds_rpm: Real, swings: Real
) -> Worst:
    """Of each shaft and the first node, whose swings at these speeds are known, (speeds, shafts +
    1).
    """
    count = len(system.shafts)
    rpm, height = _approach_largest(system, excitation, speeds_rpm, range(count + 1), swings)
    each = np.arange(count)
    torque = _find_curves(system, excitation, rpm)[:, each, each]
    return Worst(
        rpm[:count],
        height[:count],
        sum_amplitudes(torque),
        height[:count] * stress_by_torque(system),
        np.abs(torque),
        float(rpm[count]),
        float(height[count]),
    )


def find_largest(
    system: TorsionalSystem, excitation: Excitation, speeds_rpm: Real, curves: Sequence[int]
) -> tuple[Real, Real]:
    """At which speed, rpm, the vibratory torque of some shafts is largest, and half of peak to peak
    there, N m, (curves,) each, between the first and last of speeds (speeds,), rising; at each
    speed as of `find_response`. Behind the last shaft, a curve more is the angle of the first node,
    rad.

    Between the speeds, those about resonances are looked at, and every peak that may be the highest
    is approached.

    Raises:
        BalcliError: an undamped mode is driven at its own frequency.
    """
    _refuse_too_many(len(excitation.orders), len(speeds_rpm), len(system.shafts))
    _refuse_resonance(system, excitation, speeds_rpm)
    swings = _find_large_swings(system, excitation, speeds_rpm, curves, np.zeros(len(curves)))
    return _approach_largest(system, excitation, speeds_rpm, curves, swings)


def _approach_largest(
    system: TorsionalSystem,
    excitation: Excitation,
    speeds_rpm: Real,
    curves: Sequence[int],
    swings: Real,
) -> tuple[Real, Real]:
    """The same, with the swings at these speeds (speeds, curves), of which small ones may be 0."""
    narrow = _find_resonant_speeds(system, excitation, speeds_rpm, _WIDE)
    about = sort_others(narrow, speeds_rpm)
    speeds = np.concatenate([speeds_rpm, about])
    if len(about):
        beside = _find_large_swings(system, excitation, about, curves, swings.max(axis=0))
        swings = np.concatenate([swings, beside])
    rising = np.argsort(speeds)
    speeds, swings = speeds[rising], swings[rising]
    largest, rpm = swings.max(axis=0), speeds[swings.argmax(axis=0)]
    at, curve = np.nonzero(mark_high_peaks(swings, _NEAR))
    if not len(at) or len(speeds) == 1:  # nothing twists these shafts, or between no speeds
        return rpm, largest
    column = np.array(curves)[curve]

    def evaluate(rpm: Real) -> Real:
        few = sort_distinct(rpm)  # many curves peak between the same two
        found = _find_curves(system, excitation, few)[:, np.searchsorted(few, rpm), column]
        return find_swing(excitation.orders, found).half

    last = len(speeds) - 1
    low, high = speeds[np.maximum(at - 1, 0)], speeds[np.minimum(at + 1, last)]
    place, height = find_peaks_between(evaluate, low, high)
    for k in np.argsort(height):  # the highest last
        if height[k] > largest[curve[k]]:
            rpm[curve[k]], largest[curve[k]] = place[k], height[k]
    return rpm, largest


def _find_large_swings(
    system: TorsionalSystem,
    excitation: Excitation,
    rpm: Real,
    curves: Sequence[int],
    largest: Real,
) -> Real:
    """Half of peak to peak of some curves, as of `find_largest`, at these speeds (speeds, curves),
    wherever it is near the largest, here or known of elsewhere (curves,); elsewhere 0.

    No curve swings further than the sum of its amplitudes, so that most need not be added up.
    """
    found = _find_curves(system, excitation, rpm)[:, :, curves]
    most = sum_amplitudes(found)
    swings = np.zeros_like(most)
    for some in np.array_split(np.argsort(-most, axis=0), _ROUNDS):
        largest = np.maximum(largest, swings.max(axis=0))
        near = np.take_along_axis(most, some, axis=0) >= _NEAR * largest
        speed, curve = np.nonzero(near)
        if not len(speed):
            break
        at = some[speed, curve]
        swings[at, curve] = find_swing(excitation.orders, found[:, at, curve]).half
    return swings


def _find_curves(system: TorsionalSystem, excitation: Excitation, rpm: Real) -> Complex:
    """Torques by order, and the angle of the first node: (orders, speeds, shafts + 1); some speeds
    at a time.
    """
    motions = (move(system, excitation, rpm[some]) for some in _split(system, excitation, rpm))
    pieces = [np.concatenate([each.torque, each.angle[:, :, :1]], axis=2) for each in motions]
    return np.concatenate(pieces, axis=1)


def _find_resonant_speeds(
    system: TorsionalSystem, excitation: Excitation, rpm: Real, widest: float = np.inf
) -> Real:
    """Speeds (rpm) within a range at which an order meets a damped resonance, and beside it, as
    near as it is wide; `widest`: as many steps of these speeds (rpm) as it may be wide.
    """
    if len(rpm) == 1:
        return np.zeros(0)
    orders = excitation.orders
    if system.pendulums:  # their inertia differs from order to order
        poles = [find_poles(system, float(order)) for order in orders]
    else:
        poles = [find_poles(system)] * len(orders)
    found = [np.zeros(0)]
    for order, each in zip(orders, poles, strict=True):
        damped = each[(each.imag > 0) & (-each.real > _UNDAMPED * np.abs(each))]
        at, width = damped.imag / (RPM * order), -2 * damped.real / (RPM * order)
        steps = np.diff(rpm)[np.clip(np.searchsorted(rpm, at) - 1, 0, len(rpm) - 2)]
        narrow = width < widest * steps
        found.append((at + width * _BESIDE[:, None])[:, narrow].ravel())
    speeds = np.concatenate(found)
    return speeds[(speeds > rpm[0]) & (speeds < rpm[-1])]


def _refuse_too_many(orders: int, speeds: int, shafts: int) -> None:
    if orders * speeds * shafts > MOST_TORSION_TORQUES:
        raise BalcliError(
            f"{orders} orders at {speeds} speeds in {shafts} shafts are {orders * speeds * shafts} "
            f"torques, and at most {MOST_TORSION_TORQUES} are kept: take fewer speeds or orders"
        )


_AXES = (0, 0, 0, 1, 1, 0)  # the axis of speeds in what is summed up


def _split(system: TorsionalSystem, excitation: Excitation, speeds: Real) -> Iterator[slice]:
    """Pieces of the range that keep memory small."""
    samples = 16 * (excitation.orders.max() + 1) * (len(system.shafts) + 1)
    work = len(excitation.orders) * (len(system.nodes) + len(system.shafts))
    size = max(int(_AT_A_TIME / max(samples, work)), 1)
    for start in range(0, len(speeds), size):
        yield slice(start, min(start + size, len(speeds)))


def _summarise(system: TorsionalSystem, excitation: Excitation, rpm: Real) -> tuple[Real, ...]:
    motion = move(system, excitation, rpm)
    first = motion.angle[:, :, :1]
    swing = find_swing(excitation.orders, np.concatenate([motion.torque, first], axis=-1)).half
    return (
        swing[:, :-1],
        sum_amplitudes(motion.torque),
        swing[:, -1],
        np.abs(motion.torque),
        np.abs(first[:, :, 0]),
        motion.heat.sum(axis=0),
    )


def move(system: TorsionalSystem, excitation: Excitation, rpm: Real) -> ChainMotion:
    """Motion order by order at these speeds (rpm)."""
    speeds = rpm * RPM
    w = frequencies(excitation.orders, speeds)
    load = excitation.on_nodes(speeds, len(system.nodes))
    order = np.broadcast_to(excitation.orders[:, None], w.shape)
    attached = system.attached(w, order)
    try:
        twist = respond_chain(system.chain, system.damping, w, load, attached)
    except UndampedResonanceError as error:
        raise BalcliError(_tell_resonance(system, error.frequency / (2 * np.pi))) from None
    heat = _heat_of_oil(system, w, twist.angle), _heat_of_rubber(system, w, twist.torque)
    return ChainMotion(twist.angle, twist.torque, np.concatenate(heat, axis=-1))


def _heat_of_rubber(system: TorsionalSystem, w: Real, torque: Complex) -> Real:
    """Power (orders, speeds, rings) that rubber turns to heat: `w loss |T|^2/(2 k (1 + loss^2))`;
    its shafts are the last ones.
    """
    first = len(system.shafts) - (len(system.nodes) - 1 - system.last)
    loss, stiffness = system.damping.loss[first:], system.chain.stiffness[first:]
    softness = loss / (stiffness * (1 + loss**2))
    return np.asarray(w[..., None] / 2 * softness * np.abs(torque[..., first:]) ** 2)


def _heat_of_oil(system: TorsionalSystem, w: Real, angle: Complex) -> Real:
    """Power (orders, speeds, rings) that rings in oil turn to heat: `-w^3 Im J |x|^2/2`."""
    found = np.zeros((*w.shape, len(system.rings)))
    for k, ring in enumerate(system.rings):
        slip = w * (ring.inertia / ring.damping)
        lagging = ring.inertia * slip / (1 + slip**2)
        found[..., k] = w**3 * lagging * np.abs(angle[..., ring.node]) ** 2 / 2
    return found


def stress_by_torque(system: TorsionalSystem) -> Real:
    """(shafts,) Pa for 1 N m; nan where there is no diameter."""
    found = [np.nan if s is None else s.stress_by_torque for s in system.sections]
    return np.array(found)


def _refuse_resonance(system: TorsionalSystem, excitation: Excitation, rpm: Real) -> None:
    """Refuse a range in which an undamped mode is driven at its own frequency."""
    lossy = (system.damping.loss > 0) | (system.damping.dashpots > 0)
    if np.all(lossy | np.isinf(system.chain.stiffness)):  # whatever twists, loses
        return
    if system.pendulums:  # their inertia differs from order to order, and so do the modes
        _drive_undamped(system, excitation, rpm)
        return
    modes = find_chain_modes(system.chain)
    loss = chain_loss(system.chain, system.damping, modes, system.attached(modes.omega))
    speeds = rpm * RPM
    load = excitation.on_nodes(speeds, len(system.nodes))
    met = find_resonances(modes, loss, excitation.orders, speeds, load)
    if met:
        worst = met[0]
        hertz = modes.omega[worst.mode] / (2 * np.pi)
        speed = f" by order {worst.order:g} at {worst.speed / RPM:.6g} rpm"
        raise BalcliError(_tell_resonance(system, float(hertz), speed))


def _drive_undamped(system: TorsionalSystem, excitation: Excitation, rpm: Real) -> None:
    """Vibration at every speed of a range at which an order meets an undamped resonance: there is
    one only where it drives nothing.
    """
    for order in excitation.orders:
        poles = find_poles(system, float(order))
        free = poles[(poles.imag > 0) & (-poles.real <= _UNDAMPED * np.abs(poles))]
        met = free.imag / (RPM * order)
        met = met[(met >= rpm[0]) & (met <= rpm[-1])]
        if len(met):
            move(system, excitation.only(order), met)


def _tell_resonance(system: TorsionalSystem, hertz: float, speed: str = "") -> str:
    where = f"{system.name}: " if system.name else ""
    return (
        f"{where}the natural frequency of {hertz:.6g} Hz is excited{speed} and nothing damps it: "
        "its vibration has no bound; give a loss factor (loss = 0.02), or damping"
    )


def find_barred(
    system: TorsionalSystem, excitation: Excitation, response: Response, criticals_rpm: Real
) -> tuple[tuple[float, float], ...] | None:
    """Ranges of speed (rpm) in which a limit of the file is passed; None where it has none.

    Between the speeds of the response those of criticals and damped resonances are looked at, too,
    and the middle between two that pass it; the ends of a range are found by halving.
    """
    if system.limit_pa is None and system.angle_limit is None:
        return None
    known = response.speeds_rpm
    resonant = _find_resonant_speeds(system, excitation, known)
    inner = criticals_rpm[(criticals_rpm > known[0]) & (criticals_rpm < known[-1])]
    between = sort_others(np.concatenate([inner, resonant]), known)
    speeds = np.concatenate([known, between])
    excess = np.concatenate(
        [
            _share_of_limits(system, response.torque, response.free_end),
            _exceed(system, excitation, between),
        ]
    )
    rising = np.argsort(speeds)
    speeds, above = speeds[rising], excess[rising] > 0
    gaps = np.flatnonzero(above[1:] & above[:-1])  # such as between two resonances
    middle = (speeds[gaps] + speeds[gaps + 1]) / 2
    speeds = np.insert(speeds, gaps + 1, middle)
    above = np.insert(above, gaps + 1, _exceed(system, excitation, middle) > 0)
    changes = np.flatnonzero(above[1:] != above[:-1])
    low, high, upward = speeds[changes], speeds[changes + 1], above[changes + 1]
    for _ in range(_HALVINGS if len(changes) else 0):
        middle = (low + high) / 2
        passed = (_exceed(system, excitation, middle) > 0) == upward
        low, high = np.where(passed, low, middle), np.where(passed, middle, high)
    ends = (low + high) / 2
    starts = [*speeds[:1][above[:1]].tolist(), *ends[upward].tolist()]
    stops = [*ends[~upward].tolist(), *speeds[-1:][above[-1:]].tolist()]
    return tuple(zip(starts, stops, strict=True))


def _exceed(system: TorsionalSystem, excitation: Excitation, rpm: Real) -> Real:
    """By how much of it a limit is passed at each speed (speeds,); negative below it."""
    if not len(rpm):
        return np.zeros(0)
    torque, _, free_end, *_ = _summarise(system, excitation, rpm)
    return _share_of_limits(system, torque, free_end)


def _share_of_limits(system: TorsionalSystem, torque: Real, free_end: Real) -> Real:
    share = np.zeros(len(free_end))
    if system.limit_pa is not None:
        stress = np.nan_to_num(torque * stress_by_torque(system)) / system.limit_pa
        share = np.maximum(share, stress.max(axis=1, initial=0.0))
    if system.angle_limit is not None:
        share = np.maximum(share, free_end / system.angle_limit)
    return share - 1
