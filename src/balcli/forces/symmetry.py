"""Whether an order is balanced by symmetry of the layout or by chance.

An order that is balanced by symmetry (docs/theory.md) stays balanced whatever all cylinders have in
common. So the engine is computed again with other piston and rod masses and another rod length, the
same for all cylinders, a few times; where it is still balanced to rounding, the layout balances it.
The speed is a common factor of all forces and needs no test. Gas torque is balanced by symmetry if
the phasors of the firing angles sum to zero.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from operator import attrgetter
from typing import Literal

import numpy as np

from ..core.phasors import Array, unit
from ..engine.build import Engine
from .gas import take_gas
from .kinds import KINDS
from .orders import merge_orders
from .spectrum import Spectra, compute_each_cylinder, compute_spectra
from .textbook import find_textbook, without_devices

Verdict = Literal["none", "symmetry", "chance", "nearly", "unbalanced"]
KindGroup = Literal["force", "moment", "turning", "gas"]  # turning: couple, torque and roll
_GROUPS: dict[str, KindGroup] = {  # by the name of the kind
    "force": "force",
    "moment": "moment",
    "couple": "turning",
    "torque": "turning",
    "roll": "turning",
}
_SUMMED: dict[KindGroup, tuple[str, ...]] = {
    "force": ("force",),
    "moment": ("moment",),
    "turning": ("couple", "torque"),
}
NEARLY = 1e-2  # of one cylinder
_DRAWS = 3
_SEED = 1
_EVEN = 1e-11  # of a cycle, by which intervals that are equal may differ
_ROUNDING = 1e-13  # of the sum of all shares of gas torque


@dataclass(frozen=True)
class Reason:
    """Whether one order of a group of kinds is balanced, and how.

    Attributes:
        order: the order, above 0.
        quantity: group of kinds.
        verdict: "none": no cylinder has any; "symmetry": balanced for any masses and rod length
            that all cylinders have in common; "chance": balanced for these figures only; "nearly":
            less than NEARLY of one cylinder is left; "unbalanced".
        size: what is left, in units of the largest that one cylinder makes.
        reciprocating, built: what is left of the reciprocating masses alone, as textbooks have it,
            and of the engine as built (`textbook.Textbook`), in `unit`; None where it has none.
        unit: F_n of the order, or F_n a; else empty.
    """

    order: float
    quantity: KindGroup
    verdict: Verdict
    size: float
    reciprocating: float | None = None
    built: float | None = None
    unit: str = ""

    @property
    def subject(self) -> str:
        """Name of the group, in words."""
        names = {"turning": "couple, torque and roll", "gas": "gas torque"}
        return names.get(self.quantity, self.quantity)

    @property
    def finding(self) -> str:
        """The verdict, in words."""
        return {
            "none": "no cylinder has any",
            "symmetry": "balanced by symmetry of the layout",
            "chance": "balanced by chance, for these figures only",
            "nearly": f"nearly balanced: {self.size:.1g} of one cylinder",
            "unbalanced": f"unbalanced: {self._multiple}",
        }[self.verdict]

    @property
    def _multiple(self) -> str:
        """What is left, in the textbook's unit where there is one."""
        if self.reciprocating is None:
            return f"{self.size:.4g} of one cylinder"
        alone, built = f"{self.reciprocating:.4g}", f"{self.built:.4g}"
        if alone == "0":
            return f"{built} {self.unit} as built (0 without rotating masses and stagger)"
        return f"{alone} {self.unit}" + (f" ({built} as built)" if built != alone else "")


@dataclass(frozen=True)
class Symmetry:
    """Whether each order of each group of kinds is balanced, and how.

    Attributes:
        reasons: one for every order and group.
        firing: how the engine fires; empty where the file does not say.
        scope: what of the engine the reasons leave out; empty: nothing.
    """

    reasons: tuple[Reason, ...]
    firing: str
    scope: str = ""

    @property
    def sentences(self) -> tuple[str, ...]:
        """All findings in words; orders with the same finding share a sentence."""
        subjects = list(dict.fromkeys(reason.subject for reason in self.reasons))
        orders: dict[tuple[str, str], list[str]] = defaultdict(list)
        for reason in sorted(self.reasons, key=lambda reason: subjects.index(reason.subject)):
            orders[reason.subject, reason.finding].append(f"{reason.order:g}")
        findings = (
            f"order{'s' * (len(names) > 1)} {', '.join(names)} {subject}: {finding}"
            for (subject, finding), names in orders.items()
        )
        return tuple(filter(None, (self.scope, *findings, self.firing)))


def explain_symmetry(
    engine: Engine, orders: Iterable[float], kinds: Collection[str] = tuple(_GROUPS)
) -> Symmetry:
    """Find out whether the cylinders alone, without devices and at steady speed, are balanced by
    symmetry or by chance.

    Moments are about the engine's point of reference; in couple, torque and roll the displacement
    of this point is left out.

    Args:
        engine: without trailing axes.
        orders: multiples of 1/2, above 0.
        kinds: any of force, moment, couple, torque, roll and gas; couple, torque and roll have one
            reason in common.
    """
    asked = merge_orders(orders)
    groups = list(dict.fromkeys(group for name, group in _GROUPS.items() if name in kinds))
    reasons = list(_explain_inertia(without_devices(engine), asked, groups))
    if engine.gas is not None and "gas" in kinds:
        reasons += _explain_gas(engine, asked)
    reasons.sort(key=attrgetter("order"))
    return Symmetry(tuple(reasons), describe_firing(engine), _describe_scope(engine))


