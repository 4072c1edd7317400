"""Arrangements that a search finds, engine files with them, and the objective: a weighted sum of
quantities to minimise or maximise, and limits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ...core.phasors import Array
from ...engine.build import build
from ...engine.layout import plan_cylinders
from ...engine.parse import parse
from ...errors import BalcliError, InputError
from ...file.edit import set_keys
from ...file.model import EngineFile
from ...forces.kinds import GAS_KINDS
from ...forces.quantity import Quantity
from ..quantities import AnyQuantity, parse_quantities

# One arrangement: what differs from the file, by key: a key of PATHS, or the dotted name of a
# number. Throws (deg) and firing orders are lists.
Design: TypeAlias = Mapping[str, Any]
PATHS = {
    "throws": "crank.throws",
    "firing_order": "layout.firing_order",
    "bank_angle": "layout.bank_angle",
    "splay": "crank.splay",
}
NOTE = "found by balcli"
SAME = 1e-9  # relative difference of the objectives of mirror images


class Found(NamedTuple):
    """One arrangement, the value of its objective, and its figures by name of quantity."""

    design: Design
    objective: float
    figures: Mapping[str, float]


def list_changes(design: Design) -> dict[str, Any]:
    """Return a design by dotted keys, as `Engine.vary` takes them."""
    changed = {PATHS.get(key, key): value for key, value in design.items()}
    return changed | ({"layout.firing_intervals": None} if "firing_order" in design else {})


def drop_mirror_images(found: Iterable[Found], model: EngineFile) -> Iterator[Found]:
    """Yield the arrangements without those that are an earlier one seen from the other end of the
    crank, or turning the other way, with the same objective.
    """
    cells = plan_cylinders(model.crank, model.layout).cells
    numbers = {(cell.bank, cell.throw): cell.number for cell in cells}
    last = max(cell.throw for cell in cells)
    other_end = {c.number: numbers.get((c.bank, last - c.throw), c.number) for c in cells}
    seen: dict[tuple[float, ...], float] = {}
    for one in found:
        images = list(_find_images(one.design, other_end))
        known = [seen[image] for image in images if image in seen]
        if not any(abs(value - one.objective) <= SAME * abs(one.objective) for value in known):
            yield one
        seen |= dict.fromkeys(images, one.objective)


def _find_images(design: Design, other_end: Mapping[int, int]) -> Iterator[tuple[float, ...]]:
    """Yield a firing order or throws, their mirror images from the other end and in the other
    sense of rotation, and both.
    """
    if (order := design.get("firing_order")) is not None:
        for row in (order, [other_end[number] for number in order]):
            start = row.index(1)
            turned = row[start:] + row[:start]
            yield tuple(turned)
            yield (1, *reversed(turned[1:]))
    elif (throws := design.get("throws")) is not None:
        for angles in (throws, throws[::-1]):
            for sign in (1, -1):
                from_first = ((sign * (angle - angles[0])) % 360.0 for angle in angles)
                yield tuple(round(angle, 6) % 360.0 for angle in from_first)


def write_design(text: bytes, design: Design, name: str = "") -> str:
    """Return the text of an engine file, comments included, with a design; a firing order that no
    longer fits is left out.

    Args:
        text: Text of the file.
        design: Throws, a firing order or angles.
        name: Name of the file; files that it names are in the same folder.

    Raises:
        BalcliError: The engine needs the firing order, or the design has other numbers.
    """
    if any(key not in PATHS for key in design):
        settings = ", ".join(f"{path} = {best:.9g}" for path, best in design.items())
        raise BalcliError(
            f"--write takes throws, firing orders and angles; write {settings} by hand"
        )
    new = text.decode("utf-8-sig")
    for path, value in list_changes(design).items():
        table, _, last = path.partition(".")
        new = set_keys(new, table, {last: value}, NOTE)
    if not _is_engine(new, name):
        new = set_keys(new, "layout", {"firing_order": None, "firing_intervals": None}, NOTE)
        if not _is_engine(new, name):
            raise BalcliError(
                "--write: the firing order of the file does not fit what was found, and [gas] "
                "needs one: look for it by --over firing_order, or leave [gas] out"
            )
    return new


def _is_engine(text: str, name: str) -> bool:
    try:
        build(parse(text, name))
    except InputError:
        return False
    return True


_SIGNED = ("torque.mean", "torque.min")


class Merit(NamedTuple):
    """Merits of candidates, shape (candidates,): the one with less excess is better, of equal ones
    the one with less cost.

    Attributes:
        excess: 0 where all limits are kept, else the largest ratio of a quantity to its limit.
        cost: weighted sum of the quantities; its negative where it is maximised.
    """

    excess: Array
    cost: Array

    def take(self, where: Any) -> Merit:
        """Return the merits of some candidates, by an index as of numpy."""
        return Merit(self.excess[where], self.cost[where])

    def is_at_most(self, other: Merit) -> NDArray[np.bool_]:
        """Return whether each candidate is as good as the other one, or better."""
        cheaper = (self.excess == other.excess) & (self.cost <= other.cost)
        return np.asarray((self.excess < other.excess) | cheaper)

    def rank(self) -> NDArray[np.intp]:
        """Return the indices of the candidates, best first, along the last axis."""
        return np.lexsort((self.cost, self.excess), axis=-1)


@dataclass(frozen=True)
class Objective:
    """Weights by quantity, upper limits by quantity (SI), and whether the sum is maximised."""

    weights: Mapping[AnyQuantity, float]
    limits: Mapping[AnyQuantity, float]
    maximise: bool = False

    @property
    def quantities(self) -> tuple[AnyQuantity, ...]:
        """All quantities of the sum and of the limits, each once."""
        return tuple(dict.fromkeys((*self.weights, *self.limits)))

    @property
    def is_sum_over_cylinders(self) -> bool:
        """Whether all quantities are orders of inertia forces, which throws contribute to."""
        return all(isinstance(q, Quantity) and q.kind not in GAS_KINDS for q in self.quantities)

    def add_up(self, value: Callable[[AnyQuantity], Any]) -> Any:
        """Return the weighted sum; `value` gives each quantity."""
        return sum(weight * value(q) for q, weight in self.weights.items())

    def judge(self, values: Mapping[Any, Array]) -> Merit:
        """Return the merits of candidates by their quantities, shape (candidates,) each."""
        total = np.asarray(self.add_up(values.__getitem__), float)
        excess = np.zeros_like(total)
        for q, limit in self.limits.items():
            share = values[q] / limit
            excess = np.where(share < 1, excess, np.maximum(excess, share))
        return Merit(excess, -total if self.maximise else total)


def parse_objective(
    minimise: str | None,
    limits: Sequence[str] = (),
    *,
    maximise: str | None = None,
    with_gas: bool = False,
) -> Objective:
    """Read `moment.1.major,force.2.major=0.5` and limits such as `moment.2.major<100` (N, N m).

    Args:
        minimise: Weighted sum that should be small.
        limits: What quantities must stay below.
        maximise: Weighted sum that should be large; exactly one of both is given.
        with_gas: Whether the engine has gas.

    Raises:
        BalcliError: An unknown quantity, or a wrong weight or limit.
    """
    if (minimise is None) == (maximise is None):
        raise BalcliError("give exactly one of --minimise and --maximise")
    goal = maximise or minimise or ""
    weights: dict[AnyQuantity, float] = {}
    for term in goal.split(","):
        name, _, weight = term.partition("=")
        share = _parse_positive(weight, term) if weight else 1.0
        weights |= dict.fromkeys(_parse_sizes(name, with_gas), share)
    bounds: dict[AnyQuantity, float] = {}
    for text in limits:
        name, less, bound = text.partition("<")
        if not less:
            raise BalcliError(
                f'--limit "{text}": give a quantity and what it must stay below, such as '
                '"moment.2.major<100"'
            )
        bounds |= dict.fromkeys(_parse_sizes(name, with_gas), _parse_positive(bound, text))
    return Objective(weights, bounds, maximise is not None)


def _parse_sizes(name: str, with_gas: bool) -> tuple[AnyQuantity, ...]:
    """Return quantities that cannot be negative."""
    found = parse_quantities(name, with_gas=with_gas)
    for q in found:
        if isinstance(q, Quantity) and (q.signed or q.part == "axis"):
            raise BalcliError(
                f"{q.name} has a sign or a direction; name a size such as "
                f"{q.kind}.{q.order:g}.major"
            )
        if q.name in _SIGNED:
            raise BalcliError(f"{q.name} may be negative; name a size such as torque.max")
    return found


def _parse_positive(text: str, whole: str) -> float:
    """Return a positive number; `whole` is the text that it stands in."""
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not 0 < number < math.inf:
        raise BalcliError(f'"{whole}": {text.strip() or "nothing"} is no positive number')
    return number
