"""Forces and moments order by order, as tables; and their largest values over a revolution."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from ..forces.kinds import FORCE, GAS_KINDS, KINDS, MOMENT, ROLL, Kind
from .figures import peak_deg, phase_deg, size_or_mean
from .sheet import (
    NEGLIGIBLE,
    NOTHING,
    UNKNOWN,
    Facts,
    Grid,
    capitalized,
    degrees,
    number,
    order_name,
    order_number,
    size_cell,
    size_text,
    small_text,
)

if TYPE_CHECKING:
    from ..core.peaks import Peak
    from ..core.phasors import Array, Phasors
    from ..forces.spectrum import Spectra
    from ..forces.textbook import Textbook
    from .figures import OrdersAndPeaks
    from .units import ShownUnit, System

Cells = tuple[str, ...]
WHOLE_TURN = 360 - 1e-6  # deg
_UNKNOWN_SIZES: Mapping[str, float] = MappingProxyType({})
_AS_BUILT = (
    "Reciprocating masses in the planes of the throws; as built: with rotating masses and stagger, "
    "without devices, at steady speed."
)


def order_tables(
    spectra: Spectra,
    system: System,
    pivot: str,
    roll: str = "",
    *,
    with_gas: bool = False,
    every: bool = False,
) -> Iterator[Grid]:
    """A table of each vector, and one of what acts about z.

    Args:
        pivot: about what couple and roll are.
        roll: a sentence on what the roll is, if it is more than the couple C less the torque T.
        with_gas: whether the engine has gas, beside which that of inertia alone is told as such.
        every: also orders above 2 in which all is balanced.
    """
    for kind, phasors in spectra.vectors():
        yield _vector_table(kind, phasors, system.unit(kind), every)
    of_inertia, of_gas = spectra.only(KINDS), spectra.only(GAS_KINDS)
    if of_inertia.scalars():
        what = f"{pivot} of inertia alone" if with_gas else pivot
        yield _scalar_table(of_inertia, system.moment, roll, what, every)
    if of_gas.scalars():
        yield _scalar_table(of_gas, system.moment, "", f"{pivot} with gas", every)


def direction_tables(spectra: Spectra, system: System, *, every: bool = False) -> Iterator[Grid]:
    """Vectors along x and y, if there are any; `every` as of `order_tables`."""
    if spectra.vectors():
        yield _direction_table(spectra, system, every)


def textbook_tables(book: Textbook, system: System, *, every: bool = False) -> Iterator[Grid]:
    """Force and moment as multiples of the units of textbooks, where there are such units; `every`
    as of `order_tables`.
    """
    units = book.units
    if not units.force:
        return
    if book.built.force is not None:
        cylinder = "one cylinder" if units.equal else f"cylinder {units.cylinder}"
        note = (
            f"F1 = m r ω² = {size_text(units.force, system.force, 5)} "
            f"(reciprocating mass of {cylinder}), Fn = A_n F1 its n-th order. {_AS_BUILT}"
        )
        yield _textbook_table(FORCE, book, note, every)
    if book.built.moment is not None and not math.isnan(units.arm):
        arm = f"{number(system.length.of(units.arm), 4)} {system.length.name}"
        note = f"a = {arm}, the smallest distance of neighbouring throws."
        note = note if book.built.force else f"{note} {_AS_BUILT}"
        yield _textbook_table(MOMENT, book, note, every)


def cylinder_table(cylinder: int, share: Spectra, system: System) -> Grid:
    """The part of one cylinder, as lecturers have it: vectors as size and angle."""
    vectors = [(phasors, system.unit(kind)) for kind, phasors in share.vectors()]

    def cells(k: int) -> Iterator[str]:
        yield order_name(share.orders[k])
        for phasors, unit in vectors:
            yield _size_and_angle(phasors.forward[k], unit)
            yield _size_and_angle(phasors.backward[k], unit)

    heads = [
        f"{kind.name} {way}, {system.unit(kind).name}"
        for kind, _ in share.vectors()
        for way in ("with", "against")
    ]
    rows = tuple(tuple(cells(k)) for k in range(len(share.orders)))
    return Grid(f"Cylinder {cylinder} alone", ("order", *heads), rows)


def peak_facts(
    result: OrdersAndPeaks, system: System, title: str, single: Mapping[str, float] = _UNKNOWN_SIZES
) -> Facts:
    """The largest values over a revolution that were asked for.

    Args:
        single: what one cylinder makes of each kind, beside which a peak may be negligible.
    """
    pairs = []
    for kind, peak in result.peaks:
        known = kind is not MOMENT or result.moments_known
        least = NEGLIGIBLE * single.get(kind.name, 0.0)
        pairs.append((kind.name, _peak(peak, system.unit(kind), least) if known else UNKNOWN))
    return Facts(tuple(pairs), title)


def _shown_rows(
    orders: Array, phasors: list[Phasors], cells: Callable[[int], Cells], every: bool
) -> tuple[Cells, ...]:
    """Rows of orders up to 2, and of those in which one of these quantities is not balanced, or of
    every one.
    """
    return tuple(
        cells(k)
        for k, order in enumerate(orders)
        if every or order <= 2 or not all(p.balanced[k] for p in phasors)
    )


def _vector_table(kind: Kind, phasors: Phasors, unit: ShownUnit, every: bool) -> Grid:
    unit = fit_largest(unit, phasors)

    def cells(k: int) -> Cells:
        name = order_name(phasors.orders[k])
        if phasors.balanced[k]:
            return name, NOTHING, "", "", "", ""
        if np.isnan(phasors.forward[k]):
            return name, *[UNKNOWN] * 5
        values = (phasors.major, phasors.minor, abs(phasors.forward), abs(phasors.backward))
        largest, smallest, ahead, against = (number(unit.of(float(v[k]))) for v in values)
        if not phasors.orders[k]:  # a mean does not turn
            return name, largest, *[UNKNOWN] * 4
        return name, largest, smallest, degrees(float(phasors.axis_deg[k]), 180), ahead, against

    return Grid(
        f"{capitalized(kind.label)} by order, {unit.name}",
        ("order", "largest", "smallest", "axis, deg", "with crank", "against"),
        _shown_rows(phasors.orders, [phasors], cells, every),
    )


def _scalar_table(spectra: Spectra, unit: ShownUnit, roll: str, what: str, every: bool) -> Grid:
    scalars = spectra.scalars()
    unit = fit_largest(unit, *(phasors for _, phasors in scalars))

    def cells(k: int) -> Cells:
        pairs = (_amplitude(phasors.x[k], spectra.orders[k], unit) for _, phasors in scalars)
        return (order_name(spectra.orders[k]), *(cell for pair in pairs for cell in pair))

    labels = [ROLL.name if roll and kind == ROLL else kind.label for kind, _ in scalars]
    heads = [head for label in labels for head in (label, "peak, deg")]
    return Grid(
        f"About {what}, {unit.name}",
        ("order", *heads),
        _shown_rows(spectra.orders, [phasors for _, phasors in scalars], cells, every),
        note=roll,
    )


def _amplitude(c: complex, order: float, unit: ShownUnit) -> tuple[str, str]:
    """Amplitude, and where it is reached first; or a mean."""
    if c == 0:
        return NOTHING, ""
    return number(unit.of(size_or_mean(c, order))), show_peak_deg(c, order)


def show_peak_deg(c: complex, order: float) -> str:
    """Where an amplitude is reached first, or a dash of a mean."""
    at = peak_deg(c, order)
    return UNKNOWN if at is None else degrees(at)


def fit_largest(unit: ShownUnit, *columns: Phasors) -> ShownUnit:
    """The unit for the largest of all that is known."""
    return unit.fit(max(float(np.nan_to_num(p.major).max(initial=0)) for p in columns))


def _direction_table(spectra: Spectra, system: System, every: bool) -> Grid:
    """Vertical and horizontal, as builders state them."""
    vectors = [
        (phasors, fit_largest(system.unit(kind), phasors)) for kind, phasors in spectra.vectors()
    ]

    def cells(k: int) -> Iterator[str]:
        yield order_name(spectra.orders[k])
        for phasors, unit in vectors:
            for c in (phasors.x[k], phasors.y[k]):
                yield size_cell(abs(c), unit)
                yield degrees(phase_deg(complex(c))) if c else ""

    phasors = [phasors for phasors, _ in vectors]
    axes = [kind.symbol + axis for kind, _ in spectra.vectors() for axis in "xy"]
    return Grid(
        f"Along x (vertical) and y (horizontal), {', '.join(unit.name for _, unit in vectors)}",
        ("order", *(head for axis in axes for head in (axis, "deg"))),
        _shown_rows(spectra.orders, phasors, lambda k: (*cells(k),), every),
        note="Value = amplitude · cos(order · θ − angle). My is the moment of the "
        "forces along x (marine: M1V, M2V), Mx of those along y (M1H).",
    )


def _textbook_table(kind: Kind, book: Textbook, note: str, every: bool) -> Grid:
    """Multiples of each order's own unit."""
    alone, built = book.reciprocating[kind.name], book.built[kind.name]

    def cells(k: int) -> Cells:
        order = order_number(built.orders[k])
        size = book.units.size(kind, order)
        values = (alone.major[k], abs(alone.forward[k]), abs(alone.backward[k]), built.major[k])
        return order_name(order), *(_ratio(float(value), size) for value in values)

    unit = book.units.name(kind)
    heads = ("order", f"largest, {unit}", "with crank", "against", "as built")
    rows = _shown_rows(built.orders, [alone, built], cells, every)
    return Grid(f"{capitalized(kind.label)} in textbook units", heads, rows, note)


def _ratio(value: float, size: float) -> str:
    """A multiple; a dash where the order is no multiple of anything."""
    if not value:
        return NOTHING
    return "–" if math.isnan(size) else number(value / size, 4)


def _size_and_angle(v: complex, unit: ShownUnit) -> str:
    if v == 0:
        return NOTHING
    return f"{number(unit.of(abs(v)), 4)} ∠ {degrees(float(np.degrees(np.angle(v))))}"


def _peak(peak: Peak, unit: ShownUnit, least: float) -> str:
    if not peak.value or peak.value < least:
        return small_text(peak.value, unit)
    size = size_text(peak.value, unit, 5)
    if not peak.every:
        return f"{size} at every crank angle"
    at, every = degrees(float(np.degrees(peak.theta))), float(np.degrees(peak.every))
    again = f" and every {every:.6g} deg" if every < WHOLE_TURN else ""
    return f"{size} at crank angle {at} deg{again}"
