"""The figures of a result by name, as JSON nests them and CSV lists them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple, Protocol

import numpy as np

from ..core.peaks import Peak
from ..core.phasors import Phasors
from ..forces.kinds import KINDS, MOMENT, Kind
from ..forces.spectrum import Spectra
from .units import System, Unit


class Result(Protocol):
    """What has orders and peaks: an analysis, or the sum of two engines."""

    @property
    def spectra(self) -> Spectra: ...

    @property
    def peaks(self) -> list[tuple[Kind, Peak]]: ...

    @property
    def cylinders(self) -> tuple[tuple[int, Spectra], ...]: ...

    @property
    def moments_known(self) -> bool: ...


class Row(NamedTuple):
    """One figure of a result; `cylinder` 0 is the engine, order None the whole curve."""

    cylinder: int
    quantity: str
    order: float | None
    figure: str
    value: float | bool | str | None
    unit: str


def assumptions(analysis: Result) -> dict[str, list[str]]:
    """What JSON says of figures that rest on what the engine file does not say."""
    return {} if analysis.moments_known else {"assumed": ["crank.spacing = 0"]}


def order_number(order: float) -> int | float:
    return int(order) if order == int(order) else float(order)


def clean(value: Any) -> float | None:
    """A plain float; None for nan, and no negative zero."""
    number = float(value)
    return None if number != number else number + 0.0


def figures(kind: Kind, phasors: Phasors, k: int) -> dict[str, Any]:
    """All figures of the k-th order of a kind, SI and degrees."""
    return vector(phasors, k) if kind.vector else scalar(phasors, k)


def vector(phasors: Phasors, k: int) -> dict[str, Any]:
    """Force or moment of the k-th order."""
    phasors, k = (
        phasors.select_orders(phasors.orders[k : k + 1]),
        0,
    )  # else each figure would be computed for all orders each time
    forward, backward = phasors.forward[k], phasors.backward[k]
    return {
        "forward": [clean(forward.real), clean(forward.imag)],
        "backward": [clean(backward.real), clean(backward.imag)],
        "major": clean(phasors.major[k]),
        "minor": clean(phasors.minor[k]),
        "axis_deg": clean(phasors.axis_deg[k]),
        "x": _component(phasors.x[k], phasors.orders[k]),
        "y": _component(phasors.y[k], phasors.orders[k]),
        "balanced": bool(phasors.balanced[k]),
    }


def scalar(phasors: Phasors, k: int) -> dict[str, Any]:
    """Couple, torque or roll of the k-th order."""
    phasors, k = phasors.select_orders(phasors.orders[k : k + 1]), 0
    c, order = phasors.x[k], phasors.orders[k]
    return {
        "cos": clean(c.real),
        "sin": clean(-c.imag),
        "amplitude": clean(abs(c)),
        "peak_deg": peak_deg(c, order),
        "balanced": bool(phasors.balanced[k]),
    }


def peak_deg(c: complex, order: float) -> float | None:
    """First crank angle in [0, 360/order) at which `Re(c e^{i n theta})` is largest; None if it
    vanishes or is a mean.
    """
    if c == 0 or order == 0:
        return None
    angle = float(np.degrees(-np.angle(c)) % 360 / order)
    return clean(angle if angle < 360 / order else 0.0)


def _component(c: complex, order: float) -> dict[str, float | None]:
    """`amplitude cos(n theta - phase)`."""
    return {"amplitude": clean(abs(c)), "phase_deg": phase_deg(c) if c and order else None}


def phase_deg(c: complex) -> float:
    """Angle in (-180, 180] of the amplitude in `amplitude cos(n theta - angle)`."""
    angle = -float(np.degrees(np.angle(c)))
    return angle + 360 if angle <= -180 else angle + 0.0


def entries(spectra: Spectra, k: int) -> dict[str, dict[str, Any]]:
    """All kinds of the k-th order by their JSON keys."""
    return {kind.key: figures(kind, phasors, k) for kind, phasors in spectra.items()}


def order_entries(spectra: Spectra) -> list[dict[str, Any]]:
    """What JSON says order by order."""
    return [
        {"order": order_number(order), **entries(spectra, k)}
        for k, order in enumerate(spectra.orders)
    ]


def peaks(analysis: Result) -> dict[str, float | None]:
    """The largest force and moment over a revolution."""
    found: dict[str, float | None] = {}
    for kind, peak in analysis.peaks:
        found[kind.key] = clean(peak.value)
        found[f"{kind.name}_deg"] = clean(np.degrees(peak.theta)) if peak.value else None
    return found


# ------------------------------------------------------------------ as a list
def rows(analysis: Result, system: System) -> Iterator[Row]:
    """Every figure of an analysis, one a row; none of moments that are not known."""
    told = [kind.name for kind in KINDS.values() if analysis.moments_known or kind is not MOMENT]
    for cylinder, spectra in ((0, analysis.spectra), *analysis.cylinders):
        for k, order in enumerate(spectra.orders):
            for kind, phasors in spectra.items():
                if kind.name not in told:
                    continue
                entry = figures(kind, phasors, k)
                yield from order_rows(kind.name, order, entry, system.unit(kind), cylinder)
    for kind, peak in [each for each in analysis.peaks if each[0].name in told]:
        yield from peak_rows(kind.name, peak, system.unit(kind))


def peak_rows(quantity: str, peak: Peak, unit: Unit) -> Iterator[Row]:
    """The largest value over a revolution, and its crank angle."""
    yield Row(0, quantity, None, "peak", clean(unit.of(peak.value)), unit.name)
    yield Row(
        0, quantity, None, "peak_deg", clean(np.degrees(peak.theta)) if peak.value else None, "deg"
    )


def order_rows(
    quantity: str, order: float, entry: dict[str, Any], unit: Unit, cylinder: int = 0
) -> Iterator[Row]:
    """All figures of one order, as JSON has them."""
    return (Row(cylinder, quantity, order_number(order), *figure) for figure in _flat(entry, unit))


def _flat(
    entry: dict[str, Any], unit: Unit, prefix: str = ""
) -> Iterator[tuple[str, float | bool | None, str]]:
    for name, value in entry.items():
        if isinstance(value, dict):
            yield from _flat(value, unit, f"{prefix}{name}_")
        elif isinstance(value, list):
            for axis, part in zip("xy", value, strict=True):
                yield f"{prefix}{name}_{axis}", unit.of(part), unit.name
        elif name == "balanced":
            yield name, value, ""
        elif name.endswith("_deg"):
            yield f"{prefix}{name}", value, "deg"
        else:
            yield f"{prefix}{name}", None if value is None else unit.of(value), unit.name
