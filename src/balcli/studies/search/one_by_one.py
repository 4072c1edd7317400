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
from .objective import Merit, Objective
from .throws import count_from

_GRID = 32  # parts of a range, in which minima are looked for
_MINIMA = 3  # of these, the lowest, are followed
_ROUNDS = 44  # of golden section: to 1e-9 of a part of the range, where there is a kink
_AS_GOOD = 1e-13  # of the largest value thereabouts: a smooth minimum is flat to this
_DECIMALS = 11  # fewer than a part of the range is large, and more
_IMPOSSIBLE = Merit(math.inf, math.inf)


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
    figures = _evaluate(model, design, objective.quantities)
    by_name = {q.name: value for q, value in figures.items()}
    return Found(design, float(objective.evaluate(figures.__getitem__)), by_name)


def _evaluate(
    model: EngineFile, design: Design, quantities: tuple[AnyQuantity, ...]
) -> dict[AnyQuantity, float]:
    """Each quantity of an engine file with this design."""
    changed = parse_dict(change_tables(model, design.changes()), model.folder)
    of_engine = choose_of_engine(quantities)
    found: dict[AnyQuantity, float] = {}
    if of_engine:
        values = evaluate_quantities(build(changed), of_engine)
        found |= {q: float(value) for q, value in zip(of_engine, values, strict=True)}
    for chapter, members in group_by_chapter(quantities).items():
        figures = load_chapter(chapter).Variants(changed, members).evaluate({})
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
    judge: Callable[[float], Merit], low: float, high: float, tell: Tell = tell_nobody
) -> list[float]:
    """Where a function of a number is least in a range and keeps its limits: local minima, found on
    a grid and followed as far as the function tells them from their neighbours, lowest first; there
    the roundest number that is as good, and of a stretch of equal values the first point of the
    grid. Where the grid breaks limits, it is followed to where they are broken least: what keeps
    them may lie between two of its points.

    Args:
        judge: infinite where it cannot be.
        tell: which share is done; it may say that what is found by then is enough.
    """
    if low == high:
        return [low] if _keeps_limits(judge(low)) else []
    grid = np.linspace(low, high, _GRID + 1).tolist()
    judged: list[Merit] = []
    share = 1 / (len(grid) + _MINIMA)
    for k, x in enumerate(grid):
        judged.append(judge(x))
        enough = tell((k + 1) * share)
        if enough:
            break
    followed = _find_bottoms(judged)
    found = [(judged[k], grid[k]) for k in followed]
    for n, k in enumerate(followed):
        if enough:
            break
        around = slice(max(k - 1, 0), k + 2)
        ends = grid[around][0], grid[around][-1]
        slack = _AS_GOOD * max(abs(one.value) for one in judged[around] if math.isfinite(one.value))
        near = find_least(judge, *ends, _ROUNDS)
        there = judge(near)
        if there < found[n][0]:
            found[n] = _round_off(judge, near, there._replace(value=there.value + slack), ends)
        enough = tell((len(grid) + n + 1) * share)
    return [x for one, x in sorted(found) if _keeps_limits(one)]


def _keeps_limits(one: Merit) -> bool:
    return one.excess == 0 and math.isfinite(one.value)


def _round_off(
    judge: Callable[[float], Merit], x: float, enough: Merit, ends: tuple[float, float]
) -> tuple[Merit, float]:
    """The merit and the place of the roundest number between the ends that is good enough."""
    low, high = ends
    coarsest = -math.floor(math.log10(high - low))
    for digits in range(coarsest, coarsest + _DECIMALS):
        rounder = round(x, digits) + 0.0  # without the sign of -0.0
        if low <= rounder <= high and (there := judge(rounder)) <= enough:
            return there, rounder
    return judge(x), x


def _find_bottoms(judged: list[Merit]) -> list[int]:
    """Which of a row are better than their neighbours, the best three; one of each stretch of equal
    ones.
    """
    starts = [k for k, one in enumerate(judged) if k == 0 or one != judged[k - 1]]
    steps = [judged[k] for k in starts]
    before, after = [_IMPOSSIBLE, *steps[:-1]], [*steps[1:], _IMPOSSIBLE]
    bottoms = [
        k
        for k, one in enumerate(steps)
        if one <= before[k] and one <= after[k] and math.isfinite(sum(one))
    ]
    return [starts[k] for k in sorted(bottoms, key=steps.__getitem__)[:_MINIMA]]


class BestNumbers(NamedTuple):
    """Designs with the best values of a number in a range.

    Attributes:
        constant: whether the objective, limits left aside, is the same for all values tried.
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

    def judge(value: float) -> Merit:
        try:
            figures = _evaluate(model, name(value), objective.quantities)
        except InputError as error:
            mistakes.append((value, error))
            return _IMPOSSIBLE
        one = objective.judge(figures.__getitem__)
        found.append(one.value)
        return one

    best = find_best_numbers(judge, low, high, tell)
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
