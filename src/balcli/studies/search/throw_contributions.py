"""Forces and moments as sums over the throws: what each contributes at each angle it may take."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.cached_property import cached_property
from ...core.phasors import Array, Complex, Phasors
from ...engine.build import build
from ...engine.layout import plan_cylinders
from ...enginefile.model import EngineFile
from ...forces.quantity import Quantity
from ...forces.spectrum import compute_spectra, with_only

Key = tuple[str, float]  # name of a kind of force or moment, and order
ROUNDING = 1e-12  # sums below this share of the size of their parts are 0


@dataclass(frozen=True)
class Contributions:
    """Forward and backward vectors of one kind and order.

    Attributes:
        forward, backward: of every throw at every angle, shape (throws, angles).
        devices: forward and backward vector of the devices.
    """

    order: float
    forward: Complex
    backward: Complex
    devices: tuple[complex, complex]

    @cached_property
    def reach(self) -> Array:
        """The most by which each throw can change a vector, shape (throws,)."""
        most: Array = np.maximum(np.abs(self.forward), np.abs(self.backward)).max(axis=1)
        return most

    def add_throws(self, throws: Sequence[int], rows: NDArray[np.int8]) -> tuple[Complex, Complex]:
        """Sums over some throws at angles by their indices, shape (candidates, throws): forward and
        backward, shape (candidates,).
        """
        forward, backward = np.zeros(len(rows), complex), np.zeros(len(rows), complex)
        for throw, column in zip(throws, rows.T, strict=True):
            forward += self.forward[throw].take(column)
            backward += self.backward[throw].take(column)
        return forward, backward

    def read(self, quantity: Quantity, forward: Complex, backward: Complex) -> Array:
        """A quantity by the sums over all throws and the devices, shape (candidates,)."""
        noise = np.full((1, 1), ROUNDING * self.reach.sum())
        order = np.array([float(self.order)])
        return quantity.read_from(
            Phasors.of(order, forward[None], backward[None], noise).drop_noise()
        )


def tabulate_contributions(
    model: EngineFile, angles: Array, fixed: int, quantities: Collection[Quantity]
) -> dict[Key, Contributions]:
    """All kinds and orders that the quantities need; throw `fixed` (cylinder 1's) stands at 0, the
    others at any of `angles` (deg).
    """
    throw_of = {c.number: c.throw for c in plan_cylinders(model.crank, model.layout).cells}
    count = 1 + max(throw_of.values())
    paths = {f"crank.throws.{t + 1}": 0.0 if t == fixed else angles for t in range(count)}
    engine = build(model, paths)
    own_throw = np.array([throw_of[number] for number in engine.numbers])
    orders, kinds = sorted({q.order for q in quantities}), {q.kind for q in quantities}
    each = [
        compute_spectra(with_only(engine, own_throw == throw), orders, kinds)
        for throw in range(count)
    ]
    nothing = with_only(engine, own_throw < 0)
    devices = compute_spectra(replace(nothing, devices=engine.devices), orders, kinds)
    table = {}
    for q in quantities:
        row, throws, still = orders.index(q.order), [s[q.kind] for s in each], devices[q.kind]
        table[q.kind, q.order] = Contributions(
            q.order,
            np.stack([np.broadcast_to(p.forward[row], angles.shape) for p in throws]),
            np.stack([np.broadcast_to(p.backward[row], angles.shape) for p in throws]),
            (still.forward[row].flat[0], still.backward[row].flat[0]),
        )
    return table
