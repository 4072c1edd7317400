"""An analysis in brief: the orders that matter, roll, peaks, and the devices in one line.

Plain words on each order: which part turns with the crank and can be met by a counterweight,
which part needs shafts.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.cylinders import Device
from ..core.phasors import Phasors, wrap_degrees
from ..file.messages import ordinal
from ..forces.kinds import ROLL, ROLL_TOTAL, Kind
from ..forces.spectrum import Spectra
from ..show.engine_facts import tell_pivot
from ..show.sheet import (
    NEGLIGIBLE,
    NOTHING,
    UNKNOWN,
    Facts,
    Grid,
    capitalized,
    degrees,
    number,
    order_name,
    size_text,
    small_text,
)
from ..show.units import ShownUnit, System
from .order_tables import fit_largest, peak_facts

if TYPE_CHECKING:
    from .answer import Analysis


def find_orders_that_matter(spectra: Spectra, single: dict[str, float]) -> list[float]:
    """Return orders to 2, and those with a force or moment that is not small against one
    cylinder's.

    Args:
        spectra: Spectra to show.
        single: Size of each kind for one cylinder; of a kind that is not in it, none is small.
    """
    return [
        float(order)
        for k, order in enumerate(spectra.orders)
        if order in (0, 1, 2)
        or any(p.major[k] > NEGLIGIBLE * single.get(kind.name, 0.0) for kind, p in spectra.items())
    ]


def vectors_grid(spectra: Spectra, shown: list[float], system: System, *, hints: bool) -> Grid:
    """Return force and moment side by side, with the parts of each that turn with the crank and
    against it; the other orders are listed in one line, with a hint how to see them.

    Args:
        spectra: Spectra to show.
        shown: Orders that have rows.
        system: System of units.
        hints: Whether the option that shows more is named.
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
    """Return a kind at the head of a column, or in a sentence."""
    return "roll with gas" if kind is ROLL_TOTAL else kind.name


