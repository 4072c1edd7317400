"""Engine -> Balance: what a scheme fits, and the analyses without and with it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from types import NoneType

import numpy as np

from ..engine.build import Engine, check_engine
from ..errors import BalcliError, check_type
from ..field_balancing.permitted import find_permitted_unbalance
from ..forces.orders import merge_orders
from ..result import Result
from ..sizing.options import SchemeOptions
from ..sizing.remedy import Remedy, fit_devices
from ..sizing.sizing import size
from ..sizing.workshop import Practical, Tools, find_practical
from .analysis import Analysis, analyze

_UNEVEN = "sized for steady mean speed; before and after are those of the uneven one"


@dataclass(frozen=True, kw_only=True)
class PermittedUnbalance:
    """What a grade of ISO 21940-11 permits.

    Attributes:
        grade: Permitted speed of the centre of mass, mm/s.
        mass_kg: Mass of the crankshaft.
        each_g_mm: Permitted unbalance at each counterweight, or in each plane of the remedy's
            `needs`; all share alike.
    """

    grade: float
    mass_kg: float
    each_g_mm: float


@dataclass(frozen=True, repr=False)
class Balance(Result):
    """A remedy, and what the engine does without and with it.

    Attributes:
        remedy: New devices, and why these.
        before: Analysis of the engine without them.
        after: Analysis with them, of the same orders.
        practical: The workshop's figures of each device, in the order of `remedy.devices`.
        tools: Tools of the workshop.
        speed_note: How remedy and analyses differ in speed; empty if they do not.
        permitted: What a grade permits, if one was asked for.
        every_order: Whether orders were asked for, so that none of them is left out.
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
    before, after = analyze_both(engine, fit_devices(engine, remedy), orders)
    note = _UNEVEN if engine.ripple else ""
    every = orders is not None
    return Balance(remedy, before, after, practical, tools, note, every_order=every)


def analyze_both(
    engine: Engine, changed: Engine, orders: Iterable[float] | None
) -> tuple[Analysis, Analysis]:
    """Analyze an engine without and with a remedy by the same orders: those asked for, or 1 and 2
    and all that are not negligible in one of them.
    """
    before, after = analyze(engine, orders), analyze(changed, orders)
    if np.array_equal(before.orders, after.orders):
        return before, after
    both = merge_orders(before.orders, after.orders)
    return analyze(engine, both), analyze(changed, both)


def permit_unbalance(
    remedy: Remedy, grade: float | None, mass: float | None, speed_rpm: float
) -> PermittedUnbalance | None:
    """Return what a grade permits next to each counterweight; None without a grade.

    Args:
        remedy: Remedy with counterweights.
        grade: Grade of ISO 21940-11, mm/s.
        mass: Mass of the crankshaft as it is balanced, bobweights included, kg.
        speed_rpm: Speed of the engine.

    Raises:
        BalcliError: one without the other, figures that are not positive, or no counterweights.
    """
    if grade is None and mass is None:
        return None
    if grade is None or mass is None:
        raise BalcliError(
            "--grade and --mass belong together: a grade such as 16 permits an unbalance by the "
            "mass of the crankshaft, in kg"
        )
    if not (0 < grade < math.inf and 0 < mass < math.inf):
        raise BalcliError(f"--grade {grade:g} --mass {mass:g}: both must be positive numbers")
    count = len(remedy.needs or remedy.counterweights)
    if not count:
        raise BalcliError(
            f"--grade: scheme {remedy.scheme} fits no counterweights to the crankshaft, so "
            "there is nothing to share the permitted unbalance; choose one that does, such as "
            "--scheme counterweights"
        )
    whole = find_permitted_unbalance(grade, mass, speed_rpm)
    return PermittedUnbalance(grade=grade, mass_kg=mass, each_g_mm=whole / count)
