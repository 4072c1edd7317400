"""Plain words on each order: which part turns with the crank and can be met by a counterweight,
which part needs shafts.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import NamedTuple

from ..core.phasors import Phasors
from ..enginefile.messages import ordinal
from ..forces.spectrum import Spectra
from .sheet import NEGLIGIBLE, capitalized, degrees, number, order_name
from .units import ShownUnit, System

_NAMES = dict(
    enumerate(["First", "Second", "Third", "Fourth", "Fifth", "Sixth", "Seventh", "Eighth"], 1)
)
_MOST_HIGH_ORDERS = 8  # near the lock dozens matter: these one by one, the others together
_AXES = {"0.0": "x", "90.0": "y"}
_SWAYS = {"x": "yawing", "y": "pitching"}
_Row = tuple[int, float]  # index of an order, and the order
_UNKNOWN: Mapping[str, float] = MappingProxyType({})
_UNEVEN = (
    "At this uneven speed orders have parts of one another: what cancels an order at steady speed, "
    "for which balance sizes devices, cancels its parts in all others, too."
)


class _Vector(NamedTuple):
    """Force or moment, and what one cylinder makes of it (0: not known)."""

    what: str
    phasors: Phasors
    unit: ShownUnit
    single: float

    def size(self, k: int) -> str:
        unit, value = self.unit_at(k), float(self.phasors.major[k])
        return f"{number(unit.of(value), 4)} {unit.name}"

    def unit_at(self, k: int) -> ShownUnit:
        return self.unit.fit(float(self.phasors.major[k]))

    def matters(self, k: int) -> bool:
        return bool(self.phasors.major[k] > NEGLIGIBLE * self.single)


def verdict(
    spectra: Spectra, system: System, single: Mapping[str, float] = _UNKNOWN, *, steady: bool = True
) -> tuple[str, ...]:
    """A sentence for every order that matters; empty if neither forces nor moments were asked for.

    Args:
        single: force (N) and moment (N m) of one cylinder's reciprocating mass, beside which an
            order may be negligible.
        steady: whether the speed is. If not, orders are told without what cancels them: most of an
            order may be what the unevenness makes of another, and goes with that one.
    """
    vectors = [
        _Vector(kind.name, phasors, system.unit(kind), single.get(kind.name, 0.0))
        for kind, phasors in spectra.vectors()
    ]
    if not vectors:
        return ()
    rows = [(k, order) for k, order in enumerate(spectra.orders) if order > 0]
    higher = [(k, order) for k, order in rows if order not in (1, 2)]
    told = [_tell_low_order(k, int(order), vectors, steady) for k, order in rows if order in (1, 2)]
    if any(vector.matters(k) for k, _ in rows for vector in vectors):
        told += _tell_high_orders(higher, vectors, steady)
        told += [] if steady else [_UNEVEN]
    elif largest := _tell_largest(higher, vectors):
        told.append(f"Higher orders: negligible, at most {largest}.")
    if higher and not told:
        told.append(f"The orders shown: free of {' and '.join(v.what for v in vectors)}.")
    return tuple(told)


def _order_name(order: float) -> str:
    if order % 1:
        return f"Order {order_name(order)}"
    return f"{_NAMES[int(order)] if order < len(_NAMES) else ordinal(int(order))} order"


def _tell_low_order(k: int, order: int, vectors: list[_Vector], steady: bool) -> str:
    """Return for order 1 or 2 what is there, which way it turns, and at steady speed what cancels
    it.
    """
    there, free = [], []
    for vector in vectors:
        if vector.phasors.balanced[k]:
            free.append(vector.what)
            continue
        told, cure = _tell_vector(k, order, vector)
        there.append(f"{told}: {cure}." if cure and steady else f"{told}.")
    if not there:
        return f"{_order_name(order)}: free of {' and '.join(free)}."
    rest = [*there[1:], *(f"no {what}." for what in free)]
    return f"{_order_name(order)}: {' '.join([there[0], *map(capitalized, rest)])}"


def _tell_high_orders(higher: list[_Row], vectors: list[_Vector], steady: bool) -> Iterator[str]:
    """Yield sentences on the higher orders that are small neither next to one cylinder nor next to
    other orders: the lowest one by one, the others together.
    """
    least = [NEGLIGIBLE * vector.phasors.major.max() for vector in vectors]
    worth: list[tuple[int, float, list[str]]] = []
    for k, order in higher:
        sizes = [
            f"{vector.what} up to {vector.size(k)}"
            for vector, small in zip(vectors, least, strict=True)
            if vector.matters(k) and vector.phasors.major[k] > small
        ]
        worth += [(k, order, sizes)] if sizes else []
    alone = len(worth) if len(worth) == _MOST_HIGH_ORDERS + 1 else _MOST_HIGH_ORDERS
    for _, order, sizes in worth[:alone]:
        cure = f"; rarely balanced, it would take shafts at {order:g} times crank speed" * steady
        yield f"{_order_name(order)}: {', '.join(sizes)}{cure}."
    if others := [(k, order) for k, order, _ in worth[alone:]]:
        first, last = others[0][1], others[-1][1]
        largest = _tell_largest(others, vectors)
        yield f"{len(others)} more, of orders {first:g} to {last:g}: at most {largest}."


def _tell_largest(rows: list[_Row], vectors: list[_Vector]) -> str:
    """The largest force and moment of some orders; empty if all are balanced."""
    told = []
    for vector in vectors if rows else ():
        k, order = max(rows, key=lambda row: vector.phasors.major[row[0]])
        if vector.phasors.major[k]:
            told.append(f"a {vector.what} of {vector.size(k)} in order {order:g}")
    return " and ".join(told)


def _tell_vector(k: int, order: int, vector: _Vector) -> tuple[str, str]:
    """One vector of order 1 or 2: its size and how it turns; and what cancels it, nothing where it
    is negligible.
    """
    what, phasors, unit, size = vector.what, vector.phasors, vector.unit_at(k), vector.size(k)
    if not vector.matters(k):
        return f"{what} of up to {size}, negligible", ""
    forward, backward = abs(phasors.forward[k]), abs(phasors.backward[k])
    shafts = "nothing on the crankshaft cancels it; it needs {} times crank speed"
    if backward == 0:
        cure = shafts.format(f"a balancer shaft at +{order}")
        by_weights = "counterweights on the crankshaft cancel it"
        return f"{what} of {size}, turning with the crank", by_weights if order == 1 else cure
    if forward == 0:
        cure = shafts.format(f"a balancer shaft at -{order}")
        return f"{what} of {size}, turning against the crank", cure
    cure = shafts.format(f"two balancer shafts, at +{order} and -{order}")
    if order == 1:
        cure = "counterweights cancel the first part, a shaft at -1 times crank speed the second"
    ahead, against = number(unit.of(forward), 4), number(unit.of(backward), 4)
    parts = f"{ahead} turns with the crank, {against} against it"
    direction = _tell_direction(what, float(phasors.axis_deg[k]))
    return f"{what} of up to {size} {direction} ({parts})", cure


def _tell_direction(what: str, axis_deg: float) -> str:
    """A force acts along an axis, a moment about it."""
    angle = degrees(axis_deg, 180)
    axis = _AXES.get(angle) or f"an axis at {angle} deg"
    if what != "moment":
        return f"along {axis}"
    return f"{_SWAYS[axis]} (about {axis})" if axis in _SWAYS else f"about {axis}"