def tell_others(
    states: Sequence[Spectra], shown: list[float], system: System, *, hints: bool
) -> str:
    """Return one line on the orders that are not shown, or nothing.

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
    """Return moments about the crank's axis and the largest values over a revolution, a line each.

    Args:
        result: Analysis to show.
        system: System of units.
        every_order: Whether orders were given, which need not be those that roll has.
    """
    peaks = peak_facts(result, system, "", result.of_one_cylinder).pairs
    roll = result.spectra.roll
    name = ROLL.label if result.engine.gas is None else f"{ROLL.label}, inertia alone"
    pairs = []
    if roll is not None:
        pairs = [(name, _tell_roll(result, roll, system, every_order=every_order))]
    title = "Largest over a revolution" if peaks else f"About {tell_pivot(result.engine)}"
    return Facts((*pairs, *peaks), title)


def _tell_roll(result: Analysis, roll: Phasors, system: System, *, every_order: bool) -> str:
    """Return every order that matters: `order 2: 458, 4: 26.3 N m`; arguments as of
    `roll_and_peaks`.
    """
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


_NAMES = dict(
    enumerate(["First", "Second", "Third", "Fourth", "Fifth", "Sixth", "Seventh", "Eighth"], 1)
)
_MOST_HIGH_ORDERS = 8  # near the lock dozens matter: these one by one, the others together
_AXES = {"0.0": "x", "90.0": "y"}
_Row = tuple[int, float]  # index of an order, and the order
_UNKNOWN: Mapping[str, float] = MappingProxyType({})
_UNEVEN = (
    "The uneven speed mixes the orders. Devices are sized at steady speed; one that cancels an "
    "order there also cancels what that order adds to others."
)


class _Vector(NamedTuple):
    """Force or moment, and what one cylinder makes of it (0: not known)."""

    kind: Kind
    phasors: Phasors
    unit: ShownUnit
    single: float
    up_deg: float | None

    @property
    def what(self) -> str:
        return self.kind.name

    def size(self, k: int) -> str:
        unit, value = self.unit_at(k), float(self.phasors.major[k])
        return f"{number(unit.of(value), 4)} {unit.name}"

    def unit_at(self, k: int) -> ShownUnit:
        return self.unit.fit(float(self.phasors.major[k]))

    def matters(self, k: int) -> bool:
        return bool(self.phasors.major[k] > NEGLIGIBLE * self.single)


def verdict(
    spectra: Spectra,
    system: System,
    single: Mapping[str, float] = _UNKNOWN,
    *,
    steady: bool = True,
    devices: Sequence[Device] = (),
) -> tuple[str, ...]:
    """Return a sentence for every order that matters; none without forces and moments.

    Args:
        single: force (N) and moment (N m) of one cylinder's reciprocating mass, against which an
            order may be negligible.
        steady: whether the speed is. If not, no cure is named: most of an order may come
            from another one through the unevenness, and vanishes with that one.
        devices: Devices of the file, which are not named as what would cancel an order.
    """
    vectors = [
        _Vector(kind, phasors, system.unit(kind), single.get(kind.name, 0.0), spectra.up_deg)
        for kind, phasors in spectra.vectors()
    ]
    if not vectors:
        return ()
    rows = [(k, order) for k, order in enumerate(spectra.orders) if order > 0]
    higher = [(k, order) for k, order in rows if order not in (1, 2)]
    told = [
        _tell_low_order(k, int(order), vectors, spectra.couple, steady, devices)
        for k, order in rows
        if order in (1, 2)
    ]
    if any(vector.matters(k) for k, _ in rows for vector in vectors):
        told += _tell_high_orders(higher, vectors, steady)
        told += [] if steady else [_UNEVEN]
    elif largest := _tell_largest(higher, vectors):
        told.append(f"Higher orders: negligible, at most {largest}.")
    if higher and not told:
        names, couple = [vector.what for vector in vectors], spectra.couple
        sizes = [] if couple is None else [couple.major[k] for k, _ in higher]
        told.append(f"The orders shown: {_tell_balanced(names, max(sizes, default=0.0), vectors)}")
    return tuple(told)


def _order_name(order: float) -> str:
    if order % 1:
        return f"Order {order_name(order)}"
    return f"{_NAMES[int(order)] if order < len(_NAMES) else ordinal(int(order))} order"


def _tell_low_order(
    k: int,
    order: int,
    vectors: list[_Vector],
    couple: Phasors | None,
    steady: bool,
    devices: Sequence[Device],
) -> str:
    """Return for order 1 or 2 its forces, the way they turn, and at steady speed the cure; the
    roll couple where the moment is balanced.
    """
    there, balanced = [], []
    for vector in vectors:
        if vector.phasors.balanced[k]:
            balanced.append(vector.what)
            continue
        told, cure = _tell_vector(k, order, vector, devices)
        there.append(f"{told}: {cure}." if cure and steady else f"{told}.")
    left = 0.0 if couple is None else float(couple.major[k])
    if not there:
        return f"{_order_name(order)}: {_tell_balanced(balanced, left, vectors)}"
    rest = there[1:]
    if "moment" in balanced and left:
        rest.append(f"roll couple of {size_text(left, vectors[-1].unit)}.")
    elif balanced:
        rest.append(f"no {balanced[0]}.")
    return f"{_order_name(order)}: {' '.join([there[0], *map(capitalized, rest)])}"


def _tell_balanced(names: list[str], couple: float, vectors: list[_Vector]) -> str:
    """Return the balanced quantities, and the roll couple (N m) that remains."""
    remains = f"; roll couple of {size_text(couple, vectors[-1].unit)}" if couple else ""
    return f"{' and '.join(names)} balanced{remains if 'moment' in names else ''}."


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
        shafts = f"it would need shafts at {order:g} times crank speed"
        cure = f"; usually left unbalanced ({shafts})" * steady
        yield f"{_order_name(order)}: {', '.join(sizes)}{cure}."
    if others := [(k, order) for k, order, _ in worth[alone:]]:
        first, last = others[0][1], others[-1][1]
        largest = _tell_largest(others, vectors)
        span = f"{order_name(first)} to {order_name(last)}"
        yield f"Orders {span}, {len(others)} more: at most {largest}."


def _tell_largest(rows: list[_Row], vectors: list[_Vector]) -> str:
    """Return the largest force and moment of some orders; empty if all are balanced."""
    told = []
    for vector in vectors if rows else ():
        k, order = max(rows, key=lambda row: vector.phasors.major[row[0]])
        if vector.phasors.major[k]:
            told.append(f"a {vector.what} of {vector.size(k)} in order {order_name(order)}")
    return " and ".join(told)


def _tell_vector(k: int, order: int, vector: _Vector, devices: Sequence[Device]) -> tuple[str, str]:
    """Return one vector of order 1 or 2: its size and how it turns; and what cancels it, nothing
    where it is negligible, or where the file has such devices already.
    """
    own = [device for device in devices if device.order == order]
    ahead_fitted = any(np.any(device.forward) for device in own)
    against_fitted = any(np.any(device.backward) for device in own)
    what, phasors, unit, size = vector.what, vector.phasors, vector.unit_at(k), vector.size(k)
    if not vector.matters(k):
        return f"{what} of up to {size}, negligible", ""
    forward, backward = abs(phasors.forward[k]), abs(phasors.backward[k])
    shafts = "counterweights cannot cancel it; use {} times crank speed"
    if backward == 0:
        cure = shafts.format(f"a balancer shaft at +{order}")
        by_weights = "counterweights on the crankshaft cancel it"
        cure = by_weights if order == 1 else cure
        return f"{what} of {size}, turning with the crank", "" if ahead_fitted else cure
    if forward == 0:
        cure = shafts.format(f"a balancer shaft at -{order}")
        return f"{what} of {size}, turning against the crank", "" if against_fitted else cure
    cure = shafts.format(f"two balancer shafts, at +{order} and -{order}")
    if order == 1:
        weights = "" if ahead_fitted else "counterweights cancel the first, "
        shaft = "a balancer shaft at -1 times crank speed"
        cure = f"{weights}{shaft}{' cancels' if ahead_fitted else ''} the second"
    if against_fitted:
        cure = "counterweights cancel the first" * (order == 1 and not ahead_fitted)
    elif ahead_fitted and order > 1:
        cure = ""
    ahead, against = number(unit.of(forward), 4), number(unit.of(backward), 4)
    parts = f"{ahead} {unit.name} rotates with the crank, {against} {unit.name} against it"
    direction = _tell_direction(k, vector)
    return f"{what} of up to {size} {direction} ({parts})", cure


def _tell_direction(k: int, vector: _Vector) -> str:
    """Return the axis along which a force acts, or about which a moment does; and what that is
    called where the file says which way is up.
    """
    kind, axis_deg, up = vector.kind, float(vector.phasors.axis_deg[k]), vector.up_deg
    angle = degrees(axis_deg, 180)
    axis = kind.tell_axis(_AXES.get(angle) or f"an axis at {angle} deg")
    if up is None:
        return axis
    names = dict(zip(_AXES, kind.upright, strict=True))
    if name := names.get(degrees(float(wrap_degrees(axis_deg - up, 180)), 180)):
        return f"{name} ({axis})"
    turned, unit = vector.phasors.turn(-up), vector.unit_at(k)
    parts = zip((turned.x[k], turned.y[k]), kind.upright, strict=True)
    sizes = " and ".join(f"{number(unit.of(abs(c)), 4)} {name}" for c, name in parts)
    return f"{axis}, {sizes}"
