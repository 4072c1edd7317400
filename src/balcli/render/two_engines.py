"""Two engines on one frame."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

from .csv import Rows
from .engine_facts import tell_pivot, tell_speed
from .figures import assumptions, clean, figure_rows, order_entries, peak_entries
from .order_tables import order_tables, peak_facts
from .sheet import Facts, Sheet, number

if TYPE_CHECKING:
    from ..engine.build import Engine
    from ..results.two_engines import Combined, Load
    from .units import ShownUnit, System

_GEARED = "Geared one to one, kinetic energies add: the first crank feels T = T1 + T2."
_ROLL: dict[Load, str] = {
    "first": f"{_GEARED} It drives the load, and the roll is C − T.",
    "second": f"{_GEARED} The second one drives the load, against its sense: the roll is C + T.",
    "both": f"{_GEARED} Each has its own flywheel and load: the roll is C − T1 + T2.",
}
# Whose gas counts, by whether the first and the second have some.
_GAS = {
    (True, True): "of both; their torques add as those of inertia do",
    (True, False): "of the first alone; the file of the second has no [gas]",
    (False, True): "of the second alone; the file of the first has no [gas]",
    (False, False): "",
}


def document(result: Combined) -> dict[str, Any]:
    """`balcli.sum/1`: orders and peak as in `balcli.analysis/1`."""
    first, how = result.engines[0], result.arrangement
    return {
        "format": "balcli.sum/1",
        "engines": [
            {
                "name": e.name,
                "cylinders": e.cylinders.count,
                "displacement_m3": clean(e.displacement_m3),
                **({"gas": here} if any(result.has_gas) else {}),
            }
            for e, here in zip(result.engines, result.has_gas, strict=True)
        ],
        "arrangement": {
            "phase_deg": how.phase_deg,
            "at_mm": [clean(v * 1e3) for v in how.at_m],
            "turn_deg": how.turn_deg,
            "reverse": how.reverse,
            "load": how.load,
        },
        "speed_rpm": clean(first.speed_rpm),
        "reference_mm": [clean(v * 1e3) for v in first.reference_m],
        "orders": order_entries(result.spectra),
        **assumptions(result),
        "peak": peak_entries(result),
    }


def rows(result: Combined, system: System) -> Rows:
    """CSV: a figure a line, of both engines together."""
    header = ("quantity", "order", "figure", "value", "unit")
    return Rows(header, [row[1:] for row in figure_rows(result, system)])


def sheet(result: Combined, system: System) -> Sheet:
    """The engines, how they stand, and what they do together."""
    spectra = result.spectra.with_moment_if(result.moments_known)
    how = result.arrangement
    return Sheet(
        " and ".join(engine.name for engine in result.engines),
        (
            Facts(tuple(_list_facts(result, system))),
            *order_tables(
                spectra,
                system,
                tell_pivot(result.engines[0]),
                _ROLL[how.load] if how.reverse else "",
                every=result.every_order,
            ),
            peak_facts(result, system, "Largest over a revolution, all orders"),
        ),
    )


def _list_facts(result: Combined, system: System) -> Iterator[tuple[str, str]]:
    """The engines, and how they stand and turn beside each other."""
    first, how = result.engines[0], result.arrangement
    for which, engine in zip(("first", "second"), result.engines, strict=True):
        count = engine.cylinders.count
        yield which, f"{engine.name}, {count} cylinder{'s' * (count > 1)}"
    place = _tell_place(how.at_m, system.length)
    yield "place", f"the second at {place}, turned by {how.turn_deg:g} deg"
    against = ", and turns against the first" if how.reverse else ""
    yield "crank", f"the second leads by {how.phase_deg:g} deg{against}"
    yield "speed", f"both at {tell_speed(first)}{_tell_other_speed(*result.engines)}"
    if gas := _GAS[result.has_gas]:
        yield "gas", gas
    if result.moments_known:
        yield "reference", f"moments about {_tell_place(first.reference_m, system.length)}"
    else:
        yield "reference", "moments are not known: crank.spacing is missing"


def _tell_other_speed(first: Engine, second: Engine) -> str:
    """That the second engine's own speed, or its unevenness, does not count where it is another."""
    slower = second.speed_rpm != first.speed_rpm and not second.speed_assumed
    other = slower or second.ripple not in ((), first.ripple)
    return "; what the second's file says of its speed does not count" if other else ""


def _tell_place(point: Iterable[Any], unit: ShownUnit) -> str:
    return f"x, y, z = {', '.join(number(unit.of(float(v))) for v in point)} {unit.name}"
