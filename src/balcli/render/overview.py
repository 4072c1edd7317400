"""An analysis in brief: the orders that matter, roll, peaks, and the devices in one line."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np

from ..enginefile.model import Counterweight, Shaft
from ..forces.kinds import ROLL, ROLL_TOTAL, Kind
from ..sizing.device_tables import DeviceTable, find_unbalance
from .engine_facts import tell_pivot
from .order_tables import fit_largest, peak_facts
from .sheet import (
    NEGLIGIBLE,
    NOTHING,
    UNKNOWN,
    Facts,
    Grid,
    Text,
    capitalized,
    number,
    order_name,
    size_text,
    small_text,
)

if TYPE_CHECKING:
    from ..core.phasors import Phasors
    from ..forces.spectrum import Spectra
    from ..results.analysis import Analysis, Sizing
    from .units import ShownUnit, System


def find_orders_that_matter(spectra: Spectra, single: dict[str, float]) -> list[float]:
    """Orders to 2, and those of which one force or moment is not small beside one cylinder's.

    Args:
        single: what one cylinder makes of each kind; of a kind that is not in it, none is small.
    """
    return [
        float(order)
        for k, order in enumerate(spectra.orders)
        if order in (0, 1, 2)
        or any(p.major[k] > NEGLIGIBLE * single.get(kind.name, 0.0) for kind, p in spectra.items())
    ]


def vectors_grid(spectra: Spectra, shown: list[float], system: System, *, hints: bool) -> Grid:
    """Return force and moment side by side, with the parts of each that turn with the crank and
    against it; the other orders in one line, with a hint how to see them.
    """
    chosen = spectra.select_orders(shown)
    heads = ["order"]
    columns: list[Sequence[str]] = [[order_name(order) for order in chosen.orders]]
    for kind, phasors in chosen.vectors():
        unit = fit_largest(system.unit(kind), phasors)
        heads += [f"{kind.name}, {unit.name}", "with crank", "against"]
        columns += zip(*(_vector_cells(phasors, k, unit) for k in range(len(shown))), strict=True)
    return Grid(
        "Largest by order, and its parts that turn with the crank and against it",
        tuple(heads),
        tuple(zip(*columns, strict=True)),
        tell_others([spectra], shown, system, hints=hints),
    )


def name_column(kind: Kind) -> str:
    """A kind at the head of a column, or in a sentence."""
    return "roll with gas" if kind is ROLL_TOTAL else kind.name


def tell_others(
    states: Sequence[Spectra], shown: list[float], system: System, *, hints: bool
) -> str:
    """One line on the orders that are not shown, or nothing.

    Args:
        states: of one engine, as of now or before and after, with the same orders.
    """
    others = [
        float(order)
        for k, order in enumerate(states[0].orders)
        if order not in shown and any(p.major[k] > 0 for one in states for _, p in one.items())
    ]
    if not others:
        return ""
    rest = [one.select_orders(others) for one in states]
    sizes = []
    for kind, _ in rest[0].items():
        largest = max(float(np.nan_to_num(one[kind.name].major).max()) for one in rest)
        if largest:  # nan, and so 0 here, where it is not known
            sizes.append(f"{name_column(kind)} {size_text(largest, system.unit(kind))}")
    names = ", ".join(map(order_name, others[:6]))
    more = ", …" if len(others) > 6 else ""
    plural = "s" * (len(others) > 1)
    told = f"Negligible: order{plural} {names}{more} (at most {', '.join(sizes)})."
    return f"{told} All: --all." if hints else told


def roll_and_peaks(result: Analysis, system: System, *, every_order: bool) -> Facts:
    """What acts about the crank's axis, and the largest values over a revolution, a line each.

    Args:
        every_order: whether orders were asked for, which need not be those that roll has.
    """
    peaks = peak_facts(result, system, "", result.of_one_cylinder).pairs
    roll = result.spectra.roll
    name = ROLL.label if result.engine.gas is None else f"{ROLL.label}, inertia alone"
    pairs = []
    if roll is not None:
        pairs = [(name, _tell_roll(result, roll, system, every_order=every_order))]
    title = "Largest over a revolution" if peaks else f"About {tell_pivot(result.engine)}"
    return Facts((*pairs, *peaks), title)


def sizing_in_brief(sizing: Sizing, system: System) -> Text:
    """Which devices leave nothing of orders 1 and 2, in one sentence."""
    known = sizing.after.moments_known
    if not sizing.remedy.devices:
        what = "Orders 1 and 2 need" if known else "The forces of orders 1 and 2 need"
        unknown = "" if known else "; moments are not known"
        return Text("Sizing", (f"{what} no counterweight and no shaft{unknown}.",))
    texts: dict[str, str] = {}
    for kind, group in groupby(sizing.remedy.devices, _tell_place):
        devices = list(group)
        planes = sorted({device.position for device in devices})
        at = ", ".join(number(system.length.of(z / 1e3)) for z in planes)
        sizes = tell_sizes(map(find_unbalance, devices), system.unbalance)
        texts[f"{kind} {sizes}"] = f"at z = {at} {system.length.name}"
    places = [*texts.values()]
    fitted = "; ".join(map(" ".join, texts.items()))
    if len(places) > 1 and len(set(places)) == 1:
        fitted = "; ".join((*texts, f"all {places[0]}"))
    left = "no free force or moment" if known else "no free force (moments are not known)"
    steady = " at steady speed" if sizing.after.engine.ripple else ""
    result = f"They leave {left} of orders 1 and 2{steady}. Details: balcli balance."
    return Text("Sizing", (f"{capitalized(fitted)}.", result))


def tell_sizes(unbalances: Iterable[float], unit: ShownUnit) -> str:
    """Return unbalances as `2 x 35057 g mm`, in the order in which they stand."""
    counted = Counter(size_text(unbalance, unit) for unbalance in unbalances)
    return " + ".join(f"{count} × {text}" for text, count in counted.items())


def _tell_place(device: DeviceTable) -> str:
    match device:
        case Counterweight():
            return "counterweights:"
        case Shaft():
            return f"shaft at {device.ratio:+d}:"
        case _:
            return "sliders:"


def _tell_roll(result: Analysis, roll: Phasors, system: System, *, every_order: bool) -> str:
    """Every order that matters: `order 2: 458, 4: 26.3 N m`; arguments as of `roll_and_peaks`."""
    least = NEGLIGIBLE * result.of_one_cylinder[ROLL.name]
    rows = [k for k, size in enumerate(roll.major) if size > least]
    largest = float(roll.major.max(initial=0))
    if not rows:
        nothing = small_text(largest, system.moment)
        return f"{nothing} in the orders shown" if every_order else nothing
    unit = system.moment.fit(largest)
    sizes = (
        f"{order_name(roll.orders[k])}: {number(unit.of(float(roll.major[k])), 4)}" for k in rows
    )
    return f"order {', '.join(sizes)} {unit.name}"


def _vector_cells(phasors: Phasors, k: int, unit: ShownUnit) -> tuple[str, str, str]:
    if phasors.balanced[k]:
        return NOTHING, "", ""
    if np.isnan(phasors.forward[k]):
        return UNKNOWN, UNKNOWN, UNKNOWN
    largest, ahead, against = (
        number(unit.of(float(v)), 4)
        for v in (phasors.major[k], abs(phasors.forward[k]), abs(phasors.backward[k]))
    )
    return (largest, ahead, against) if phasors.orders[k] else (largest, UNKNOWN, UNKNOWN)
