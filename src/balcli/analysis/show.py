"""Show the analysis of one engine: the printed sheet, CSV, and columns of a DataFrame."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import TypeAlias

import numpy as np

from ..core.phasors import Array
from ..engine.engine import CylinderNumber
from ..errors import MOMENTS_UNKNOWN
from ..file.fields import join_words
from ..forces.kinds import COUPLE, EVERY_KIND, FREE, GAS, GAS_KINDS, KINDS, MOMENT, TORQUE
from ..forces.spectrum import Spectra
from ..forces.symmetry import find_textbook
from ..show.engine_facts import engine_facts, speed_facts, tell_pivot
from ..show.figures import FigureRow, figure_rows, record_rows
from ..show.formats import Columns, Renderer, Rows
from ..show.sheet import (
    NAMELESS,
    WITHOUT_HINTS,
    Facts,
    Grid,
    Sheet,
    Text,
    View,
    assumed_facts,
    sentence,
)
from ..show.units import System
from . import sections
from .answer import EXTRAS, Analysis, Sizing
from .couple import select_couple
from .devices_show import device_grid, device_rows, number_devices
from .ladder_show import ladder_grid, list_ladder
from .order_tables import (
    cylinder_tables,
    direction_tables,
    gas_grid,
    order_tables,
    peak_facts,
    textbook_tables,
)
from .other_speeds import lay_out_other_speeds, list_other_rows
from .overview import (
    find_orders_that_matter,
    roll_and_peaks,
    tell_others,
    vectors_grid,
)
from .parts import lay_out_parts, list_part_rows
from .textbook_show import one_cylinder_grids
from .verdict_words import VerdictWords

_UNCOUNTED = (
    "Couple and torque include only pistons, rods and throw masses; give [crank] inertia and "
    "[flywheel] to include all turning parts."
)
Part: TypeAlias = Grid | Facts | Text
STEADY = ("journals", "masses", "parts", "pru")  # parts that are computed at the mean speed
TEXTS = frozenset({"verdict", "sizing", "ladder", "textbook"})  # parts shown without the speed
TABLES = TEXTS - {"verdict"} | {"xy", "peak", *EXTRAS}  # parts that are shown without a verdict


def sheet(result: Analysis, system: System, view: View | None = None) -> Sheet:
    """Return the sheet of an analysis: engine, verdict, forces order by order, peaks and devices.

    Args:
        result: Analysis to show.
        system: System of units.
        view: Tables and orders to show; default, for the library: those that the analysis was
            asked for, without names of options.
    """
    if view is None:
        view = _choose_view(result)
    return Sheet(result.engine.name or NAMELESS, tuple(_parts(result, system, view)))


def _choose_view(result: Analysis) -> View:
    """Return the view in brief, or, if some kinds were not asked for, that of the other kinds."""
    computed = frozenset(result.spectra.kinds)
    if computed.issuperset(KINDS):
        return WITHOUT_HINTS
    return View(parts=computed, hints=False)


def _parts(result: Analysis, system: System, view: View) -> Iterator[Part]:
    heads_with_facts = not view.parts or view.whole
    if heads_with_facts:
        yield engine_facts(result.engine, system, whole=view.whole)
    else:
        if view.parts - TEXTS:
            yield speed_facts(result.engine, steady=view.parts <= {*STEADY})
        yield from assumed_facts(result.assumed)
    if not view.parts <= TABLES or not view.parts:
        yield from lay_out_verdict(result, system)
    if view.parts or view.whole:
        yield from _chosen_order_parts(result, system, view)
    else:
        yield from _order_parts_in_brief(result, system, view)
    yield from tell_uncounted(result)
    about_crank = view.whole or bool(view.parts)
    for title, share in _list_shares(result).items():
        spectra = share.with_moment_if(result.moments_known)
        yield from cylinder_tables(f"{title} alone", spectra, system, about_crank=about_crank)
    yield from _further_parts(result, system)
    is_listed = not view.parts or view.whole or "parts" in view.parts
    if result.other_speeds is not None and is_listed:
        yield lay_out_other_speeds(result.other_speeds, system)
    if hasattr(result, "ladder"):
        yield ladder_grid(result.ladder, result.engine, system, tell_skirt=heads_with_facts)
    if hasattr(result, "sizing"):
        yield from _sizing_parts(result.sizing, system)


def _crank_drive_parts(result: Analysis, system: System) -> Iterator[Part]:
    from . import crank_drive  # loads the curves of the gas

    if hasattr(result, "journals"):
        yield from crank_drive.lay_out_journals(result.journals, result.engine, system)
    if hasattr(result, "masses"):
        yield crank_drive.lay_out_masses(result.masses, system)
    if hasattr(result, "power_related_unbalance"):
        yield crank_drive.lay_out_related(result.power_related_unbalance, system)


def _further_parts(result: Analysis, system: System) -> Iterator[Part]:
    """Yield the parts that only some engines have, or that are computed only on request."""
    if hasattr(result, "inner"):
        yield from sections.sheet_parts(result.inner, system)
    if hasattr(result, "guide"):
        yield sections.lay_out_guide(result.guide, system)
    if any(hasattr(result, name) for name in ("journals", "masses", "power_related_unbalance")):
        yield from _crank_drive_parts(result, system)
    if hasattr(result, "parts"):
        yield from lay_out_parts(result.parts, system)
    if hasattr(result, "why"):
        yield sections.lay_out_symmetry(result.why)
    if hasattr(result, "stars"):
        yield sections.lay_out_stars(result.stars, system)


def _chosen_order_parts(result: Analysis, system: System, view: View) -> Iterator[Part]:
    """Yield all tables, or those that `--only` names; by default with the orders that matter."""
    spectra = result.spectra.with_moment_if(result.moments_known)
    every = view.every_order
    of_one = set() if result.engine.placed else {"textbook"}
    parts = view.parts or {*EVERY_KIND, "xy", *of_one}
    others = ""
    if not (view.whole or every):
        shown = find_orders_that_matter(spectra, result.of_one_cylinder)
        others = tell_others(spectra, shown, system, hints=view.hints)
        spectra = spectra.select_orders(shown)
    tables: list[Grid] = []
    named = spectra.only({*parts, *(GAS_KINDS if GAS.name in parts else ())})
    if parts.intersection(EVERY_KIND):
        pivot = tell_pivot(result.engine)
        with_gas = result.engine.gas is not None
        tables += order_tables(named, system, pivot, with_gas=with_gas, every=every)
    if "xy" in parts:
        tables += direction_tables(spectra, system, every=every)
    if "textbook" in parts and spectra.vectors():
        known = [k.name for k, _ in spectra.vectors() if k is not MOMENT or result.moments_known]
        book = find_textbook(result.engine, spectra.orders, known)
        tables += one_cylinder_grids(book.units, system)
        tables += textbook_tables(book, system, every=every)
    yield from tables
    if tables and others:
        yield Text("", (others,))
    if result.peaks:
        yield peak_facts(result, system, "Largest over a revolution, all orders")


def _order_parts_in_brief(result: Analysis, system: System, view: View) -> Iterator[Part]:
    """Yield a table of force and moment, and lines on roll and peaks."""
    yield from lay_out_orders(result, system, view)
    yield from lay_out_couple(result, system)
    facts = roll_and_peaks(result, system, every_order=view.every_order)
    if facts.pairs:
        yield facts
    yield from gas_grid(result.spectra, system, tell_pivot(result.engine), view)


def lay_out_orders(result: Analysis, system: System, view: View) -> Iterator[Grid]:
    """Yield the table of force and moment by order, if one of them was computed."""
    spectra = result.spectra.with_moment_if(result.moments_known)
    vectors = spectra.only([kind.name for kind in FREE])
    shown = list(map(float, vectors.orders))
    if not view.every_order:
        shown = find_orders_that_matter(vectors, result.of_one_cylinder)
    if vectors.vectors():
        of_one = result.of_one_cylinder
        least = {kind.name: result.small * of_one[kind.name] for kind in FREE}
        yield vectors_grid(vectors, shown, system, hints=view.hints, least=least)


def lay_out_couple(result: Analysis, system: System) -> Iterator[Grid]:
    """Yield the table of the transverse couple by order, if it is not negligible."""
    couple = select_couple(result.spectra.couple, result.scales)
    if couple is not None:
        alone = Spectra(couple.orders, kinds={COUPLE.name: couple})
        yield from order_tables(alone, system, tell_pivot(result.engine))


def tell_uncounted(result: Analysis) -> Iterator[Text]:
    """Yield a note if the speed is uneven and the file gives no inertia that resists it."""
    engine = result.engine
    shown = result.spectra.only((COUPLE.name, TORQUE.name)).scalars()
    if engine.ripple and shown and engine.find_constant_inertia() is None:
        yield Text("Note", (_UNCOUNTED,))


def lay_out_verdict(result: Analysis, system: System) -> Iterator[Text]:
    """Yield the verdict. If moments are not known, it covers only forces and states this."""
    if not hasattr(result, "verdict"):
        return
    words = VerdictWords(result.spectra, result.scales, system, result.engine)
    sentences = words.write(result.verdict)
    if not result.moments_known:
        sentences = (*sentences, sentence(MOMENTS_UNKNOWN))
    if sentences:  # order 0 needs no verdict
        yield Text("Verdict", sentences)


def _sizing_parts(sizing: Sizing, system: System) -> Iterator[Part]:
    remedy = sizing.remedy
    after = sizing.after
    if not remedy.devices:
        yield Text("Sizing", ("No counterweight and no shaft is worth fitting.",))
        return
    steady = ", at steady speed" if after.engine.ripple else ""
    steps = join_words(remedy.steps or ())
    yield Text(f"Sizing: {steps}{steady}", tuple(dict.fromkeys(remedy.reasons)))
    yield device_grid(remedy, system)
    yield peak_facts(after, system, "Largest with these devices")


def columns(result: Analysis) -> Columns:
    """Return columns of sizes and directions of each kind, with a row for each order. Names are
    those of the quantities of `sweep`, without the order.
    """
    spectra = result.spectra.with_moment_if(result.moments_known)
    values: dict[str, Array] = {"order": result.orders}
    units: dict[str, str] = {}
    for kind, phasors in spectra.items():
        parts = {"amplitude": phasors.major, "cos": phasors.x.real, "sin": -phasors.x.imag}
        if kind.vector:
            parts = {
                "major": phasors.major,
                "minor": np.abs(phasors.minor),
                "axis": phasors.axis_deg,
                "forward": np.abs(phasors.forward),
                "backward": np.abs(phasors.backward),
            }
        for part, figures in parts.items():
            values[f"{kind.name}.{part}"] = figures + 0.0
            units[f"{kind.name}.{part}"] = "deg" if part == "axis" else kind.si_unit
    return Columns(values, units)


def rows(
    result: Analysis, system: System, *, named: Collection[str] = ("sizing", "ladder")
) -> Rows:
    """Return the rows of CSV, one for each figure; cylinder 0 is the whole engine, an empty order
    means the sum of all orders.

    Args:
        result: Analysis to show.
        system: System of units.
        named: Which of "sizing" and "ladder" to include; figures of the ladder are in SI units.
    """
    header = ("cylinder", "quantity", "order", "figure", "value", "unit")
    return Rows(header, _all_rows(result, system, named))


def _list_shares(result: Analysis) -> dict[str, Spectra]:
    """Return the spectra of single cylinders or banks that were asked for, by their titles."""
    shares = {}
    if hasattr(result, "cylinders"):
        for cylinder in result.cylinders:
            shares[f"Cylinder {cylinder.cylinder}"] = cylinder.spectra
    if hasattr(result, "banks"):
        for bank in result.banks:
            numbers = ", ".join(map(str, bank.cylinders))
            shares[f"Bank at {bank.axis_deg:g} deg (cylinders {numbers})"] = bank.spectra
    return shares


def _all_rows(result: Analysis, system: System, named: Collection[str]) -> Iterator[FigureRow]:
    shares: dict[CylinderNumber, Spectra] = {}
    if hasattr(result, "cylinders"):
        shares = {share.cylinder: share.spectra for share in result.cylinders}
    elif hasattr(result, "banks"):
        shares = {f"bank {share.axis_deg:g}": share.spectra for share in result.banks}
    yield from figure_rows(result, system, shares)
    if "ladder" in named and hasattr(result, "ladder"):
        for step, name, value, unit in list_ladder(result.ladder):
            yield FigureRow(0, step, None, name, value, unit)
    if "sizing" in named and hasattr(result, "sizing"):
        for part, device in number_devices(result.sizing.remedy.devices):
            for figure, value, unit in device_rows(device, system):
                yield FigureRow(0, part, None, figure, value, unit)
    yield from _further_rows(result, system)


def _further_rows(result: Analysis, system: System) -> Iterator[FigureRow]:
    if result.travel is not None:
        yield from sections.list_strokes(result.travel, system)
    if hasattr(result, "inner"):
        yield from sections.rows(result.inner, system)
    if hasattr(result, "guide"):
        yield from sections.list_guide(result.guide, system)
    yield from _record_rows(result)
    if hasattr(result, "parts"):
        yield from list_part_rows(result.parts)
    if result.other_speeds is not None:
        yield from list_other_rows(result.other_speeds)
    if hasattr(result, "why"):
        yield from sections.list_symmetry(result.why)


def _record_rows(result: Analysis) -> Iterator[FigureRow]:
    """Yield the rows of results that are lists of records: one row for each attribute."""
    if hasattr(result, "journals"):
        for journal in result.journals:
            yield from record_rows(0, journal.place, None, journal, "place")
    if hasattr(result, "masses"):
        for one in result.masses:
            yield from record_rows(one.cylinders[0], "masses", None, one, "cylinders")
    if hasattr(result, "power_related_unbalance"):
        for moment in result.power_related_unbalance.orders:
            yield from record_rows(0, "pru", moment.order, moment, "order")


RENDERER = Renderer(sheet=sheet, rows=rows, columns=columns)
