"""Find out which bank a letter in a firing order means: "1R-6L-5R" has the banks R and L."""

from __future__ import annotations

from itertools import permutations

from ...file.firing_order import NamedOrder
from ...file.model import EngineFile
from ..layout import Plan
from .usual import number_groups


def list_lettered(model: EngineFile, plan: Plan) -> list[EngineFile]:
    """Return the file with its cylinders numbered bank by bank, for each way to give the letters of
    its firing order to the banks.

    Args:
        model: Engine file, whose firing order has letters.
        plan: Its cylinders.
    """
    order = model.layout.firing_order
    if not isinstance(order, NamedOrder):
        return []
    sizes = [len(group) for group in plan.groups]
    ways = (order.with_letters(letters) for letters in permutations(order.letters))
    return [
        model.with_inferred("layout", firing_order=way, numbering=number_groups(plan))
        for way in ways
        if way.bank_sizes == sizes
    ]


def describe_letters(order: NamedOrder) -> str:
    """Return which numbers the names of the cylinders stand for: "1R to 8R are 1 to 8"."""
    of_banks = []
    for letter in order.letters:
        numbers = sorted(
            number for number, name in zip(order, order.names, strict=True) if name.letter == letter
        )
        first = numbers[0]
        last = numbers[-1]
        names = f"{order.find_name(first)} to {order.find_name(last)} are {first} to {last}"
        of_banks.append(names if len(numbers) > 1 else f"{order.find_name(first)} is {first}")
    return ", ".join(of_banks)
