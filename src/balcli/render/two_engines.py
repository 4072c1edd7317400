"""Two engines on one frame."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from .csv import Rows
from .engine_facts import tell_pivot, tell_speed
from .figures import (
    assumptions,
    clean,
    describe_engine,
    describe_state,
    figure_rows,
    order_entries,
    peak_entries,
)
from .formats import Renderer
from .order_tables import order_tables, peak_facts
from .sheet import Facts, Grid, Sheet, number

if TYPE_CHECKING:
    from ..results.two_engines import Combined
    from .units import ShownUnit, System

_GEARED = "Geared one to one, kinetic energies add: the first crank feels T = T1 + T2."
_ROLL = {
    "first": f"{_GEARED} It drives the load, and the roll is C − T.",
    "second": f"{_GEARED} The second one drives the load, against its sense: the roll is C + T.",
    "both": f"{_GEARED} Each has its own flywheel and load: the roll is C − T1 + T2.",
}
_GAS = {  # whose gas counts, by whether the first and the second have some
    (True, True): "of both; their torques add as those of inertia do",
    (True, False): "of the first alone; the file of the second has no [gas]",
    (False, True): "of the second alone; the file of the first has no [gas]",
}


def document(result: Combined) -> dict[str, Any]:
    """Return `balcli.sum/1`: orders and peak as in `balcli.analysis/1`."""
    how = asdict(result.arrangement)
    place = {"at_mm": [clean(v * 1e3) for v in how.pop("at_m")]}
    engines = [describe_engine(engine) for engine in result.engines]
    if any(result.has_gas):
        engines = [e | {"gas": gas} for e, gas in zip(engines, result.has_gas, strict=True)]
    return {
        "format": "balcli.sum/1",
        "engines": engines,
        "arrangement": {"phase_deg": how.pop("phase_deg"), **place, **how},
        **describe_state(result.engines[0]),
        "orders": order_entries(result.spectra),
        **assumptions(result),
        "peak": peak_entries(result),
    }


def rows(result: Combined, system: System) -> Rows:
    """Return CSV: a figure a line, of both engines together."""
    header = ("quantity", "order", "figure", "value", "unit")
    return Rows(header, [row[1:] for row in figure_rows(result, system)])


def sheet(result: Combined, system: System) -> Sheet:
    """Return the engines, how they stand, and what they do together."""
    spectra = result.spectra.with_moment_if(result.moments_known)
    how, pivot = result.arrangement, tell_pivot(result.engines[0])
    roll = _ROLL[how.load] if how.reverse else ""
    parts: tuple[Facts | Grid, ...] = (
        Facts(tuple(_list_facts(result, system))),
        *order_tables(spectra, system, pivot, roll, every=result.every_order),
        peak_facts(result, system, "Largest over a revolution, all orders"),
    )
    return Sheet(" and ".join(engine.name for engine in result.engines), parts)


def _list_facts(result: Combined, system: System) -> Iterator[tuple[str, str]]:
    """Yield the engines, and how they stand and turn next to each other."""
    (first, second), how = result.engines, result.arrangement
    for which, engine in (("first", first), ("second", second)):
        count = engine.cylinders.count
        yield which, f"{engine.name}, {count} cylinder{'s' * (count > 1)}"
    place = _tell_place(how.at_m, system.length)
    yield "place", f"the second at {place}, turned by {how.turn_deg:g} deg"
    against = ", and turns against the first" if how.reverse else ""
    yield "crank", f"the second leads by {how.phase_deg:g} deg{against}"
    slower = second.speed_rpm != first.speed_rpm and not second.speed_assumed
    other = slower or second.ripple not in ((), first.ripple)
    ignored = "; what the second's file says of its speed does not count" * other
    yield "speed", f"both at {tell_speed(first)}{ignored}"
    if any(result.has_gas):
        yield "gas", _GAS[result.has_gas]
    if result.moments_known:
        yield "reference", f"moments about {_tell_place(first.reference_m, system.length)}"
    else:
        yield "reference", "moments are not known: crank.spacing is missing"


def _tell_place(point: Iterable[Any], unit: ShownUnit) -> str:
    return f"x, y, z = {', '.join(number(unit.of(float(v))) for v in point)} {unit.name}"


RENDERER = Renderer(sheet=sheet, document=document, rows=rows)
