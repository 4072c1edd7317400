"""Search for the best sequence of the throw angles along a crank.

Forces and moments are sums of contributions, which are tabulated by throw and angle. A branch is
the set of all cranks whose first throws have the same angles. Branch and bound drops a branch if no
sequence of the remaining angles can be better than the best known cranks.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache, partial
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ...core.phases import TURN
from ...core.phasors import Array, Complex, Phasors
from ...engine.build import assemble, build
from ...engine.figures import ranked
from ...engine.layout import plan_cylinders
from ...errors import ArgumentError, BalcliError
from ...file.model import EngineFile
from ...forces.quantity import Quantity
from ...forces.spectrum import compute_spectra, with_only
from ...limits import MOST_ARRANGEMENTS
from ...process import Tell, tell_nobody
from ...show.sheet import count_name
from ..quantities import AnyQuantity, choose_of_engine
from .designs import (
    BROKEN,
    Found,
    Objective,
    drop_firing_order,
    fires_evenly,
    name_throws,
    rank_one_by_one,
    rank_throws,
    refuse_many,
)

Left: TypeAlias = tuple[int, ...]  # how often each angle remains to be assigned
Allowed = Callable[[Array], NDArray[np.bool_]]
IMAGES = 8  # number of candidates kept for each requested result, since many are mirror images
BLOCK = 7  # number of throws whose arrangements are all tried at once (7! = 5040)
_DECIMALS = 9  # decimals (deg) to which equal angles agree
_NEAR = 1e-11  # deg; a smaller distance from a short decimal is rounding
ROUNDING = 1e-12  # sums below this share of their parts' magnitudes are 0


def search_throws(
    model: EngineFile, objective: Objective, wanted: int, even_firing: bool, tell: Tell
) -> Iterator[Found]:
    """Return at least `wanted` arrangements of the throws of a file, best first, or all if there
    are fewer.

    Raises:
        BalcliError: There is nothing to arrange, or `peak.force` or `peak.moment` is requested.
    """
    model = drop_firing_order(give_throws(model))

    def can_fire(throws: Array) -> NDArray[np.bool_]:
        return fires_evenly(build(model, name_throws(throws)), model)

    if not objective.is_sum_over_cylinders:
        throws = list_throws(model)
        throws = throws[can_fire(throws)] if even_firing else throws
        designs = ({"throws": row} for row in throws.tolist())
        return rank_one_by_one(model, designs, objective, tell)
    if peaks := [q.name for q in objective.quantities if q.part == "peak"]:
        raise BalcliError(
            f"a search over throws adds up orders, which {peaks[0]} does not allow; name orders, "
            "such as force.1.major"
        )
    allowed = can_fire if even_firing else None
    throws = find_best_throws(model, objective, IMAGES * wanted, allowed, tell)
    return rank_throws(model, count_from(throws[:, :1], throws), objective)


def list_throws(model: EngineFile) -> Array:
    """Return all different arrangements of the throw angles of a file, deg, shape (arrangements,
    throws); the first throw is at 0.

    Raises:
        BalcliError: A four-stroke engine with gas depends on the firing order as well, or there are
            too many arrangements to compute one by one.
    """
    if model.gas is not None and model.layout.strokes == 4:
        raise ArgumentError(
            "with [gas], results of four-stroke engines depend on the firing order as well; use "
            "{over} firing_order (without crank.throws in the file it tries all cranks)"
        )
    sets = _find_sets(model)
    refuse_many(sum(_count_sequences(each.left) for each in sets))
    fixed = _find_first_throw(model)
    rows = [np.insert(each.levels[_list_sequences(each.left)], fixed, 0.0, axis=1) for each in sets]
    throws = np.concatenate(rows)
    return count_from(throws[:, :1], throws)


def give_throws(model: EngineFile) -> EngineFile:
    """Return the file with explicit throws; if it gives none, they follow from its firing order.

    Raises:
        BalcliError: The crank has one throw, or a cylinder has its own throw angle.
    """
    if any(own.throw is not None for own in model.cylinder.values()):
        raise BalcliError(
            "cylinders with throw angles of their own are not arranged by crank.throws: "
            "give only crank.throws and splay"
        )
    if model.crank.throws is None:
        found = assemble(model).pins.throws_deg
        model = model.with_table("crank", throws=[float(found[t]) for t in range(len(found))])
    if len(model.crank.throws or ()) < 2:
        raise BalcliError(
            "there is nothing to permute: the crank has one throw; give crank.throws, or a "
            "layout.firing_order from which the throws follow"
        )
    return model


def count_from(first: Array, throws: Array) -> Array:
    """Return the angles of throws relative to `first`, deg, in [0, 360). Rounding errors are
    removed from short decimals and fractions of a turn.
    """
    angles = np.mod(throws - first, TURN)
    different, which = np.unique(angles, return_inverse=True)
    neat = np.array([_neaten(float(angle)) for angle in different])
    return neat[which].reshape(angles.shape) % TURN


def _neaten(angle: float) -> float:
    short = round(angle, _DECIMALS)
    fraction = float(TURN * Fraction(angle / TURN).limit_denominator(1000))
    return next((neat for neat in (short, fraction) if abs(neat - angle) <= _NEAR), angle)


# ------------------------------------------------------------------ contributions of throws
class Contributions(NamedTuple):
    """Forward and backward vectors of the throws, for the kinds and orders of some quantities.

    Attributes:
        rows: For each quantity, the row of the arrays that holds its kind and order.
        throws: Vectors of every throw at every angle, shape (rows, 2, throws, angles).
        devices: Vectors of the devices, shape (rows, 2).
        reach: Largest magnitude of the contribution of each throw, shape (rows, throws).
    """

    rows: Mapping[AnyQuantity, int]
    throws: Complex
    devices: Complex
    reach: Array

    def read(self, quantity: Quantity, sums: Complex) -> Array:
        """Return a quantity from sums over all throws and devices, shape (rows, 2, candidates)."""
        k = self.rows[quantity]
        noise = np.full((1, 1), ROUNDING * self.reach[k].sum())
        order = np.array([float(quantity.order)])
        return quantity.read_from(Phasors.of(order, sums[k, :1], sums[k, 1:], noise).drop_noise())


def tabulate_contributions(
    model: EngineFile, angles: Array, fixed: int, quantities: tuple[Quantity, ...]
) -> Contributions:
    """Return the contributions to the quantities. The throw `fixed` (cylinder 1's) is at 0; the
    others may be at any of `angles` (deg).
    """
    throw_of = {c.number: c.throw for c in plan_cylinders(model).cells}
    count = 1 + max(throw_of.values())
    paths = {f"crank.throws.{t + 1}": 0.0 if t == fixed else angles for t in range(count)}
    engine = build(model, paths)
    own_throw = np.array([throw_of[int(number)] for number in engine.numbers])
    parts = [with_only(engine, own_throw == throw) for throw in range(count)]
    parts.append(replace(with_only(engine, own_throw < 0), devices=engine.devices))
    keys = list(dict.fromkeys((q.kind, q.order) for q in quantities))
    orders = sorted({order for _, order in keys})
    kinds = {kind for kind, _ in keys}
    table = np.empty((len(keys), 2, len(parts), len(angles)), complex)
    for part, each in enumerate(parts):
        spectra = compute_spectra(each, orders, kinds)
        for k, (kind, order) in enumerate(keys):
            table[k, :, part] = spectra[kind].vectors[:, orders.index(order)]
    throws = table[:, :, :-1]
    rows: dict[AnyQuantity, int] = {q: keys.index((q.kind, q.order)) for q in quantities}
    return Contributions(rows, throws, table[:, :, -1, 0], np.abs(throws).max(axis=(1, 3)))


# ------------------------------------------------------------------ sequences of angles
class AngleSet(NamedTuple):
    """Angles of the throws relative to cylinder 1's throw.

    Attributes:
        levels: Different angles, deg, ascending from 0.
        left: How often each level remains to be assigned; cylinder 1's throw already has the first.
    """

    levels: Array
    left: Left


def _find_sets(model: EngineFile) -> list[AngleSet]:
    """Return the different angle sets of a file's throws; any throw may become cylinder 1's.

    Raises:
        BalcliError: There are more than MOST_ARRANGEMENTS.
    """
    given = np.mod(np.asarray(model.crank.throws, float), TURN)
    if _count_sequences(np.unique(given, return_counts=True)[1]) > MOST_ARRANGEMENTS:
        raise BalcliError(
            f"crank.throws: {len(given)} throws have more than {count_name(MOST_ARRANGEMENTS)} "
            "arrangements, too many to search"
        )
    turned: dict[bytes, AngleSet] = {}
    for row in np.sort(count_from(given[:, None], given)):
        levels, times = np.unique(row, return_counts=True)
        left = (int(times[0]) - 1, *map(int, times[1:]))
        turned.setdefault(np.round(row, _DECIMALS).tobytes(), AngleSet(levels, left))
    return [*turned.values()]


def _find_first_throw(model: EngineFile) -> int:
    """Return the index of cylinder 1's throw."""
    return next(cell.throw for cell in plan_cylinders(model).cells if cell.number == 1)


def _count_sequences(left: Iterable[int]) -> int:
    """Return the number of sequences in which each angle occurs as often as `left` says."""
    times = [*left]
    return math.factorial(sum(times)) // math.prod(map(math.factorial, times))


@lru_cache(maxsize=4096)
def _list_sequences(left: Left) -> NDArray[np.int8]:
    """Return all sequences in which each angle occurs as often as `left` says, shape (sequences,
    length).
    """
    if not sum(left):
        return np.empty((1, 0), np.int8)
    starts = _take_one(left)
    parts = [np.insert(_list_sequences(fewer), 0, level, axis=1) for level, fewer in starts]
    return np.concatenate(parts)


def _take_one(left: Left) -> Iterator[tuple[int, Left]]:
    """Yield every remaining angle, and the counts after it is assigned once."""
    for level, times in enumerate(left):
        if times:
            yield level, (*left[:level], times - 1, *left[level + 1 :])


# ------------------------------------------------------------------ branch and bound
def find_best_throws(
    model: EngineFile,
    objective: Objective,
    count: int,
    allowed: Allowed | None = None,
    tell: Tell = tell_nobody,
) -> Array:
    """Return the best arrangements of the file's throw angles, best first, deg, shape (at most
    count, throws); cylinder 1's throw is at 0.

    Args:
        model: Engine file with throws.
        objective: Objective with quantities that are sums over the cylinders.
        count: Largest number of arrangements.
        allowed: Function that returns which arrangements (candidates, throws) are allowed; None:
            all.
        tell: Called with the share of all arrangements that were tried or excluded; it returns
            whether to stop with the best arrangements so far.

    Raises:
        BalcliError: There are more than MOST_ARRANGEMENTS.
    """
    sets = _find_sets(model)
    search = _BranchAndBound(model, objective, count, allowed)
    total = sum(_count_sequences(each.left) for each in sets)
    done = 0
    for each in sets:
        for decided in search.grow(each):
            done += decided
            if tell(done / total) and len(search.best):
                return search.best
    return search.best


class _BranchAndBound:
    """Search for the best arrangements. A branch assigns angles to the first throws; cylinder 1's
    throw is fixed and not counted.

    Attributes:
        best: Throw angles of the best arrangements so far, deg, shape (at most count, throws).
    """

    def __init__(
        self, model: EngineFile, objective: Objective, count: int, allowed: Allowed | None
    ) -> None:
        self._model = model
        self._objective = objective
        self._count = count
        self._allowed = allowed
        self._quantities = choose_of_engine(objective.quantities)
        throws = len(model.crank.throws or ())
        self._fixed = _find_first_throw(model)
        self._free = [throw for throw in range(throws) if throw != self._fixed]
        self.best = np.empty((0, throws))
        self._costs = np.empty(0)
        self._worst = BROKEN

    def grow(self, angles: AngleSet) -> Iterator[int]:
        """Try all arrangements of an angle set, and yield after each step how many more were
        tried or excluded.
        """
        self._levels = angles.levels
        self._table = tabulate_contributions(
            self._model, angles.levels, self._fixed, self._quantities
        )
        vectors = self._table.throws
        start = vectors[:, :, self._fixed, 0] + self._table.devices
        branches: list[tuple[tuple[int, ...], Left, Complex]] = [((), angles.left, start)]
        while branches:
            prefix, left, sums = branches.pop()
            if self._find_bound(self._free[len(prefix) :], sums) < self._worst:
                if sum(left) > BLOCK:
                    throw = self._free[len(prefix)]
                    further = [
                        ((*prefix, level), fewer, sums + vectors[:, :, throw, level])
                        for level, fewer in _take_one(left)
                    ]
                    branches += further[::-1]
                    continue
                self._try(prefix, left, sums)
            yield _count_sequences(left)

    def _find_bound(self, to_come: list[int], sums: Complex) -> float:
        """Return a lower bound of the cost: remaining throws may add or cancel their whole
        magnitude.
        """
        reach = self._table.reach[:, to_come].sum(axis=1)[:, None]
        sizes = np.abs(sums)
        least = np.maximum(sizes - reach, 0.0)
        most = sizes + reach
        objective = self._objective
        at_least = partial(self._read_bound, least, False)
        if any(at_least(q) >= limit for q, limit in objective.limits.items()):
            return math.inf
        if objective.maximise:
            return -float(objective.add_up(partial(self._read_bound, most, True)))
        return float(objective.add_up(at_least))

    def _read_bound(self, sizes: Array, at_most: bool, q: AnyQuantity) -> float:
        """Return the smallest or largest value of a quantity from bounds of the magnitudes of both
        vectors, shape (rows, 2).
        """
        ahead, astern = sizes[self._table.rows[q]].tolist()
        both = ahead + astern
        known = {"forward": ahead, "backward": astern, "major": both, "amplitude": both}
        return float(known.get(q.part, both if at_most else 0.0))

    def _try(self, prefix: tuple[int, ...], left: Left, sums: Complex) -> None:
        """Try all cranks with this beginning and the remaining angles, and keep the best."""
        ends = _list_sequences(left)
        whole = np.repeat(sums[..., None], len(ends), axis=2)
        for throw, levels in zip(self._free[len(prefix) :], ends.T, strict=True):
            whole += self._table.throws[:, :, throw, levels]
        figures: dict[AnyQuantity, Array] = {
            q: self._table.read(q, whole) for q in self._quantities
        }
        costs = ranked(self._objective.judge(figures))
        good = np.flatnonzero(costs < self._worst)
        rows = np.concatenate([np.tile(prefix, (len(good), 1)), ends[good]], axis=1).astype(int)
        angles = np.insert(self._levels[rows], self._fixed, 0.0, axis=1)
        costs = costs[good]
        if self._allowed is not None and len(good):
            may = self._allowed(angles)
            angles = angles[may]
            costs = costs[may]
        costs = np.concatenate([self._costs, costs])
        order = np.argsort(costs, kind="stable")[: self._count]  # of equal costs, the first stay
        self.best = np.concatenate([self.best, angles])[order]
        self._costs = costs[order]
        if len(order) == self._count:
            self._worst = float(self._costs[-1])
