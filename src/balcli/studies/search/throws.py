"""The best arrangements of given throw angles along the crank, by branch and bound.

Candidates are rows of indices into a table of what each throw contributes at each angle, thousands
at a time; a beginning of the crank is dropped as soon as nothing that may follow can bring its sum
below the best that are known.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import lru_cache, partial
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.phases import TURN
from ...core.phasors import Array, Complex
from ...core.telling import Tell, tell_nobody
from ...engine.arrays import ranked
from ...engine.layout import plan_cylinders
from ...enginefile.model import EngineFile
from ...errors import BalcliError
from ...forces.quantity import Quantity
from ...limits import MOST_ARRANGEMENTS
from .angles import neaten
from .objective import Objective
from .throw_contributions import Contributions, Key, tabulate_contributions

Arrangements = NDArray[np.int8]  # (arrangements, throws): indices of angles
Allowed = Callable[[Array], NDArray[np.bool_]]
Left = tuple[int, ...]  # how often each angle is still to be given
Sums = dict[Key, tuple[Complex, Complex]]  # forward and backward vectors, (candidates,) each
_DECIMALS = 9  # of angles that are equal, deg
BLOCK = 7  # throws of which all arrangements are tried at a time (7! = 5040)
_KEPT = 2**22  # sums of such arrangements that are kept, 32 bytes each


def find_best_throws(
    model: EngineFile,
    objective: Objective[Quantity],
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


def count_from(first: Array, throws: Array) -> Array:
    """Angles of throws counted from others, deg in [0, 360), as a file would have them."""
    return neaten(np.mod(throws - first, TURN)) % TURN


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
        objective: Objective[Quantity],
        places: _Places,
        best: _BestSoFar,
        allowed: Allowed | None,
        decided: _Decided,
    ) -> None:
        self._objective, self._places, self._best, self._allowed = objective, places, best, allowed
        self._decided = decided
        self._table = tabulate_contributions(
            model, places.levels, places.fixed, objective.quantities
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
        """What the objective is at least: what is to come may cancel as much as its size."""
        sums = self._add_beginning(prefix)
        to_come = self._places.free[len(prefix) :]

        def bound(q: Quantity) -> float:
            key = q.kind, q.order
            reach = float(self._table[key].reach[to_come].sum())
            ahead, astern = (max(float(np.abs(v[0])) - reach, 0.0) for v in sums[key])
            sizes = {"forward": ahead, "backward": astern}
            sizes |= dict.fromkeys(("major", "amplitude"), ahead + astern)
            return sizes.get(q.part, 0.0)

        return float(self._objective.evaluate(bound))

    def _try(self, prefix: tuple[int, ...], left: Left) -> None:
        """Keep what is good enough of all cranks that begin so and end with what is left."""
        sums = _add(self._add_beginning(prefix), self._add_endings(left))

        def read(q: Quantity) -> Array:
            key = q.kind, q.order
            return self._table[key].read(q, *sums[key])

        values = ranked(self._objective.evaluate(read))  # of equal arrangements the first are kept
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
