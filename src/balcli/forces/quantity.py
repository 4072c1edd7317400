"""Define quantities, the single figures of an engine that sweep, search and scatter evaluate.

They have names such as `force.2.major` or `peak.moment`; figures of a mode, mount or other target
have names such as `mode.3.Hz`, `mount.left.force` or `guide.6.H`.
"""

from collections.abc import Iterable, Sequence
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
from .kinds import EVERY_KIND, FREE, GAS_KINDS, TORQUE_TOTAL
from .spectrum import compute_spectra, find_relevant_orders, split_order

_SIZES = ("major", "minor", "forward", "backward")
_ALONG_AXES = ("x", "y", "x_cos", "x_sin", "y_cos", "y_sin")
_SENSES = MappingProxyType({"with": "forward", "against": "backward"})  # words of table headings
VECTOR_PARTS = (*_SIZES, "axis", *_ALONG_AXES)
SCALAR_PARTS = ("amplitude", "major", "cos", "sin")


class Quantity(NamedTuple):
    """One figure of a force or moment: `kind.order.part`, or `peak.kind` with order 0 and part
    "peak".

    For couple, torque and roll, and for force and moment along x or y, `cos` and `sin` are the
    coefficients a and b of `a cos n theta + b sin n theta`. They are signed. The `cos` of order 0
    is the mean.

    Attributes:
        kind: Kind of force or moment.
        order: Order; 0 for a peak.
        part: Figure of the order, such as "major" (`VECTOR_PARTS`, `SCALAR_PARTS`), or "peak".
        called: First word of the quantity's name if it differs from `kind`. With gas, the word
            `torque` means the kind `torque_total`.
    """

    kind: str
    order: float
    part: str
    called: str = ""

    @property
    def name(self) -> str:
        """Name as a user writes it."""
        if self.part == "peak":
            return f"peak.{self.kind}"
        return f"{self.called or self.kind}.{self.order:g}.{self.part}"

    @property
    def unit(self) -> str:
        """SI unit or degrees."""
        return "deg" if self.part == "axis" else EVERY_KIND[self.kind].si_unit

    @property
    def signed(self) -> bool:
        """Whether the quantity is a coefficient of cosine or sine, which may be negative."""
        return self.part.endswith(("cos", "sin"))

    def read_from(self, phasors: Phasors) -> Array:
        """Return the value from the phasors of its kind, SI or degrees, shape (*trailing)."""
        own = phasors.select_orders([self.order])
        if self.signed:
            c = (own.y if self.part.startswith("y") else own.x)[0]
            return (c.real if self.part.endswith("cos") else -c.imag) + 0.0
        if self.part == "axis":
            return own.axis_deg[0]
        size = "major" if self.part == "amplitude" else self.part
        value: Array = np.abs(getattr(own, size)[0])
        return value


def parse_quantity(text: str, *, with_gas: bool = False) -> Quantity:
    """Return the quantity that a text names, such as `force.2.major` or `peak.force`.

    Args:
        text: Name, which begins with a kind or with peak.
        with_gas: Whether the engine has gas; `torque` then means the torque of gas and inertia.

    Raises:
        BalcliError: The text names no quantity; the error lists the possible ones.
    """
    kind, _, rest = text.partition(".")
    if kind == "peak" and rest in [vector.name for vector in FREE]:
        return Quantity(rest, 0, "peak")
    if kind == "peak":
        raise BalcliError(f"{text} is not a quantity: after peak comes force or moment")
    order, part = split_order(rest)
    part = _SENSES.get(part, part)
    allowed = VECTOR_PARTS if EVERY_KIND[kind].vector else SCALAR_PARTS
    if order is None:
        message = f"after {kind} comes an order up to {HIGHEST_ORDER}, as in {kind}.2.{allowed[0]}"
        raise BalcliError(f"{text} is not a quantity: {message}")
    if part not in allowed:
        message = f"after the order comes one of {', '.join(allowed)}"
        hint = suggest_nearest(part, allowed, message)
        raise BalcliError(f"{text} is not a quantity: {hint}")
    if kind == "torque" and with_gas:
        return Quantity(TORQUE_TOTAL.name, order, part, called=kind)
    return Quantity(kind, order, part)


