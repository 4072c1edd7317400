"""Sizing of counterweights, balancer shafts and sliders: every scheme is a choice of devices for
one least squares.
"""

from __future__ import annotations

from collections.abc import Callable

from ..engine.build import Engine
from .auto import size_auto
from .balance_factor import size_by_factor
from .counterweights import size_counterweights
from .minimax import size_minimax
from .options import SchemeOptions
from .remedy import Remedy
from .residual import NothingToBalanceError
from .shaft_pair import size_four_shaft, size_two_shaft
from .shafts import size_couple_shaft, size_single_shaft
from .single_cylinder import size_eccentric_slider, size_oldham
from .sliders import size_sliders

SIZE: dict[str, Callable[[Engine, SchemeOptions], Remedy]] = {
    "auto": size_auto,
    "counterweights": size_counterweights,
    "factor": size_by_factor,
    "minimax": size_minimax,
    "single-shaft": size_single_shaft,
    "two-shaft": size_two_shaft,
    "four-shaft": size_four_shaft,
    "couple-shaft": size_couple_shaft,
    "slider": size_sliders,
    "eccentric-slider": size_eccentric_slider,
    "oldham": size_oldham,
}


def size(engine: Engine, scheme: str = "auto", options: SchemeOptions | None = None) -> Remedy:
    """The devices that a scheme fits to an engine; none, with a note, where there is nothing to
    balance.

    Args:
        engine: without trailing axes. scheme: of `SCHEMES`.

    Raises BalcliError, with the reason, for an unknown scheme, an option that it does not take, and
    options that cannot be met.
    """
    asked = options or SchemeOptions()
    asked.check(scheme)
    try:
        return SIZE[scheme](engine, asked)
    except NothingToBalanceError as reason:
        return Remedy(scheme, asked.order, note=str(reason), details=reason.details)