def _describe_scope(engine: Engine) -> str:
    left_out = {
        "without counterweights, shafts and sliders": bool(engine.devices),
        "at steady speed": bool(engine.ripple),
        "couple and roll about the crank's axis": any(engine.reference_m[:2]),
    }
    words = [text for text, there in left_out.items() if there]
    return f"of the cylinders alone: {', '.join(words)}" if words else ""


def _explain_inertia(
    engine: Engine, orders: Array, groups: Collection[KindGroup]
) -> Iterator[Reason]:
    parts = [part for group in groups for part in _SUMMED[group]]
    book, single = find_textbook(engine, orders, parts), _measure_largest(engine, orders, parts)
    redrawn = [compute_spectra(other, orders, parts) for other in _draw(engine)]
    for row, order in enumerate(map(_as_number, orders.tolist())):
        for group in groups:
            there = [part for part in _SUMMED[group] if single[part][row]]
            if not there:
                yield Reason(order, group, "none", 0.0)
                continue
            balanced = [
                all(spectra[part].balanced[row] for part in there)
                for spectra in (book.built, *redrawn)
            ]
            size = max(float(book.built[part].major[row] / single[part][row]) for part in there)
            verdict = _judge(size, now=balanced[0], always=all(balanced))
            alone = built = None
            name = ""
            force = math.nan if group == "turning" else book.units.size(KINDS[group], order)
            if not math.isnan(force):
                alone = float(book.reciprocating[group].major[row] / force)
                built = float(book.built[group].major[row] / force)
                name = book.units.name(KINDS[group], int(order))
            yield Reason(order, group, verdict, 0.0 if balanced[0] else size, alone, built, name)


def _measure_largest(engine: Engine, orders: Array, parts: Collection[str]) -> dict[str, Array]:
    """Return what the largest of the cylinders makes by itself, shape (orders,), by part."""
    each: Spectra = compute_each_cylinder(engine, orders, parts)
    return {part: np.where(each[part].balanced, 0, each[part].major).max(axis=1) for part in parts}


def _draw(engine: Engine) -> Iterator[Engine]:
    """Yield the engine with other masses and another rod length, the same for all cylinders."""
    c, random = engine.cylinders, np.random.default_rng(_SEED)

    def redraw(masses: Array) -> Array:
        factor, more = random.uniform(0.5, 2, 2)
        return np.where(masses, factor * masses + more * np.abs(masses).max(), 0)

    for _ in range(_DRAWS):
        longer = random.uniform(0.5, 0.9)
        yield replace(
            engine,
            cylinders=replace(
                c,
                lam=longer * c.lam,
                eps=longer * c.eps,
                reciprocating=redraw(c.reciprocating),
                rotating=redraw(c.rotating),
                couple=redraw(c.couple),
            ),
        )


def _explain_gas(engine: Engine, orders: Array) -> Iterator[Reason]:
    gas = take_gas(engine)
    whole = compute_spectra(engine, orders, ["gas"])["gas"]
    single = _measure_largest(engine, orders, ["gas"])["gas"]
    always = np.ones(len(orders), dtype=bool)
    for _, rows in gas.group_equal():  # cylinders with the same torque over their cycle
        phasors = [
            gas.cylinders[k].share * unit(-orders * gas.cylinders[k].nominal_deg) for k in rows
        ]
        sizes = sum(gas.cylinders[k].share for k in rows)
        always &= np.abs(np.sum(phasors, axis=0)) <= _ROUNDING * sizes
    for row, order in enumerate(map(_as_number, orders.tolist())):
        if not single[row]:
            yield Reason(order, "gas", "none", 0.0)
            continue
        now = bool(whole.balanced[row])
        size = float(whole.major[row] / single[row])
        verdict = _judge(size, now=now, always=now and bool(always[row]))
        yield Reason(order, "gas", verdict, 0.0 if now else size)


def _judge(size: float, *, now: bool, always: bool) -> Verdict:
    if now:
        return "symmetry" if always else "chance"
    return "nearly" if size < NEARLY else "unbalanced"


def describe_firing(engine: Engine) -> str:
    """Return in words whether the engine fires evenly; empty where the file says nothing of it."""
    if not engine.fires_deg:
        return ""
    cycle = 180 * engine.strokes
    instants = sorted(float(t) % cycle for t in engine.fires_deg.values())
    gaps = [b - a for a, b in pairwise([*instants, instants[0] + cycle])]
    uneven = max(gaps) - min(gaps)
    if uneven <= _EVEN * cycle:
        return f"firing: even, every {cycle / len(gaps):.6g} deg"
    least, most = f"{min(gaps):.6g}", f"{max(gaps):.6g}"
    if least == most:
        return f"firing: even to {uneven:.1g} deg, every {least} deg"
    if uneven < NEARLY * cycle / len(gaps):
        return f"firing: nearly even, every {least} to {most} deg"
    return f"firing: uneven, at intervals of {', '.join(f'{gap:.6g}' for gap in gaps)} deg"


def _as_number(order: float) -> float:
    """Return an order as people write it: 2, not 2.0."""
    return int(order) if order == int(order) else order
