"""The figures of a result by name, as JSON nests them and CSV lists them."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np

from ..core.peaks import Peak
from ..core.phasors import Phasors
from ..engine.engine import Engine, SilentCylinders
from ..forces.kinds import EVERY_KIND, MOMENT, Kind
from ..forces.spectrum import Spectra
from .sheet import order_number
from .units import ShownUnit, System


class Located(Protocol):
    """A result of an engine whose file may say where its throws stand."""

    @property
    def moments_known(self) -> bool: ...


class OrdersAndPeaks(Located, Protocol):
    """A result with orders and peaks: an analysis, or the sum of two engines."""

    @property
    def spectra(self) -> Spectra: ...

    @property
    def peaks(self) -> list[tuple[Kind, Peak]]: ...

    @property
    def cylinders(self) -> tuple[tuple[int, Spectra], ...]: ...


class FigureRow(NamedTuple):
    """One figure of a result; `cylinder` 0 is the engine, order None the whole curve."""

    cylinder: int
    quantity: str
    order: float | None
    figure: str
    value: float | bool | str | None
    unit: str


def describe_engine(engine: Engine) -> dict[str, Any]:
    """Return the entry `engine` of JSON."""
    return {
        "name": engine.name,
        "cylinders": engine.cylinders.count,
        "displacement_m3": clean(engine.displacement_m3),
    }


def describe_state(engine: Engine) -> dict[str, Any]:
    """Return the entries of JSON on its speed, cylinders without gas, and point of reference."""
    return {
        "speed_rpm": clean(engine.speed_rpm),
        **silent_entries(engine.silent),
        "reference_mm": [clean(v * 1e3) for v in engine.reference_m],
    }


def assumptions(result: Located, inferred: Sequence[str] = ()) -> dict[str, list[str]]:
    """Return the entry `assumed` of JSON: what is taken because the engine file leaves it out."""
    listed = [*inferred, *([] if result.moments_known else ["crank.spacing = 0"])]
    return {"assumed": listed} if listed else {}


def silent_entries(silent: SilentCylinders) -> dict[str, list[int]]:
    """Numbers of the cylinders without gas, and of those that compress and burn nothing."""
    each = {"no_gas_in": silent.without_gas, "no_burning_in": silent.without_burning}
    return {key: list(numbers) for key, numbers in each.items() if numbers}


def clean(value: Any) -> float | None:
    """A plain float; None for nan, and no negative zero."""
    number = float(value)
    return None if math.isnan(number) else number + 0.0


def clean_each(values: Iterable[Any]) -> list[float | None]:
    """Plain floats; None for nan, and no negative zero."""
    return [clean(value) for value in values]


Entry = dict[str, Any]  # the figures of one order of one kind, as JSON nests them


def kind_entries(kind: Kind, phasors: Phasors) -> list[Entry]:
    """All figures of a kind, SI and degrees, an entry an order."""
    return vector_entries(phasors) if kind.vector else scalar_entries(phasors)


def vector_entries(phasors: Phasors) -> list[Entry]:
    """Return forces or moments as JSON has them, an entry an order."""
    columns = (phasors.forward, phasors.backward, phasors.x, phasors.y, phasors.major)
    others = (phasors.minor, phasors.axis_deg, phasors.orders, phasors.balanced)
    rows = zip(*(column.tolist() for column in (*columns, *others)), strict=True)
    return [
        {
            "forward": [clean(forward.real), clean(forward.imag)],
            "backward": [clean(backward.real), clean(backward.imag)],
            "major": clean(major),
            "minor": clean(minor),
            "axis_deg": clean(axis_deg),
            "x": _component_entry(x, order),
            "y": _component_entry(y, order),
            "balanced": balanced,
        }
        for forward, backward, x, y, major, minor, axis_deg, order, balanced in rows
    ]


def scalar_entries(phasors: Phasors) -> list[Entry]:
    """Couples, torques or rolls as JSON has them, an entry an order."""
    columns = phasors.x, phasors.orders, phasors.balanced
    rows = zip(*(column.tolist() for column in columns), strict=True)
    return [scalar_entry(c, order, balanced) for c, order, balanced in rows]


def scalar_entry(c: complex, order: float, balanced: bool) -> Entry:
    """One order of a torque and its like as JSON has it, of value `Re(c e^{i n theta})`."""
    return {
        "cos": clean(c.real),
        "sin": clean(-c.imag),
        "amplitude": clean(abs(c)),
        "peak_deg": peak_deg(c, order),
        "balanced": balanced,
    }


def size_or_mean(c: complex, order: float) -> float:
    """Amplitude of `Re(c e^{i n theta})`; of order 0 the mean, with its sign."""
    return abs(c) if order else c.real


def peak_deg(c: complex, order: float) -> float | None:
    """First crank angle in [0, 360/order) at which `Re(c e^{i n theta})` is largest; None if it
    vanishes or is a mean.
    """
    if c == 0 or order == 0:
        return None
    angle = float(np.degrees(-np.angle(c)) % 360 / order)
    return clean(angle if angle < 360 / order else 0.0)


def _component_entry(c: complex, order: float) -> dict[str, float | None]:
    """Return `amplitude cos(n theta - phase)`."""
    return {"amplitude": clean(abs(c)), "phase_deg": phase_deg(c) if c and order else None}


def phase_deg(c: complex) -> float:
    """Return the angle in (-180, 180] of `amplitude cos(n theta - angle)`."""
    angle = 0.0 - math.degrees(cmath.phase(c))
    return angle + 360 if angle <= -180 else angle


def order_entries(spectra: Spectra) -> list[Entry]:
    """What JSON says order by order: all kinds by their keys."""
    columns = [(kind.key, kind_entries(kind, phasors)) for kind, phasors in spectra.items()]
    return [
        {"order": order_number(order)} | {key: entries[k] for key, entries in columns}
        for k, order in enumerate(spectra.orders)
    ]


def peak_entries(result: OrdersAndPeaks) -> dict[str, float | None]:
    """What JSON says of the largest values over a revolution."""
    found: dict[str, float | None] = {}
    for kind, peak in result.peaks:
        found[kind.key] = clean(peak.value)
        found[f"{kind.name}_deg"] = peak_angle_deg(peak)
    return found


def peak_angle_deg(peak: Peak) -> float | None:
    """The crank angle of the largest value, None where that is 0."""
    return clean(np.degrees(peak.theta)) if peak.value else None


# ------------------------------------------------------------------ as a list
def figure_rows(result: OrdersAndPeaks, system: System) -> Iterator[FigureRow]:
    """Every figure of the orders and the peaks, one a row; none of moments that are not known."""
    told = [kind for kind in EVERY_KIND.values() if result.moments_known or kind is not MOMENT]
    for cylinder, spectra in ((0, result.spectra), *result.cylinders):
        columns = [(kind, kind_entries(kind, p)) for kind, p in spectra.items() if kind in told]
        for k, order in enumerate(spectra.orders):
            for kind, entries in columns:
                unit = system.unit(kind)
                yield from order_rows(kind.name, order, entries[k], unit, cylinder)
    for kind, peak in result.peaks:
        if kind in told:
            yield from peak_rows(kind.name, peak, system.unit(kind))


def peak_rows(quantity: str, peak: Peak, unit: ShownUnit) -> Iterator[FigureRow]:
    """The largest value over a revolution, and its crank angle."""
    yield FigureRow(0, quantity, None, "peak", clean(unit.of(peak.value)), unit.name)
    yield FigureRow(0, quantity, None, "peak_deg", peak_angle_deg(peak), "deg")


def order_rows(
    quantity: str, order: float, entry: Entry, unit: ShownUnit, cylinder: int = 0
) -> Iterator[FigureRow]:
    """All figures of one order; the entry is SI as in JSON, the rows are in the unit."""
    for figure in _flattened(entry, unit):
        yield FigureRow(cylinder, quantity, order_number(order), *figure)


def _flattened(
    entry: Entry, unit: ShownUnit, prefix: str = ""
) -> Iterator[tuple[str, float | bool | None, str]]:
    """Name, value and unit of every figure of an entry: `x_amplitude` from `x` and `amplitude`."""
    for name, value in entry.items():
        if isinstance(value, dict):
            yield from _flattened(value, unit, f"{prefix}{name}_")
        elif isinstance(value, list):
            for axis, part in zip("xy", value, strict=True):
                yield f"{prefix}{name}_{axis}", unit.of(part), unit.name
        elif name == "balanced":
            yield name, value, ""
        elif name.endswith("_deg"):
            yield f"{prefix}{name}", value, "deg"
        else:
            yield f"{prefix}{name}", None if value is None else unit.of(value), unit.name
