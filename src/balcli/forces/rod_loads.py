"""Compute loads along the piston rod over a cycle, as API 618 defines them (5th edition, 6.6).

Loads are positive in compression. With the gas force P towards the crank, the acceleration s'' w^2
of the piston away from it, and the masses of piston and crosshead,

    gas         P
    inertia     (m_piston + m_crosshead) s'' w^2
    piston rod  P + m_piston s'' w^2
    pin         P + (m_piston + m_crosshead) s'' w^2

The connecting rod is in none of them. The pin needs a reversal of its load, so that oil reaches
both sides of its bearing.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import numpy as np

from ..core.phasors import Array, Complex
from ..core.piecewise import Extreme, Panels, PiecewiseCurve, find_panels
from ..engine.engine import Engine
from .loads_with_gas import compute_in_pieces, find_breaks
from .rod_forces import compute_rod_forces

LEAST_REVERSAL_DEG = 15.0  # API 618, 5th edition, 6.6.4
LEAST_SHARE = 0.03
_NO_SIGN = 1e-9  # loads below this share of the largest have no sign
_STEPS = 60  # halvings of the search for a change of sign


class SignSpans(NamedTuple):
    """Spans of a load in compression and in tension, deg of a cycle.

    Attributes:
        compression_deg: Degrees in compression.
        tension_deg: Degrees in tension.
        longest_deg: Longest unbroken span of the sign that lasts shorter in all; 0 without a change
            of sign.
    """

    compression_deg: float
    tension_deg: float
    longest_deg: float


class RodLoadCurves(NamedTuple):
    """Loads of one cylinder over the crank angle, N.

    Attributes:
        gas: Gas force on the piston, towards the crank.
        inertia: Inertia force of piston and crosshead.
        piston_rod: Load of the piston rod.
        pin: Load of the crosshead pin, or of the piston pin of a trunk piston.
        guide: Force of the crosshead (or trunk piston) on its guide, positive towards the side to
            which the crank pin moves after the outer dead centre.
    """

    gas: PiecewiseCurve
    inertia: PiecewiseCurve
    piston_rod: PiecewiseCurve
    pin: PiecewiseCurve
    guide: PiecewiseCurve


def compute_rod_loads(engine: Engine) -> list[RodLoadCurves]:
    """Return the loads of every cylinder, in the order of `engine.numbers`.

    Args:
        engine: One engine with gas of known pressure, at a steady speed.

    Raises:
        BalcliError: The gas pressure is not known.
    """
    count = len(engine.numbers)
    pistons = np.array([[float(each.piston)] for each in engine.weighed])
    crossheads = np.array([[float(each.crosshead)] for each in engine.weighed])

    def stack(crank_deg: Array) -> Complex:
        forces = compute_rod_forces(engine, crank_deg)
        of_piston = pistons * forces.acceleration
        inertia = of_piston + crossheads * forces.acceleration
        loads = [forces.gas, inertia, forces.gas + of_piston, forces.gas + inertia, forces.thrust]
        return np.concatenate(loads).astype(complex)

    compute = partial(compute_in_pieces, engine, stack)
    panels = find_panels(compute, find_breaks(engine), 1.0)
    samples = compute(panels.angles).real
    curves = [_draw(panels, each) for each in samples]
    return [RodLoadCurves(*curves[row::count]) for row in range(count)]


def _draw(panels: Panels, samples: Array) -> PiecewiseCurve:
    return PiecewiseCurve(panels.breaks, panels.find_series(samples))


def find_spans(curve: PiecewiseCurve) -> SignSpans:
    """Return how long a load is in compression and in tension."""
    edges = _find_sign_changes(curve)
    widths = np.degrees(np.diff(edges))
    signs = np.sign(curve.within((edges[1:] + edges[:-1]) / 2))
    if not len(widths):
        return SignSpans(0.0, 0.0, 0.0)
    compression = float(widths[signs > 0].sum())
    tension = float(widths[signs < 0].sum())
    if compression == 0 or tension == 0:
        return SignSpans(compression, tension, 0.0)
    shorter = 1 if compression <= tension else -1
    return SignSpans(compression, tension, _find_longest(widths, signs == shorter))


def _find_longest(widths: Array, wanted: Array) -> float:
    """Return the longest sum of neighbouring widths that are wanted; the last one is a neighbour of
    the first.
    """
    start = int(np.argmin(wanted))  # not wanted: no span continues across it
    longest = 0.0
    span = 0.0
    for width, counts in zip(np.roll(widths, -start), np.roll(wanted, -start), strict=True):
        span = span + float(width) if counts else 0.0
        longest = max(longest, span)
    return longest


def _find_sign_changes(curve: PiecewiseCurve) -> Array:
    """Return angles (rad) that cut the period into spans without a change of sign: both ends of the
    period, the jumps, and the zeros.
    """
    edges = [curve.breaks[0]]
    size = max(abs(extreme.value) for extreme in curve.extremes())
    for low, high in zip(curve.breaks[:-1], curve.breaks[1:], strict=True):
        grid = np.linspace(low, high, 9)
        inner = grid.copy()
        inner[0] += 1e-9 * (high - low)  # at a jump, this panel's side of it
        inner[-1] -= 1e-9 * (high - low)
        values = curve.within(inner)
        values[np.abs(values) <= _NO_SIGN * size] = 0.0
        for k in np.flatnonzero(values[:-1] * values[1:] < 0):
            edges.append(_bisect(curve, inner[k], inner[k + 1]))
        edges.append(high)
    return np.unique(np.array(edges))


def _bisect(curve: PiecewiseCurve, low: float, high: float) -> float:
    """Return the angle between `low` and `high` (rad) at which a curve changes its sign."""
    rises = float(curve.within(np.array(low))) < 0
    for _ in range(_STEPS):
        middle = (low + high) / 2
        if (float(curve.within(np.array(middle))) < 0) == rises:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def find_peaks(curve: PiecewiseCurve) -> tuple[Extreme, Extreme]:
    """Return the largest tension and the largest compression of a load: angle (rad) and signed load
    (N); a load that never occurs is 0.
    """
    low, high = curve.extremes()
    return low._replace(value=min(low.value, 0.0)), high._replace(value=max(high.value, 0.0))
