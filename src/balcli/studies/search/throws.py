"""Search over the throws of a crank: which of its angles stands where along it.

Forces and moments are sums over the throws, tabulated by throw and angle. Candidates are rows of
indices into that table, thousands at a time. By branch and bound, a beginning of the crank is
dropped when nothing that may follow can make its sum better than the best that are known.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, lru_cache, partial
from itertools import permutations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.phases import TURN
from ...core.phasors import Array, Complex, Phasors
from ...core.telling import Tell, tell_nobody
from ...engine.arrays import ranked
from ...engine.build import assemble, build
from ...engine.layout import plan_cylinders
from ...enginefile.model import EngineFile
from ...errors import BalcliError
from ...forces.quantity import Quantity
from ...forces.spectrum import compute_spectra, with_only
from ...limits import MOST_ARRANGEMENTS
from ..quantities import AnyQuantity, choose_of_engine
from .designs import Design, Found
from .evaluate import build_throws, fires_evenly, rank_throws
from .objective import Objective

Arrangements = NDArray[np.int8]  # (arrangements, throws): indices of angles
Allowed = Callable[[Array], NDArray[np.bool_]]
Left = tuple[int, ...]  # how often each angle is still to be given
Key = tuple[str, float]  # name of a kind of force or moment, and order
Sums = dict[Key, tuple[Complex, Complex]]  # forward and backward vectors, (candidates,) each
IMAGES = 8  # candidates kept for each that is asked for, as many are mirror images
BLOCK = 7  # throws of which all arrangements are tried at a time (7! = 5040)
_KEPT = 2**22  # sums of such arrangements that are kept, 32 bytes each
_DECIMALS = 9  # of angles that are equal, deg
_NEAR = 1e-11  # deg, from a short decimal
ROUNDING = 1e-12  # sums below this share of the size of their parts are 0


def search_throws(
    model: EngineFile, objective: Objective, wanted: int, even_firing: bool, tell: Tell
) -> Iterator[Found]:
    """Yield at least `wanted` arrangements of the throws of a file, best first, if there are so
    many; its quantities are sums over the cylinders.

    Raises:
        BalcliError: there is nothing to arrange, or a peak is asked for.
    """
    if peaks := [q.name for q in choose_of_engine(objective.quantities) if q.part == "peak"]:
        raise BalcliError(
            f"a search over throws adds up orders, which {peaks[0]} does not allow; name orders, "
            "such as force.1.major"
        )

    def can_fire(throws: Array) -> NDArray[np.bool_]:
        return fires_evenly(build_throws(model, throws), model)

    allowed = can_fire if even_firing else None
    throws = find_best_throws(model, objective, IMAGES * wanted, allowed, tell)
    if len(throws):
        throws = count_from(throws[:, :1], throws)
    return rank_throws(model, throws, objective)


def list_throws(model: EngineFile) -> Iterator[Design]:
    """Yield all arrangements of the throw angles of a file, the first throw at 0, each once.

    Raises:
        BalcliError: gas in four strokes, which fires by an order of its own.
    """
    if model.gas is not None and model.layout.strokes == 4:
        raise BalcliError(
            "with [gas] in four strokes the firing order decides, too: search --over firing_order "
            "(without crank.throws in the file it tries all cranks)"
        )
    every = (np.asarray(row, float) for row in permutations(model.crank.throws or ()))
    turned = (tuple(count_from(row[:1], row).tolist()) for row in every)
    yield from (Design(throws=throws) for throws in dict.fromkeys(turned))


def give_throws(model: EngineFile) -> EngineFile:
    """Return the file with the throws that its firing order needs, where it gives none.

    Raises:
        BalcliError: the crank has one throw, or cylinders have throws of their own.
    """
    if any(own.throw is not None for own in model.cylinder.values()):
        raise BalcliError(
            "cylinders with throws of their own take no part in an arrangement of crank.throws: "
            "give crank.throws and splay alone"
        )
    if model.crank.throws is None and model.layout.firing_order:
        found = assemble(model).throws_deg
        model = model.with_table("crank", throws=[float(found[t]) for t in range(len(found))])
    if len(model.crank.throws or ()) < 2:
        raise BalcliError(
            "there is nothing to permute: the crank has one throw; give crank.throws, or a "
            "layout.firing_order they follow from"
        )
    return model


def count_from(first: Array, throws: Array) -> Array:
    """Return the angles of throws after others, deg in [0, 360), as short decimals or fractions of
    a turn where rounding alone makes them longer.
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
@dataclass(frozen=True)
class Contributions:
    """Forward and backward vectors of one kind and order.

    Attributes:
        forward, backward: of every throw at every angle, shape (throws, angles).
        devices: forward and backward vector of the devices.
    """

    order: float
    forward: Complex
    backward: Complex
    devices: tuple[complex, complex]

    @cached_property
    def reach(self) -> Array:
        """The most by which each throw can change a vector, shape (throws,)."""
        most: Array = np.maximum(np.abs(self.forward), np.abs(self.backward)).max(axis=1)
        return most

    def add_throws(self, throws: Sequence[int], rows: NDArray[np.int8]) -> tuple[Complex, Complex]:
        """Sums over some throws at angles by their indices, shape (candidates, throws): forward and
        backward, shape (candidates,).
        """
        forward, backward = np.zeros(len(rows), complex), np.zeros(len(rows), complex)
        for throw, column in zip(throws, rows.T, strict=True):
            forward += self.forward[throw].take(column)
            backward += self.backward[throw].take(column)
        return forward, backward

    def read(self, quantity: Quantity, forward: Complex, backward: Complex) -> Array:
        """A quantity by the sums over all throws and the devices, shape (candidates,)."""
        noise = np.full((1, 1), ROUNDING * self.reach.sum())
        order = np.array([float(self.order)])
        return quantity.read_from(
            Phasors.of(order, forward[None], backward[None], noise).drop_noise()
        )


