"""Designs of an engine file that a search compares: all as one engine, and their figures."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.phasors import Array
from ...engine.arrays import ranked
from ...engine.build import Engine, build
from ...engine.layout import plan_cylinders
from ...enginefile.model import EngineFile
from ...errors import InputError
from ...forces.quantity import Quantity, evaluate_quantities
from ..varied_gas import attach_gas_torque
from .objective import Objective

# One column by its key of the engine file: `throws`, shape (candidates, throws), or `bank_angle` or
# `splay`, shape (candidates,); angles in deg.
Candidates = Mapping[str, Array]
# The table of the engine file in which each of these stands.
TABLES = {"throws": "crank", "splay": "crank", "firing_order": "layout", "bank_angle": "layout"}


class Design(NamedTuple):
    """What an engine file says of one arrangement; None: as it was.

    Attributes:
        firing_order: numbers of the cylinders.
        throws: angles along the crank, deg.
        bank_angle, splay: deg.
        number: any other number of the file, by its dotted name, with its value.
    """

    firing_order: tuple[int, ...] | None = None
    throws: tuple[float, ...] | None = None
    bank_angle: float | None = None
    splay: float | None = None
    number: tuple[str, float] | None = None

    def given(self) -> dict[str, float | list[float] | list[int]]:
        """What is not as it was, by key of the engine file, as JSON has it."""
        if self.number is not None:
            return dict([self.number])
        there = {key: value for key, value in self._asdict().items() if value is not None}
        return {key: list(v) if isinstance(v, tuple) else v for key, v in there.items()}

    def changes(self) -> dict[str, Any]:
        """The same by dotted keys, as `engine.vary.vary_engine` takes them."""
        if self.number is not None:
            return dict([self.number])
        changed: dict[str, Any] = {
            f"{TABLES[key]}.{key}": value for key, value in self.given().items()
        }
        if self.firing_order is not None:
            changed["layout.firing_intervals"] = None
        return changed


class Found(NamedTuple):
    """One design, the value of its objective, and its figures by the names of their quantities."""

    design: Design
    objective: float
    figures: Mapping[str, float]


def build_candidates(model: EngineFile, candidates: Candidates) -> Engine:
    """All candidates as one engine, with these as its trailing axis."""
    paths: dict[str, Array] = {}
    if "throws" in candidates:
        model = drop_firing_order(model)
        for number, column in enumerate(candidates["throws"].T, 1):
            paths[f"crank.throws.{number}"] = column
    if "bank_angle" in candidates:
        paths["layout.bank_angle"] = candidates["bank_angle"]
    if "splay" in candidates:
        paths["crank.splay"] = candidates["splay"]
    return attach_gas_torque(build(model, paths), model, paths)


def find_buildable(model: EngineFile, key: str, angles: Array) -> NDArray[np.bool_]:
    """At which of these values of an angle of the file (deg) there is an engine, and not a
    mechanism that locks: shape (candidates,).
    """
    try:
        if len(angles):
            build_candidates(model, {key: angles})
    except InputError:
        if len(angles) == 1:
            return np.array([False])
        halves = np.array_split(angles, 2)
        return np.concatenate([find_buildable(model, key, half) for half in halves])
    return np.ones(len(angles), bool)


def drop_firing_order(model: EngineFile) -> EngineFile:
    """With throws of some kind and no firing order, so that any throws can be tried."""
    throws = model.crank.throws or (0.0,) * plan_cylinders(model.crank, model.layout).throws
    model = model.with_table("crank", throws=throws)
    return model.with_table("layout", firing_order=None, firing_intervals=None)


def evaluate_candidates(
    engine: Engine, objective: Objective[Quantity], count: int
) -> tuple[dict[Quantity, Array], Array]:
    """Each quantity and the objective of so many candidates, shape (candidates,) each."""
    found = evaluate_quantities(engine, objective.quantities)
    values = {
        q: np.broadcast_to(value, count)
        for q, value in zip(objective.quantities, found, strict=True)
    }
    return values, np.broadcast_to(objective.evaluate(values.__getitem__), count)


def rank_candidates(
    model: EngineFile, candidates: Candidates, objective: Objective[Quantity]
) -> Iterator[Found]:
    """Candidates that keep the limits, best first, with figures of the whole engine anew."""
    count = len(next(iter(candidates.values())))
    if not count:
        return
    values, totals = evaluate_candidates(build_candidates(model, candidates), objective, count)
    for k in np.argsort(ranked(totals), kind="stable"):
        if np.isfinite(totals[k]):
            figures = {q.name: float(value[k]) for q, value in values.items()}
            yield Found(_design(candidates, int(k)), float(totals[k]), figures)


def _design(candidates: Candidates, row: int) -> Design:
    if "throws" in candidates:
        return Design(throws=tuple(candidates["throws"][row].tolist()))
    if "bank_angle" in candidates:
        return Design(bank_angle=float(candidates["bank_angle"][row]))
    return Design(splay=float(candidates["splay"][row]))
