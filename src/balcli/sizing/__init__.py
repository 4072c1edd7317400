"""Sizing of counterweights, balancer shafts and sliders: every scheme is a choice of devices for one least squares."""
from __future__ import annotations

from collections.abc import Callable

from ..engine import Engine
from . import crank, shafts, single
from .auto import auto
from .remedy import Remedy, fitted
from .shop import Practical, Tools, practical
from .wish import NoNeedError, Wish, options

__all__ = ["SCHEMES", "Practical", "Remedy", "Tools", "Wish", "auto", "fitted", "practical", "remedy_for"]

_Scheme = tuple[Callable[[Engine, Wish], Remedy], tuple[str, ...]]

SCHEMES: dict[str, _Scheme] = {
    "auto": (lambda engine, _: auto(engine), ()),
    "counterweights": (crank.counterweights, ("order", "planes")),
    "factor": (crank.factor, ("factor",)),
    "minimax": (crank.minimax, ("planes", "position")),
    "single-shaft": (shafts.single_shaft, ("order", "at", "position")),
    "two-shaft": (shafts.two_shaft, ("order", "at", "position", "roll")),
    "four-shaft": (shafts.four_shaft, ("at", "position")),
    "couple-shaft": (shafts.couple_shaft, ("order", "at", "planes")),
    "slider": (shafts.slider, ("order", "at", "position")),
    "eccentric-slider": (single.eccentric_slider, ()),
    "oldham": (single.oldham, ()),
}


def remedy_for(engine: Engine, scheme: str = "auto", wish: Wish | None = None) -> Remedy:
    """The devices that a scheme fits; none, with a note in the details, where there is nothing to balance.

    Raises:
        BalcliError: an unknown scheme, an option that it does not have, or a wish that cannot be met, with the reason.
    """
    asked = wish or Wish()
    accepted = options({name: takes for name, (_, takes) in SCHEMES.items()}, scheme)
    asked.check(scheme, accepted)
    try:
        return SCHEMES[scheme][0](engine, asked)
    except NoNeedError as reason:
        return Remedy(scheme, asked.order, details={"note": str(reason)})
