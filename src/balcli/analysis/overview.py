"""Lay out an analysis in brief: a table of the orders that matter, and one line each on roll and
peaks.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ..core.peaks import find_peak
from ..core.phasors import Phasors
from ..forces.kinds import ROLL, ROLL_TOTAL, Kind
from ..forces.spectrum import Spectra
from ..show.engine_facts import tell_pivot
from ..show.sheet import (
    NEGLIGIBLE,
    Column,
    Facts,
    Grid,
    degrees,
    number,
    order_name,
    size_text,
    small_text,
)
from ..show.units import System
from .order_tables import fit_largest, peak_facts, shade_sizes, write_vector

if TYPE_CHECKING:
    from .answer import Analysis


def find_orders_that_matter(spectra: Spectra, single: dict[str, float]) -> list[float]:
    """Return the orders up to 2, and those with a force or moment that is not negligible compared
    with one cylinder.

    Args:
        spectra: Spectra to show.
        single: Size of each kind for one cylinder; a kind that is missing is never negligible.
    """
    matters = np.isin(spectra.orders, (0, 1, 2))
    for kind, phasors in spectra.items():
        matters |= phasors.major > NEGLIGIBLE * single.get(kind.name, 0.0)
    return [float(order) for order in spectra.orders[matters]]


def vectors_grid(
    spectra: Spectra,
    shown: list[float],
    system: System,
    *,
    hints: bool,
    least: Mapping[str, float],
) -> Grid:
    """Return a table of force and moment side by side, each with its vectors that turn with and
    against the crank. A line on the other orders follows.

    Args:
        spectra: Spectra to show.
        shown: Orders that have rows.
        system: System of units.
        hints: Whether to name the option that shows more.
        least: Size from which a force or moment is not small, SI, by the name of its kind.
    """
    chosen = spectra.select_orders(shown)
    columns = [Column("order", list(map(order_name, chosen.orders)), words=True)]
    for kind, phasors in chosen.vectors():
        unit = fit_largest(system.unit(kind), phasors)
        rows = [write_vector(phasors, k, unit, 4) for k in range(len(shown))]
        sizes = [row.largest for row in rows]
        shades = shade_sizes(phasors, least.get(kind.name))
        columns.append(Column(f"{kind.name}, {unit.name}", sizes, shades=shades))
        columns.append(Column("with crank", [row.ahead for row in rows]))
        columns.append(Column("against", [row.against for row in rows]))
    title = "Largest by order, and its parts that turn with the crank and against it"
    return Grid(title, columns, tell_others(spectra, shown, system, hints=hints))


def name_column(kind: Kind) -> str:
    """Return the name of a kind for headings of columns and for sentences."""
    return "roll with gas" if kind is ROLL_TOTAL else kind.name


def tell_others(spectra: Spectra, shown: list[float], system: System, *, hints: bool) -> str:
    """Return a line on the orders that are not shown; empty if there are none.

    Args:
        spectra: All orders that were computed.
        shown: Orders that are shown.
        system: System of units.
        hints: Whether to name the option that shows more.
    """
    present = np.zeros(spectra.orders.shape, bool)
    for _, phasors in spectra.items():
        present |= phasors.major > 0
    others = [float(order) for order in spectra.orders[present] if order not in shown]
    if not others:
        return ""
    sizes = []
    for kind, phasors in spectra.select_orders(others).items():
        if largest := float(np.nan_to_num(phasors.major).max()):  # not known (nan): counts as 0
            sizes.append(f"{name_column(kind)} {size_text(largest, system.unit(kind))}")
    names = ", ".join(map(order_name, others[:6]))
    if len(others) > 6:
        names += ", …"
    noun = "orders" if len(others) > 1 else "order"
    text = f"Negligible: {noun} {names} (at most {', '.join(sizes)})."
    return f"{text} --all shows them." if hints else text


def roll_and_peaks(result: Analysis, system: System, *, every_order: bool) -> Facts:
    """Return lines on the roll by order and on the largest values over a revolution.

    Args:
        result: Analysis to show.
        system: System of units.
        every_order: Whether the caller chose the orders.
    """
    peaks = peak_facts(result, system, "", result.of_one_cylinder).pairs
    roll = result.spectra.roll
    name = ROLL.label if result.engine.gas is None else f"{ROLL.label}, inertia alone"
    title = "Largest over a revolution" if peaks else f"About {tell_pivot(result.engine)}"
    if roll is None:
        return Facts(peaks, title)
    sizes = _tell_roll(result, roll, system, every_order=every_order)
    return Facts(((name, sizes), *peaks), title)


def _tell_roll(result: Analysis, roll: Phasors, system: System, *, every_order: bool) -> str:
    """Return the largest roll over a revolution and that of every order that matters: `470.1 N m at
    crank angle 43.5 deg; order 2: 458, 4: 26.3 N m`; arguments as for `roll_and_peaks`.
    """
    least = NEGLIGIBLE * result.of_one_cylinder[ROLL.name]
    largest = float(roll.major.max(initial=0))
    unit = system.moment.fit(largest)
    sizes = []
    for order, size in zip(roll.orders, roll.major, strict=True):
        if size > least:
            sizes.append(f"{order_name(order)}: {number(unit.of(float(size)))}")
    if sizes:
        whole = roll if result.whole_roll is None else result.whole_roll
        peak = find_peak(whole)
        at = degrees(float(np.degrees(peak.theta)))
        return (
            f"{size_text(peak.value, system.moment, 5)} at crank angle {at} deg; "
            f"order {', '.join(sizes)} {unit.name}"
        )
    nothing = small_text(largest, system.moment)
    return f"{nothing} in the orders shown" if every_order else nothing
