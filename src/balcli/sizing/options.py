"""What a user may ask of a scheme, and which scheme takes which of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ..engine.build import Engine
from ..engine.positions import MOMENTS_UNKNOWN
from ..errors import BalcliError
from ..limits import HIGHEST_ORDER_SOUGHT, HIGHEST_SHAFT_ORDER
from .effects import Rest, rest
from .schemes import KNUCKLES, NAMES, SCHEMES


class NoNeedError(Exception):
    """There is nothing to balance, as its text says: a scheme then fits no device."""


class Wish(NamedTuple):
    """Options of the schemes; what is None was not asked for. Lengths in m.

    Attributes:
        order: the order that is to be balanced.
        at: places x + iy of shafts or sliders; of a pair, first the one that turns against the
        crank.
        position: z of new shafts.
        planes: "ends", "throws", or places along z.
        factor: shares of the reciprocating mass.
        roll: "zero": the second shaft is placed such that the roll of this order vanishes, too.
    """

    order: int | None = None
    at: tuple[complex, ...] | None = None
    position: float | None = None
    planes: str | tuple[float, ...] | None = None
    factor: tuple[float, ...] | None = None
    roll: str | None = None

    def check(self, scheme: str, accepted: Sequence[str]) -> None:
        """BalcliError for an option that the scheme does not have, or a value that none has."""
        given = [name for name, value in self._asdict().items() if value is not None]
        if strangers := [name for name in given if name not in accepted]:
            has = (
                f"it takes {', '.join('--' + a for a in accepted)}"
                if accepted
                else "it takes no options"
            )
            raise BalcliError(f"scheme {scheme} has no --{strangers[0]}; {has}")
        if self.order is not None and not 1 <= self.order <= HIGHEST_SHAFT_ORDER:
            raise BalcliError(
                f"--order {self.order}: the order must be a whole number from 1 to "
                f"{HIGHEST_SHAFT_ORDER}"
            )
        if self.roll not in (None, "zero"):
            raise BalcliError(f'--roll "{self.roll}": only "zero" can be asked for')


def lowest(engine: Engine, quantity: str, senses: Sequence[int]) -> Rest:
    """The lowest order at which a free force (or moment) is left; NoNeedError if there is none,
    BalcliError for moments that are not known.
    """
    _check_known(engine, quantity)
    for order in range(1, HIGHEST_ORDER_SOUGHT + 1):
        found = rest(engine, order)
        if any(found.at(quantity, sense) for sense in senses):
            return found
    raise NoNeedError(
        f"there is no free {quantity}{_turning(senses)} of orders 1 to {HIGHEST_ORDER_SOUGHT}: "
        "nothing to balance; --order names a higher one"
    )


def _check_known(engine: Engine, quantity: str) -> None:
    if quantity == "moment" and not engine.places_known:
        raise BalcliError(MOMENTS_UNKNOWN)


def _turning(senses: Sequence[int]) -> str:
    return " turning against the crank" if tuple(senses) == (-1,) else ""


def chosen(engine: Engine, wish: Wish, quantity: str, senses: Sequence[int] = (1, -1)) -> Rest:
    """What is left of the order asked for, or of the lowest that has something; NoNeedError if
    there is nothing.
    """
    _check_known(engine, quantity)
    if wish.order is None:
        return lowest(engine, quantity, senses)
    found = rest(engine, wish.order)
    if any(found.at(quantity, sense) for sense in senses):
        return found
    other = next(
        (q for q in ("force", "moment") if q != quantity and any(found.at(q, s) for s in senses)),
        None,
    )
    hint = {
        "moment": "; it has a free moment: couple-shaft",
        "force": "; it has a free force: two-shaft",
        None: "",
    }[other]
    raise NoNeedError(
        f"order {wish.order} has no free {quantity}{_turning(senses)}: nothing to balance{hint}"
    )


def options(scheme: str) -> Sequence[str]:
    """What a scheme takes; BalcliError if there is no such scheme, with the nearest name, or if it
    sizes no devices.
    """
    if scheme in SCHEMES:
        return SCHEMES[scheme].options
    if scheme == KNUCKLES:
        raise BalcliError(
            "scheme knuckles sizes no devices but changes the engine file: `balcli balance "
            "--scheme knuckles` does so"
        )
    from ..enginefile.fields import nearest

    near = nearest(scheme, NAMES)
    meant = f"did you mean {near}? " if near else ""
    raise BalcliError(f"there is no scheme {scheme[:60]!r}: {meant}choose from {', '.join(NAMES)}")
