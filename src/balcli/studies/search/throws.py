"""The best arrangements of given throw angles along the crank, by branch and bound.

Candidates are rows of indices into a table of what each throw contributes at each angle, thousands
at a time; a beginning of the crank is dropped as soon as nothing that may follow can bring its sum
below the best that are known.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...engine.arrays import ranked
from ...engine.layout import plan_cylinders
from ...enginefile.model import EngineFile
from ...errors import BalcliError
from ...forces.quantity import Quantity
from ...limits import MOST_ARRANGEMENTS
from .objective import Objective
from .throw_contributions import Array, Complex, Key, Share, shares

Indices = NDArray[np.int8]
Allowed = Callable[[Array], NDArray[np.bool_]]
Left = tuple[int, ...]  # how often each angle is still to be given
BLOCK = 7  # throws of which all arrangements are tried at a time (7! = 5040)


def best(
    file: EngineFile, objective: Objective, count: int, allowed: Allowed | None = None
) -> Array:
    """The best arrangements of the file's throw angles, shape (at most count, throws), cylinder 1's
    throw at 0, best first.

    Args:
        allowed: which of some arrangements (shape (candidates, throws)) may be; None: all.

    Raises:
        BalcliError: more than MOST_ARRANGEMENTS.
    """
    given = np.mod(np.asarray(file.crank.throws, float), 360.0)
    if _count(given) > MOST_ARRANGEMENTS:
        raise BalcliError(
            f"crank.throws: {len(given)} throws can be arranged in more than "
            f"{MOST_ARRANGEMENTS:g} ways, too many to search"
        )
    fixed = next(c.throw for c in plan_cylinders(file.crank, file.layout).cells if c.number == 1)
    free = [t for t in range(len(given)) if t != fixed]
    found = _Best(count)
    for angles in _turns(given):
        levels, times = np.unique(angles, return_counts=True)

        tree = _Tree(
            shares(file, levels, fixed, objective.quantities),
            objective,
            levels,
            fixed,
            free,
            found,
            allowed,
        )
        tree.grow((), (times[0] - 1, *times[1:]))
    return found.rows


def _count(given: Array) -> int:
    """How many arrangements there are."""
    return math.factorial(len(given)) // math.prod(
        map(math.factorial, np.unique(given, return_counts=True)[1].tolist())
    )


def _turns(given: Array) -> Iterator[Array]:
    """The angles counted from each that can be cylinder 1's; turns that give the same angles
    once.
    """
    seen = set()
    for first in given:
        turned = np.sort(np.round(np.mod(given - first, 360.0), 9) % 360.0)
        if turned.tobytes() not in seen:
            seen.add(turned.tobytes())
            yield turned


class _Best:
    """The best candidates so far."""

    def __init__(self, count: int) -> None:
        self.count, self.worst = count, np.inf
        self.rows, self._values = np.empty((0, 0)), np.empty(0)

    def take(self, rows: Array, values: Array) -> None:
        both = np.concatenate([self._values, values])
        order = np.argsort(both, kind="stable")[: self.count]
        self.rows = (np.concatenate([self.rows, rows]) if len(self.rows) else rows)[order]
        self._values = both[order]
        self.worst = self._values[-1] if len(order) == self.count else np.inf


class _Tree:
    """All arrangements of one set of angles, beginnings of the crank first."""

    def __init__(
        self,
        table: dict[Key, Share],
        objective: Objective,
        levels: Array,
        fixed: int,
        free: list[int],
        found: _Best,
        allowed: Allowed | None,
    ) -> None:
        self._table, self._objective, self._found, self._allowed = table, objective, found, allowed
        self._levels, self._fixed, self._free = levels, fixed, free
        self._start = {
            key: tuple(
                a + b
                for a, b in zip(
                    share.sums([fixed], np.zeros((1, 1), np.int8)), share.devices, strict=True
                )
            )
            for key, share in table.items()
        }

    def grow(self, prefix: tuple[int, ...], left: Left) -> None:
        """Try everything that begins so."""
        if len(prefix) and self._least(prefix) >= self._found.worst:
            return
        if sum(left) <= BLOCK:
            self._try(_joined(prefix, _arrangements(left)))
            return
        for level, times in enumerate(left):
            if times:
                self.grow((*prefix, level), (*left[:level], times - 1, *left[level + 1 :]))

    def _whole(self, rows: Indices) -> Array:
        """Angles of all throws by the indices of the free ones."""
        return np.insert(self._levels[rows], self._fixed, 0.0, axis=1)

    def _sums(self, key: Key, rows: Indices) -> tuple[Complex, Complex]:
        ahead, astern = self._table[key].sums(self._free[: rows.shape[1]], rows)
        return self._start[key][0] + ahead, self._start[key][1] + astern

    def _least(self, prefix: tuple[int, ...]) -> float:
        """A bound of the objective from below: what is to come may cancel as much as its size."""
        sums = {key: self._sums(key, np.array([prefix], np.int8)) for key in self._table}
        to_come = {
            key: share.reach[self._free[len(prefix) :]].sum() for key, share in self._table.items()
        }

        def least(q: Quantity) -> float:
            ahead, astern = (
                max(float(np.abs(v[0])) - to_come[q.kind, q.order], 0.0)
                for v in sums[q.kind, q.order]
            )
            return {
                "major": ahead + astern,
                "amplitude": ahead + astern,
                "forward": ahead,
                "backward": astern,
            }.get(q.part, 0.0)

        return float(self._objective.of(least))

    def _try(self, rows: Indices) -> None:
        sums = {key: self._sums(key, rows) for key in self._table}
        values = self._objective.of(
            lambda q: self._table[q.kind, q.order].value(q, *sums[q.kind, q.order])
        )
        values = ranked(values)  # of equal arrangements the first are kept
        good = np.flatnonzero(values < self._found.worst)
        if self._allowed is not None and len(good):
            good = good[self._allowed(self._whole(rows[good]))]
        if len(good):
            good = good[np.argsort(values[good], kind="stable")[: self._found.count]]
            self._found.take(self._whole(rows[good]), values[good])


def _joined(prefix: tuple[int, ...], rest: Indices) -> Indices:
    return np.concatenate([np.tile(np.array(prefix, np.int8), (len(rest), 1)), rest], axis=1)


@lru_cache(maxsize=4096)
def _arrangements(left: Left) -> Indices:
    """All distinct sequences with each index that often, shape (sequences, length)."""
    if not sum(left):
        return np.empty((1, 0), np.int8)
    return np.concatenate(
        [
            _joined((k,), _arrangements((*left[:k], times - 1, *left[k + 1 :])))
            for k, times in enumerate(left)
            if times
        ]
    )
