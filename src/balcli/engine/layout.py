"""Which cylinders an engine has: banks x throws -> numbered cylinders, and their crank pins.

Angles are degrees and positions mm, as in the file; any of them may be an array of variants.
"""

from __future__ import annotations

from collections import Counter
from itertools import count
from typing import Any, NamedTuple

from ..enginefile.fields import counted
from ..enginefile.model import Crank, Layout
from ..errors import InputError, Problem
from ..limits import MOST_PARTS

TURN = 360.0


class Cell(NamedTuple):
    """One cylinder: on which bank and which throw (from 0), and its number."""

    bank: int
    throw: int
    number: int


class Plan(NamedTuple):
    """All cylinders, sorted by bank and throw."""

    banks: tuple[Any, ...]  # angle of each bank, deg
    throws: int
    cells: tuple[Cell, ...]
    rods_on_throw: int

    @property
    def numbers(self) -> tuple[int, ...]:
        return tuple(cell.number for cell in self.cells)


def plan(crank: Crank, layout: Layout) -> Plan:
    """The cylinders of an engine.

    Raises:
        InputError: all of: positions, numbering or firing order that do not fit the throws and
        banks.
    """
    banks = bank_angles(layout)
    shared = layout.rods == "shared" or len(banks) == 1
    throws, problems = _throws(crank, layout, len(banks) if shared else 1)
    problems = problems or _too_many(throws, len(banks), shared)
    if problems:  # all else counts throws
        raise InputError(problems)
    places = [
        (b, t) for b in range(len(banks)) for t in range(throws) if shared or t % len(banks) == b
    ]
    numbers, misnumbered = _numbers(layout, places, len(banks))
    problems += misnumbered + _positions(crank, throws)
    if not shared and throws < len(banks):
        problems.append(
            Problem(
                "layout.rods",
                f'"alternating" gives every throw one rod, but there are {len(banks)} banks and '
                "only "
                f'{counted(throws, "throw")}: give more throws, or "shared"',
            )
        )
    problems += _firing(layout, sorted(numbers))
    if problems:
        raise InputError(problems)
    cells = tuple(Cell(b, t, number) for (b, t), number in zip(places, numbers, strict=True))
    return Plan(banks, throws, cells, len(banks) if shared else 1)


def bank_angles(layout: Layout) -> tuple[Any, ...]:
    """Angle of each bank from x: a vee lies symmetrical to x, a radial begins on it."""
    if layout.bank_angle is not None:
        return -layout.bank_angle / 2, layout.bank_angle / 2
    if layout.radial is not None:
        return tuple(TURN * k / layout.radial for k in range(layout.radial))
    return tuple(layout.banks) if layout.banks is not None else (0.0,)


def cycle(layout: Layout) -> float:
    """Degrees from one firing of a cylinder to its next."""
    return TURN * layout.strokes / 2


def _throws(crank: Crank, layout: Layout, rods: int) -> tuple[int, list[Problem]]:
    """Number of throws: those given, or as many as the firing order needs."""
    if crank.throws is not None:
        return len(crank.throws), []
    cylinders = len(layout.firing_order or ())
    if cylinders % rods:
        return 1, [
            Problem(
                "layout.firing_order",
                f"has {cylinders} cylinders, which {rods} banks cannot share evenly: "
                f"give crank.throws, or a multiple of {rods} cylinders",
            )
        ]
    return max(cylinders // rods, 1), []


def _too_many(throws: int, banks: int, shared: bool) -> list[Problem]:
    """Banks x throws of a short file can be more cylinders than there is memory for."""
    if max(banks, throws, throws * banks * shared) <= MOST_PARTS:
        return []
    return [
        Problem(
            "layout" if banks > 1 else "crank.throws",
            f"{counted(banks, 'bank')} on {counted(throws, 'throw')} are too many; "
            f"no engine has more than {MOST_PARTS} cylinders",
        )
    ]


def _positions(crank: Crank, throws: int) -> list[Problem]:
    if crank.positions is None or len(crank.positions) == throws:
        return []
    return [
        Problem(
            "crank.positions",
            f"has {counted(len(crank.positions), 'value')} for {counted(throws, 'throw')}: "
            "give one position a throw",
        )
    ]


def _numbers(
    layout: Layout, places: list[tuple[int, int]], banks: int
) -> tuple[list[int], list[Problem]]:
    """Number of the cylinder at each place, as given per bank or counted through."""
    default = [number for number, _ in zip(count(1), places, strict=False)]
    if layout.numbering is None:
        return default, []
    sizes = [sum(b == bank for b, _ in places) for bank in range(banks)]
    found = [len(row) for row in layout.numbering]
    if found != sizes:
        return default, [
            Problem(
                "layout.numbering",
                f"has rows of {_words(found)}, but the banks have {_words(sizes)} cylinders: "
                "give one row a bank, from the free end to the flywheel end",
            )
        ]
    numbers = [number for row in layout.numbering for number in row]
    if sorted(numbers) != default:
        return default, [Problem("layout.numbering", _not_once(numbers, default))]
    return numbers, []


def _firing(layout: Layout, numbers: list[int]) -> list[Problem]:
    if layout.firing_order is None or sorted(layout.firing_order) == numbers:
        return []
    return [Problem("layout.firing_order", _not_once(list(layout.firing_order), numbers))]


def _not_once(found: list[int], wanted: list[int]) -> str:
    """Which numbers are missing, doubled or unknown."""
    times = Counter(found)
    parts = [
        f"cylinder {n} stands {times[n]} times"
        for n in sorted(times)
        if times[n] > 1 and n in wanted
    ]
    parts += [f"there is no cylinder {n}" for n in sorted(times) if n not in wanted]
    if missing := [n for n in wanted if n not in times]:
        parts.append(
            f"cylinder {_words(missing)} is missing"
            if len(missing) == 1
            else f"cylinders {_words(missing)} are missing"
        )
    return f"{', '.join(parts)}: each of the cylinders 1 to {len(wanted)} must stand once"


def _words(numbers: list[int]) -> str:
    return " and ".join(map(str, numbers)) if len(numbers) < 3 else ", ".join(map(str, numbers))