def tabulate_contributions(
    model: EngineFile, angles: Array, fixed: int, quantities: Collection[Quantity]
) -> dict[Key, Contributions]:
    """All kinds and orders that the quantities need; throw `fixed` (cylinder 1's) stands at 0, the
    others at any of `angles` (deg).
    """
    throw_of = {c.number: c.throw for c in plan_cylinders(model.crank, model.layout).cells}
    count = 1 + max(throw_of.values())
    paths = {f"crank.throws.{t + 1}": 0.0 if t == fixed else angles for t in range(count)}
    engine = build(model, paths)
    own_throw = np.array([throw_of[number] for number in engine.numbers])
    orders, kinds = sorted({q.order for q in quantities}), {q.kind for q in quantities}
    each = [
        compute_spectra(with_only(engine, own_throw == throw), orders, kinds)
        for throw in range(count)
    ]
    nothing = with_only(engine, own_throw < 0)
    devices = compute_spectra(replace(nothing, devices=engine.devices), orders, kinds)
    table = {}
    for q in quantities:
        row, throws, still = orders.index(q.order), [s[q.kind] for s in each], devices[q.kind]
        table[q.kind, q.order] = Contributions(
            q.order,
            np.stack([np.broadcast_to(p.forward[row], angles.shape) for p in throws]),
            np.stack([np.broadcast_to(p.backward[row], angles.shape) for p in throws]),
            (still.forward[row].flat[0], still.backward[row].flat[0]),
        )
    return table


# ------------------------------------------------------------------ branch and bound
def find_best_throws(
    model: EngineFile,
    objective: Objective,
    count: int,
    allowed: Allowed | None = None,
    tell: Tell = tell_nobody,
) -> Array:
    """The best arrangements of the file's throw angles, shape (at most count, throws), cylinder 1's
    throw at 0, best first, deg.

    Args:
        allowed: which of some arrangements (shape (candidates, throws)) may be; None: all.
        tell: is told which share of all arrangements has been decided on, and says whether that is
            enough: then the result is the best of those.

    Raises:
        BalcliError: more than MOST_ARRANGEMENTS.
    """
    given = np.mod(np.asarray(model.crank.throws, float), 360.0)
    if _count_arrangements(given) > MOST_ARRANGEMENTS:
        raise BalcliError(
            f"crank.throws: {len(given)} throws can be arranged in more than "
            f"{MOST_ARRANGEMENTS:g} ways, too many to search"
        )
    fixed = next(c.throw for c in plan_cylinders(model.crank, model.layout).cells if c.number == 1)
    free = [t for t in range(len(given)) if t != fixed]
    best = _BestSoFar(count)
    turned = list(_turn_to_cylinder_1(given))
    decided = _Decided(tell, sum(map(_count_arrangements_of_others, turned)))
    for angles in turned:
        levels, times = np.unique(angles, return_counts=True)
        tree = _Tree(model, objective, _Places(levels, fixed, free), best, allowed, decided)
        if not tree.grow((), (int(times[0]) - 1, *map(int, times[1:]))):
            break
    return best.rows


