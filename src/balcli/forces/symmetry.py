"""Why an engine is balanced: sums of e^{i(n phi +- gamma)} decided exactly where angles are
fractions of a turn.

Cylinders with one mechanism share their Fourier coefficients, so an order vanishes if its sum over
each such family does (docs/theory.md): for the force `sum m e^{i(n phi +- g)}`, for the moment the
same with z, for couple, torque and roll `sum e^{i n phi}`. Families of different mechanisms may
still cancel each other by their figures; that is no symmetry.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.phasors import Array
from ..core.roots_of_unity import even, rational, turns, vanishes
from ..engine.build import Engine
from .spectrum import each, spectra

Verdict = Literal["none", "exact", "rounding", "nearly", "free"]
Quantity = Literal["force", "moment", "turning"]  # turning: couple, torque and roll
KINDS_OF: dict[Quantity, tuple[str, ...]] = {
    "force": ("force",),
    "moment": ("moment",),
    "turning": ("couple", "torque"),  # and roll, their difference
}
QUANTITIES: tuple[Quantity, ...] = tuple(KINDS_OF)
_KINDS = tuple(name for names in KINDS_OF.values() for name in names)
NEARLY = 1e-2  # of one cylinder
_DECIMALS = 10_000  # largest denominator of a place in mm or a mass in g
_ULPS = 4


@dataclass(frozen=True)
class Reason:
    """Why one order of one quantity is balanced, or is not; `size`: what is left, in units of one
    cylinder's.
    """

    order: int
    quantity: Quantity
    verdict: Verdict
    size: float

    @property
    def sentence(self) -> str:
        name = "couple, torque and roll" if self.quantity == "turning" else self.quantity
        told = {
            "none": "no cylinder has any",
            "exact": "balanced exactly, by symmetry",
            "rounding": "balanced to rounding, but not by exact fractions of a turn",
            "nearly": f"nearly balanced: {self.size:.1g} of one cylinder",
            "free": f"free: {self.size:.4g} of one cylinder",
        }[self.verdict]
        return f"order {self.order} {name}: {told}"


@dataclass(frozen=True)
class Why:
    """Reasons by order and quantity, and how the engine fires (empty: the file does not say)."""

    reasons: tuple[Reason, ...]
    firing: str

    @property
    def sentences(self) -> tuple[str, ...]:
        return (
            *(reason.sentence for reason in self.reasons),
            *([self.firing] if self.firing else []),
        )


def why(
    engine: Engine, orders: Iterable[float], quantities: Collection[Quantity] = QUANTITIES
) -> Why:
    """The conditions of self-balance for whole orders from 1, at steady speed, of the cylinders
    alone: no devices.

    The moment is that about the engine's point of reference; in couple, torque and roll the
    displacement of this point is left out. The engine has no trailing axes.
    """
    asked = np.unique(np.fromiter(orders, float))
    bare = replace(engine, devices=(), ripple=(), reference_m=(0.0, 0.0, engine.reference_m[2]))
    layout = _Layout(bare, asked)
    return Why(
        tuple(layout.reason(row, q) for row in range(len(asked)) for q in quantities),
        firing(engine),
    )


def firing(engine: Engine) -> str:
    """Even or odd fire, in words; empty where the file says nothing of firing."""
    if not engine.fires_deg:
        return ""
    cycle = 180 * engine.strokes
    instants = sorted(float(t) % cycle for t in engine.fires_deg.values())
    gaps = [b - a for a, b in pairwise([*instants, instants[0] + cycle])]
    exact = [turns(t * 360 / cycle) for t in instants]
    if None not in exact and even([x for x in exact if x is not None], Fraction(1)):
        return f"firing: even, every {cycle / len(gaps):.6g} deg"
    if max(gaps) - min(gaps) < NEARLY * cycle / len(gaps):
        return f"firing: nearly even, every {min(gaps):.6g} to {max(gaps):.6g} deg"
    return f"firing: uneven, at intervals of {', '.join(f'{gap:.6g}' for gap in gaps)} deg"


class _Sum(NamedTuple):
    """`sum w e^{i(n phi + side gamma)}` over some rows of the cylinders."""

    rows: list[int]
    weights: Array
    order: int
    side: int


class _Layout:
    """Angles and weights of an engine's cylinders, as fractions where they are some; forces of the
    whole and its parts.
    """

    def __init__(self, engine: Engine, orders: Array) -> None:
        self._c = c = engine.cylinders
        self._orders = orders
        self._axis_deg = c.axis_of_each_deg
        self._arms = (c.z - engine.reference_m[2]) * 1e3
        self._whole = spectra(engine, orders, _KINDS)
        self._single = {
            kind.name: phasors.major for kind, phasors in each(engine, orders, _KINDS).items()
        }

    def reason(self, row: int, quantity: Quantity) -> Reason:
        order, names = int(self._orders[row]), KINDS_OF[quantity]
        single = {name: self._single[name][row] for name in names}
        whole = {name: self._whole[name].major[row] for name in names}
        sizes = [whole[name] / single[name].max() for name in names if single[name].any()]
        if not sizes:
            return Reason(order, quantity, "none", 0.0)
        there = np.any([one > 0 for one in single.values()], axis=0)
        if all(map(self._exactly_zero, self._sums(order, quantity, there))):
            return Reason(order, quantity, "exact", 0.0)
        verdict: Verdict = (
            "rounding" if max(sizes) == 0 else "nearly" if max(sizes) < NEARLY else "free"
        )
        return Reason(order, quantity, verdict, float(max(sizes)))

    def _sums(self, order: int, quantity: Quantity, there: NDArray[np.bool_]) -> Iterator[_Sum]:
        """All that must vanish; `there`: which cylinders have this order at all."""
        if quantity == "turning":
            for rows in self._families(self._figures("reciprocating", "couple"), there):
                yield _Sum(rows, np.ones(self._c.count), order, 0)
            return
        arms = self._arms if quantity == "moment" else np.ones(self._c.count)
        for rows in self._families(self._figures(), there):
            yield from (_Sum(rows, self._moving() * arms, order, side) for side in (1, -1))
        if order == 1:
            yield _Sum(list(range(self._c.count)), self._grams("rotating") * arms, 1, 1)

    # -------------------------------------------------------------- one sum
    def _exactly_zero(self, s: _Sum) -> bool:
        """Whether the sum vanishes, each set of cylinders that stand fractions of a turn apart for
        itself.
        """
        weights = _decimals(s.weights)
        for angles in self._commensurable(s):
            terms = [(w, angle) for row, angle in angles.items() if (w := weights[row]) is not None]
            if len(terms) < len(angles) or not vanishes(*zip(*terms, strict=True)):
                return False
        return True

    def _commensurable(self, s: _Sum) -> list[dict[int, Fraction]]:
        """Sets of rows whose angles differ by fractions of a turn, with these differences from the
        first of each.
        """
        pin, axis = (
            self._c.pin_deg,
            self._axis_deg if s.side != s.order else np.zeros(self._c.count),
        )
        sets: list[dict[int, Fraction]] = []
        for row in s.rows:
            for known in sets:
                first = next(iter(known))
                turned, leaned = (
                    turns(float(pin[row] - pin[first])),
                    turns(float(axis[row] - axis[first])),
                )
                if turned is not None and leaned is not None:
                    known[row] = (s.order * turned + (s.side - s.order) * leaned) % 1
                    break
            else:
                sets.append({row: Fraction(0)})
        return sets

    # -------------------------------------------------------------- which cylinders are alike
    def _figures(self, *more: str) -> Callable[[int], tuple[Any, ...]]:
        """What two cylinders of one family have in common."""
        linkage = self._c.linkage
        columns = [getattr(self._c, key) for key in ("lam", "eps", *more)]
        if linkage is not None:
            columns += [*linkage.figures, self._c.reciprocating]
        return lambda row: tuple(column[row if len(column) > 1 else 0].item() for column in columns)

    @staticmethod
    def _families(
        figures: Callable[[int], tuple[Any, ...]], there: NDArray[np.bool_]
    ) -> list[list[int]]:
        found: dict[tuple[Any, ...], list[int]] = defaultdict(list)
        for row in map(int, np.flatnonzero(there)):
            found[figures(row)].append(row)
        return list(found.values())

    def _moving(self) -> Array:
        """What moves with each piston, g: on its axis, or on the curve of a linkage (whose
        cylinders count as equal or not).
        """
        linkage = self._c.linkage
        return self._grams("reciprocating") + (0 if linkage is None else linkage.mass * 1e3)

    def _grams(self, key: str) -> Array:
        return np.broadcast_to(getattr(self._c, key) * 1e3, (self._c.count,))


def _decimals(values: Array) -> list[Fraction | None]:
    """Places or masses as the short fractions that they were written as; a factor common to all
    does not matter.
    """
    largest = float(np.abs(values).max())
    if np.all(np.isin(values, (0, largest, -largest))):
        return [Fraction(int(np.sign(v))) for v in values]
    return [rational(float(v), _DECIMALS, _ULPS * float(np.spacing(largest))) for v in values]
