"""Candidates of a search: their figures, all together where they are sums, and their merits."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from ...core.phases import TURN
from ...core.phasors import Array
from ...core.telling import Tell
from ...engine.arrays import ranked
from ...engine.build import Engine, build
from ...engine.firing import TOLERANCE_DEG
from ...engine.layout import cycle_deg, plan_cylinders
from ...engine.load import parse_dict
from ...enginefile.model import EngineFile
from ...enginefile.plain_tables import change_tables
from ...errors import BalcliError, InputError
from ...forces.quantity import evaluate_quantities
from ...limits import MOST_DESIGNS_ONE_BY_ONE
from ..parameters import tell_variant
from ..quantities import AnyQuantity, choose_of_engine, group_by_chapter, load_chapter
from ..varied_gas import attach_gas_torque
from .designs import Design, Found
from .objective import Merit, Objective

AT_ONCE = 256  # candidates that are built as one engine
_EVEN_DEG = 1e-9  # firings that are less uneven are even


class NumbersJudge:
    """Merits of values of some numbers of an engine file.

    Attributes:
        alone: whether quantities of mounts, torsion, guides or the cycle are asked for, which take
            each candidate by itself.
        refused: the first candidate that makes no engine, and why; empty if all do.

    Args:
        model: the engine file.
        paths: of the numbers.
        even_firing: whether the cylinders have to fire evenly.
        tell: is told how many candidates have been evaluated.
    """

    def __init__(
        self,
        model: EngineFile,
        paths: Sequence[str],
        objective: Objective,
        even_firing: bool,
        tell: Tell,
    ) -> None:
        self._model, self._paths, self._objective = model, paths, objective
        self._even_firing, self._tell, self._count = even_firing, tell, 0
        self._of_engine = choose_of_engine(objective.quantities)
        self._of_chapters = [
            (members, load_chapter(chapter).Variants(model, members))
            for chapter, members in group_by_chapter(objective.quantities).items()
        ]
        self.alone = bool(self._of_chapters) or not objective.is_sum_over_cylinders
        self.first_error: InputError | None = None
        self.refused = ""

    def __call__(self, points: Array) -> Merit:
        """Return the merits of points, shape (points, numbers); infinite where no engine is."""
        size = 1 if self.alone else AT_ONCE
        starts = range(0, len(points), size)
        return _join([self._judge(points[k : k + size]) for k in starts])

    def _judge(self, points: Array) -> Merit:
        try:
            merit = self._judge_engines(points)
        except InputError as error:
            if len(points) > 1:
                return _join([self._judge(half) for half in np.array_split(points, 2)])
            if self.first_error is None:
                self.first_error = error
                figures = dict(zip(self._paths, points[0].tolist(), strict=True))
                self.refused = f"{tell_variant(figures)}: {error.problems[0]}"
            merit = Merit(*np.full((2, 1), np.inf))
        self._count += len(points)
        self._tell(self._count)
        return merit

    def _judge_engines(self, points: Array) -> Merit:
        values = self.evaluate(points)
        merit = self._objective.judge(values)
        if not self._even_firing:
            return merit
        uneven = find_unevenness(self._build(points), self._model)
        missed = np.where(uneven > _EVEN_DEG, 1 + uneven, 0.0)
        return Merit(np.maximum(merit.excess, missed), merit.cost)

    def _build(self, points: Array) -> Engine:
        columns = dict(zip(self._paths, points.T, strict=True))
        return attach_gas_torque(build(self._model, columns), self._model, columns)

    def evaluate(self, points: Array) -> dict[AnyQuantity, Array]:
        """Return each quantity, shape (points,).

        Raises:
            InputError: one of the points makes no engine.
        """
        found: dict[AnyQuantity, Array] = {}
        if self._of_engine or self._even_firing:
            values = evaluate_quantities(self._build(points), self._of_engine)
            found |= {
                q: np.broadcast_to(value, len(points))
                for q, value in zip(self._of_engine, values, strict=True)
            }
        rows = [dict(zip(self._paths, point, strict=True)) for point in points.tolist()]
        for members, variants in self._of_chapters:
            columns = np.array([variants.evaluate(row) for row in rows]).T
            found |= dict(zip(members, columns, strict=True))
        return found


def _join(parts: Sequence[Merit]) -> Merit:
    """Return the merits of all candidates together."""
    none = np.empty(0)
    return Merit(
        np.concatenate([none, *(each.excess for each in parts)]),
        np.concatenate([none, *(each.cost for each in parts)]),
    )


def find_unevenness(engine: Engine, model: EngineFile) -> Array:
    """Return by how much the cylinders reach top dead centre beside even intervals, at most, deg,
    shape (candidates,).
    """
    c = engine.cylinders
    # of plain slider-cranks, as `Assembly.tops_deg`; articulated pins are set for their lead
    late = 0.0 if model.articulation else np.degrees(np.arcsin(c.eps / (1 + c.lam)))
    tops = np.asarray(c.axis_of_each_deg + late - c.pin_deg)
    tops = tops - tops[engine.numbers.index(1)]
    count = len(tops)
    ready = np.sort(np.mod(tops + TOLERANCE_DEG, TURN), axis=0) - TOLERANCE_DEG
    slots = np.sort(np.mod(cycle_deg(model.layout) * np.arange(count) / count, TURN))
    return np.asarray(np.abs(ready - slots.reshape(-1, *(1,) * (ready.ndim - 1))).max(axis=0))


def fires_evenly(engine: Engine, model: EngineFile) -> NDArray[np.bool_]:
    """Return whether the cylinders fire evenly within TOLERANCE_DEG, shape (candidates,)."""
    return np.asarray(find_unevenness(engine, model) <= TOLERANCE_DEG)


def drop_firing_order(model: EngineFile) -> EngineFile:
    """Return the file without its firing order and with some throws, so that any can be tried."""
    throws = model.crank.throws or (0.0,) * plan_cylinders(model.crank, model.layout).throws
    model = model.with_table("crank", throws=throws)
    return model.with_table("layout", firing_order=None, firing_intervals=None)


def build_throws(model: EngineFile, throws: Array) -> Engine:
    """Return engines with these throws, shape (candidates, throws), deg, as one engine."""
    columns = {f"crank.throws.{n}": column for n, column in enumerate(throws.T, 1)}
    return build(model, columns)


def rank_throws(model: EngineFile, throws: Array, objective: Objective) -> Iterator[Found]:
    """Yield throws that keep the limits, best first, by the figures of the whole engine."""
    if not len(throws):
        return
    wanted = choose_of_engine(objective.quantities)
    found = evaluate_quantities(build_throws(model, throws), wanted)
    values: Mapping[AnyQuantity, Array] = {
        q: np.broadcast_to(v, len(throws)) for q, v in zip(wanted, found, strict=True)
    }
    designs = [Design(throws=tuple(row)) for row in throws.tolist()]
    yield from rank_designs(designs, values, objective)


def rank_designs(
    designs: Sequence[Design], values: Mapping[AnyQuantity, Array], objective: Objective
) -> Iterator[Found]:
    """Yield the designs that keep the limits, best first, with their figures; `values`: of each
    quantity, shape (designs,).
    """
    merit = objective.judge(values)
    for k in Merit(merit.excess, ranked(merit.cost)).rank():
        if merit.excess[k] == 0 and np.isfinite(merit.cost[k]):
            figures = {q.name: float(value[k]) for q, value in values.items()}
            total = -merit.cost[k] if objective.maximise else merit.cost[k]
            yield Found(designs[k], float(total), figures)


def rank_one_by_one(
    model: EngineFile, designs: Iterable[Design], objective: Objective, tell: Tell
) -> Iterator[Found]:
    """Return the designs that keep the limits, best first, each computed by itself.

    Args:
        tell: is told the share that is done, and returns whether that is enough.

    Raises:
        BalcliError: more than MOST_DESIGNS_ONE_BY_ONE.
    """
    every = list(islice(designs, MOST_DESIGNS_ONE_BY_ONE + 1))
    if len(every) > MOST_DESIGNS_ONE_BY_ONE:
        raise BalcliError(
            f"there are more than {MOST_DESIGNS_ONE_BY_ONE} arrangements, and each takes a "
            "computation of its own: give crank.throws, or look for what inertia alone does"
        )
    rows = []
    for k, design in enumerate(every, 1):
        changed = parse_dict(change_tables(model, design.changes()), model.folder)
        rows.append(_evaluate(changed, objective))
        if tell(k / len(every)):
            break
    values = {q: np.array([row[q] for row in rows]) for q in objective.quantities} if rows else {}
    return rank_designs(every[: len(rows)], values, objective) if rows else iter(())


def _evaluate(model: EngineFile, objective: Objective) -> dict[AnyQuantity, float]:
    judge = NumbersJudge(model, (), objective, False, lambda _: False)
    return {q: float(v[0]) for q, v in judge.evaluate(np.empty((1, 0))).items()}
