"""List the usual numberings of an engine's cylinders."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain

from ..layout import Cell, Plan

Rows = tuple[tuple[int, ...], ...]  # cylinder numbers in the lists of layout.numbering


def list_tiers(plan: Plan, *, radial: bool) -> Iterator[list[Rows]]:
    """Yield the usual numberings of an engine, tier by tier, the most usual first.

    Args:
        plan: Banks and throws.
        radial: Whether the banks are evenly spaced round the crank.
    """
    bank_by_bank = number_groups(plan)
    if plan.in_rows:
        yield [bank_by_bank]
        yield [_number_rows(plan, plan.cells)]  # round the engine, from row to row
    elif radial:
        yield [bank_by_bank, (bank_by_bank[0], *reversed(bank_by_bank[1:]))]
    elif plan.banks > 2:
        from_last_bank = sorted(plan.cells, key=lambda cell: (cell.throw, -cell.bank))
        yield [bank_by_bank, _number_along(plan), _number_rows(plan, from_last_bank)]
    else:
        yield from _list_tiers_of_two_banks(plan)


def _list_tiers_of_two_banks(plan: Plan) -> Iterator[list[Rows]]:
    """Yield the usual numberings of an engine with two banks. Only equal banks are exchanged."""
    usual = [number_groups(plan), _number_along(plan)]
    exchanged: list[Rows] = []
    second_backwards: list[Rows] = []
    first_backwards: list[Rows] = []
    both_backwards: list[Rows] = []
    of_exchanged: list[Rows] = []
    for first, second in usual:
        second_backwards.append((first, second[::-1]))
        both_backwards.append((first[::-1], second[::-1]))
        if len(first) == len(second):
            exchanged.append((second, first))
            first_backwards.append((second[::-1], first))
            of_exchanged.append((second[::-1], first[::-1]))
    if plan.rods_on_throw > 1:
        yield [*usual, *exchanged]
        yield [*second_backwards, *first_backwards]
    else:
        yield usual
        yield [*second_backwards, *first_backwards, *exchanged]
    yield [*both_backwards, *of_exchanged]


def number_groups(plan: Plan) -> Rows:
    """Return the numbering bank by bank; in a radial in rows, row by row."""
    return _number_rows(plan, chain(*plan.groups))


def _number_along(plan: Plan) -> Rows:
    """Return the numbering along the crank, from throw to throw."""
    return _number_rows(plan, sorted(plan.cells, key=lambda cell: (cell.throw, cell.bank)))


def _number_rows(plan: Plan, cells: Iterable[Cell]) -> Rows:
    """Return the numbering in which the cells are counted in this order."""
    numbers = {cell: number for number, cell in enumerate(cells, 1)}
    groups = []
    for group in plan.groups:
        groups.append(tuple(numbers[cell] for cell in group))
    return tuple(groups)


def list_numbers(plan: Plan) -> Rows:
    """Return the numbers of the cylinders as `layout.numbering` lists them."""
    groups = []
    for group in plan.groups:
        groups.append(tuple(cell.number for cell in group))
    return tuple(groups)


def write_rows(rows: Sequence[Sequence[int]]) -> str:
    """Return a numbering in the form that a file has."""
    return str([list(row) for row in rows])
