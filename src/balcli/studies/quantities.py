"""Quantities that a user asks for: of the engine (`force.2.major`), or of it on its mounts
(`mode.roll.Hz`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..errors import BalcliError
from ..forces.quantity import Quantity, parse_quantity_list

if TYPE_CHECKING:
    from ..mounting.quantity import MountQuantity

_OF_MOUNTS = ("mode", "mount", "point")  # their beginnings


def parse_quantities(text: str) -> tuple[Quantity | MountQuantity, ...]:
    """All that are named, in this order, each once.

    Raises:
        BalcliError: what is none, with what there is.
    """
    words = [word.strip() for word in text.split(",") if word.strip()]
    on_mounts = [word for word in words if word.partition(".")[0] in _OF_MOUNTS]
    if not on_mounts:
        return parse_quantity_list(text)
    from ..mounting.quantity import parse_mount_quantity

    found = [
        parse_mount_quantity(word) if word in on_mounts else parse_quantity_list(word)[0]
        for word in words
    ]
    return tuple(dict.fromkeys(found))


def part_quantities(
    wanted: Sequence[Quantity | MountQuantity],
) -> tuple[tuple[Quantity, ...], tuple[MountQuantity, ...]]:
    """Those of the engine, and those of it on its mounts.

    Raises:
        BalcliError: there are both.
    """
    of_engine = tuple(q for q in wanted if isinstance(q, Quantity))
    on_mounts = tuple(q for q in wanted if not isinstance(q, Quantity))
    if of_engine and on_mounts:
        raise BalcliError(
            f"{of_engine[0].name} and {on_mounts[0].name} have tolerances of their own; ask for "
            "quantities of the engine and of its mounts one after the other"
        )
    return of_engine, on_mounts
