"""Quantities that a user asks for: of the engine (`force.2.major`), of it on its mounts
(`mode.roll.Hz`), of its crankshaft that twists (`torsion.1.Hz`), or of its gas (`torque.mean`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ..errors import BalcliError
from ..forces.quantity import Quantity, parse_quantity_list

if TYPE_CHECKING:
    from ..mounting.quantity import MountQuantity
    from ..torque.quantity import TorqueQuantity
    from ..torsion.quantity import TorsionQuantity

    AnyQuantity = Quantity | MountQuantity | TorsionQuantity | TorqueQuantity

_OF_MOUNTS = ("mode", "mount", "point")  # beginnings of their names
_OF_TORSION = ("torsion", "shaft")
_OF_GAS = ("gas", "torque_total", "roll_total", "fluctuation")


def parse_quantities(text: str, *, with_gas: bool = False) -> tuple[AnyQuantity, ...]:
    """All that are named, in this order, each once.

    Args:
        with_gas: whether the engine has gas: its `torque` is then that of gas and inertia.

    Raises:
        BalcliError: what is none, with what there is.
    """
    words = [word.strip() for word in text.split(",") if word.strip()]
    of_gas = (*_OF_GAS, "torque") if with_gas else _OF_GAS
    if not any(_begin(word) in (*_OF_MOUNTS, *_OF_TORSION, *of_gas) for word in words):
        return parse_quantity_list(text)
    return tuple(dict.fromkeys(_parse_quantity(word, of_gas) for word in words))


def _begin(name: str) -> str:
    """What the name of a quantity begins with: its kind."""
    return name.partition(".")[0]


def _parse_quantity(word: str, of_gas: Sequence[str]) -> AnyQuantity:
    if _begin(word) in _OF_MOUNTS:
        from ..mounting.quantity import parse_mount_quantity  # for those who ask for it

        return parse_mount_quantity(word)
    if _begin(word) in _OF_TORSION:
        from ..torsion.quantity import parse_torsion_quantity

        return parse_torsion_quantity(word)
    if _begin(word) in of_gas:
        from ..torque.quantity import parse_torque_quantity

        return parse_torque_quantity(word)
    return parse_quantity_list(word)[0]


def choose_of_engine(wanted: Sequence[AnyQuantity]) -> tuple[Quantity, ...]:
    """Those of forces and moments."""
    return tuple(q for q in wanted if isinstance(q, Quantity))


def choose_of_mounts(wanted: Sequence[AnyQuantity]) -> tuple[MountQuantity, ...]:
    """Those of the engine on its mounts."""
    found = [q for q in wanted if _begin(q.name) in _OF_MOUNTS]
    return tuple(found)  # type: ignore[arg-type]


def choose_of_torsion(wanted: Sequence[AnyQuantity]) -> tuple[TorsionQuantity, ...]:
    """Those of the crankshaft that twists."""
    found = [q for q in wanted if _begin(q.name) in _OF_TORSION]
    return tuple(found)  # type: ignore[arg-type]


def choose_of_torque(wanted: Sequence[AnyQuantity]) -> tuple[TorqueQuantity, ...]:
    """Those of an engine with gas."""
    others = (*choose_of_engine(wanted), *choose_of_mounts(wanted), *choose_of_torsion(wanted))
    found = [q for q in wanted if q not in others]
    return tuple(found)  # type: ignore[arg-type]


def part_quantities(
    wanted: Sequence[AnyQuantity],
) -> tuple[tuple[Quantity, ...], tuple[MountQuantity, ...]]:
    """Those of the engine, or those of it on its mounts: what scatters.

    Raises:
        BalcliError: there are both, or others.
    """
    of_engine, on_mounts = choose_of_engine(wanted), choose_of_mounts(wanted)
    others = [q.name for q in choose_of_torsion(wanted)]
    others += [q.name for q in choose_of_torque(wanted)]
    if others:
        raise BalcliError(f"{others[0]} has no scatter; vary single figures with sweep")
    if of_engine and on_mounts:
        raise BalcliError(
            f"{of_engine[0].name} and {on_mounts[0].name} have tolerances of their own; ask for "
            "quantities of the engine and of its mounts one after the other"
        )
    return of_engine, on_mounts
