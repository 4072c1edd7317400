"""Compute forced torsional vibration over speeds: torque and stress of every shaft, with all orders
added up in time; swings of the free end and of pendulums; heat of dampers; and the largest values
over a range of speeds.

The largest values may lie between the given speeds. Therefore the speeds at which an order meets a
damped resonance are added, with the half-power speeds on both sides. Every peak that may be the
highest is then refined.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from ..core.peaks import find_highest
from ..core.phases import RPM
from ..core.vibration import ROUNDING, Complex, Indices, Real
from ..file.fields import order_number
from ..process import Tell, tell_nobody
from .columns import Columns
from .motion import compute_curves, compute_in_parts, refuse_unbounded
from .poles import find_poles
from .system import TorsionalSystem

_ABOUT = np.array([[-0.5], [0], [0.5]])  # offsets of added speeds, in widths of the resonance
# Resonances wider than this number of steps between given speeds need no added speeds: one of the
# given speeds has at least 95 % of the peak.
_WIDE = 3.0
# Beside a speed with at least this share of the largest value, a higher value may lie between two
# speeds.
_NEAR = 0.9


def find_largest(
    system: TorsionalSystem,
    rpm: Real,
    weights: Real | None = None,
    *,
    together: bool = False,
    known: Real | None = None,
) -> tuple[Real, Real]:
    """Return the largest value of each column between the first and last speed: its speed
    (columns,), rpm, and the value (columns,).

    The columns are half of peak to peak of the torque of each shaft (N m), half of the swing of the
    free end and of each pendulum (rad), and the heat of each damper (W).

    Args:
        system: System with an excitation.
        rpm: Rising speeds, shape (speeds,).
        weights: Factors of the first columns, none below 0, by which values are multiplied; columns
            whose factor is 0 or missing are skipped, and their values are 0. Default: 1 for all.
        together: Whether only the highest of all columns is needed, which takes less time; values
            of other columns may then be too small.
        known: Values of all columns at these speeds, shape (speeds, columns), if they are known.

    Raises:
        BalcliError: Nothing excites the system, or an undamped mode is driven at its own frequency.
    """
    refuse_unbounded(system, rpm)
    search = _Search(Columns([system]), [system], [rpm], weights)
    return search.find(together=together, known=known)[0]


def find_largest_of_each(
    systems: Sequence[TorsionalSystem], rpm: Sequence[Real], weights: Real | None = None
) -> list[tuple[Real, Real]]:
    """Return the largest values of several variants of a system, as `find_largest` does, in less
    time.

    Args:
        systems: Systems with an excitation.
        rpm: Rising speeds of each system.
        weights: As for `find_largest`.

    Raises:
        BalcliError: As for `find_largest`.
    """
    orders = [system.require_excitation().orders for system in systems]
    if not all(np.array_equal(own, orders[0]) for own in orders):
        return [find_largest(*each, weights) for each in zip(systems, rpm, strict=True)]
    for system, own in zip(systems, rpm, strict=True):
        refuse_unbounded(system, own)
    return _Search(Columns(systems), systems, rpm, weights).find()


class _Search:
    """Search for the largest values of columns of one or more systems. Each wanted column of each
    system is a function of the speed; the functions of a system follow one another.

    Args:
        columns: Columns of the systems.
        systems: Systems with an excitation.
        rpm: Rising speeds of each system.
        weights: As for `find_largest`.
    """

    def __init__(
        self,
        columns: Columns,
        systems: Sequence[TorsionalSystem],
        rpm: Sequence[Real],
        weights: Real | None,
    ) -> None:
        self.columns = columns
        self.rpm = rpm
        self.factors = np.ones(columns.count)
        if weights is not None:
            self.factors[:] = 0
            self.factors[: len(weights)] = weights
        self.wanted = np.flatnonzero(self.factors)
        own = [
            add_resonances(system, given, columns.find_poles(k))
            for k, (system, given) in enumerate(zip(systems, rpm, strict=True))
        ]
        most = max(map(len, own))
        speeds = [np.pad(each, (0, most - len(each)), mode="edge") for each in own]
        self.speeds = np.repeat(np.stack(speeds, axis=1), len(self.wanted), axis=1)

    def judge(self, at: Real, which: Indices, least: Real | None = None) -> Real:
        """Return the values at speeds `at`, each of the function in `which`; see `Columns.find` for
        `least`, which has the shape of `at`.
        """
        speeds, function = (each.ravel() for each in np.broadcast_arrays(at, which))
        system, number = np.divmod(function, len(self.wanted))
        column = self.wanted[number]
        factors = self.factors[column]
        of_columns = None if least is None else least.ravel() / factors
        values = self.columns.find(speeds, column, system, of_columns) * factors
        return np.asarray(values.reshape(np.shape(at)))

    def bound(self) -> Real:
        """Return upper bounds of the functions at their speeds, shape (speeds, functions)."""
        of_systems = []
        for k in range(len(self.rpm)):
            speeds = self.speeds[:, k * len(self.wanted)]
            bounds = self.columns.bound(speeds, self.wanted, k)
            of_systems.append(bounds * self.factors[self.wanted])
        return np.concatenate(of_systems, axis=1)

    def find(self, *, together: bool = False, known: Real | None = None) -> list[tuple[Real, Real]]:
        """Return the speed and the value of the highest peak of each column of each system.

        Args:
            together: As for `find_largest`.
            known: As for `find_largest`, for a single system.
        """
        if not len(self.wanted):
            none = np.zeros(self.columns.count)
            return [(np.full(self.columns.count, rpm[0]), none) for rpm in self.rpm]
        heights = self.bound()
        functions = np.arange(heights.shape[1])
        unknown = np.ones((len(heights), 1), bool)
        if known is None:
            level = self.judge(self.speeds[heights.argmax(axis=0), functions], functions)
        else:
            given = np.searchsorted(self.speeds[:, 0], self.rpm[0])
            unknown[given] = False
            heights[given] = known[:, self.wanted] * self.factors[self.wanted]
            level = heights[given].max(axis=0)
        if together:
            level[:] = level.max()
        least = _NEAR * level
        near = np.nonzero(unknown & (heights > 0) & (heights >= least))
        heights[near] = self.judge(self.speeds[near], near[1], least[near[1]])
        level = heights.max(axis=0)
        if together:
            level[:] = level.max()
        places, _ = find_highest(self.judge, self.speeds, heights, level, _NEAR)
        system, number = np.divmod(functions, len(self.wanted))
        exact = self.columns.find_exactly(places, self.wanted[number], system)
        largest: list[tuple[Real, Real]] = []
        for k, rpm in enumerate(self.rpm):
            best = np.full(self.columns.count, rpm[0])
            best[self.wanted] = places[system == k]
            highest = np.zeros(self.columns.count)
            highest[self.wanted] = exact[system == k] * self.factors[self.wanted]
            largest.append((best, highest))
        return largest


def add_resonances(system: TorsionalSystem, rpm: Real, poles: Complex | None = None) -> Real:
    """Return the speeds (rpm) and additional speeds about the damped resonances that orders meet
    between them. Resonances that are wide compared with the steps need no additional speeds.

    Args:
        system: System with an excitation.
        rpm: Rising speeds, shape (speeds,).
        poles: Poles that do not depend on the order, if they are known.
    """
    if len(rpm) == 1:
        return rpm
    orders = system.every_order
    if system.pendulums:
        of_orders = [find_poles(system, order) for order in orders.tolist()]
    else:
        of_orders = [find_poles(system) if poles is None else poles] * len(orders)
    poles = np.array(of_orders)
    met = (poles.imag > 0) & (-poles.real > ROUNDING * np.abs(poles))
    by_order = RPM * np.broadcast_to(orders[:, None], poles.shape)[met]
    at = poles.imag[met] / by_order
    width = -2 * poles.real[met] / by_order
    steps = np.diff(rpm)[np.clip(np.searchsorted(rpm, at) - 1, 0, len(rpm) - 2)]
    there = (at > rpm[0]) & (at < rpm[-1]) & (width < _WIDE * steps)
    about = (at + width * _ABOUT)[:, there]
    return np.unique(np.clip(np.append(rpm, about), rpm[0], rpm[-1]))


Edge = Literal["first", "last"]


class OrderTorque(NamedTuple):
    """Torque of one order.

    Attributes:
        order: Order of the excitation.
        amplitude_Nm: Amplitude of the torque.
    """

    order: float
    amplitude_Nm: float


@dataclass(frozen=True, kw_only=True)
class WorstTorque:
    """Largest vibratory torque of a shaft over the range of speeds; it may lie between given
    speeds.

    Attributes:
        speed_rpm: Speed at which this torque occurs.
        half_peak_to_peak_Nm: Half of the peak-to-peak torque, all orders added with their phases.
        stress_Pa: Stress at that speed; left out without a diameter.
        orders: Torque by order at that speed; torques without a known phase come last, each by
            itself.
        edge: End of the range of speeds at which this torque occurs, so that it may be larger
            outside; left out elsewhere, and for a single speed.
    """

    speed_rpm: float
    half_peak_to_peak_Nm: float
    stress_Pa: float | None = None
    orders: tuple[OrderTorque, ...]
    edge: Edge | None = None


@dataclass(frozen=True, eq=False, kw_only=True)
class ShaftResponse:
    """Vibratory torque of a shaft.

    Attributes:
        name: Name of the shaft.
        half_peak_to_peak_Nm: Half of the peak-to-peak torque, by speed.
        sum_of_amplitudes_Nm: Sum of the amplitudes of all orders, by speed.
        stress_Pa: Stress under `half_peak_to_peak_Nm`, by speed; left out without a diameter.
        mean_Nm: Mean torque, by speed; left out without gas.
        worst: Largest torque over the range of speeds.
    """

    name: str
    half_peak_to_peak_Nm: Real
    sum_of_amplitudes_Nm: Real
    stress_Pa: Real | None = None
    mean_Nm: Real | None = None
    worst: WorstTorque


class WorstSwing(NamedTuple):
    """Largest swing over the range of speeds; it may lie between given speeds.

    Attributes:
        speed_rpm: Speed at which the largest swing occurs.
        half_swing_deg: Half of the peak-to-peak swing.
        edge: End of the range of speeds at which this swing occurs, so that it may be larger
            outside; left out elsewhere, and for a single speed.
    """

    speed_rpm: float
    half_swing_deg: float
    edge: Edge | None = None


class WorstPendulum(NamedTuple):
    """Largest swing of pendulums over the range of speeds; it may lie between given speeds.

    Attributes:
        speed_rpm: Speed at which the largest swing occurs.
        half_swing_deg: Half of the peak-to-peak swing.
        order: Order with the largest amplitude at this speed.
    """

    speed_rpm: float
    half_swing_deg: float
    order: float


class WorstHeat(NamedTuple):
    """Largest power that a damper dissipates over the range of speeds.

    Attributes:
        speed_rpm: Speed at which the largest power occurs.
        heat_W: Largest power.
    """

    speed_rpm: float
    heat_W: float


class DamperHeat(NamedTuple):
    """Power that a damper dissipates.

    Attributes:
        node: Name of the node that carries the damper.
        heat_W: Power by speed.
        worst: Largest power over the range of speeds.
    """

    node: str
    heat_W: Real
    worst: WorstHeat


class PendulumSwing(NamedTuple):
    """Swing of pendulums against their node.

    Attributes:
        node: Name of the node that carries the pendulums.
        half_swing_deg: Half of the peak-to-peak swing, by speed.
        worst: Largest swing over the range of speeds.
    """

    node: str
    half_swing_deg: Real
    worst: WorstPendulum


class ExcitationBySpeed(NamedTuple):
    """A torque of one order on a node, from [[torsion.excitation]].

    Attributes:
        node: Name of the node.
        order: Oscillations per turn of the node.
        crank_order: Oscillations per turn of the crankshaft.
        phase: Whether the phase to the cylinders is known. If not, what the torque causes is added
            in the worst phase.
        amplitude_Nm: Amplitude by speed.
    """

    node: str
    order: float
    crank_order: float
    phase: Literal["known", "unknown"]
    amplitude_Nm: Real


@dataclass(frozen=True, eq=False, kw_only=True)
class TorsionResponse:
    """Forced vibration over speeds.

    Attributes:
        speeds_rpm: Speeds.
        imep_Pa: Indicated mean effective pressure, by speed; left out if it is the same at all
            speeds.
        shafts: Torque of each shaft.
        free_end_deg: Half of the peak-to-peak swing of the free end, by speed.
        free_end_worst: Largest swing of the free end.
        dampers: Heat of dampers, viscous rings first; left out if there are none.
        pendulums: Swing of pendulums; left out if there are none.
        excitations: Torques on nodes besides those of the cylinders; left out if there are none.
    """

    speeds_rpm: Real
    imep_Pa: Real | None = None
    shafts: tuple[ShaftResponse, ...]
    free_end_deg: Real
    free_end_worst: WorstSwing
    dampers: tuple[DamperHeat, ...] | None = None
    pendulums: tuple[PendulumSwing, ...] | None = None
    excitations: tuple[ExcitationBySpeed, ...] | None = None


def find_response(
    system: TorsionalSystem, speeds_rpm: Real, tell: Tell = tell_nobody
) -> TorsionResponse:
    """Return the forced vibration at these speeds, and its largest values over their range.

    Args:
        system: System with an excitation.
        speeds_rpm: Rising speeds, shape (speeds,).
        tell: Function that is called with the share of the speeds computed so far.

    Raises:
        BalcliError: Nothing excites the system, or an undamped mode is driven at its own frequency.
    """
    refuse_unbounded(system, speeds_rpm)
    excitation = system.require_excitation()
    end = len(system.shafts)
    pieces = []
    for part in compute_in_parts(system, speeds_rpm):
        pieces.append((part.swings, part.sums, part.heat))
        tell(sum(len(each) for each, *_ in pieces) / len(speeds_rpm))
    swings, sums, heat = (np.concatenate(each) for each in zip(*pieces, strict=True))
    at, value = find_largest(system, speeds_rpm, known=np.append(swings, heat, axis=1))
    curves = np.arange(end + 1 + len(system.pendulums))  # torques, free end, pendulums
    worst_curves = compute_curves(system, at[: len(curves)])
    at_worst = worst_curves.select(curves, curves)  # each curve at its worst speed
    by_order = np.concatenate([np.abs(at_worst.phasors), at_worst.unphased])
    unphased = [float(own.orders[0]) for own in system.unphased]
    named_orders = [*map(order_number, (*excitation.orders.tolist(), *unphased))]
    means = None if system.means is None else system.means.at(speeds_rpm)
    shafts = []
    for k, name in enumerate(system.shafts):
        by_torque = system.stress_by_torque[k]  # 0 without a diameter
        worst = WorstTorque(
            speed_rpm=float(at[k]),
            half_peak_to_peak_Nm=float(value[k]),
            stress_Pa=float(value[k] * by_torque) if by_torque else None,
            orders=tuple(map(OrderTorque, named_orders, by_order[:, k].tolist())),
            edge=_find_edge(speeds_rpm, at[k], value[k]),
        )
        shaft = ShaftResponse(
            name=name,
            half_peak_to_peak_Nm=swings[:, k],
            sum_of_amplitudes_Nm=sums[:, k],
            stress_Pa=swings[:, k] * by_torque if by_torque else None,
            mean_Nm=None if means is None else means[:, k],
            worst=worst,
        )
        shafts.append(shaft)
    degrees = np.degrees(swings)
    worst_deg = np.degrees(value).tolist()
    pendulums = []
    for k, pendulum in enumerate(system.pendulums, end + 1):
        largest = named_orders[by_order[:, k].argmax()]
        swing = WorstPendulum(float(at[k]), worst_deg[k], largest)
        pendulums.append(PendulumSwing(system.nodes[pendulum.node], degrees[:, k], swing))
    worst_heat = list(map(WorstHeat, at.tolist(), value.tolist()))[sums.shape[1] :]
    names = [system.nodes[ring.node] for ring in system.rings]
    names += [name.removesuffix(" ring") for name in system.nodes[system.last + 1 :]]
    dampers = tuple(map(DamperHeat, names, heat.T, worst_heat))
    return TorsionResponse(
        speeds_rpm=speeds_rpm,
        imep_Pa=None if excitation.gas is None else excitation.gas.imep(speeds_rpm),
        shafts=tuple(shafts),
        free_end_deg=degrees[:, end],
        free_end_worst=WorstSwing(
            float(at[end]), worst_deg[end], _find_edge(speeds_rpm, at[end], value[end])
        ),
        dampers=dampers or None,
        pendulums=tuple(pendulums) or None,
        excitations=tuple(_list_excitations(system, speeds_rpm)) or None,
    )


def _list_excitations(system: TorsionalSystem, speeds_rpm: Real) -> Iterator[ExcitationBySpeed]:
    """Yield the torques of [[torsion.excitation]] at these speeds."""
    for torque in system.torques:
        yield ExcitationBySpeed(
            node=system.nodes[torque.node],
            order=order_number(torque.own_order),
            crank_order=order_number(torque.order),
            phase="unknown" if torque.turn is None else "known",
            amplitude_Nm=torque.amplitude(speeds_rpm),
        )


def _find_edge(speeds_rpm: Real, at: float, value: float) -> Edge | None:
    """Return the end of the range of speeds at which the largest value occurs.

    Args:
        speeds_rpm: Rising speeds, shape (speeds,).
        at: Speed of the largest value, rpm.
        value: Largest value; if it is 0, it occurs at no speed.
    """
    if len(speeds_rpm) == 1 or value == 0:
        return None
    if at <= speeds_rpm[0]:
        return "first"
    return "last" if at >= speeds_rpm[-1] else None
