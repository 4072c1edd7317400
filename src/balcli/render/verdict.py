"""Plain words on each order: which part turns with the crank and can be met by a counterweight,
which part needs shafts.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

from ..core.phasors import Phasors
from ..forces.spectrum import Spectra
from .sheet import capitalized, degrees, number
from .units import System, Unit

_NAMES = {
    1: "First",
    2: "Second",
    3: "Third",
    4: "Fourth",
    5: "Fifth",
    6: "Sixth",
    7: "Seventh",
    8: "Eighth",
}
_AXES = {"0.0": "x", "90.0": "y"}
# share of what one cylinder does, or of the largest order, below which a higher order is passed
# over
NEGLIGIBLE = 1e-3
_UNKNOWN: Mapping[str, float] = MappingProxyType({})


class _Found(NamedTuple):
    """Force or moment, and what one cylinder makes of it (0: not known)."""

    what: str
    phasors: Phasors
    unit: Unit
    single: float

    def size(self, k: int) -> str:
        return f"{number(self.unit.of(float(self.phasors.major[k])), 4)} {self.unit.name}"

    def matters(self, k: int) -> bool:
        return bool(self.phasors.major[k] > NEGLIGIBLE * self.single)


def verdict(
    spectra: Spectra, system: System, single: Mapping[str, float] = _UNKNOWN
) -> tuple[str, ...]:
    """A sentence for every order that matters; empty if neither forces nor moments were asked for.

    `single`: force (N) and moment (N m) of one cylinder's reciprocating mass, beside which an order
    may be negligible.
    """
    found = [
        _Found(kind.name, phasors, system.unit(kind), single.get(kind.name, 0.0))
        for kind, phasors in spectra.vectors()
    ]
    if not found:
        return ()
    rows = [(k, order) for k, order in enumerate(spectra.orders) if order >= 1]
    high = tuple(filter(None, (_high(k, order, found) for k, order in rows if order > 2)))
    if not any(one.matters(k) for k, _ in rows for one in found):
        high = tuple(filter(None, [_rest([(k, order) for k, order in rows if order > 2], found)]))
    return (*(_low(k, int(order), found) for k, order in rows if order <= 2), *high)


def _name(order: float) -> str:
    return f"{_NAMES.get(int(order)) or f'{order:g}th'} order"


def _low(k: int, order: int, found: list[_Found]) -> str:
    """Orders 1 and 2: what is there, which way it turns, and what meets it."""
    there = [_vector(k, order, one) for one in found if not one.phasors.balanced[k]]
    free = [one.what for one in found if one.phasors.balanced[k]]
    if not there:
        return f"{_name(order)}: free of {' and '.join(free)}."
    rest = [f"no {what}." for what in free]
    return f"{_name(order)}: " + " ".join([there[0], *map(capitalized, [*there[1:], *rest])])


def _high(k: int, order: float, found: list[_Found]) -> str:
    """Higher orders: their size, if it is worth a word."""
    sizes = [
        f"{one.what} up to {one.size(k)}"
        for one in found
        if one.matters(k) and one.phasors.major[k] > NEGLIGIBLE * one.phasors.major.max()
    ]
    return (
        f"{_name(order)}: {', '.join(sizes)}; rarely balanced, it would take shafts at {order:g} "
        "times crank speed."
        if sizes
        else ""
    )


def _rest(rows: list[tuple[int, float]], found: list[_Found]) -> str:
    """The largest of the higher orders, where nothing is left that matters."""
    largest = [(max(rows, key=lambda row: one.phasors.major[row[0]]), one) for one in found if rows]
    told = [
        f"a {one.what} of {one.size(k)} in order {order:g}"
        for (k, order), one in largest
        if one.phasors.major[k]
    ]
    return f"Higher orders: negligible, at most {' and '.join(told)}." if told else ""


def _vector(k: int, order: int, found: _Found) -> str:
    what, p, unit, size = found.what, found.phasors, found.unit, found.size(k)
    if not found.matters(k):
        return f"{what} of up to {size}, negligible."
    forward, backward = abs(p.forward[k]), abs(p.backward[k])
    if backward == 0:
        cure = (
            "counterweights on the crankshaft cancel it"
            if order == 1
            else _shafts(f"a shaft at +{order}")
        )
        return f"{what} of {size}, turning with the crank: {cure}."
    if forward == 0:
        return f"{what} of {size}, turning against the crank: {_shafts(f'a shaft at −{order}')}."
    parts = (
        f"{number(unit.of(forward), 4)} turns with the crank, {number(unit.of(backward), 4)} "
        "against it"
    )
    cure = (
        "counterweights cancel the first part, a shaft at −1 times crank speed the second"
        if order == 1
        else _shafts(f"shafts at +{order} and −{order}")
    )
    return f"{what} of up to {size} {_direction(what, float(p.axis_deg[k]))} ({parts}): {cure}."


def _direction(what: str, axis_deg: float) -> str:
    """A force acts along an axis, a moment about it."""
    angle = degrees(axis_deg, 180)
    return (
        f"{'about' if what == 'moment' else 'along'} "
        f"{_AXES.get(angle) or f'an axis at {angle} deg'}"
    )


def _shafts(which: str) -> str:
    return f"nothing on the crankshaft cancels it; it takes {which} times crank speed"
