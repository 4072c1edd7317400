"""Recorded results of engines against what is computed now."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .engine.build import Engine
from .errors import BalcliError
from .forces.kinds import GAS, GAS_KINDS, KINDS, VECTORS
from .forces.spectrum import Spectra
from .render import analysis_document as renderer
from .results.analysis import analyze

TOLERANCE = 1e-9  # of a quantity's largest order, beyond what rounding may do
RECORDED = (*KINDS, "peak")
_PARTS = ("forward", "backward", "cos", "sin")
# whatever a record that somebody has edited may cause
_UNREADABLE = (
    OSError,
    ValueError,
    OverflowError,
    LookupError,
    TypeError,
    AttributeError,
    RecursionError,
    BalcliError,
)


@dataclass(frozen=True)
class Difference:
    """A figure that moved, or a reason why it could not be compared.

    Attributes:
        engine: its file, in messages.
        figure: what moved, or why nothing could be compared.
        recorded, now: its values; None where it has none.
        share: by how much it moved, of the largest of its kind.
    """

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


class _Place(NamedTuple):
    """Where a figure stands in a result: name of its kind, `order 2` or `peak,`, part and unit."""

    kind: str
    order: str
    part: str


def find_record(engine_file: Path) -> Path:
    """Where the result of an engine file is recorded."""
    return engine_file.parent / "expected" / f"{engine_file.stem}.json"


def find_engine_file(record: Path) -> Path:
    """The engine file whose result stands in this record (of `find_record`), there or not."""
    return record.parent.with_name(f"{record.stem}.toml")


def find_abandoned(files: Iterable[Path]) -> list[Difference]:
    """Recorded results (of `find_record`) among files, whose engine file is not there."""
    gone = {record: find_engine_file(record) for record in files}
    return [
        Difference(
            str(engine_file),
            f"its result is recorded in {record.parent.name}/{record.name}, but there is no "
            f"{engine_file.name}; bring it back, or delete the record",
        )
        for record, engine_file in gone.items()
        if not engine_file.exists() and _is_record(record)
    ]


def _is_record(path: Path) -> bool:
    """Whether a JSON file is such a result, and not what others expect."""
    try:
        return bool(json.loads(path.read_text(encoding="utf-8"))["format"] == renderer.FORMAT)
    except _UNREADABLE:
        return False


def record_result(engine: Engine) -> str:
    """The text to record of an engine."""
    document = renderer.document(analyze(engine, only=_list_recorded(engine)))
    return json.dumps(document, indent=1, ensure_ascii=False) + "\n"


def find_differences(name: str, engine: Engine, record: Path) -> list[Difference]:
    """All figures of an engine that are not those of its recorded result; `name`: in messages."""
    where = f"{record.parent.name}/{record.name}"
    if not record.exists():
        missing = f"no result is recorded in {where}; check --update records it"
        return [Difference(name, missing)]
    wanted = _list_recorded(engine)
    found = analyze(engine, only=wanted)
    document = renderer.document(found)
    try:
        recorded = json.loads(record.read_text(encoding="utf-8"))
        if document == recorded:  # to the last digit, as where the same processor recorded it
            return []
        old = dict(_list_figures(recorded))
        if not all(map(math.isfinite, old.values())):  # beside infinity nothing would differ
            raise BalcliError("a figure is not finite")
        exactly_old = _list_exact_figures(recorded)
        orders = {entry["order"] for entry in recorded["orders"]}
        if not orders <= set(found.orders):
            found = analyze(engine, {*orders, *found.orders}, wanted)
            document = renderer.document(found)
    except _UNREADABLE as error:
        broken = f"the result recorded in {where} cannot be read ({_describe_broken(error)})"
        return [Difference(name, f"{broken}; check --update records it anew")]
    exactly_new = _list_exact_figures(document).items()
    moved = [
        (what, exactly_old[what], now) for what, now in exactly_new if exactly_old[what] != now
    ]
    return [
        *(Difference(name, f"{what}: {old} -> {now}") for what, old, now in moved),
        *_compare_figures(name, old, dict(_list_figures(document)), _find_roundings(found.spectra)),
    ]


def _describe_broken(error: Exception) -> str:
    """Why a recorded result cannot be read, for people who know no Python."""
    if isinstance(error, OSError):
        return error.strerror or str(error)
    if isinstance(error, json.JSONDecodeError):
        return f"it is not JSON: line {error.lineno}"
    if isinstance(error, KeyError):
        return f"{error.args[0]} is missing"
    if isinstance(error, BalcliError):
        return str(error)
    return "it is no result of balcli analyze"


def _list_recorded(engine: Engine) -> tuple[str, ...]:
    """What is recorded of an engine: with gas, also what that does."""
    return RECORDED if engine.gas is None else (*RECORDED, GAS.name)


def _list_exact_figures(document: dict[str, Any]) -> dict[str, Any]:
    """What must be the same to the last digit."""
    return {
        "format": document["format"],
        "number of cylinders": document["engine"]["cylinders"],
        "speed, rpm": document["speed_rpm"],
    }


def _compare_figures(
    name: str,
    old: Mapping[_Place, float],
    new: Mapping[_Place, float],
    roundings: Mapping[tuple[str, str], float],
) -> Iterator[Difference]:
    largest: dict[str, float] = {}
    for figures in (old, new):
        for place, value in figures.items():
            largest[place.kind] = max(largest.get(place.kind, 0.0), abs(value))
    for place in dict.fromkeys((*new, *old)):
        before, after = old.get(place, 0.0), new.get(place, 0.0)
        scale, move = largest[place.kind], abs(after - before)
        allowed = TOLERANCE * scale + roundings.get((place.kind, place.order), 0.0)
        if not move <= allowed:  # nan is a difference
            yield Difference(name, " ".join(filter(None, place)), before, after, move / scale)


def _find_roundings(found: Spectra) -> dict[tuple[str, str], float]:
    """How far rounding may move a figure, by the kind and order of its place: what decides whether
    an order is balanced. Where all large orders cancel, that is more than TOLERANCE of what is
    left, and the next processor may round otherwise.
    """
    errors: dict[tuple[str, str], float] = {}
    for kind, phasors in found.items():
        each = 2 * np.broadcast_to(phasors.noise, phasors.forward.shape)
        for order, error in zip(phasors.orders, each, strict=True):
            errors[kind.name, f"order {order:g}"] = float(error)
        errors[kind.name, "peak,"] = float(each.sum())
    return errors


def _list_figures(document: dict[str, Any]) -> Iterator[tuple[_Place, float]]:
    """Everything that is compared within a tolerance."""
    for entry in document["orders"]:
        gas = [kind for kind in GAS_KINDS.values() if kind.key in entry]
        there = [*KINDS.values(), *gas]
        for kind in there:
            for part, value in _list_parts(entry[kind.key]):
                place = _Place(kind.name, f"order {entry['order']}", f"{part}, {kind.si_unit}")
                yield place, value
    for kind in VECTORS:
        place = _Place(kind.name, "peak,", kind.si_unit)
        yield place, float(document["peak"][kind.key])


def _list_parts(figures: dict[str, Any]) -> Iterator[tuple[str, float]]:
    """The figures of one kind and order that are compared, vectors component by component."""
    for part in _PARTS:
        value = figures.get(part)
        if isinstance(value, list):
            for axis, component in zip("xy", value, strict=True):
                yield f"{part} {axis}", float(component)
        elif value is not None:
            yield part, float(value)