def _count_arrangements(given: Array) -> int:
    """In how many ways throws at these angles can follow each other."""
    return _count_sequences(tuple(np.unique(given, return_counts=True)[1].tolist()))


def _count_arrangements_of_others(angles: Array) -> int:
    """In how many ways throws at these angles can follow each other beside one of them that stays:
    a throw at the first angle, ascending.
    """
    times = np.unique(angles, return_counts=True)[1].tolist()
    return _count_sequences((times[0] - 1, *times[1:]))


def _count_sequences(left: Left) -> int:
    """In how many ways what is left can follow."""
    return math.factorial(sum(left)) // math.prod(map(math.factorial, left))


def _turn_to_cylinder_1(given: Array) -> Iterator[Array]:
    """The angles, ascending, counted from each that can be cylinder 1's; turns that give the same
    angles once.
    """
    seen = set()
    for turned in count_from(given[:, None], given):
        rounded = np.round(np.sort(turned), _DECIMALS).tobytes()
        if rounded not in seen:
            seen.add(rounded)
            yield np.sort(turned)


class _Places(NamedTuple):
    """The angles that throws may take (deg, ascending, each once, shape (angles,)), the throw that
    stands at 0, and the others.
    """

    levels: Array
    fixed: int
    free: list[int]


class _BestSoFar:
    """The best candidates so far, at most `count`.

    Attributes:
        rows: angles of all throws, deg, shape (candidates, throws), best first.
        worst: what a value must be below to belong to them.
    """

    def __init__(self, count: int) -> None:
        self.count, self.worst = count, np.inf
        self.rows, self._values = np.empty((0, 0)), np.empty(0)

    def take(self, rows: Array, values: Array) -> None:
        """Those of further candidates that belong to them; of equal ones the first stay."""
        together = np.concatenate([self._values, values])
        order = np.argsort(together, kind="stable")[: self.count]
        self.rows = (np.concatenate([self.rows, rows]) if len(self.rows) else rows)[order]
        self._values = together[order]
        self.worst = self._values[-1] if len(order) == self.count else np.inf


class _Decided:
    """How many of all arrangements have been tried, or cannot be good."""

    def __init__(self, tell: Tell, total: int) -> None:
        self._tell, self._total, self._count = tell, total, 0

    def add(self, count: int) -> bool:
        """So many more; whether to go on."""
        self._count += count
        return not self._tell(self._count / self._total)


