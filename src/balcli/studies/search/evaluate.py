"""Candidates of a search: their figures, all together where they are sums, and their merits."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from ...core.phases import TURN
from ...core.phasors import Array
from ...engine.build import Engine
from ...engine.figures import ranked
from ...engine.layout import TOLERANCE_DEG, cycle_deg, plan_cylinders
from ...engine.parse import parse_dict
from ...errors import BalcliError, InputError
from ...file.model import EngineFile
from ...file.plain_tables import change_tables
from ...limits import MOST_DESIGNS_ONE_BY_ONE
from ...process import Tell
from ..evaluator import Evaluator
from ..parameters import tell_variant
from ..quantities import AnyQuantity
from .designs import Design, Found, Merit, Objective, list_changes

AT_ONCE = 256  # candidates that are built as one engine
_EVEN_DEG = 1e-9  # firings that are less uneven are even


class NumbersJudge:
    """Merits of values of some numbers of an engine file.

    Args:
        model: Engine file.
        paths: Dotted names of the numbers.
        objective: Objective of the search.
        even_firing: Whether the cylinders have to fire evenly.
        tell: Called with the number of candidates so far.

    Attributes:
        alone: Whether each candidate takes a computation of its own.
        refused: Error of the first candidate that makes no engine, with its numbers as `file`;
            None if all do.
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
        self._evaluator = Evaluator(model, objective.quantities)
        self.alone = not objective.is_sum_over_cylinders
        self.refused: InputError | None = None

    def __call__(self, points: Array) -> Merit:
        """Return the merits of points, shape (points, numbers); infinite where no engine is."""
        size = 1 if self.alone else AT_ONCE
        return _join([self._judge(points[k : k + size]) for k in range(0, len(points), size)])

    def _judge(self, points: Array) -> Merit:
        try:
            merit = self._judge_engines(points)
        except InputError as error:
            if len(points) > 1:
                return _join([self._judge(half) for half in np.array_split(points, 2)])
            figures = dict(zip(self._paths, points[0].tolist(), strict=True))
            self.refused = self.refused or InputError(error.problems, tell_variant(figures))
            merit = Merit(*np.full((2, 1), np.inf))
        self._count += len(points)
        self._tell(self._count)
        return merit

    def _judge_engines(self, points: Array) -> Merit:
        merit = self._objective.judge(self.evaluate(points))
        if not self._even_firing:
            return merit
        columns = dict(zip(self._paths, points.T, strict=True))
        uneven = find_unevenness(self._evaluator.build(columns, 1), self._model)
        missed = np.where(uneven > _EVEN_DEG, 1 + uneven, 0.0)
        return Merit(np.maximum(merit.excess, missed), merit.cost)

    def evaluate(self, points: Array) -> dict[AnyQuantity, Array]:
        """Return each quantity, shape (points,).

        Raises:
            InputError: One of the points makes no engine.
        """
        columns = dict(zip(self._paths, points.T, strict=True))
        values = self._evaluator.evaluate(columns, (len(points),))
        return dict(zip(self._objective.quantities, values, strict=True))


def _join(parts: Sequence[Merit]) -> Merit:
    """Return the merits of all candidates together."""
    return Merit(*np.concatenate([np.empty((2, 0)), *parts], axis=1))


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


def name_throws(throws: Array) -> dict[str, Array]:
    """Return throws, shape (candidates, throws), deg, as figures of the file."""
    return {f"crank.throws.{n}": column for n, column in enumerate(throws.T, 1)}


def rank_throws(model: EngineFile, throws: Array, objective: Objective) -> Iterator[Found]:
    """Yield throws that keep the limits, best first, by the figures of the whole engine."""
    if not len(throws):
        return
    found = Evaluator(model, objective.quantities).evaluate(name_throws(throws), throws.shape[:1])
    designs = [{"throws": row} for row in throws.tolist()]
    yield from rank_designs(designs, dict(zip(objective.quantities, found, strict=True)), objective)


def rank_designs(
    designs: Sequence[Design], values: Mapping[AnyQuantity, Array], objective: Objective
) -> Iterator[Found]:
    """Yield the designs that keep the limits, best first, with their figures.

    Args:
        designs: Arrangements.
        values: Each quantity, shape (designs,).
        objective: Objective of the search.
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
        model: Engine file.
        designs: Arrangements.
        objective: Objective of the search.
        tell: Called with the share that is done; returns whether to stop.

    Raises:
        BalcliError: More than MOST_DESIGNS_ONE_BY_ONE.
    """
    every = list(islice(designs, MOST_DESIGNS_ONE_BY_ONE + 1))
    if len(every) > MOST_DESIGNS_ONE_BY_ONE:
        raise BalcliError(
            f"there are more than {MOST_DESIGNS_ONE_BY_ONE} arrangements, and each takes a "
            "computation of its own: give crank.throws, or look for what inertia alone does"
        )
    rows: list[list[Array]] = []
    for k, design in enumerate(every, 1):
        changed = parse_dict(change_tables(model, list_changes(design)), model.folder)
        rows.append(Evaluator(changed, objective.quantities).evaluate({}, (1,)))
        if tell(k / len(every)):
            break
    values = np.array(rows).reshape(-1, len(objective.quantities)).T
    return rank_designs(
        every[: len(rows)], dict(zip(objective.quantities, values, strict=True)), objective
    )
