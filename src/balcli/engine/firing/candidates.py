"""Engines that a file may mean, in a list to choose from."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ...core.loads import Loads, find_needed_series
from ...core.mechanisms.closed_form import select_cylinders
from ...core.phases import RPM, TURN, Phases
from ...core.phasors import Phasors
from ...file.firing_order import NamedOrder
from ...file.model import EngineFile
from ..devices import build_devices
from ..figures import place_in_plane
from ..layout import TOLERANCE_DEG, Cell, are_places_known, bank_angles, cycle_deg
from ..parts import Parts
from .fits import count_throws_from_first, find_missed, list_gaps
from .usual import Rows, list_numbers, write_rows


class Setting(NamedTuple):
    """A key of the file and a value that the user may give it.

    Attributes:
        path: Dotted name of the key.
        value: A number, or a list of numbers.
    """

    path: str
    value: float | Sequence[float]

    def apply(self, model: EngineFile) -> EngineFile:
        """Return the file with this value."""
        table, _, key = self.path.partition(".")
        return model.with_table(table, **{key: self.value})

    def __str__(self) -> str:
        if isinstance(self.value, (int, float)):
            return f"{self.path} = {self.value:g}"
        return f"{self.path} = [{join_numbers(self.value)}]"


def join_numbers(numbers: Iterable[float]) -> str:
    """Return numbers with commas between them."""
    return ", ".join(f"{number:.6g}" for number in numbers)


@dataclass(eq=False, repr=False)
class Candidate:
    """An engine that a file may mean.

    Attributes:
        model: The file with this numbering and these settings.
        place: Place of the numbering among the usual ones, from 0.
        settings: Further keys that the file needs to mean this engine.
        other_numberings: Other numberings that describe the same engine.
        letters_suffice: Whether the file means this engine if it keeps the letters in its firing
            order. If not, the list has the firing order in numbers.
    """

    model: EngineFile
    place: int = 0
    settings: tuple[Setting, ...] = ()
    other_numberings: list[Rows] = field(default_factory=list)
    letters_suffice: bool = True

    @cached_property
    def parts(self) -> Parts:
        """Stages of the engine."""
        return Parts(self.model)

    @property
    def numbering(self) -> Rows:
        """Numbers of the cylinders."""
        return list_numbers(self.parts.plan)

    def with_setting(self, path: str, value: float | Sequence[float]) -> Candidate:
        """Return the candidate with another value of a key."""
        setting = Setting(path, value)
        return Candidate(setting.apply(self.model), self.place, (*self.settings, setting))

    def fits(self, least_interval: float = 0.0) -> bool:
        """Return whether every cylinder is at its dead centre when it fires, and no firing follows
        the firing before it by less than `least_interval` deg, unless both fire together.
        """
        if find_missed(self.parts):
            return False
        apart = [gap for gap in list_gaps(self.parts) if gap > TOLERANCE_DEG]
        return min(apart) >= least_interval - TOLERANCE_DEG

    def is_same(self, other: Candidate) -> bool:
        """Return whether the firing angles of both engines differ by the same shift at all places
        (throw, bank), modulo the cycle if the file has gas, else modulo 360 deg.
        """
        turn = TURN if self.model.gas is None else cycle_deg(self.model.layout)
        shifts = other.fires_by_place - self.fires_by_place
        off = np.remainder(shifts - shifts[0] + turn / 2, turn) - turn / 2
        return bool(np.all(np.abs(off) <= TOLERANCE_DEG))

    @cached_property
    def fires_by_place(self) -> np.ndarray:
        """Firing angle of each cylinder, deg, in the order of the plan; 0 for dummies."""
        fires = self.parts.fires_deg
        return np.array([float(fires.get(cell.number, 0.0)) for cell in self.parts.plan.cells])

    # -------------------------------------------------------------- forces and moments
    @cached_property
    def balance(self) -> tuple[Phasors, Phasors]:
        """Free force (N) and moment (N m) of orders 1 and 2 at the speed of the file, with throws
        0.1 m apart if the file gives no positions.
        """
        model = self.model
        orders = np.array([1.0, 2.0])
        if not self._places_known:
            model = model.with_table("crank", spacing=100.0)
        parts = Parts(model)
        cylinders = parts.cylinders
        x, y, z = parts.places.reference
        needed = find_needed_series(cylinders, {"force", "moment"}, uneven=False)
        few, which = cylinders.find_distinct_harmonics(orders, needed)
        loads = Loads(
            cylinders,
            tuple(build_devices(parts)),
            place_in_plane(x, y),
            z,
            Phases(cylinders, orders),
            select_cylinders(few, which),
            (model.operation.speed * RPM) ** 2,
        )
        return loads.force.drop_noise(), loads.moment.drop_noise()

    @property
    def backward_share(self) -> float:
        """Size of the vector of order 1 that turns against the crank, divided by one cylinder's
        force of order 1. The force and the moment (divided by the engine length) have such a
        vector, and the larger counts; if the positions are not known, only that of the force.
        """
        force, moment = (float(abs(phasors.backward[0])) for phasors in self.balance)
        cylinders = self.parts.cylinders
        mass = max(float(each.reciprocating) for each in self.parts.weighed.values())
        radius = float(np.max(cylinders.radius))
        of_cylinder = mass * radius * (self.model.operation.speed * RPM) ** 2
        length = max(float(np.ptp(cylinders.z)), 2 * radius)
        largest = max(force, moment / length) if self._places_known else force
        return largest / (of_cylinder or np.inf)

    @property
    def _places_known(self) -> bool:
        return are_places_known(self.model, self.parts.plan)

    @property
    def rank(self) -> tuple[float, ...]:
        """Key for sorting engines: force and moment that counterweights cannot cancel, splay, and
        place of the numbering. With one rod on each throw, numbering along the crank comes before
        numbering bank by bank.
        """
        place = self.place  # 0: bank by bank, 1: along the crank
        if self.parts.plan.rods_on_throw == 1:
            place = {0: 1, 1: 0}.get(place, place)
        left = []
        for phasors in self.balance:
            size = float(abs(phasors.backward[0]) + phasors.major[1])
            left.append(float(f"{size:.6g}"))  # rounding errors must not decide
        return *left, abs(self.model.crank.splay), place

    # -------------------------------------------------------------- in words
    def describe(self) -> str:
        """Return the line for this engine in a list: keys to copy, throws, forces and moments."""
        force, moment = (" and ".join(map(_write_size, phasors.major)) for phasors in self.balance)
        moment = f"{moment} N m" if self._places_known else "not known"
        line = (
            f"{', '.join(self._list_keys())}: throws "
            f"{join_numbers(count_throws_from_first(self.parts))}; {self._describe_first()};"
            f" orders 1 and 2: force {force} N, moment {moment}"
        )
        if self.other_numberings:
            line += f"; the same engine: {' or '.join(map(write_rows, self.other_numberings))}"
        return line

    def _list_keys(self) -> list[str]:
        """Return the keys to copy into the file, each with its value."""
        layout = self.model.layout
        order = layout.firing_order
        named = isinstance(order, NamedOrder)
        in_numbers = named and not self.letters_suffice
        open_numbering = self.parts.plan.banks > 1 and not layout.has("numbering")
        keys = []
        if in_numbers:
            keys.append(f"layout.firing_order = {[*(order or ())]}")
        if open_numbering and (in_numbers or not named):
            keys.append(f"layout.numbering = {write_rows(self.numbering)}")
        return [*keys, *map(str, self.settings)]

    def _describe_first(self) -> str:
        """Return where cylinder 1 stands."""
        first = next(cell for cell in self.parts.plan.cells if cell.number == 1)
        order = self.model.layout.firing_order
        name = f"1 ({order.find_name(1)})" if isinstance(order, NamedOrder) else "1"
        return f"cylinder {name} on {self._describe_bank(first)}throw {first.throw + 1}"

    def _describe_bank(self, cell: Cell) -> str:
        """Return the bank of a cylinder, with a comma; empty if there is only one."""
        angles = bank_angles(self.model.layout, self.parts.figures)
        side = float(np.remainder(angles[cell.bank] + 180.0, 360.0)) - 180.0
        if len(angles) == 1:
            return ""
        if len(angles) > 2 or not side:
            return f"bank {cell.bank + 1}, "
        return f"the {'left' if side < 0 else 'right'} bank seen from the free end, "


def merge_same(candidates: Iterable[Candidate]) -> list[Candidate]:
    """Return one candidate for each different engine; it names the numberings of the others that
    need the same settings.
    """
    engines: list[Candidate] = []
    for candidate in candidates:
        twin = next(filter(candidate.is_same, engines), None)
        if twin is None:
            engines.append(candidate)
            continue
        named = (twin.numbering, *twin.other_numberings)
        if candidate.numbering not in named and candidate.settings == twin.settings:
            twin.other_numberings.append(candidate.numbering)
    return engines


def _write_size(value: float) -> str:
    """Return a force or moment with four significant digits, without an exponent."""
    return f"{float(f'{value:.4g}'):.12g}"
