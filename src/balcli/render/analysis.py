"""The analysis of one engine for people; for programs it is in `analysis_data`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from ..engine.positions import MOMENTS_UNKNOWN
from ..forces.spectrum import Spectra
from ..results.analysis import Analysis, Sizing
from . import crankshaft, guide_moments, strokes, symmetry
from .devices import device_grid
from .engine_facts import engine_facts
from .order_tables import cylinder_table, order_tables, peak_facts, textbook_tables
from .sheet import NAMELESS, Facts, Grid, Sheet, Text, capitalized
from .terminal_plot import sketches
from .units import System
from .verdict import verdict


def sheet(result: Analysis, system: System, *, pictures: bool = False) -> Sheet:
    """What the engine is, what it does order by order, peaks, verdict, sizing; with `pictures` also
    such as are made of characters.
    """
    parts: list[Grid | Facts | Text] = list(_order_parts(result, system))
    if result.travel is not None:
        parts += strokes.sheet_parts(result.travel, result.engine.numbers, system)
    if result.inner is not None:
        parts += crankshaft.sheet_parts(result.inner, system)
    if result.guide is not None:
        parts += guide_moments.sheet_parts(result.guide, system)
    if found := _judge(result, system):
        parts.append(Text("Verdict", found))
    if result.why is not None:
        parts += symmetry.sheet_parts(result.why)
    if result.sizing is not None:
        parts += _sizing_parts(result.sizing, system)
    if pictures:
        parts += sketches(replace(result, spectra=_known_spectra(result)), system)
    return Sheet(result.engine.name or NAMELESS, tuple(parts))


def _known_spectra(result: Analysis) -> Spectra:
    """Without the moment where it is not known."""
    return result.spectra if result.moments_known else replace(result.spectra, moment=None)


def _order_parts(result: Analysis, system: System) -> Iterator[Grid | Facts | Text]:
    """What the engine is and what it does order by order; moments that are not known are dashes."""
    known = result.moments_known
    spectra = result.spectra if known else result.spectra.without_moment()
    yield engine_facts(result.engine, system, higher=result.has_higher_orders)
    yield from order_tables(spectra, system)
    if spectra.vectors():
        yield from textbook_tables(result.textbook, system)
    if result.peaks:
        yield peak_facts(result, system, "Largest over a revolution, all orders")
    for n, share in result.cylinders:
        yield cylinder_table(n, share if known else share.without_moment(), system)


def _judge(result: Analysis, system: System) -> tuple[str, ...]:
    """The verdict; of forces alone where moments are not known, which it then says."""
    spectra = result.spectra
    if result.moments_known:
        return verdict(spectra, system, result.of_one_cylinder)
    forces = verdict(replace(spectra, moment=None), system, result.of_one_cylinder)
    return (*forces, capitalized(f"{MOMENTS_UNKNOWN}.")) if spectra.vectors() else ()


def _sizing_parts(sizing: Sizing, system: System) -> Iterator[Grid | Text | Facts]:
    remedy, after = sizing.remedy, sizing.after
    if not (remedy.counterweights or remedy.shafts or remedy.sliders):
        needs = "no counterweight and no shaft"
        yield Text(
            "Sizing",
            (
                f"Orders 1 and 2 need {needs}."
                if after.moments_known
                else f"The forces of orders 1 and 2 need {needs}; moments are not known.",
            ),
        )
        return
    yield Text(
        "Sizing: what leaves no free force or moment of orders 1 and 2"
        if after.moments_known
        else "Sizing: what leaves no free force of orders 1 and 2 (moments are not known)",
        tuple(dict.fromkeys(remedy.reasons)),
    )
    yield device_grid(remedy, system)
    yield peak_facts(after, system, "Largest with these devices")
