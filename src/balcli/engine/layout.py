"""Which cylinders an engine has: banks x throws -> numbered cylinders."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ..core.phases import TURN
from ..core.phasors import Figure
from ..enginefile.fields import counted
from ..enginefile.model import Crank, Layout
from ..errors import InputError, Problem
from ..limits import MOST_PARTS
from .figures import FileFigures


class Cell(NamedTuple):
    """One cylinder: on which bank and which throw (from 0), and its number."""

    bank: int
    throw: int
    number: int


class Plan(NamedTuple):
    """All cylinders.

    Attributes:
        banks: how many there are.
        throws: how many the crank has.
        cells: the cylinders, sorted by bank and throw.
        rods_on_throw: how many each throw carries.
    """

    banks: int
    throws: int
    cells: tuple[Cell, ...]
    rods_on_throw: int

    @property
    def numbers(self) -> tuple[int, ...]:
        return tuple(cell.number for cell in self.cells)


def plan_cylinders(crank: Crank, layout: Layout) -> Plan:
    """The cylinders of an engine.

    Raises:
        InputError: all of: positions, numbering or firing order that do not fit the throws and
        banks.
    """
    banks = count_banks(layout)
    shared = layout.rods == "shared" or banks == 1
    throws = _count_throws(crank, layout, banks if shared else 1)
    _refuse_too_many(throws, banks, shared)
    all_places = ((bank, throw) for bank in range(banks) for throw in range(throws))
    places = [(bank, throw) for bank, throw in all_places if shared or throw % banks == bank]
    numbers, problems = _number_cylinders(layout, places, banks)
    problems += _check_positions(crank, throws)
    if not shared and throws < banks:
        problems.append(
            Problem(
                "layout.rods",
                f'"alternating" gives every throw one rod, but there are {banks} banks and only '
                f'{counted(throws, "throw")}: give more throws, or "shared"',
            )
        )
    problems += _check_firing_order(layout, sorted(numbers), throws)
    if problems:
        raise InputError(problems)
    cells = tuple(Cell(*place, number) for place, number in zip(places, numbers, strict=True))
    return Plan(banks, throws, cells, banks if shared else 1)


def count_banks(layout: Layout) -> int:
    """How many banks there are."""
    if layout.bank_angle is not None:
        return 2
    return layout.radial or len(layout.banks or (0.0,))


def bank_angles(layout: Layout, figures: FileFigures) -> tuple[Figure, ...]:
    """Angle of each bank from x, deg: a vee lies symmetrical to x, a radial begins on it."""
    angle = figures.take_optional("layout.bank_angle", layout.bank_angle)
    if angle is not None:
        return -angle / 2, angle / 2
    if layout.radial is not None:
        return tuple(TURN * k / layout.radial for k in range(layout.radial))
    return figures.take_each("layout.banks", layout.banks or (0.0,))


def cycle_deg(layout: Layout) -> float:
    """Degrees from one firing of a cylinder to its next."""
    return TURN * layout.strokes / 2


def _count_throws(crank: Crank, layout: Layout, rods: int) -> int:
    """Number of throws, with so many rods on each: given, or as the firing order needs it."""
    if crank.throws is not None:
        return len(crank.throws)
    cylinders = len(layout.firing_order or ())
    if cylinders % rods:
        message = (
            f"has {cylinders} cylinders, which {rods} banks cannot share evenly: "
            f"give crank.throws, or a multiple of {rods} cylinders"
        )
        raise InputError([Problem("layout.firing_order", message)])
    return max(cylinders // rods, 1)


def _refuse_too_many(throws: int, banks: int, shared: bool) -> None:
    """Banks x throws of a short file can be more cylinders than there is memory for."""
    if max(banks, throws, throws * banks * shared) <= MOST_PARTS:
        return
    message = (
        f"{counted(banks, 'bank')} on {counted(throws, 'throw')} are too many; "
        f"no engine has more than {MOST_PARTS} cylinders"
    )
    raise InputError([Problem("layout" if banks > 1 else "crank.throws", message)])


def _check_positions(crank: Crank, throws: int) -> Iterator[Problem]:
    if crank.positions is not None and len(crank.positions) != throws:
        yield Problem(
            "crank.positions",
            f"has {counted(len(crank.positions), 'value')} for {counted(throws, 'throw')}: "
            "give one position a throw",
        )


def _number_cylinders(
    layout: Layout, places: Sequence[tuple[int, int]], banks: int
) -> tuple[list[int], list[Problem]]:
    """Number of the cylinder at each place (bank, throw), as given for each bank or counted
    through; and what is wrong with those given.
    """
    default = list(range(1, len(places) + 1))
    if layout.numbering is None:
        return default, []
    on_bank = Counter(bank for bank, _ in places)
    sizes = [on_bank[bank] for bank in range(banks)]
    given = [len(row) for row in layout.numbering]
    if given != sizes:
        message = (
            f"has rows of {_join(given)}, but the banks have {_join(sizes)} cylinders: "
            "give one row a bank, from the free end to the flywheel end"
        )
        return default, [Problem("layout.numbering", message)]
    numbers = [number for row in layout.numbering for number in row]
    if sorted(numbers) != default:
        return default, [Problem("layout.numbering", _describe_not_once(numbers, default))]
    return numbers, []


def _check_firing_order(layout: Layout, numbers: Sequence[int], throws: int) -> Iterator[Problem]:
    """Every cylinder stands in the firing order once; where that has one for each throw, and banks
    share the throws, the mistake says how they do not.
    """
    order = layout.firing_order
    if order is None or sorted(order) == numbers:
        return
    told = _describe_not_once(order, numbers)
    banks = count_banks(layout)
    if 1 < banks <= throws == len(order) and layout.rods == "shared":
        told += (
            f"; every throw carries a rod of each of the {banks} banks: if they take the throws in "
            'turn, as in a boxer, say layout.rods = "alternating"'
        )
    yield Problem("layout.firing_order", told)


def _describe_not_once(given: Sequence[int], wanted: Sequence[int]) -> str:
    """Which of the numbers wanted are missing or doubled, and which are unknown."""
    times = Counter(given)
    doubled = [n for n in sorted(times) if times[n] > 1 and n in wanted]
    parts = [f"cylinder {n} stands {times[n]} times" for n in doubled]
    parts += [f"there is no cylinder {n}" for n in sorted(times) if n not in wanted]
    missing = [n for n in wanted if n not in times]
    if len(missing) == 1:
        parts.append(f"cylinder {missing[0]} is missing")
    elif missing:
        parts.append(f"cylinders {_join(missing)} are missing")
    return f"{', '.join(parts)}: each of the cylinders 1 to {len(wanted)} must stand once"


def _join(numbers: Sequence[int]) -> str:
    """`1 and 2`, `1, 2, 3`."""
    return " and ".join(map(str, numbers)) if len(numbers) < 3 else ", ".join(map(str, numbers))
