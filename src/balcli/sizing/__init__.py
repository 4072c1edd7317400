"""Sizing of counterweights, balancer shafts and sliders: every scheme is a choice of devices for one least squares."""
from __future__ import annotations

from importlib import import_module
from typing import NamedTuple

from ..engine import Engine
from .auto import auto
from .remedy import Remedy, fitted
from .shop import Practical, Tools, practical
from .wish import NoNeedError, Wish, options

__all__ = ["SCHEMES", "Practical", "Remedy", "Tools", "Wish", "auto", "fitted", "practical", "remedy_for"]


class _Scheme(NamedTuple):
    """Where the function of a scheme is (imported when it is asked for), and the options it takes."""

    room: str
    options: tuple[str, ...] = ()


SCHEMES = {
    "auto": _Scheme("auto"),
    "counterweights": _Scheme("crank", ("order", "planes")),
    "factor": _Scheme("crank", ("factor",)),
    "minimax": _Scheme("crank", ("planes", "position")),
    "single-shaft": _Scheme("shafts", ("order", "at", "position")),
    "two-shaft": _Scheme("shafts", ("order", "at", "position", "roll")),
    "four-shaft": _Scheme("shafts", ("at", "position")),
    "couple-shaft": _Scheme("shafts", ("order", "at", "planes")),
    "slider": _Scheme("shafts", ("order", "at", "position")),
    "eccentric-slider": _Scheme("single"),
    "oldham": _Scheme("single"),
}


def remedy_for(engine: Engine, scheme: str = "auto", wish: Wish | None = None) -> Remedy:
    """The devices that a scheme fits; none, with a note in the details, where there is nothing to balance.

    Raises:
        BalcliError: an unknown scheme, an option that it does not have, or a wish that cannot be met, with the reason.
    """
    asked = wish or Wish()
    asked.check(scheme, options({name: known.options for name, known in SCHEMES.items()}, scheme))
    size = getattr(import_module(f".{SCHEMES[scheme].room}", __name__), scheme.replace("-", "_"))
    try:
        remedy: Remedy = size(engine, asked)
    except NoNeedError as reason:
        return Remedy(scheme, asked.order, details={"note": str(reason)})
    return remedy
