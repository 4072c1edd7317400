"""What sweep, search and scatter are about: single figures of an engine such as `force.2.major` or
`peak.moment`.

Quantities of something by its number or name: `mode.3.Hz`, `mount.left.force`, `guide.6.H`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from ..core.peaks import find_largest
from ..core.phasors import Array, Phasors
from ..engine.engine import Engine
from ..errors import MOMENTS_UNKNOWN, BalcliError
from ..file.fields import shorten, suggest_nearest
from ..limits import HIGHEST_ORDER
from .kinds import EVERY_KIND, GAS_KINDS, TORQUE_TOTAL, VECTORS
from .spectrum import compute_spectra, find_relevant_orders, split_order

_SIZES = ("major", "minor", "forward", "backward")
_ALONG_AXES = ("x", "y", "x_cos", "x_sin", "y_cos", "y_sin")
_SENSES = MappingProxyType({"with": "forward", "against": "backward"})  # as tables head them
VECTOR_PARTS = (*_SIZES, "axis", *_ALONG_AXES)
SCALAR_PARTS = ("amplitude", "major", "cos", "sin")


@dataclass(frozen=True)
class Quantity:
    """One figure: `kind.order.part`, or `peak.kind` with order 0 and part "peak".

    Of a couple, torque or roll, and of force and moment along x or y, `cos` and `sin` are the parts
    of the value `cos cos n theta + sin sin n theta`: they have signs, and so has the mean of order
    0, which is its `cos`.

    Attributes:
        called: what its name begins with, if that is not its kind: of an engine with gas the
            `torque` is that of gas and inertia.
    """

    kind: str
    order: float
    part: str
    called: str = ""

    @property
    def name(self) -> str:
        """As a user writes it."""
        if self.part == "peak":
            return f"peak.{self.kind}"
        return f"{self.called or self.kind}.{self.order:g}.{self.part}"

    @property
    def unit(self) -> str:
        """SI unit or degrees."""
        return "deg" if self.part == "axis" else EVERY_KIND[self.kind].si_unit

    @property
    def signed(self) -> bool:
        """Whether it is one of two parts of a harmonic, which may be negative."""
        return self.part.endswith(("cos", "sin"))

    def read_from(self, phasors: Phasors) -> Array:
        """Its value by the phasors of its kind, SI or degrees, shape (*trailing)."""
        row = int(np.searchsorted(phasors.orders, self.order))
        own = phasors.select_row(row)
        if self.signed:
            c = (own.y if self.part.startswith("y") else own.x)[0]
            return (c.real if self.part.endswith("cos") else -c.imag) + 0.0
        if self.part == "axis":
            return own.axis_deg[0]
        size = "major" if self.part == "amplitude" else self.part
        value: Array = np.abs(getattr(own, size)[0])
        return value


def parse_quantity(text: str, *, with_gas: bool = False) -> Quantity:
    """`force.2.major`, `moment.1.backward`, `couple.4.amplitude`, `peak.force` and their like; it
    begins with a kind, or peak.

    Args:
        with_gas: whether the engine has gas: its `torque` is then that of gas and inertia.

    Raises:
        BalcliError: anything else, with what there is.
    """
    kind, _, rest = text.partition(".")
    if kind == "peak" and rest in [vector.name for vector in VECTORS]:
        return Quantity(rest, 0, "peak")
    if kind == "peak":
        raise BalcliError(f"{text} is no quantity: after peak comes force or moment")
    order, part = split_order(rest)
    part = _SENSES.get(part, part)
    allowed = VECTOR_PARTS if EVERY_KIND[kind].vector else SCALAR_PARTS
    if order is None:
        raise BalcliError(
            f"{text} is no quantity: after {kind} comes an order up to {HIGHEST_ORDER}, as in "
            f"{kind}.2.{allowed[0]}"
        )
    if part not in allowed:
        raise BalcliError(
            f"{text} is no quantity: after the order comes one of {', '.join(allowed)}"
        )
    if kind == "torque" and with_gas:
        return Quantity(TORQUE_TOTAL.name, order, part, called=kind)
    return Quantity(kind, order, part)


def leave_out_unknown(engine: Engine, quantities: Iterable[Quantity]) -> tuple[Quantity, ...]:
    """The quantities without moments, of an engine that does not say where its throws stand."""
    return tuple(q for q in quantities if q.kind != "moment" or engine.places_known)


def refuse_unknown(engine: Engine, quantities: Iterable[Quantity]) -> None:
    """Nothing, unless one of these is a moment of an engine whose file does not say where its
    throws stand, or of gas, of an engine without.

    Raises:
        BalcliError: the quantity, and what the file has to say.
    """
    has_gas = engine.gas is not None or engine.gas_of_variants is not None
    for q in quantities:
        if q.kind == "moment" and not engine.places_known:
            raise BalcliError(f"{q.name}: {MOMENTS_UNKNOWN}")
        if q.kind in GAS_KINDS and not has_gas:
            raise BalcliError(f"{q.name}: the engine file has no [gas]")


def evaluate_quantities(engine: Engine, quantities: Sequence[Quantity]) -> list[Array]:
    """The value of each quantity, SI or degrees, shape (*trailing), of length 1 along axes on which
    it does not depend.

    Only the orders that a kind is asked for are computed; kinds with the same orders share what
    they have in common.
    """
    values: dict[Quantity, Array] = {}
    for orders, members in _group_by_orders(quantities):
        found = compute_spectra(engine, orders, {q.kind for q in members})
        values |= {q: q.read_from(found[q.kind]) for q in members}
    peaks = [q for q in quantities if q.part == "peak"]
    if peaks:
        whole = compute_spectra(engine, find_relevant_orders(engine), {q.kind for q in peaks})
        values |= {q: find_largest(whole[q.kind]) for q in peaks}
    return [values[q] for q in quantities]


def find_orders(engine: Engine, quantities: Sequence[Quantity]) -> list[list[float]]:
    """The orders that are computed together for these quantities, group by group."""
    groups = [orders for orders, _ in _group_by_orders(quantities)]
    if any(q.part == "peak" for q in quantities):
        groups.append(find_relevant_orders(engine).tolist())
    return groups


def _group_by_orders(quantities: Iterable[Quantity]) -> list[tuple[list[float], list[Quantity]]]:
    """Quantities whose kinds need the same orders, with these; peaks left out."""
    by_kind: dict[str, list[Quantity]] = {}
    for q in quantities:
        if q.part != "peak":
            by_kind.setdefault(q.kind, []).append(q)
    groups: dict[tuple[float, ...], list[Quantity]] = {}
    for members in by_kind.values():
        orders = tuple(sorted({q.order for q in members}))
        groups.setdefault(orders, []).extend(members)
    return [(list(orders), members) for orders, members in groups.items()]


class Subject(NamedTuple):
    """What quantities are of, by the word that their names begin with.

    Attributes:
        example: one of its numbers or names, for messages.
        units: SI unit of everything that can be asked of it.
    """

    example: str
    units: Mapping[str, str]


@dataclass(frozen=True)
class TargetQuantity:
    """One figure.

    Attributes:
        kind: of what, such as `mount`.
        target: its number or name.
        part: what of it.
        unit: SI, or percent.
    """

    kind: str
    target: str
    part: str
    unit: str = field(compare=False)

    @property
    def name(self) -> str:
        """As a user writes it."""
        return f"{self.kind}.{self.target}.{self.part}"


def parse_target_quantity(text: str, subjects: Mapping[str, Subject]) -> TargetQuantity:
    """`kind.target.part`, the kind one of the subjects.

    Raises:
        BalcliError: a part that there is not, or no target, with what there is.
    """
    kind, _, rest = text.partition(".")
    target, _, part = rest.rpartition(".")
    units = subjects[kind].units
    if part not in units or not target:
        there = " or ".join(f"{kind}.{subjects[kind].example}.{each}" for each in units)
        raise BalcliError(f"{text} is no quantity: give {there}")
    return TargetQuantity(kind, target, part, units[part])


def refuse_stranger(q: TargetQuantity, there: Sequence[str]) -> None:
    """Nothing, unless the file does not have what a quantity is of.

    Args:
        there: names of what it has of this kind.

    Raises:
        BalcliError: with the nearest name, or some of those that there are.
    """
    if q.target in there:
        return
    some = f"there are {', '.join(there[:8])}" if there else "there is none"
    hint = suggest_nearest(q.target, there, some)
    raise BalcliError(f"{q.name}: the file has no {q.kind} {shorten(q.target)}; {hint}")
