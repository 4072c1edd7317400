"""Recorded results of engines against what is computed now."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .engine.build import Engine
from .errors import BalcliError
from .forces.kinds import KINDS, VECTORS
from .forces.spectrum import Spectra
from .render import analysis as documents
from .results.analysis import analyze

TOLERANCE = 1e-9  # of a quantity's largest order, beyond what rounding may do
RECORDED = (*KINDS, "peak")
_PARTS = ("forward", "backward", "cos", "sin")


@dataclass(frozen=True)
class Difference:
    """A figure that moved, or a reason why it could not be compared."""

    engine: str
    figure: str
    recorded: float | None = None
    now: float | None = None
    share: float | None = None

    def __str__(self) -> str:
        if self.recorded is None or self.now is None:
            return f"{self.engine}: {self.figure}"
        return (
            f"{self.engine}: {self.figure}: {self.recorded:.10g} -> {self.now:.10g} "
            f"({self.share:.1e} of the largest)"
        )


def recorded_at(engine_file: Path) -> Path:
    """Where the result of an engine file is recorded."""
    return engine_file.parent / "expected" / f"{engine_file.stem}.json"


def record(engine: Engine) -> str:
    """What `check --update` writes."""
    return (
        json.dumps(documents.document(analyze(engine, only=RECORDED)), indent=1, ensure_ascii=False)
        + "\n"
    )


def differences(name: str, engine: Engine, file: Path) -> list[Difference]:
    """All figures of an engine that are not those of its recorded result."""
    if not file.exists():
        return [
            Difference(
                name,
                f"no result is recorded in {file.parent.name}/{file.name}; check --update records "
                "it",
            )
        ]
    shown = analyze(engine, only=RECORDED)
    try:
        recorded = json.loads(file.read_text(encoding="utf-8"))
        old, before = dict(_figures(recorded)), _plain(recorded)
        found = analyze(
            engine, {*(entry["order"] for entry in recorded["orders"]), *shown.orders}, RECORDED
        )
        now = documents.document(found)
    except (
        OSError,
        ValueError,
        LookupError,
        TypeError,
        AttributeError,
        RecursionError,
        BalcliError,
    ) as error:
        return [
            Difference(
                name,
                f"the result recorded in {file.parent.name}/{file.name} cannot be read "
                f"({type(error).__name__}: {error}); check --update records it anew",
            )
        ]
    plain = [
        Difference(name, f"{what}: {before[what]} -> {new}")
        for what, new in _plain(now).items()
        if before[what] != new
    ]
    return [*plain, *_moved(name, old, dict(_figures(now)), _roundings(found.spectra))]


def _plain(document: dict[str, Any]) -> dict[str, Any]:
    """What must be the same to the last digit."""
    return {
        "number of cylinders": document["engine"]["cylinders"],
        "speed, rpm": document["speed_rpm"],
    }


def _moved(
    name: str,
    old: dict[tuple[str, str, str], float],
    new: dict[tuple[str, str, str], float],
    roundings: dict[tuple[str, str], float],
) -> Iterator[Difference]:
    scale: dict[str, float] = {}
    for figures in (old, new):
        for (quantity, _, _), value in figures.items():
            scale[quantity] = max(scale.get(quantity, 0.0), abs(value))
    for key in dict.fromkeys((*new, *old)):
        before, after = old.get(key, 0.0), new.get(key, 0.0)
        if not abs(after - before) <= TOLERANCE * scale[key[0]] + roundings.get(key[:2], 0.0):
            yield Difference(
                name,
                " ".join(filter(None, key)),
                before,
                after,
                abs(after - before) / scale[key[0]],
            )


def _roundings(found: Spectra) -> dict[tuple[str, str], float]:
    """How far rounding may move a figure, by (quantity, order): what decides whether an order is
    balanced. Where all large orders cancel, that is more than TOLERANCE of what is left, and the
    next processor may round otherwise.
    """
    errors: dict[tuple[str, str], float] = {}
    for kind, phasors in found.items():
        each = 2 * np.broadcast_to(phasors.noise, phasors.forward.shape)
        errors |= {
            (kind.name, f"order {order:g}"): float(error)
            for order, error in zip(phasors.orders, each, strict=True)
        }
        errors[kind.name, "peak,"] = float(each.sum())
    return errors


def _figures(document: dict[str, Any]) -> Iterator[tuple[tuple[str, str, str], float]]:
    """(quantity, order, part) and value of everything that is compared."""
    for entry in document["orders"]:
        for kind in KINDS.values():
            for part, value in _parts(entry[kind.key]):
                yield (kind.name, f"order {entry['order']}", f"{part}, {kind.si_unit}"), value
    for kind in VECTORS:
        yield (kind.name, "peak,", kind.si_unit), float(document["peak"][kind.key])


def _parts(figures: dict[str, Any]) -> Iterator[tuple[str, float]]:
    """The figures of one kind and order that are compared, vectors component by component."""
    for part in _PARTS:
        value = figures.get(part)
        if isinstance(value, list):
            for axis, component in zip("xy", value, strict=True):
                yield f"{part} {axis}", float(component)
        elif value is not None:
            yield part, float(value)
