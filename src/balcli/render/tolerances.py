"""Results of a Monte-Carlo run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..studies.quantity_names import tell_assumed_speed, tell_speeds
from .csv import Rows
from .sheet import NAMELESS, Grid, Sheet, number

if TYPE_CHECKING:
    from ..studies.tolerances import Scatter, Shape, Spread
    from .units import System

SHOWN = 6  # sources of each quantity in a table
_ORDER = "(exact for masses, to first order for lengths and angles)"
_BOUND: dict[Shape, str] = {
    "uniform": f"bound: no combination exceeds it {_ORDER}",
    "normal": f"bound: no combination within the tolerances exceeds it {_ORDER}; normal deviations "
    "go beyond a tolerance, three times their standard deviation, in 1 of 370",
}

_BOUND_ONE_BY_ONE = (
    "bound: nominal and all changes added up, to first order: {one} may go a little beyond"
)


def document(result: Scatter) -> dict[str, Any]:
    """`balcli.scatter/1`."""
    return {
        "format": "balcli.scatter/1",
        "engine": {"name": result.model.name},
        "samples": result.samples,
        "distribution": result.shape,
        "quantities": {
            s.quantity.name: _statistics(s)
            | {"sensitivity": {source.name: share for source, share in s.shares}}
            for s in result.spreads
        },
    }


def _statistics(s: Spread) -> dict[str, float]:
    return {
        "nominal": s.nominal,
        "mean": s.mean,
        **s.percentiles,
        "max": s.largest,
        "bound": s.bound,
    }


def rows(result: Scatter, _system: System) -> Rows:
    """CSV: a quantity a line, in SI units."""
    return Rows(
        ("quantity", *_statistics(result.spreads[0]), "unit"),
        [
            (s.quantity.name, *_statistics(s).values(), s.quantity.unit or None)
            for s in result.spreads
        ],
    )


def sheet(result: Scatter, _system: System) -> Sheet:
    """Percentiles in SI units, and which tolerances matter most."""
    notes = (
        _tell_bound(result),
        tell_speeds(s.quantity.name for s in result.spreads),
        tell_assumed_speed(result.model),
    )
    spread = Grid(
        f"Spread of {result.samples} {result.varied}",
        ("quantity", *_statistics(result.spreads[0])),
        tuple((_name(s), *map(number, _statistics(s).values())) for s in result.spreads),
        note=". ".join(filter(None, notes)),
    )
    shares = Grid(
        "What each tolerance alone changes, most first",
        ("quantity", *(f"{k}." for k in range(1, SHOWN + 1))),
        tuple((_name(s), *_largest_shares(s)) for s in result.spreads),
        words=tuple(range(SHOWN + 1)),
    )
    return Sheet(result.model.name or NAMELESS, (spread, shares))


def _tell_bound(result: Scatter) -> str:
    if result.varied == "engines":
        return _BOUND[result.shape]
    one = "an engine" if result.varied.startswith("engines") else "a set"
    return _BOUND_ONE_BY_ONE.format(one=one)


def _name(s: Spread) -> str:
    return ", ".join(filter(None, (s.quantity.name, s.quantity.unit)))


def _largest_shares(s: Spread) -> list[str]:
    texts = [f"{source.name}: {number(share, 3)}" for source, share in s.shares[:SHOWN]]
    return texts + [""] * (SHOWN - len(texts))