class _Tree:
    """All arrangements of one set of angles, beginnings of the crank first."""

    def __init__(
        self,
        model: EngineFile,
        objective: Objective,
        places: _Places,
        best: _BestSoFar,
        allowed: Allowed | None,
        decided: _Decided,
    ) -> None:
        self._objective, self._places, self._best, self._allowed = objective, places, best, allowed
        self._decided = decided
        self._table = tabulate_contributions(
            model, places.levels, places.fixed, choose_of_engine(objective.quantities)
        )
        self._start: Sums = {}  # of the fixed throw and the devices
        for key, own in self._table.items():
            ahead, astern = own.add_throws([places.fixed], np.zeros((1, 1), np.int8))
            self._start[key] = ahead + own.devices[0], astern + own.devices[1]
        # The last throws add the same whatever the crank begins with: other orders of the same
        # beginning, which soon follow, leave the same throws.
        most = _KEPT // (math.factorial(BLOCK) * len(self._table))
        self._add_endings = lru_cache(most)(partial(_sum_endings, self._table, places.free))

    def grow(self, prefix: tuple[int, ...], left: Left) -> bool:
        """Try everything that begins so; False: who is told has heard enough, and there is some."""
        hopeless = prefix and self._find_bound(prefix) >= self._best.worst
        if hopeless or sum(left) <= BLOCK:
            if not hopeless:
                self._try(prefix, left)
            return self._decided.add(_count_sequences(left)) or not len(self._best.rows)
        levels = (level for level, times in enumerate(left) if times)
        return all(self.grow((*prefix, level), _take_one(left, level)) for level in levels)

    def _find_angles(self, rows: Arrangements) -> Array:
        """Angles of all throws by the indices of the free ones, deg, shape (candidates, throws)."""
        return np.insert(self._places.levels[rows], self._places.fixed, 0.0, axis=1)

    def _add_beginning(self, prefix: tuple[int, ...]) -> Sums:
        """Vectors of a crank that begins so, with the fixed throw and the devices, (1,) each."""
        throws, row = self._places.free[: len(prefix)], np.array([prefix], np.int8)
        return _add(self._start, {k: own.add_throws(throws, row) for k, own in self._table.items()})

    def _find_bound(self, prefix: tuple[int, ...]) -> float:
        """Return the least possible cost: what is to come may cancel or add its whole size."""
        sums = self._add_beginning(prefix)
        to_come = self._places.free[len(prefix) :]

        keys: dict[AnyQuantity, Key] = {
            q: (q.kind, q.order) for q in choose_of_engine(self._objective.quantities)
        }

        def bound(q: AnyQuantity, side: int) -> Array:
            key = keys[q]
            reach = side * float(self._table[key].reach[to_come].sum())
            ahead, astern = (max(float(np.abs(v[0])) + reach, 0.0) for v in sums[key])
            sizes = {"forward": ahead, "backward": astern}
            sizes |= dict.fromkeys(("major", "amplitude"), ahead + astern)
            return np.array(
                sizes.get(q.name.rpartition(".")[2], 0.0 if side < 0 else ahead + astern)
            )

        if any(bound(q, -1) >= limit for q, limit in self._objective.limits.items()):
            return math.inf
        if self._objective.maximise:
            return -float(self._objective.add_up(partial(bound, side=1)))
        return float(self._objective.add_up(partial(bound, side=-1)))

    def _try(self, prefix: tuple[int, ...], left: Left) -> None:
        """Keep what is good enough of all cranks that begin so and end with what is left."""
        sums = _add(self._add_beginning(prefix), self._add_endings(left))
        read = {
            q: self._table[q.kind, q.order].read(q, *sums[q.kind, q.order])
            for q in choose_of_engine(self._objective.quantities)
        }
        merit = self._objective.judge(read)
        values = np.where(merit.excess > 0, np.inf, ranked(merit.cost))  # of equal ones the first
        good = np.flatnonzero(values < self._best.worst)
        if not len(good):
            return
        angles = self._find_angles(_prepend(prefix, _list_arrangements(left)[good]))
        values = values[good]
        if self._allowed is not None:
            may = self._allowed(angles)
            angles, values = angles[may], values[may]
        first = np.argsort(values, kind="stable")[: self._best.count]
        self._best.take(angles[first], values[first])


def _sum_endings(table: dict[Key, Contributions], free: list[int], left: Left) -> Sums:
    """What all arrangements of what is left add as the last of the free throws, (arrangements,)
    each.
    """
    rows = _list_arrangements(left)
    throws = free[len(free) - rows.shape[1] :]
    return {key: own.add_throws(throws, rows) for key, own in table.items()}


def _add(one: Sums, other: Sums) -> Sums:
    """Vectors of all that both have."""
    return {
        key: (ahead + other[key][0], astern + other[key][1]) for key, (ahead, astern) in one.items()
    }


def _take_one(left: Left, level: int) -> Left:
    return (*left[:level], left[level] - 1, *left[level + 1 :])


def _prepend(prefix: tuple[int, ...], rest: Arrangements) -> Arrangements:
    return np.concatenate([np.tile(np.array(prefix, np.int8), (len(rest), 1)), rest], axis=1)


@lru_cache(maxsize=4096)
def _list_arrangements(left: Left) -> Arrangements:
    """All distinct sequences with each index that often, shape (sequences, length)."""
    if not sum(left):
        return np.empty((1, 0), np.int8)
    first = [level for level, times in enumerate(left) if times]
    return np.concatenate(
        [_prepend((level,), _list_arrangements(_take_one(left, level))) for level in first]
    )
