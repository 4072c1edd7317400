"""Engine -> Balance: what a scheme fits, and the analyses without and with it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from types import NoneType
from typing import NamedTuple

import numpy as np

from ..engine.build import Engine, check_engine
from ..errors import check_type
from ..forces.orders import merge_orders
from ..result import Result
from ..sizing.options import SchemeOptions
from ..sizing.remedy import Remedy, fit_devices
from ..sizing.sizing import size
from ..sizing.workshop import Practical, Tools, find_practical
from .analysis import Analysis, analyze

_UNEVEN = "sized for steady mean speed; before and after are those of the uneven one"


class PermittedUnbalance(NamedTuple):
    """By ISO 21940-11, SI.

    Attributes:
        grade: permitted speed of the centre of mass, mm/s. mass: of the crankshaft, kg.
        each: permitted unbalance at each counterweight, or in each plane of the remedy's `needs`,
            kg m; all share alike.
    """

    grade: float
    mass: float
    each: float


@dataclass(frozen=True, repr=False)
class Balance(Result):
    """A remedy, and what the engine does without and with it.

    Attributes:
        remedy: the new devices, and why these.
        before: analysis of the engine without them.
        after: with them, of the same orders.
        practical: the workshop's figures of each device, in the order of `remedy.devices`.
        tools: what the workshop has.
        speed_note: how remedy and analyses differ in speed; empty if they do not.
        permitted: what a grade permits, if one was asked for.
        every_order: whether orders were asked for, so that none of them is left out.
    """

    remedy: Remedy
    before: Analysis
    after: Analysis
    practical: tuple[Practical, ...] = ()
    tools: Tools = field(default_factory=Tools)
    speed_note: str = ""
    permitted: PermittedUnbalance | None = None
    every_order: bool = False

    @property
    def summary(self) -> str:
        """The scheme, what it fits, and to what."""
        count = len(self.remedy.devices) + len(self.remedy.beyond)
        devices = f"{count} device{'s' * (count != 1)}"
        return f"{self.remedy.scheme}: {devices} for {self.before.engine.summary}"


def balance(
    engine: Engine,
    scheme: str = "auto",
    options: SchemeOptions | None = None,
    orders: Iterable[float] | None = None,
    tools: Tools | None = None,
) -> Balance:
    """What a scheme fits and what it leaves.

    Devices are sized for a steady speed; under uneven speed both analyses include it.

    Args:
        engine: without trailing axes.
        scheme: its name, such as "counterweights" or "factor"; the message for one that is not
            there has them all, and `balcli balance --schemes` says what each does.
        options: of the scheme, such as SchemeOptions(factor=(0.51,), planes="ends").
        orders: which to show; default: 1 and 2 and all that are not negligible before or after.
        tools: of the workshop, for masses and holes, such as Tools(radius=0.08, drill=0.012).

    Raises:
        BalcliError: an unknown scheme, or options that cannot be met, with the reason.
        TypeError: what is no engine; options or tools that are none.

    Example:
        >>> balance(load("i3.toml"), "counterweights").after.moment.value
    """
    check_engine("balance", engine)
    check_type("balance", scheme, str, 'give the name of a scheme, such as "counterweights"')
    check_type("balance", options, (SchemeOptions, NoneType), "give SchemeOptions(factor=(0.5,))")
    check_type("balance", tools, (Tools, NoneType), "give Tools(radius=0.05)")
    remedy = size(engine, scheme, options)
    tools = tools or Tools()
    practical = find_practical(engine, remedy, tools)
    balanced = fit_devices(engine, remedy)
    before, after = analyze_both(engine, balanced, orders)
    note = _UNEVEN if engine.ripple else ""
    every = orders is not None
    return Balance(remedy, before, after, practical, tools, note, every_order=every)


def analyze_both(
    engine: Engine, changed: Engine, orders: Iterable[float] | None
) -> tuple[Analysis, Analysis]:
    """An engine without and with a remedy, by the same orders: those asked for, or 1 and 2 and all
    that are not negligible in one of them.
    """
    before, after = analyze(engine, orders), analyze(changed, orders)
    if np.array_equal(before.orders, after.orders):
        return before, after
    both = merge_orders(before.orders, after.orders)
    return analyze(engine, both), analyze(changed, both)
