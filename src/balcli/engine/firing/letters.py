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
    numbering = number_groups(plan)
    models = []
    for letters in permutations(order.letters):
        way = order.with_letters(letters)
        if way.bank_sizes == sizes:
            models.append(model.with_inferred("layout", firing_order=way, numbering=numbering))
    return models


def describe_letters(order: NamedOrder) -> str:
    """Return which numbers the names of the cylinders stand for: "1R to 8R are 1 to 8"."""
    of_banks = []
    for letter in order.letters:
        numbers = order.list_bank(letter)
        first = numbers[0]
        last = numbers[-1]
        if first == last:
            of_banks.append(f"{order.find_name(first)} is {first}")
        else:
            names = f"{order.find_name(first)} to {order.find_name(last)}"
            of_banks.append(f"{names} are {first} to {last}")
    return ", ".join(of_banks)
