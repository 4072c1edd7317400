"""Measure the loads along the piston rods over a cycle: peaks, reversal, force on the guide."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.piecewise import Extreme, PiecewiseCurve
from ..engine.engine import CylinderNumber, Engine
from ..forces.rod_loads import (
    LEAST_REVERSAL_DEG,
    LEAST_SHARE,
    RodLoadCurves,
    compute_rod_loads,
    find_peaks,
    find_spans,
)


@dataclass(frozen=True, kw_only=True)
class RodPeaks:
    """Largest loads along the rod.

    Attributes:
        compression_N: Largest load in compression.
        compression_deg: Crank angle of this load; left out if the rod is never in compression.
        tension_N: Largest load in tension.
        tension_deg: Crank angle of this load; left out if the rod is never in tension.
    """

    compression_N: float
    compression_deg: float | None = None
    tension_N: float
    tension_deg: float | None = None


@dataclass(frozen=True, kw_only=True)
class Guide:
    """Force of the crosshead, or of a trunk piston, on its guide, positive towards the side to
    which the crank pin moves after the outer dead centre.

    Attributes:
        max_N: Largest force.
        max_deg: Crank angle of the largest force.
        min_N: Smallest force.
        min_deg: Crank angle of the smallest force.
    """

    max_N: float
    max_deg: float
    min_N: float
    min_deg: float


@dataclass(frozen=True, kw_only=True)
class Reversal:
    """Reversal of the load of the pin.

    Attributes:
        compression_deg: Degrees of the cycle in compression.
        tension_deg: Degrees of the cycle in tension.
        longest_deg: Longest unbroken span of the sign that lasts shorter in all; 0 without a change
            of sign.
        ratio: Smaller of the largest loads in compression and tension over the larger one.
        reverses: Whether the reversal meets API 618, 5th edition, 6.6.4: at least 15 deg, and a
            ratio of at least 0.03.
    """

    compression_deg: float
    tension_deg: float
    longest_deg: float
    ratio: float
    reverses: bool


@dataclass(frozen=True, kw_only=True)
class RodLoad:
    """Loads along the rod of one cylinder over the cycle.

    Attributes:
        cylinder: Number of the cylinder.
        gas: Gas force on the piston.
        inertia: Inertia force of piston and crosshead.
        piston_rod: Load of the piston rod: gas, and inertia of the piston.
        pin: Load of the crosshead pin (of the piston pin in a trunk engine): gas and inertia of
            piston and crosshead, at equal angles.
        guide: Force on the guide.
        reversal: Reversal of the load of the pin.
    """

    cylinder: CylinderNumber
    gas: RodPeaks
    inertia: RodPeaks
    piston_rod: RodPeaks
    pin: RodPeaks
    guide: Guide
    reversal: Reversal


def measure_rod_loads(engine: Engine) -> tuple[RodLoad, ...]:
    """Return the loads along the rods of all cylinders, in the order of their numbers.

    Args:
        engine: Engine with gas of known pressure, at a steady speed.
    """
    each = zip(engine.numbers, compute_rod_loads(engine), strict=True)
    loads = [_measure(number, curves) for number, curves in each]
    return tuple(sorted(loads, key=lambda load: load.cylinder))


def _measure(number: CylinderNumber, curves: RodLoadCurves) -> RodLoad:
    low, high = curves.guide.extremes()
    guide = Guide(
        max_N=high.value,
        max_deg=_find_degrees(high, curves.guide),
        min_N=low.value,
        min_deg=_find_degrees(low, curves.guide),
    )
    pin = _find_largest(curves.pin)
    spans = find_spans(curves.pin)
    larger = max(pin.compression_N, pin.tension_N)
    ratio = min(pin.compression_N, pin.tension_N) / larger if larger else 0.0
    return RodLoad(
        cylinder=number,
        gas=_find_largest(curves.gas),
        inertia=_find_largest(curves.inertia),
        piston_rod=_find_largest(curves.piston_rod),
        pin=pin,
        guide=guide,
        reversal=Reversal(
            compression_deg=spans.compression_deg,
            tension_deg=spans.tension_deg,
            longest_deg=spans.longest_deg,
            ratio=ratio,
            reverses=spans.longest_deg >= LEAST_REVERSAL_DEG and ratio >= LEAST_SHARE,
        ),
    )


def _find_largest(curve: PiecewiseCurve) -> RodPeaks:
    low, high = find_peaks(curve)
    return RodPeaks(
        compression_N=high.value,
        compression_deg=_find_degrees(high, curve) if high.value else None,
        tension_N=-low.value + 0.0,
        tension_deg=_find_degrees(low, curve) if low.value else None,
    )


def _find_degrees(extreme: Extreme, curve: PiecewiseCurve) -> float:
    return float(np.degrees(extreme.angle)) % float(np.degrees(curve.period))
