"""Sizing of counterweights, balancer shafts and sliders: every scheme is a choice of devices for one least squares."""
from __future__ import annotations

from importlib import import_module

from ..engine import Engine
from ..schemes import SCHEMES
from .auto import auto
from .remedy import Remedy, fitted
from .shop import Practical, Tools, practical
from .wish import NoNeedError, Wish, options

__all__ = ["SCHEMES", "Practical", "Remedy", "Tools", "Wish", "auto", "fitted", "practical", "remedy_for"]


def remedy_for(engine: Engine, scheme: str = "auto", wish: Wish | None = None) -> Remedy:
    """The devices that a scheme fits; none, with a note in the details, where there is nothing to balance.

    Raises:
        BalcliError: an unknown scheme, an option that it does not have, or a wish that cannot be met, with the reason.
    """
    asked = wish or Wish()
    asked.check(scheme, options(scheme))
    size = getattr(import_module(f".{SCHEMES[scheme].room}", __name__), scheme.replace("-", "_"))
    try:
        remedy: Remedy = size(engine, asked)
    except NoNeedError as reason:
        return Remedy(scheme, asked.order, details={"note": str(reason)})
    return remedy
