"""Best arrangements of an engine: throws along the crank, firing order, bank angle, splay."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from typing import Any, get_args
from typing import Literal as OneOf

import numpy as np
from numpy.typing import NDArray

from ...engine.arrays import ranked
from ...engine.build import Engine, assemble, build
from ...engine.firing import TOLERANCE_DEG
from ...engine.layout import cycle_deg, plan_cylinders
from ...enginefile.fields import nearest
from ...enginefile.model import EngineFile
from ...errors import BalcliError
from ...forces.quantity import evaluate
from ...results.analysis import Textbook, textbook
from . import angles
from . import throws as cranks
from .firing_orders import Slots
from .objective import Array, Objective, objective

__all__ = ["Found", "Search", "fires_evenly", "objective", "search"]

What = OneOf["throws", "firing_order", "bank_angle", "splay"]
IMAGES = 8  # candidates kept for each that is asked for, as many are mirror images
EXACTLY = 1e-6  # deg, of firings, where an angle is free to make them even
SAME = 1e-9  # objectives of mirror images differ by less, relatively


@dataclass(frozen=True)
class Found:
    """One arrangement: what the engine file says of it (by the keys `throws`, `firing_order` ...),
    and its figures.
    """

    arrangement: Mapping[str, Any]
    objective: float
    figures: Mapping[str, float]


@dataclass(frozen=True)
class Search:
    """The best arrangements, best first; `scale` is what textbooks measure forces and moments
    by.
    """

    file: EngineFile
    over: What
    objective: Objective
    results: tuple[Found, ...]
    scale: Textbook


def search(
    file: EngineFile, over: str, objective: Objective, top: int = 10, even_firing: bool = False
) -> Search:
    """The best arrangements, mirror images and rotations once.

    Args:
        over: throws (permutes those of the file), firing_order (all even ones; cranks follow where
        the file gives no throws),
            bank_angle (of a vee) or splay.
        even_firing: only arrangements that can fire evenly.

    Raises:
        BalcliError: an engine that has nothing to arrange, or no arrangement that keeps the limits.
    """
    if over not in get_args(What):
        near = nearest(over, get_args(What))
        raise BalcliError(
            f'--over "{over}": choose from '
            f"{', '.join(get_args(What))}{f'; did you mean {near}?' if near else ''}"
        )
    engine = build(file)
    found = list(
        islice(_distinct(_SEARCHES[over](file, objective, top, even_firing), _mirrored(file)), top)
    )
    if not found:
        raise BalcliError(
            f"no {over.replace('_', ' ')} keeps these "
            f"limits{' and fires evenly' if even_firing else ''}"
        )
    return Search(file, over, objective, tuple(found), textbook(engine, np.array([1.0])))  # type: ignore[arg-type]  # checked above


# ------------------------------------------------------------------ the four searches: candidates
# as the columns of arrays
Candidates = dict[
    str, Array
]  # by key of the engine file: shape (candidates,) or (candidates, throws)


def _over_throws(file: EngineFile, objective: Objective, top: int, even: bool) -> Iterator[Found]:
    if file.crank.throws is None or len(file.crank.throws) < 2:
        raise BalcliError(
            "there is nothing to permute: the file gives no crank.throws, or one alone"
        )
    if peaks := [q.name for q in objective.quantities if q.part == "peak"]:
        raise BalcliError(
            f"a search over throws adds up orders, which {peaks[0]} does not allow; name orders, "
            "such as force.1.major"
        )
    allowed = (
        (lambda throws: fires_evenly(_engines(file, {"throws": throws}), file)) if even else None
    )
    found = cranks.best(file, objective, IMAGES * top, allowed)
    return _figures(
        file, {"throws": np.mod(found - found[:, :1], 360.0) if len(found) else found}, objective
    )


def _over_firing_order(
    file: EngineFile, objective: Objective, top: int, even: bool
) -> Iterator[Found]:
    layout, top_deg = plan_cylinders(file.crank, file.layout), assemble(file).tops_deg
    if any(own.throw is not None for own in file.cylinder.values()):
        raise BalcliError(
            "cylinders with throws of their own leave no firing order to look for: give "
            "crank.throws and splay alone"
        )
    at_throw = {
        cell.number: float(top_deg[cell.number]) - cell.bank * file.crank.splay
        for cell in layout.cells
    }
    slots = Slots(layout.cells, at_throw, cycle_deg(file.layout), -1 if file.layout.rotary else 1)
    possible = [file.crank.throws] if file.crank.throws else slots.cranks()
    if not possible or next(slots.orders(possible[0]), None) is None:
        raise BalcliError("these throws allow no even firing order")
    throws = np.array(possible)
    best = _figures(
        file, {"throws": np.round(np.mod(throws - throws[:, :1], 360.0), 9) % 360.0}, objective
    )
    return (
        Found({"firing_order": list(order), **one.arrangement}, one.objective, one.figures)
        for one in best
        for order in slots.orders(one.arrangement["throws"])
    )


def _without_order(file: EngineFile) -> EngineFile:
    """With throws of some kind and no firing order, so that any can be looked for."""
    throws = file.crank.throws or (0.0,) * plan_cylinders(file.crank, file.layout).throws
    layout = file.layout.model_copy(update={"firing_order": None, "firing_intervals": None})
    return file.model_copy(
        update={"crank": file.crank.model_copy(update={"throws": throws}), "layout": layout}
    )


def _over_angle(
    key: str, low: float, high: float
) -> Callable[[EngineFile, Objective, int, bool], Iterator[Found]]:
    def over(file: EngineFile, objective: Objective, top: int, even: bool) -> Iterator[Found]:
        if plan_cylinders(file.crank, file.layout).banks < 2 or (
            key == "bank_angle" and file.layout.bank_angle is None
        ):
            raise BalcliError(
                f"there is no {key.replace('_', ' ')} to look for: the engine is no vee (give "
                "layout.bank_angle)"
            )
        if file.crank.throws is None and file.layout.firing_order is not None:
            raise BalcliError(
                "the crank follows from the firing order, which fits no other "
                f"{key.replace('_', ' ')}: give crank.throws, "
                "so that the crank stays as it is"
            )

        def value(x: Array) -> Array:
            engine = _engines(file, {key: x})
            figures = dict(
                zip(objective.quantities, evaluate(engine, objective.quantities), strict=True)
            )
            values = np.broadcast_to(objective.of(figures.__getitem__), x.shape)
            return np.where(fires_evenly(engine, file, EXACTLY), values, np.inf) if even else values

        return _figures(file, {key: angles.valleys(value, low, high, IMAGES * top)}, objective)

    return over


_SEARCHES: dict[str, Callable[[EngineFile, Objective, int, bool], Iterator[Found]]] = {
    "throws": _over_throws,
    "firing_order": _over_firing_order,
    "bank_angle": _over_angle("bank_angle", 0.0, 180.0),
    "splay": _over_angle("splay", -180.0, 180.0),
}


# ------------------------------------------------------------------ candidates -> engines ->
# results
def _engines(file: EngineFile, candidates: Candidates) -> Engine:
    """All candidates as one engine."""
    paths: dict[str, Any] = {}
    if "throws" in candidates:
        file = _without_order(file)
        paths |= {
            f"crank.throws.{t + 1}": column for t, column in enumerate(candidates["throws"].T)
        }
    paths |= {
        path: candidates[key]
        for key, path in (("bank_angle", "layout.bank_angle"), ("splay", "crank.splay"))
        if key in candidates
    }
    return build(file, paths)


def fires_evenly(
    engine: Engine, file: EngineFile, tolerance: float = TOLERANCE_DEG
) -> NDArray[np.bool_]:
    """Whether the cylinders reach top dead centre in turn at even distances (within a tolerance,
    deg), shape (variants,).
    """
    c = engine.cylinders
    late = (
        0.0 if file.articulation else np.degrees(np.arcsin(c.eps / (1 + c.lam)))
    )  # as Assembly.tops_deg
    ready = c.axis_of_each_deg + late - c.pin_deg
    ready = np.sort(np.mod(ready - ready[engine.numbers.index(1)] + tolerance, 360.0), axis=0)
    even = np.sort(np.mod(np.arange(c.count) * cycle_deg(file.layout) / c.count, 360.0)).reshape(
        -1, *(1,) * (ready.ndim - 1)
    )
    fits: NDArray[np.bool_] = (np.abs(ready - tolerance - even) <= tolerance).all(axis=0)
    return fits


def _figures(file: EngineFile, candidates: Candidates, objective: Objective) -> Iterator[Found]:
    """Candidates with their figures, computed anew for the whole engine, best first."""
    count = len(next(iter(candidates.values())))
    if not count:
        return
    values = dict(
        zip(
            objective.quantities,
            evaluate(_engines(file, candidates), objective.quantities),
            strict=True,
        )
    )
    values = {q: np.broadcast_to(v, count) for q, v in values.items()}
    total = np.broadcast_to(objective.of(values.__getitem__), count)
    for k in np.argsort(ranked(total), kind="stable"):
        if np.isfinite(total[k]):
            arrangement = {key: column[k].tolist() for key, column in candidates.items()}
            yield Found(
                arrangement, float(total[k]), {q.name: float(v[k]) for q, v in values.items()}
            )


def _distinct(
    found: Iterator[Found], mirrored: Callable[[Found], Iterator[tuple[float, ...]]]
) -> Iterator[Found]:
    """Without those that are mirror images of a better or equal one, and as good."""
    seen: dict[tuple[float, ...], float] = {}
    for one in found:
        images = list(mirrored(one))
        if not any(
            image in seen and abs(seen[image] - one.objective) <= SAME * abs(one.objective)
            for image in images
        ):
            yield one
        seen |= dict.fromkeys(images, one.objective)


def _mirrored(file: EngineFile) -> Callable[[Found], Iterator[tuple[float, ...]]]:
    """The arrangement and its images: seen from the other end, turning the other way, and both."""
    cells = {(c.bank, c.throw): c.number for c in plan_cylinders(file.crank, file.layout).cells}
    last = max(t for _, t in cells)
    other_end = {n: cells.get((b, last - t), n) for (b, t), n in cells.items()}

    def images(one: Found) -> Iterator[tuple[float, ...]]:
        if "firing_order" in one.arrangement:
            order = one.arrangement["firing_order"]
            for row in (order, [other_end[n] for n in order]):
                start = row.index(1)
                turned = row[start:] + row[:start]
                yield from (tuple(turned), (turned[0], *reversed(turned[1:])))
        elif "throws" in one.arrangement:
            throws = one.arrangement["throws"]
            for row in (throws, throws[::-1]):
                yield from (
                    tuple(round((sign * (a - row[0])) % 360.0, 6) % 360.0 for a in row)
                    for sign in (1, -1)
                )
        else:
            yield tuple(one.arrangement.values())

    return images
