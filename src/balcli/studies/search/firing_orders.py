"""Even firing orders: the cranks that allow one, and all that a crank allows.

Cylinders whose crank pins stand alike, seen from their own axes, reach top dead centre together and
share the slots of the cycle in which this happens. A crank allows an even firing order if there are
as many slots as cylinders of each kind, and then any cylinder of its kind may take a slot: neither
cranks nor orders have to be tried in vain.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import islice

from ...engine.firing import TOLERANCE_DEG
from ...engine.layout import Cell
from ...errors import BalcliError
from ...limits import MOST_CYLINDERS_FIRED, MOST_EVEN_CRANKS


@dataclass(frozen=True)
class Slots:
    """The firings of one cycle; BalcliError for too many cylinders to look for their orders.

    Attributes:
        cells: the cylinders.
        top: what the pin of each cylinder stands at when it is at top dead centre, less its lead
        over its throw, deg, by number.
        cycle: deg.
        sense: -1 where the cylinders turn and the pins stand still.
    """

    cells: tuple[Cell, ...]
    top: Mapping[int, float]
    cycle: float
    sense: int = 1

    def __post_init__(self) -> None:
        if len(self.cells) > MOST_CYLINDERS_FIRED:
            raise BalcliError(
                f"{len(self.cells)} cylinders are too many to look for firing orders; up to "
                f"{MOST_CYLINDERS_FIRED} are allowed"
            )

    def cranks(self) -> list[tuple[float, ...]]:
        """The angles of all throws, for every crank that allows an even firing order; cylinder 1's
        throw at 0.

        Raises:
            BalcliError: more than MOST_EVEN_CRANKS.
        """
        fixed = next(c.throw for c in self.cells if c.number == 1)
        found = list(
            islice(
                self._cranks(
                    {}, [fixed, *({c.throw for c in self.cells} - {fixed})], Counter(self._slots)
                ),
                MOST_EVEN_CRANKS + 1,
            )
        )
        if len(found) > MOST_EVEN_CRANKS:
            raise BalcliError(
                f"more than {MOST_EVEN_CRANKS} cranks of {len(self.cells)} cylinders have even "
                "firing orders; give crank.throws, or search over throws"
            )
        return found

    def _cranks(
        self, throws: dict[int, float], free: Sequence[int], left: Counter[float]
    ) -> Iterator[tuple[float, ...]]:
        """With the further throws at every angle at which there are slots left for all their
        cylinders.
        """
        if not free:
            yield tuple(throws[t] for t in sorted(throws))
            return
        cells = [c for c in self.cells if c.throw == free[0]]
        for slot in sorted(left) if throws else [0.0]:
            angle = (
                (self.top[cells[0].number] - self.top[1] - self.sense * slot) % 360.0
                if throws
                else 0.0
            )
            taken = Counter(self._slot(c, angle) for c in cells)
            if all(left[kind] >= count for kind, count in taken.items()):
                yield from self._cranks(throws | {free[0]: angle}, free[1:], left - taken)

    def orders(self, throws: Sequence[float]) -> Iterator[tuple[int, ...]]:
        """All even firing orders of a crank that begin with cylinder 1."""
        start = throws[next(c.throw for c in self.cells if c.number == 1)]
        kinds = {c.number: self._slot(c, throws[c.throw] - start) for c in self.cells}
        if Counter(kinds.values()) == Counter(self._slots):
            yield from self._orders((1,), kinds)

    def _orders(
        self, order: tuple[int, ...], kinds: Mapping[int, float]
    ) -> Iterator[tuple[int, ...]]:
        if len(order) == len(self.cells):
            yield order
            return
        for number, kind in kinds.items():
            if kind == self._slots[len(order)] and number not in order:
                yield from self._orders((*order, number), kinds)

    @cached_property
    def _slots(self) -> list[float]:
        """Where the crank stands at each firing, after cylinder 1's, deg; alike ones are equal."""
        return [round(self.cycle * k / len(self.cells), 9) % 360.0 for k in range(len(self.cells))]

    def _slot(self, cell: Cell, throw: float) -> float:
        """Where the crank stands when this cylinder is at top dead centre; nan if nothing fires
        there.
        """
        ready = self.sense * (self.top[cell.number] - self.top[1] - throw)
        return next(
            (
                slot
                for slot in self._slots
                if abs((ready - slot + 180.0) % 360.0 - 180.0) <= TOLERANCE_DEG
            ),
            math.nan,
        )
