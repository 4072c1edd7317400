"""Two engines on one frame, as a sheet and as JSON."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .figures import clean, peaks
from .json import orders

if TYPE_CHECKING:
    from ..results.two_engines import Combined
    from .sheet import Sheet
    from .units import System


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
            }
            for e in result.engines
        ],
        "arrangement": {
            "phase_deg": how.phase_deg,
            "at_mm": [clean(v * 1e3) for v in how.at_m],
            "turn_deg": how.turn_deg,
            "reverse": how.reverse,
        },
        "speed_rpm": clean(first.speed_rpm),
        "reference_mm": [clean(v * 1e3) for v in first.reference_m],
        "orders": orders(result.spectra),
        "peak": peaks(result),
    }


def sheet(result: Combined, system: System) -> Sheet:
    """The engines, how they stand, and what they do together."""
    from .analysis import largest, order_by_order
    from .sheet import Facts, Sheet, number

    first, how, length = result.engines[0], result.arrangement, system.length
    names = [engine.name for engine in result.engines]

    def place(values: tuple[Any, ...]) -> str:
        return f"x, y, z = {', '.join(number(length.of(float(v))) for v in values)} {length.name}"

    pairs = (
        *(
            (
                which,
                f"{engine.name}, {(count := engine.cylinders.count)} cylinder{'s' * (count > 1)}",
            )
            for which, engine in zip(("first", "second"), result.engines, strict=True)
        ),
        ("place", f"the second at {place(how.at_m)}, turned by {how.turn_deg:g} deg"),
        (
            "crank",
            (
                f"the second leads by {how.phase_deg:g} deg"
                f"{', and turns against the first' if how.reverse else ''}"
            ),
        ),
        ("speed", f"{number(float(first.speed_rpm), 6)} rpm, both"),
        ("reference", f"moments about {place(first.reference_m)}"),
    )
    return Sheet(
        " and ".join(names),
        (
            Facts(pairs),
            *order_by_order(result.spectra, system),
            largest(result, system, "Largest over a revolution, all orders"),
        ),
    )