def leave_out_unknown(engine: Engine, quantities: Iterable[Quantity]) -> tuple[Quantity, ...]:
    """Return the quantities, without moments if the positions of the throws are not known.

    Args:
        engine: Engine whose quantities are wanted.
        quantities: Wanted quantities.
    """
    return tuple(q for q in quantities if q.kind != "moment" or engine.places_known)


def refuse_unknown(engine: Engine, quantities: Iterable[Quantity]) -> None:
    """Raise an error for a moment if the positions of the throws are not known, and for a quantity
    of gas if the engine has no gas.

    Args:
        engine: Engine whose quantities are wanted.
        quantities: Wanted quantities.

    Raises:
        BalcliError: A quantity is not known; the error names the first and the reason.
    """
    has_gas = engine.gas is not None or engine.gas_of_variants is not None
    for q in quantities:
        if q.kind == "moment" and not engine.places_known:
            raise BalcliError(f"{q.name}: {MOMENTS_UNKNOWN}")
        if q.kind in GAS_KINDS and not has_gas:
            raise BalcliError(f"{q.name}: the engine file has no [gas]")


def evaluate_quantities(engine: Engine, quantities: Sequence[Quantity]) -> list[Array]:
    """Return the value of each quantity, SI or degrees, shape (*trailing), with length 1 along axes
    that do not affect the quantity.

    Only the wanted orders of each kind are computed; kinds with the same orders are computed
    together.

    Args:
        engine: Engine, or variants along trailing axes.
        quantities: Wanted quantities; each is known.
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
    """Return the groups of orders that are computed together for these quantities.

    Args:
        engine: Engine, which determines the orders of peaks.
        quantities: Wanted quantities.
    """
    groups = [orders for orders, _ in _group_by_orders(quantities)]
    if any(q.part == "peak" for q in quantities):
        groups.append(find_relevant_orders(engine).tolist())
    return groups


def _group_by_orders(quantities: Iterable[Quantity]) -> list[tuple[list[float], list[Quantity]]]:
    """Return groups of quantities whose kinds need the same orders, each with these orders; peaks
    are omitted.
    """
    by_kind: dict[str, list[Quantity]] = {}
    for q in quantities:
        if q.part != "peak":
            by_kind.setdefault(q.kind, []).append(q)
    groups: dict[tuple[float, ...], list[Quantity]] = {}
    for members in by_kind.values():
        orders = tuple(sorted({q.order for q in members}))
        groups.setdefault(orders, []).extend(members)
    return [(list(orders), members) for orders, members in groups.items()]


@dataclass(frozen=True)
class TargetQuantity:
    """One figure that another module computes, such as those of torsion or mounts. Most figures
    belong to a target, such as a mount: `kind.target.part`.

    Attributes:
        name: Name as a user writes it.
        unit: SI unit, or percent.
        chapter: Key in `names.QUANTITIES` of the module that computes the figure.
    """

    name: str
    unit: str = field(default="", compare=False)
    chapter: str = field(default="", compare=False)

    @property
    def kind(self) -> str:
        """Kind of the target, such as `mount`."""
        return self.name.partition(".")[0]

    @property
    def target(self) -> str:
        """Number or name of the target."""
        return self.name.partition(".")[2].rpartition(".")[0]

    @property
    def part(self) -> str:
        """Figure of the target."""
        return self.name.rpartition(".")[2]


def refuse_stranger(q: TargetQuantity, targets: Sequence[str]) -> None:
    """Raise an error if the file does not have the target of a quantity.

    Args:
        q: Quantity.
        targets: Names of all targets of its kind.

    Raises:
        BalcliError: The target is missing; the error lists the nearest name, or some names.
    """
    if q.target in targets:
        return
    some = f"there are {', '.join(targets[:8])}" if targets else "there is none"
    hint = suggest_nearest(q.target, targets, some)
    raise BalcliError(f"{q.name}: the file has no {q.kind} {shorten(q.target)}; {hint}")
