"""Sizing of counterweights, balancer shafts and sliders: every scheme is a choice of devices for
one least squares.
"""

from __future__ import annotations

from importlib import import_module

from ..engine.build import Engine
from .auto import auto
from .options import NoNeedError, Wish, options
from .remedy import Remedy, fitted
from .schemes import SCHEMES
from .workshop import Practical, Tools, practical

__all__ = [
    "SCHEMES",
    "Practical",
    "Remedy",
    "Tools",
    "Wish",
    "auto",
    "fitted",
    "practical",
    "remedy_for",
]


def remedy_for(engine: Engine, scheme: str = "auto", wish: Wish | None = None) -> Remedy:
    """The devices that a scheme fits; none, with a note in the details, where there is nothing to
    balance.

    Raises:
        BalcliError: an unknown scheme, an option that it does not have, or a wish that cannot be
        met, with the reason.
    """
    asked = wish or Wish()
    asked.check(scheme, options(scheme))
    size = getattr(import_module(f"balcli.sizing.{SCHEMES[scheme].room}"), scheme.replace("-", "_"))
    try:
        remedy: Remedy = size(engine, asked)
    except NoNeedError as reason:
        return Remedy(scheme, asked.order, details={"note": str(reason)})
    return remedy
