"""Search over the throws of a crank: the sequence of its angles along the crank.

Forces and moments are sums over the throws, tabulated by throw and angle. Branch and bound drops
the first throws of a crank when no sequence of the others can make their sum better than the best
known ones.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache, partial
from itertools import permutations
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ...core.phases import TURN
from ...core.phasors import Array, Complex, Phasors
from ...engine.build import assemble, build
from ...engine.figures import ranked
from ...engine.layout import plan_cylinders
from ...errors import BalcliError
from ...file.model import EngineFile
from ...forces.quantity import Quantity
from ...forces.spectrum import compute_spectra, with_only
from ...limits import MOST_ARRANGEMENTS
from ...process import Tell, tell_nobody
from ...show.sheet import count_name
from ..quantities import AnyQuantity, choose_of_engine
from .designs import Design, Found, Objective, fires_evenly, name_throws, rank_throws

Left: TypeAlias = tuple[int, ...]  # how often each angle is still to be given
Allowed = Callable[[Array], NDArray[np.bool_]]
IMAGES = 8  # candidates kept for each that is asked for, as many are mirror images
BLOCK = 7  # throws of which all arrangements are tried at a time (7! = 5040)
ENDINGS = 256  # such sets of throws whose sums are kept
_DECIMALS = 9  # of angles that are equal, deg
_NEAR = 1e-11  # deg, from a short decimal
ROUNDING = 1e-12  # sums below this share of the size of their parts are 0


def search_throws(
    model: EngineFile, objective: Objective, wanted: int, even_firing: bool, tell: Tell
) -> Iterator[Found]:
    """Yield at least `wanted` arrangements of the throws of a file, best first, if there are so
    many; its quantities are sums over the cylinders.

    Raises:
        BalcliError: There is nothing to arrange, or a peak is asked for.
    """
    if peaks := [q.name for q in choose_of_engine(objective.quantities) if q.part == "peak"]:
        raise BalcliError(
            f"a search over throws adds up orders, which {peaks[0]} does not allow; name orders, "
            "such as force.1.major"
        )

    def can_fire(throws: Array) -> NDArray[np.bool_]:
        return fires_evenly(build(model, name_throws(throws)), model)

    allowed = can_fire if even_firing else None
    throws = find_best_throws(model, objective, IMAGES * wanted, allowed, tell)
    if len(throws):
        throws = count_from(throws[:, :1], throws)
    return rank_throws(model, throws, objective)


def list_throws(model: EngineFile) -> Iterator[Design]:
    """Yield all arrangements of the throw angles of a file, the first throw at 0, each once.

    Raises:
        BalcliError: Gas in four strokes, which fires by an order of its own.
    """
    if model.gas is not None and model.layout.strokes == 4:
        raise BalcliError(
            "with [gas] in four strokes the result depends on the firing order as well; use "
            "--over firing_order (without crank.throws in the file it tries all cranks)"
        )
    every = (np.asarray(row, float) for row in permutations(model.crank.throws or ()))
    turned = (tuple(count_from(row[:1], row).tolist()) for row in every)
    yield from ({"throws": list(throws)} for throws in dict.fromkeys(turned))


def give_throws(model: EngineFile) -> EngineFile:
    """Return the file with the throws that its firing order needs, where it gives none.

    Raises:
        BalcliError: The crank has one throw, or cylinders have throws of their own.
    """
    if any(own.throw is not None for own in model.cylinder.values()):
        raise BalcliError(
            "cylinders with throws of their own take no part in an arrangement of crank.throws: "
            "give crank.throws and splay alone"
        )
    if model.crank.throws is None and model.layout.firing_order:
        found = assemble(model).pins.throws_deg
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
class Contributions(NamedTuple):
    """Forward and backward vectors of some kinds and orders, in their order.

    Attributes:
        keys: Kinds and orders.
        throws: Vectors of every throw at every angle, shape (keys, 2, throws, angles).
        devices: Vectors of the devices, shape (keys, 2).
        reach: The most by which a throw can change a vector, shape (keys, throws).
    """

    keys: list[tuple[str, float]]
    throws: Complex
    devices: Complex
    reach: Array

    def read(self, quantity: Quantity, sums: Complex) -> Array:
        """Return a quantity by the sums over all throws and the devices, shape (keys, 2,
        candidates).
        """
        k = self.keys.index((quantity.kind, quantity.order))
        noise = np.full((1, 1), ROUNDING * self.reach[k].sum())
        order = np.array([float(quantity.order)])
        return quantity.read_from(Phasors.of(order, sums[k, :1], sums[k, 1:], noise).drop_noise())


def tabulate_contributions(
    model: EngineFile, angles: Array, fixed: int, quantities: tuple[Quantity, ...]
) -> Contributions:
    """Return the contributions to the quantities, with throw `fixed` (cylinder 1's) at 0 and the
    others at any of `angles` (deg).
    """
    throw_of = {c.number: c.throw for c in plan_cylinders(model).cells}
    count = 1 + max(throw_of.values())
    paths = {f"crank.throws.{t + 1}": 0.0 if t == fixed else angles for t in range(count)}
    engine = build(model, paths)
    own_throw = np.array([throw_of[number] for number in engine.numbers])
    parts = [with_only(engine, own_throw == throw) for throw in range(count)]
    parts.append(replace(with_only(engine, own_throw < 0), devices=engine.devices))
    keys = list(dict.fromkeys((q.kind, q.order) for q in quantities))
    orders, kinds = sorted({order for _, order in keys}), {kind for kind, _ in keys}
    spectra = [compute_spectra(part, orders, kinds) for part in parts]
    table = np.empty((len(keys), 2, len(parts), len(angles)), complex)
    for k, (kind, order) in enumerate(keys):
        for part, spectrum in enumerate(spectra):
            phasors = spectrum[kind].select_orders([order])
            table[k, 0, part], table[k, 1, part] = phasors.forward[0], phasors.backward[0]
    throws = table[:, :, :-1]
    return Contributions(keys, throws, table[:, :, -1, 0], np.abs(throws).max(axis=(1, 3)))


# ------------------------------------------------------------------ branch and bound
def find_best_throws(
    model: EngineFile,
    objective: Objective,
    count: int,
    allowed: Allowed | None = None,
    tell: Tell = tell_nobody,
) -> Array:
    """Return the best arrangements of the file's throw angles, shape (at most count, throws),
    cylinder 1's throw at 0, best first, deg.

    Args:
        model: Engine file with throws.
        objective: Sums over the cylinders.
        count: Most arrangements to return.
        allowed: Function that tells which arrangements (candidates, throws) are allowed; None: all.
        tell: Called with the share of all arrangements that has been decided; returns whether to
            stop with the best of those.

    Raises:
        BalcliError: More than MOST_ARRANGEMENTS.
    """
    given = np.mod(np.asarray(model.crank.throws, float), 360.0)
    if _count_sequences(np.unique(given, return_counts=True)[1]) > MOST_ARRANGEMENTS:
        raise BalcliError(
            f"crank.throws: {len(given)} throws have more than {count_name(MOST_ARRANGEMENTS)} "
            "arrangements, too many to search"
        )
    turned: dict[bytes, Array] = {}  # counted from each angle that can be cylinder 1's, once
    for row in np.sort(count_from(given[:, None], given)):
        turned.setdefault(np.round(row, _DECIMALS).tobytes(), row)
    trees = [_Tree(model, objective, angles, allowed) for angles in turned.values()]
    best = _BestSoFar(count, np.empty((0, len(given))), np.empty(0))
    total, done = sum(_count_sequences(tree.left) for tree in trees), 0
    for tree in trees:
        for decided in tree.grow(best):
            done += decided
            if tell(done / total) and len(best.rows):
                return best.rows
    return best.rows


def _count_sequences(left: Iterable[int]) -> int:
    """Return the number of sequences of angles, each of which remains so often."""
    times = [*left]
    return math.factorial(sum(times)) // math.prod(map(math.factorial, times))


@lru_cache(maxsize=4096)
def _list_sequences(left: Left) -> NDArray[np.int8]:
    """Return all sequences of angles, each of which remains so often, (sequences, length)."""
    if not sum(left):
        return np.empty((1, 0), np.int8)
    parts = [
        np.insert(_list_sequences(fewer), 0, level, axis=1) for level, fewer in _take_one(left)
    ]
    return np.concatenate(parts)


def _take_one(left: Left) -> Iterator[tuple[int, Left]]:
    """Yield every remaining angle, and the counts that remain without it."""
    for level, times in enumerate(left):
        if times:
            yield level, (*left[:level], times - 1, *left[level + 1 :])


class _BestSoFar:
    """The best candidates so far, at most `count`.

    Attributes:
        rows: Angles of all throws, deg, shape (candidates, throws), best first.
        values: Their costs.
        worst: Cost above which a candidate is not one of them.
    """

    def __init__(self, count: int, rows: Array, values: Array) -> None:
        self.count, self.rows, self.values, self.worst = count, rows, values, np.inf

    def take(self, rows: Array, values: Array) -> None:
        """Keep those of further candidates that belong to them; of equal ones the first stay."""
        together = np.concatenate([self.values, values])
        order = np.argsort(together, kind="stable")[: self.count]
        self.rows, self.values = np.concatenate([self.rows, rows])[order], together[order]
        self.worst = self.values[-1] if len(order) == self.count else np.inf


class _Tree:
    """All arrangements of one set of angles, deg, ascending; cylinder 1's throw has the first."""

    def __init__(
        self, model: EngineFile, objective: Objective, angles: Array, allowed: Allowed | None
    ) -> None:
        self._model, self._objective, self._allowed = model, objective, allowed
        self._levels, times = np.unique(angles, return_counts=True)
        self.left: Left = (int(times[0]) - 1, *map(int, times[1:]))
        cells = plan_cylinders(model).cells
        self._fixed = next(cell.throw for cell in cells if cell.number == 1)
        self._free = [t for t in range(len(angles)) if t != self._fixed]
        # The last throws add the same whatever the crank begins with: other orders of the same
        # beginning, which soon follow, leave the same throws.
        self._add_endings = lru_cache(ENDINGS)(self._sum_endings)

    def grow(self, best: _BestSoFar) -> Iterator[int]:
        """Try all arrangements, and yield how many more have been decided."""
        quantities = choose_of_engine(self._objective.quantities)
        self._table = tabulate_contributions(self._model, self._levels, self._fixed, quantities)
        start = self._table.throws[:, :, self._fixed, 0] + self._table.devices
        yield from self._grow(best, (), self.left, start)

    def _grow(
        self, best: _BestSoFar, prefix: tuple[int, ...], left: Left, sums: Complex
    ) -> Iterator[int]:
        """Try all cranks with this beginning; `sums`: its vectors, shape (keys, 2)."""
        if self._find_bound(self._free[len(prefix) :], sums) >= best.worst:
            yield _count_sequences(left)
        elif sum(left) <= BLOCK:
            self._try(best, prefix, left, sums)
            yield _count_sequences(left)
        else:
            throw = self._free[len(prefix)]
            for level, fewer in _take_one(left):
                more = sums + self._table.throws[:, :, throw, level]
                yield from self._grow(best, (*prefix, level), fewer, more)

    def _find_bound(self, to_come: list[int], sums: Complex) -> float:
        """Return the least possible cost: remaining throws may cancel or add their whole size."""
        reach = self._table.reach[:, to_come].sum(axis=1)[:, None]
        least, most = np.maximum(np.abs(sums) - reach, 0.0), np.abs(sums) + reach

        rows: dict[AnyQuantity, int] = {
            q: self._table.keys.index((q.kind, q.order))
            for q in choose_of_engine(self._objective.quantities)
        }

        def bound(q: AnyQuantity, ends: Array) -> float:
            _, _, part = q.name.rpartition(".")
            ahead, astern = ends[rows[q]].tolist()
            if part in ("forward", "backward"):
                return float(ahead if part == "forward" else astern)
            known = part in ("major", "amplitude") or ends is most
            return float(ahead + astern if known else 0.0)

        if any(bound(q, least) >= limit for q, limit in self._objective.limits.items()):
            return math.inf
        if self._objective.maximise:
            return -float(self._objective.add_up(partial(bound, ends=most)))
        return float(self._objective.add_up(partial(bound, ends=least)))

    def _sum_endings(self, left: Left) -> Complex:
        """Return the vectors of all sequences of the remaining angles as the last free throws,
        shape (keys, 2, sequences).
        """
        rows = _list_sequences(left)
        columns = zip(self._free[len(self._free) - sum(left) :], rows.T, strict=True)
        nothing = np.zeros((*self._table.devices.shape, len(rows)), complex)
        return sum((self._table.throws[:, :, t, levels] for t, levels in columns), nothing)

    def _try(self, best: _BestSoFar, prefix: tuple[int, ...], left: Left, sums: Complex) -> None:
        """Keep the best of all cranks with this beginning and the remaining angles."""
        whole = sums[..., None] + self._add_endings(left)
        quantities = choose_of_engine(self._objective.quantities)
        merit = self._objective.judge({q: self._table.read(q, whole) for q in quantities})
        values = np.where(merit.excess > 0, np.inf, ranked(merit.cost))  # of equal ones the first
        good = np.flatnonzero(values < best.worst)
        if not len(good):
            return
        ends, begin = _list_sequences(left)[good], np.tile(prefix, (len(good), 1))
        rows = np.concatenate([begin, ends], axis=1).astype(int)
        angles, values = np.insert(self._levels[rows], self._fixed, 0.0, axis=1), values[good]
        if self._allowed is not None:
            may = self._allowed(angles)
            angles, values = angles[may], values[may]
        best.take(angles, values)
