"""Why an engine is balanced: sums of e^{i(n phi +- gamma)} decided exactly where angles are
fractions of a turn.

Cylinders with one mechanism share their Fourier coefficients, so an order vanishes if its sum over
each such family does (docs/theory.md): for the force `sum m e^{i(n phi +- g)}`, for the moment the
same with z, for couple, torque and roll `sum m e^{i n phi}`. In each sum the terms fall into sets
whose angles differ by fractions of a turn and whose weights are fractions of each other, and every
set has to vanish: no unit of mass or length, and no factor common to all, matters. Families and
sets may still cancel each other by their figures; that is no symmetry.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise, product
from operator import attrgetter
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.phasors import Array
from ..core.roots_of_unity import even, rational, turns
from ..engine.build import Engine
from .cancellation import WEIGHT_DENOMINATOR, Term, are_in_phase, sum_to_nothing, tell_cancellation
from .kinds import KINDS
from .orders import merge_orders
from .spectrum import compute_each_cylinder
from .textbook import find_textbook, without_devices

Verdict = Literal["none", "exact", "rounding", "nearly", "free"]
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
_ULPS = 16  # of the largest weight, by which such a ratio may be off
_IN_FULL = 1e-9  # of a sum, by which it may be less than its parts that are in phase


@dataclass(frozen=True)
class Reason:
    """Why one order of a group of kinds is balanced, or is not.

    Attributes:
        verdict: "none": no cylinder has any; "exact": by symmetry; "rounding": balanced, but not by
            exact fractions of a turn; "nearly": less than NEARLY of one cylinder is left; "free".
        size: what is left, in units of the largest that one cylinder makes.
        reciprocating, built: what is left of the reciprocating masses alone, as textbooks have it,
            and of the engine as built (`textbook.Textbook`), in `unit`; None where it has none.
        unit: F_n of the order, or F_n a; else empty.
        because: what cancels, or that nothing does, in words; empty where there is nothing to say.
    """

    order: float
    quantity: KindGroup
    verdict: Verdict
    size: float
    reciprocating: float | None = None
    built: float | None = None
    unit: str = ""
    because: str = ""

    @property
    def subject(self) -> str:
        """What it is of, in words."""
        names = {"turning": "couple, torque and roll", "gas": "gas torque"}
        return names.get(self.quantity, self.quantity)

    @property
    def finding(self) -> str:
        """What is found, and why, in words."""
        told = {
            "none": "no cylinder has any",
            "exact": "balanced exactly",
            "rounding": "balanced to rounding, but not by exact fractions of a turn",
            "nearly": f"nearly balanced: {self.size:.1g} of one cylinder",
            "free": f"free: {self._multiple}",
        }[self.verdict]
        if not self.because:
            return told
        return f"{told}{':' if self.verdict == 'exact' else ','} {self.because}"

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
    """Why each order of each group of kinds is balanced or is not, how the engine fires (empty: the
    file does not say), and of what these are the reasons (empty: of the engine as it is).
    """

    reasons: tuple[Reason, ...]
    firing: str
    scope: str = ""

    @property
    def sentences(self) -> tuple[str, ...]:
        """All of it in words, orders of which the same is found in one sentence."""
        subjects = list(dict.fromkeys(reason.subject for reason in self.reasons))
        orders: dict[tuple[str, str], list[str]] = defaultdict(list)
        for reason in sorted(self.reasons, key=lambda reason: subjects.index(reason.subject)):
            orders[reason.subject, reason.finding].append(f"{reason.order:g}")
        told = (
            f"order{'s' * (len(names) > 1)} {', '.join(names)} {subject}: {finding}"
            for (subject, finding), names in orders.items()
        )
        return tuple(filter(None, (self.scope, *told, self.firing)))


def explain_symmetry(
    engine: Engine, orders: Iterable[float], kinds: Collection[str] = tuple(_GROUPS)
) -> Symmetry:
    """The conditions of self-balance, at steady speed, of the cylinders alone: no devices.

    The moment is that about the engine's point of reference; in couple, torque and roll the
    displacement of this point is left out.

    Args:
        engine: without trailing axes.
        orders: multiples of 1/2, above 0.
        kinds: any of force, moment, couple, torque and roll; the last three have one reason in
            common.
    """
    asked = merge_orders(orders)
    groups = dict.fromkeys(group for name, group in _GROUPS.items() if name in kinds)
    layout = _Layout(without_devices(engine), asked)
    reasons = [layout.explain(row, group) for row in range(len(asked)) for group in groups]
    if engine.gas is not None and "gas" in kinds:
        reasons = sorted([*reasons, *_explain_gas(engine, asked)], key=attrgetter("order"))
    return Symmetry(tuple(reasons), describe_firing(engine), _tell_scope(engine))


def _tell_scope(engine: Engine) -> str:
    """What of an engine the reasons leave out, beside whose figures they stand."""
    left_out = {
        "without counterweights, shafts and sliders": bool(engine.devices),
        "at steady speed": bool(engine.ripple),
        "couple and roll about the crank's axis": any(engine.reference_m[:2]),
    }
    told = [words for words, there in left_out.items() if there]
    return f"of the cylinders alone: {', '.join(told)}" if told else ""


def _explain_gas(engine: Engine, orders: Array) -> Iterator[Reason]:
    """Why each order of the gas torque is balanced, or is not."""
    from .gas_symmetry import measure_gas  # engines without gas do not pay for it

    for n, (exact, size, because) in zip(orders.tolist(), measure_gas(engine, orders), strict=True):
        order = _as_number(n)
        if size is None:
            yield Reason(order, "gas", "none", 0.0)
        else:
            verdict: Verdict = "exact" if exact else _judge(size)
            yield Reason(order, "gas", verdict, 0.0 if exact else size, because=because)


def describe_firing(engine: Engine) -> str:
    """Even or odd fire, in words; empty where the file says nothing of firing."""
    if not engine.fires_deg:
        return ""
    cycle = 180 * engine.strokes
    instants = sorted(float(t) % cycle for t in engine.fires_deg.values())
    gaps = [b - a for a, b in pairwise([*instants, instants[0] + cycle])]
    exact = [turns(t * 360 / cycle) for t in instants]
    if None not in exact and even([x for x in exact if x is not None], Fraction(1)):
        return f"firing: even, every {cycle / len(gaps):.6g} deg"
    least, most = f"{min(gaps):.6g}", f"{max(gaps):.6g}"
    if least == most:
        return f"firing: even to {max(gaps) - min(gaps):.1g} deg, every {least} deg"
    if max(gaps) - min(gaps) < NEARLY * cycle / len(gaps):
        return f"firing: nearly even, every {least} to {most} deg"
    return f"firing: uneven, at intervals of {', '.join(f'{gap:.6g}' for gap in gaps)} deg"


class _Sum(NamedTuple):
    """`sum w e^{i(n phi + side gamma)}` over some rows of the cylinders.

    Attributes:
        rows: of the cylinders that it runs over.
        weights: w of every cylinder, shape (cylinders,).
        order: n.
        side: 1 forward, -1 backward, 0 for what acts about the crank's axis.
    """

    rows: list[int]
    weights: Array
    order: float
    side: int


class _Layout:
    """Angles and weights of an engine's cylinders, as fractions where they are some; what the whole
    engine and each cylinder make of some orders.
    """

    def __init__(self, engine: Engine, orders: Array) -> None:
        self._c, self._numbers = engine.cylinders, engine.numbers
        self._orders = orders
        self._axis_deg = self._c.axis_of_each_deg
        self._largest_deg = float(max(np.abs(self._axis_deg).max(), np.abs(self._c.pin_deg).max()))
        self._mechanisms = self._c.mechanisms
        self._arms = self._c.z - engine.reference_m[2]
        kinds = [name for parts in _SUMMED.values() for name in parts]
        self._book = find_textbook(engine, orders, kinds)
        self._single = compute_each_cylinder(engine, orders, kinds)

    def explain(self, row: int, group: KindGroup) -> Reason:
        """Why the order in this row is balanced, or is not."""
        n, parts = float(self._orders[row]), _SUMMED[group]
        order = _as_number(n)
        whole = {name: self._book.built[name].major[row] for name in parts}
        single = {name: self._single[name].major[row] for name in parts}
        sizes = [whole[name] / single[name].max() for name in parts if single[name].any()]
        if not sizes:
            return Reason(order, group, "none", 0.0)
        there = np.any([one > 0 for one in single.values()], axis=0)
        families = self._families(there)
        sums = [(s.side, self._commensurable(s)) for s in self._sums(order, group, families)]
        exact = all(map(_vanishes, (sets for _, sets in sums)))
        size = 0.0 if exact else float(max(sizes))
        verdict: Verdict = "exact" if exact else _judge(size)
        multiples = self._multiples(row, group)
        in_full = all(np.isclose(whole[name], single[name].sum(), _IN_FULL, 0) for name in parts)
        alike = len(families) == 1 and in_full
        because = "" if verdict == "rounding" else _tell_why(sums, alike=alike)
        return Reason(order, group, verdict, size, *multiples, because)

    def _multiples(self, row: int, group: KindGroup) -> tuple[float | None, float | None, str]:
        """What is left of the order in this row in textbook units, and their name."""
        order = int(self._orders[row])
        if group == "turning":
            return None, None, ""
        unit = self._book.units.size(KINDS[group], order)
        if math.isnan(unit):
            return None, None, ""
        alone, built = self._book.reciprocating[group], self._book.built[group]
        name = self._book.units.name(KINDS[group], order)
        return float(alone.major[row] / unit), float(built.major[row] / unit), name

    def _sums(self, order: float, group: KindGroup, families: list[list[int]]) -> Iterator[_Sum]:
        """All that must vanish, of the cylinders that have this order at all."""
        turning = group == "turning"
        arms = self._arms if group == "moment" else np.ones(self._c.count)
        masses = [self._c.reciprocating]
        if self._c.linkage is not None:
            masses.append(self._c.linkage.mass)
        if turning:
            masses.append(self._c.couple)
        sides = (0,) if turning else (1, -1)
        for mass, rows, side in product(masses, families, sides):
            yield _Sum(rows, mass * arms, order, side)
        if order == 1 and not turning:
            yield _Sum(list(range(self._c.count)), self._c.rotating * arms, 1, 1)

    # -------------------------------------------------------------- one sum
    def _commensurable(self, s: _Sum) -> list[list[Term]]:
        """The terms that are not 0 in sets within which angles differ by fractions of a turn and
        weights are fractions of each other: as shares of the largest, and from the lowest number.
        """
        largest = float(np.abs(s.weights).max())
        rounding = _ULPS * float(np.spacing(largest))
        sets: dict[int, list[Term]] = {}  # by the row of their largest weight
        for row in sorted(s.rows, key=lambda row: -abs(s.weights[row])):
            weight = float(s.weights[row])
            if abs(weight) <= rounding:
                continue
            for first, terms in sets.items():
                most = float(s.weights[first])
                share = rational(weight / most, WEIGHT_DENOMINATOR, rounding / abs(most))
                angle = None if share is None else self._angle_between(first, row, s)
                if share is not None and angle is not None:
                    terms.append(Term(self._numbers[row], share, angle))
                    break
            else:
                sets[row] = [Term(self._numbers[row], Fraction(1), Fraction(0))]
        return [_count_from_lowest(terms) for terms in sets.values()]

    def _angle_between(self, first: int, row: int, s: _Sum) -> Fraction | None:
        """By how many turns the angle of a row's term is ahead of that of the first; None if that
        is no fraction.
        """
        pin, axis, order = self._c.pin_deg, self._axis_deg, Fraction(s.order)
        lean = s.side - order
        turned = turns(float(pin[row] - pin[first]), self._largest_deg)
        leaned = turns(float(axis[row] - axis[first]), self._largest_deg) if lean else Fraction(0)
        if turned is None or leaned is None:
            return None
        return (order * turned + lean * leaned) % 1

    def _families(self, there: NDArray[np.bool_]) -> list[list[int]]:
        """Rows of the cylinders that are there, those with equal mechanisms together."""
        found: dict[tuple[complex, ...], list[int]] = defaultdict(list)
        for row in np.flatnonzero(there).tolist():
            found[self._mechanisms[row]].append(row)
        return list(found.values())


def _count_from_lowest(terms: list[Term]) -> list[Term]:
    """The same with the angles counted from that of the cylinder with the lowest number."""
    first = min(terms).angle
    return [term._replace(angle=(term.angle - first) % 1) for term in terms]


def _vanishes(sets: list[list[Term]]) -> bool:
    """Whether a sum does, each set of commensurable terms for itself."""
    return all(map(sum_to_nothing, sets))


def _tell_why(sums: list[tuple[int, list[list[Term]]]], *, alike: bool) -> str:
    """What cancels: of all sums, or of those of one sense of rotation; or that all add up.

    Args:
        sums: the side of each, and its sets of commensurable terms.
        alike: whether all have one phase at equal angles: cylinders of one mechanism have, unless
            it is offset and their masses differ.
    """
    of_side = {side: [sets for s, sets in sums if s == side] for side, _ in sums}
    told = {
        side: tell_cancellation(one for sets in own for one in sets)
        for side, own in of_side.items()
        if all(map(_vanishes, own))
    }
    if len(told) == len(of_side):
        ways = {way for way in told.values() if way}
        if len(ways) < 2:
            return "".join(ways)
        return f"with the crank {told[1]}; against it {told[-1]}"
    if told:
        ((side, cancelled),) = told.items()
        sense = "with" if side == 1 else "against"
        return f"but nothing turns {sense} the crank: {cancelled}" if cancelled else ""
    every = [one for _, sets in sums for one in sets]
    together = alike and all(len(sets) <= 1 for _, sets in sums)
    return "all in phase" if together and all(map(are_in_phase, every)) else ""


def _as_number(order: float) -> float:
    """An order as people write it: 2, not 2.0."""
    return int(order) if order == int(order) else order


def _judge(size: float) -> Verdict:
    if size == 0:
        return "rounding"
    return "nearly" if size < NEARLY else "free"
