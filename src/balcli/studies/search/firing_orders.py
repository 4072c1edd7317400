"""Find the cranks that allow an even firing order, and all even firing orders of a crank.

An even firing order has a slot for each firing, at equal angles. Cylinders that reach top dead
centre at the same crank position form a group and can only fire in the slots at this position. A
crank allows an even firing order if every group has as many slots as cylinders; the cylinders of a
group may then fire in any sequence. Hence all results are constructed without trial and error.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice, permutations, product

import numpy as np

from ...core.phasors import Array
from ...core.records import Node
from ...engine.build import assemble
from ...engine.firing.fits import find_fitting_splay
from ...engine.layout import TOLERANCE_DEG, Cell, cycle_deg, plan_cylinders
from ...errors import BalcliError
from ...file.model import EngineFile
from ...limits import MOST_CYLINDERS_FIRED, MOST_EVEN_CRANKS
from ...process import Tell
from .designs import Found, Objective, drop_firing_order, rank_one_by_one, rank_throws
from .throws import count_from


@dataclass(frozen=True)
class Slots:
    """The firings of one cycle.

    Attributes:
        cells: Cylinders that fire.
        top: Angle of each cylinder's throw at its top dead centre, deg, by cylinder number.
        cycle: Length of a cycle, deg.
        sense: 1, or -1 if the cylinders turn about a crank at rest.
    """

    cells: tuple[Cell, ...]
    top: Mapping[int, float]
    cycle: float
    sense: int = 1

    @property
    def first(self) -> Cell:
        """Cylinder with which firing orders begin: the one with the lowest number that fires."""
        return min(self.cells, key=lambda cell: cell.number)

    def find_cranks(self) -> list[tuple[float, ...]]:
        """Return the throw angles of every crank that allows an even firing order; the throw of
        cylinder `first` is at 0.

        Raises:
            BalcliError: There are more than MOST_EVEN_CRANKS cranks.
        """
        first = self.first.throw
        others = {cell.throw for cell in self.cells} - {first}
        every = self._place_throws({}, [first, *others], Counter(self._slots))
        cranks = list(islice(every, MOST_EVEN_CRANKS + 1))
        if len(cranks) > MOST_EVEN_CRANKS:
            raise BalcliError(
                f"more than {MOST_EVEN_CRANKS} cranks of {len(self.cells)} cylinders have even "
                "firing orders; give crank.throws, or search over throws"
            )
        return cranks

    def _place_throws(
        self, throws: dict[int, float], free: Sequence[int], left: Counter[int]
    ) -> Iterator[tuple[float, ...]]:
        """Yield the throw angles of all cranks that agree with the angles in `throws`. Every throw
        in `free` is tried at each angle at which enough slots are left for all its cylinders.
        `left` counts the unused slots at each crank position.
        """
        if not free:
            yield tuple(throws[throw] for throw in sorted(throws))
            return
        cells = [cell for cell in self.cells if cell.throw == free[0]]
        angles = [0.0]
        if throws:
            lead = self.top[cells[0].number] - self.top[self.first.number]
            turns = [self.sense * 180.0 * slot / len(self.cells) for slot in sorted(left)]
            angles = [(lead - turn) % 360.0 for turn in turns]
        for angle in angles:
            taken = Counter(self._find_slot(cell, angle) for cell in cells)
            if taken <= left:
                yield from self._place_throws(throws | {free[0]: angle}, free[1:], left - taken)

    def find_orders(self, throws: Sequence[float]) -> Iterator[tuple[int, ...]]:
        """Yield all even firing orders of a crank, which begin with the cylinder `first`. Cylinders
        that reach top dead centre together take their slots in any sequence.
        """
        start = throws[self.first.throw]
        ready: dict[int, list[int]] = {slot: [] for slot in self._slots}
        for cell in self.cells:
            slot = self._find_slot(cell, throws[cell.throw] - start)
            ready.setdefault(slot, []).append(cell.number)
        counts = {slot: len(numbers) for slot, numbers in ready.items()}
        if counts != Counter(self._slots):
            return
        for chosen in product(*map(permutations, ready.values())):
            turns = dict(zip(ready, map(iter, chosen), strict=True))
            order = tuple(next(turns[slot]) for slot in self._slots)
            if order[0] == self.first.number:
                yield order

    @cached_property
    def _slots(self) -> list[int]:
        """Crank position at each firing, relative to the firing of `first`, modulo a turn. The unit
        is half a turn divided by the number of cylinders; positions are whole numbers.
        """
        half_turns = round(self.cycle / 180.0)
        return [half_turns * k % (2 * len(self.cells)) for k in range(len(self.cells))]

    def _find_slot(self, cell: Cell, throw: float) -> int:
        """Return the crank position (see `_slots`) at which a cylinder is at top dead centre; -1 if
        it has no slot there.
        """
        grain = 180.0 / len(self.cells)
        ready = self.sense * (self.top[cell.number] - self.top[self.first.number] - throw)
        nearest = round(ready / grain)
        slot = nearest % (2 * len(self.cells))
        fires = abs(ready - nearest * grain) <= TOLERANCE_DEG and slot in self._slots
        return slot if fires else -1


def find_slots(model: EngineFile) -> tuple[Slots, Array]:
    """Return the firings of a cycle, and the throw angles (deg, shape (cranks, throws)) of the
    cranks with even firing orders; the first throw is at 0.

    Raises:
        BalcliError: A cylinder has its own throw angle, there are too many cylinders, or there is
            no even firing order. The error names a splay that would make the file's order even.
    """
    layout = plan_cylinders(model)
    top_deg = assemble(model).pins.tops_deg
    if any(own.throw is not None for own in model.cylinder.values()):
        raise BalcliError(
            "cylinders with throw angles of their own have no firing order to search: give only "
            "crank.throws and splay"
        )
    at_throw = {}
    for cell in layout.cells:
        at_throw[cell.number] = float(top_deg[cell.number]) - cell.bank * model.crank.splay
    sense = -1 if model.layout.rotary else 1
    order = model.layout.firing_order or layout.numbers  # without dummies
    firing = tuple(cell for cell in layout.cells if cell.number in order)
    if len(firing) > MOST_CYLINDERS_FIRED:
        raise BalcliError(
            f"firing orders of {len(firing)} cylinders are too many to search; at most "
            f"{MOST_CYLINDERS_FIRED} cylinders are searched"
        )
    slots = Slots(firing, at_throw, cycle_deg(model.layout), sense)
    possible = [model.crank.throws] if model.crank.throws else slots.find_cranks()
    if not possible or next(slots.find_orders(possible[0]), None) is None:
        splay = find_fitting_splay(model.with_table("layout", firing_intervals=None))
        hint = "" if splay is None else f"; with split pins they allow one: crank.splay = {splay:g}"
        message = "crank.throws allow no even firing order, and only even ones are searched"
        raise BalcliError(message + hint)
    throws = np.array(possible)
    return slots, count_from(throws[:, :1], throws)


def search_firing_order(model: EngineFile, objective: Objective, tell: Tell) -> Iterator[Found]:
    """Yield the even firing orders with their cranks, best first."""
    slots, cranks = find_slots(model)
    if objective.is_sum_over_cylinders:
        for crank in rank_throws(drop_firing_order(model), cranks, objective):
            for order in slots.find_orders(crank.design["throws"]):
                yield replace(crank, design={"firing_order": [*order], **crank.design})
        return
    yield from rank_one_by_one(model, _list_designs(slots, cranks), objective, tell)


def _list_designs(slots: Slots, cranks: Array) -> Iterator[Node]:
    """Yield each even firing order of each crank."""
    for throws in cranks.tolist():
        for order in slots.find_orders(throws):
            yield {"firing_order": [*order], "throws": throws}
