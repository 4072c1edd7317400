"""Forces and moments as sums over the throws: what each throw contributes at each angle that it may
take.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...core.phasors import Phasors
from ...engine.build import build
from ...engine.layout import plan_cylinders
from ...enginefile.model import EngineFile
from ...forces.quantity import Quantity
from ...forces.spectrum import spectra, with_only

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Key = tuple[str, int]  # kind (force, moment ...) and order
ROUNDING = 1e-12  # sums below this share of the size of their parts are 0


@dataclass(frozen=True)
class Share:
    """Forward and backward vectors of one kind and order: of every throw, shape (throws, angles),
    and of the devices.
    """

    order: int
    forward: Complex
    backward: Complex
    devices: tuple[complex, complex]

    @property
    def reach(self) -> Array:
        """The most by which each throw can change a vector, shape (throws,)."""
        most: Array = np.maximum(np.abs(self.forward), np.abs(self.backward)).max(axis=1)
        return most

    def sums(self, throws: Sequence[int], rows: NDArray[np.int8]) -> tuple[Complex, Complex]:
        """Of some throws at angles by their indices, shape (candidates, throws): shape
        (candidates,) each.
        """
        forward, backward = (np.zeros(len(rows), complex) for _ in range(2))
        for throw, column in zip(throws, rows.T, strict=True):
            forward += self.forward[throw].take(column)
            backward += self.backward[throw].take(column)
        return forward, backward

    def value(self, quantity: Quantity, forward: Complex, backward: Complex) -> Array:
        """A quantity by the sums of all throws and the devices."""
        noise = np.full((1, 1), ROUNDING * self.reach.sum())
        return quantity.of(
            Phasors(np.array([float(self.order)]), forward[None], backward[None], noise).settled()
        )


def shares(
    file: EngineFile, angles: Array, fixed: int, quantities: Collection[Quantity]
) -> dict[Key, Share]:
    """All kinds and orders that the quantities need; throw `fixed` (cylinder 1's) stands at 0, the
    others at any of `angles`.
    """
    cells = plan_cylinders(file.crank, file.layout).cells
    throw_of = {cell.number: cell.throw for cell in cells}
    count = 1 + max(throw_of.values())
    engine = build(
        file, {f"crank.throws.{t + 1}": 0.0 if t == fixed else angles for t in range(count)}
    )
    orders, kinds = sorted({q.order for q in quantities}), {q.kind for q in quantities}
    each = [
        spectra(with_only(engine, [throw_of[n] == t for n in engine.numbers]), orders, kinds)
        for t in range(count)
    ]
    devices = spectra(
        replace(with_only(engine, [False] * len(engine.numbers)), devices=engine.devices),
        orders,
        kinds,
    )

    def share(kind: str, order: int) -> Share:
        row, still = orders.index(order), devices[kind]

        def table(way: str) -> Complex:
            return np.stack(
                [np.broadcast_to(getattr(s[kind], way)[row], angles.shape) for s in each]
            )

        return Share(
            order,
            table("forward"),
            table("backward"),
            (still.forward[row].flat[0], still.backward[row].flat[0]),
        )

    return {(q.kind, q.order): share(q.kind, q.order) for q in quantities}
