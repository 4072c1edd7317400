"""Designs computed each by itself: for quantities of gas, guides, mounts and torsion, which are no
sums over throws.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from itertools import islice, permutations
from typing import NamedTuple

import numpy as np

from ...core.golden_section import find_least
from ...core.phasors import Array
from ...core.telling import Tell, tell_nobody
from ...engine.arrays import ranked
from ...engine.build import build
from ...engine.load import parse_dict
from ...enginefile.model import EngineFile
from ...enginefile.plain_tables import change_tables
from ...errors import BalcliError, InputError
from ...forces.quantity import evaluate_quantities
from ...limits import MOST_DESIGNS_ONE_BY_ONE
from ..quantities import AnyQuantity, choose_of_engine, group_by_chapter, load_chapter
from .designs import Design, Found
from .objective import Objective
from .throws import count_from

_GRID = 32  # parts of a range, in which minima are looked for
_MINIMA = 3  # of these, the lowest, are followed
_ROUNDS = 44  # of golden section: to 1e-9 of a part of the range, where there is a kink
_AS_GOOD = 1e-13  # of the largest value thereabouts: a smooth minimum is flat to this
_DECIMALS = 11  # fewer than a part of the range is large, and more


def rank_one_by_one(
    model: EngineFile, designs: Iterable[Design], objective: Objective[AnyQuantity], tell: Tell
) -> Iterator[Found]:
    """Designs that keep the limits, with their figures, best first.

    Args:
        tell: which share of them is done; it may say that these are enough.

    Raises:
        BalcliError: more than MOST_DESIGNS_ONE_BY_ONE.
    """
    every = list(islice(designs, MOST_DESIGNS_ONE_BY_ONE + 1))
    if len(every) > MOST_DESIGNS_ONE_BY_ONE:
        raise BalcliError(
            f"there are more than {MOST_DESIGNS_ONE_BY_ONE} arrangements, and each takes a "
            "computation of its own: give crank.throws, or look for what inertia alone does"
        )
    found = []
    for k, design in enumerate(every, 1):
        found.append(_try(model, design, objective))
        if tell(k / len(every)):
            break
    order = np.argsort(ranked([one.objective for one in found]), kind="stable")
    return (found[k] for k in order if np.isfinite(found[k].objective))


def _try(model: EngineFile, design: Design, objective: Objective[AnyQuantity]) -> Found:
    changed = parse_dict(change_tables(model, design.changes()), model.folder)
    figures = _evaluate(changed, objective.quantities)
    by_name = {q.name: value for q, value in figures.items()}
    return Found(design, float(objective.evaluate(figures.__getitem__)), by_name)


def _evaluate(model: EngineFile, quantities: tuple[AnyQuantity, ...]) -> dict[AnyQuantity, float]:
    """Each quantity of an engine file."""
    of_engine = choose_of_engine(quantities)
    found: dict[AnyQuantity, float] = {}
    if of_engine:
        values = evaluate_quantities(build(model), of_engine)
        found |= {q: float(value) for q, value in zip(of_engine, values, strict=True)}
    for chapter, members in group_by_chapter(quantities).items():
        figures = load_chapter(chapter).Variants(model, members).evaluate({})
        found |= dict(zip(members, figures, strict=True))
    return found


def list_throws(model: EngineFile) -> Iterator[Design]:
    """All arrangements of the throw angles of a file, the first throw at 0, each once.

    Raises:
        BalcliError: gas in four strokes, which fires by an order of its own.
    """
    if model.gas is not None and model.layout.strokes == 4:
        raise BalcliError(
            "with [gas] in four strokes the firing order decides, too: search --over firing_order "
            "(without crank.throws in the file it tries all cranks)"
        )
    seen = set()
    for throws in permutations(model.crank.throws or ()):
        angles = np.asarray(throws, float)
        turned = tuple(count_from(angles[:1], angles).tolist())
        if turned not in seen:
            seen.add(turned)
            yield Design(throws=turned)


def find_best_numbers(
    evaluate: Callable[[float], float], low: float, high: float, tell: Tell = tell_nobody
) -> list[float]:
    """Where a function of a number is least in a range: local minima, found on a grid and followed
    as far as the function tells them from their neighbours, lowest first; there the roundest number
    that is as good, and of a stretch of equal values the first point of the grid.

    Args:
        evaluate: infinite where it cannot be or may not be.
        tell: which share is done; it may say that what is found by then is enough.
    """
    if low == high:
        return [low] if math.isfinite(evaluate(low)) else []
    grid = np.linspace(low, high, _GRID + 1)
    values = np.full(len(grid), np.inf)
    share = 1 / (len(grid) + _MINIMA)
    for k, x in enumerate(grid):
        values[k] = evaluate(float(x))
        enough = tell((k + 1) * share)
        if enough:
            break
    followed = _find_bottoms(values)
    found = [(float(values[k]), float(grid[k])) for k in followed]
    for n, k in enumerate(followed):
        if enough:
            break
        around = slice(max(k - 1, 0), k + 2)
        ends = float(grid[around][0]), float(grid[around][-1])
        slack = _AS_GOOD * np.abs(values[around][np.isfinite(values[around])]).max()
        near = find_least(evaluate, *ends, _ROUNDS)
        value = evaluate(near)
        if value < found[n][0]:
            found[n] = _round_off(evaluate, near, value + slack, ends)
        enough = tell((len(grid) + n + 1) * share)
    return [x for _, x in sorted(found)]


def _round_off(
    evaluate: Callable[[float], float], x: float, enough: float, ends: tuple[float, float]
) -> tuple[float, float]:
    """The value and the place of the roundest number between the ends that is good enough."""
    low, high = ends
    coarsest = -math.floor(math.log10(high - low))
    for digits in range(coarsest, coarsest + _DECIMALS):
        rounder = round(x, digits)
        if low <= rounder <= high and (value := evaluate(rounder)) <= enough:
            return value, rounder
    return evaluate(x), x


def _find_bottoms(values: Array) -> list[int]:
    """Which of a row of values lie below their neighbours, the lowest three; one of each stretch of
    equal ones.
    """
    starts = np.flatnonzero(np.append(True, values[1:] != values[:-1]))
    steps = values[starts]
    before, after = np.append(np.inf, steps[:-1]), np.append(steps[1:], np.inf)
    bottoms = np.flatnonzero((steps <= before) & (steps <= after) & np.isfinite(steps))
    lowest = bottoms[np.argsort(steps[bottoms], kind="stable")][:_MINIMA]
    return [int(k) for k in starts[lowest]]


class BestNumbers(NamedTuple):
    """Designs with the best values of a number in a range.

    Attributes:
        constant: whether the objective is the same for all values that were tried.
        refused: a value that makes no engine, and why: `rod.length = 20: …`; empty if all do.
    """

    designs: list[Design]
    constant: bool
    refused: str


def find_best_designs(
    model: EngineFile,
    name: Callable[[float], Design],
    low: float,
    high: float,
    objective: Objective[AnyQuantity],
    tell: Tell = tell_nobody,
) -> BestNumbers:
    """Designs with the best values of a number in a range.

    Args:
        name: the design that has a value of it.
        tell: as of `find_best_numbers`.

    Raises:
        InputError: no value makes an engine.
    """
    mistakes: list[tuple[float, InputError]] = []
    found: list[float] = []

    def evaluate(value: float) -> float:
        try:
            found.append(_try(model, name(value), objective).objective)
        except InputError as error:
            mistakes.append((value, error))
            return np.inf
        return found[-1]

    best = find_best_numbers(evaluate, low, high, tell)
    if not found:
        raise mistakes[0][1]
    span = max(found) - min(found)
    constant = low < high and not mistakes and span <= _AS_GOOD * max(map(abs, found)) < math.inf
    refused = ""
    if mistakes:
        value, error = mistakes[0]
        [(key, setting)] = name(value).given().items()
        refused = f"{key} = {setting:.6g}: {error.problems[0]}"
    return BestNumbers(list(map(name, best)), constant, refused)
