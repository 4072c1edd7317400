"""What sweep, search and scatter are about: single figures of an engine such as `force.2.major` or
`peak.moment`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.peaks import peak
from ..core.phasors import Phasors
from ..engine.build import Engine
from ..enginefile.fields import nearest
from ..errors import BalcliError
from ..limits import HIGHEST_ORDER
from .kinds import KINDS, VECTORS
from .spectrum import relevant_orders, spectra

PARTS = (
    "major",
    "minor",
    "forward",
    "backward",
    "axis",
    "x",
    "y",
    "x_cos",
    "x_sin",
    "y_cos",
    "y_sin",
)
SCALAR_PARTS = ("amplitude", "major", "cos", "sin")
Array = NDArray[np.float64]


@dataclass(frozen=True)
class Quantity:
    """`kind.order.part`, or `peak.kind` with order 0 and part "peak".

    Of a couple, torque or roll, and of force and moment along x or y, `cos` and `sin` are the parts
    of the value `cos cos n theta + sin sin n theta`: they have signs, and so has the mean of order
    0, which is its `cos`.
    """

    kind: str
    order: int
    part: str

    @property
    def name(self) -> str:
        return (
            f"peak.{self.kind}" if self.part == "peak" else f"{self.kind}.{self.order}.{self.part}"
        )

    @property
    def unit(self) -> str:
        return "deg" if self.part == "axis" else KINDS[self.kind].si_unit

    @property
    def signed(self) -> bool:
        """Whether it is one of two parts of a harmonic, which may be negative."""
        return self.part.endswith(("cos", "sin"))

    def of(self, phasors: Phasors) -> Array:
        """Its value by the phasors of its kind, shape (*trailing): sizes of vectors, amplitudes
        along x and y or their parts, degrees.
        """
        row = int(np.searchsorted(phasors.orders, self.order))
        only = slice(row, row + 1)
        column = (len(phasors.orders), *(1,) * (phasors.forward.ndim - 1))
        noise = np.broadcast_to(phasors.noise, np.broadcast_shapes(phasors.noise.shape, column))
        own = Phasors(
            phasors.orders[only], phasors.forward[only], phasors.backward[only], noise[only]
        )
        if self.signed:
            c = (own.y if self.part.startswith("y") else own.x)[0]
            return (c.real if self.part.endswith("cos") else -c.imag) + 0.0
        name = {"amplitude": "major", "axis": "axis_deg"}.get(self.part, self.part)
        value: Array = getattr(own, name)[0]
        return value if self.part in ("major", "minor", "axis", "amplitude") else np.abs(value)


def parse(text: str) -> tuple[Quantity, ...]:
    """`force.2.major,moment.1.backward,couple.4.amplitude,peak.force`.

    Raises:
        BalcliError: anything else, with what there is.
    """
    words = [word.strip() for word in text.split(",") if word.strip()]
    if not words:
        raise BalcliError(
            "no quantity is given; name some, such as force.2.major,moment.1.backward"
        )
    return tuple(dict.fromkeys(map(_parse, words)))


def _parse(text: str) -> Quantity:
    kind, _, rest = text.partition(".")
    if kind == "peak" and rest in (vector.name for vector in VECTORS):
        return Quantity(rest, 0, "peak")
    order, _, part = rest.partition(".")
    if kind not in KINDS:
        near = nearest(kind, (*KINDS, "peak"))
        raise BalcliError(
            f"{text} is no quantity: {f'did you mean {near}?' if near else 'it begins with'} "
            f"{'' if near else ', '.join(KINDS) + ' or peak'}".rstrip()
        )
    allowed = PARTS if KINDS[kind].vector else SCALAR_PARTS
    if not (order.isascii() and order.isdigit() and len(order) < 6 and int(order) <= HIGHEST_ORDER):
        raise BalcliError(
            f"{text} is no quantity: after {kind} comes a whole order up to {HIGHEST_ORDER}, as in "
            f"{kind}.2.{allowed[0]}"
        )
    if part not in allowed:
        raise BalcliError(
            f"{text} is no quantity: after the order comes one of {', '.join(allowed)}"
        )
    return Quantity(kind, int(order), part)


def evaluate(engine: Engine, quantities: Sequence[Quantity]) -> list[Array]:
    """The value of each quantity, shape (*trailing), length 1 along axes on which it does not
    depend.

    Only the orders that a kind is asked for are computed; kinds with the same orders share what
    they have in common.
    """
    found: dict[Quantity, Array] = {}
    for orders, members in _together(quantities):
        result = spectra(engine, orders, {q.kind for q in members})
        found |= {q: q.of(result[q.kind]) for q in members}
    peaks = [q for q in quantities if q.part == "peak"]
    if peaks:
        whole = spectra(engine, relevant_orders(engine), {q.kind for q in peaks})
        found |= {q: _peaks(whole[q.kind]) for q in peaks}
    return [found[q] for q in quantities]


def _together(quantities: Iterable[Quantity]) -> list[tuple[list[int], list[Quantity]]]:
    """Quantities whose kinds need the same orders."""
    by_kind: dict[str, list[Quantity]] = {}
    for q in quantities:
        if q.part != "peak":
            by_kind.setdefault(q.kind, []).append(q)
    groups: dict[tuple[int, ...], list[Quantity]] = {}
    for members in by_kind.values():
        groups.setdefault(tuple(sorted({q.order for q in members})), []).extend(members)
    return [(list(orders), members) for orders, members in groups.items()]


def _peaks(curves: Phasors) -> Array:
    """Largest value over a revolution of every variant, one after the other."""
    shape = np.broadcast_shapes(curves.forward.shape[1:], curves.backward.shape[1:])
    forward, backward = (
        np.broadcast_to(v, (len(curves.orders), *shape)) for v in (curves.forward, curves.backward)
    )
    values: Any = np.empty(shape)
    for at in np.ndindex(shape):
        values[at] = peak(
            Phasors(curves.orders, forward[:, *at], backward[:, *at], np.zeros(1))
        ).value
    return np.asarray(values)
