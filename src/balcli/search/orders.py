"""Firing orders, slot by slot: all that the crank allows, or all with the cranks that they ask for."""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice

from ..errors import BalcliError
from ..firing import TOLERANCE
from ..layout import Cell

MOST = 200_000
MOST_CYLINDERS = 64


@dataclass(frozen=True)
class Firing:
    """A firing order, and the angle of every throw with it (deg, cylinder 1's at its own)."""

    order: tuple[int, ...]
    throws: tuple[float, ...]


@dataclass(frozen=True)
class Slots:
    """What a firing order is found for.

    Attributes:
        cells: the cylinders.
        top: axis and angle of top dead centre by cylinder, deg (its crank pin at the moment of firing, but for the slot).
        lead: of each cylinder's pin over its throw, deg.
        throws: the throws given, or None.
        cycle: deg.
    """

    cells: tuple[Cell, ...]
    top: dict[int, float]
    lead: dict[int, float]
    throws: tuple[float, ...] | None
    cycle: float

    def orders(self) -> list[Firing]:
        """All even firing orders that begin with cylinder 1.

        Raises:
            BalcliError: more than MOST, or too many cylinders to look for them.
        """
        if len(self.cells) > MOST_CYLINDERS:
            raise BalcliError(f"{len(self.cells)} cylinders are too many to look for firing orders; up to {MOST_CYLINDERS} are allowed")
        first = next(c for c in self.cells if c.number == 1)
        start = self.top[1] - self.lead[1]                                  # throw of cylinder 1, pointing along its axis
        given = dict(enumerate(t - self.throws[first.throw] + start for t in self.throws)) if self.throws else {first.throw: start}
        found = list(islice(self._continued((1,), given), MOST + 1))
        if len(found) > MOST:
            raise BalcliError(f"there are more than {MOST} firing orders for {len(self.cells)} cylinders; "
                              "give crank.throws, or search over throws")
        return found

    def _continued(self, order: tuple[int, ...], throws: dict[int, float]) -> Iterator[Firing]:
        if len(order) == len(self.cells):
            yield Firing(order, tuple(throws[t] for t in sorted(throws)))
            return
        turn = self.cycle * len(order) / len(self.cells)                    # since cylinder 1 fired
        for cell in self.cells:
            if cell.number in order:
                continue
            wanted = self.top[cell.number] - self.lead[cell.number] - turn
            if cell.throw not in throws:
                yield from self._continued((*order, cell.number), throws | {cell.throw: wanted % 360.0})
            elif abs((wanted - throws[cell.throw] + 180.0) % 360.0 - 180.0) <= TOLERANCE:
                yield from self._continued((*order, cell.number), throws)
