"""Compare recorded results of engines with what balcli computes now.

A record is the JSON document of `analyze` (orders, peaks, displacement, dead centers) with the
main figures of the further chapters that the engine file has: `torque`, `mounts` and `torsion`.
Two records agree if every leaf agrees: texts, whole numbers and flags exactly, figures within a
share of the largest figure of their group, and angles within what such a share turns them by.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import NoneType
from typing import Any, Literal, NamedTuple

import numpy as np

from .analysis.answer import Analysis, analyze
from .analysis.curves import compute_engine_curves
from .core.records import Node, to_document
from .engine.engine import Engine
from .errors import BalcliError
from .file.model import EngineFile
from .forces.kinds import GAS, GAS_KINDS, KINDS
from .forces.spectrum import Spectra
from .limits import LARGEST_FILE_BYTES
from .mounts.answer import analyze_mounts
from .torque.answer import analyze_torque
from .torsion.answer import analyze_torsion

TOLERANCE = 1e-9  # share of the largest figure of a group, beyond what rounding may do
PEAK_ANGLE_DEG = 1e-3  # a peak is flat: rounding moves its angle more than its value
RECORDED = (*KINDS, "peak")
_LABELS = ("order", "mode", "name", "cylinder")  # by which members of lists are matched
_ANGLES = ("axis_deg", "phase_deg", "peak_deg")
_BROKEN = (
    OSError,
    ValueError,
    OverflowError,
    LookupError,
    TypeError,
    AttributeError,
    RecursionError,
    BalcliError,
)


@dataclass(frozen=True, kw_only=True)
class Difference:
    """A figure that moved, or the reason why a record could not be compared.

    Attributes:
        cause: What the figure belongs to, such as `force`; null for a missing or broken record.
        figure: The figure that moved, or the reason.
        recorded: Recorded value; null without one.
        now: Present value; null without one.
        share: Size of the move over the largest figure of its group; null if it has no size.
    """

    cause: str | None
    figure: str
    recorded: float | bool | str | None
    now: float | bool | str | None
    share: float | None

    @classmethod
    def of_record(cls, reason: str) -> Difference:
        """Return the difference that a record cannot be compared."""
        return cls(cause=None, figure=reason, recorded=None, now=None, share=None)

    def __str__(self) -> str:
        if self.cause is None:
            return self.figure
        values = " -> ".join(
            f"{v:.10g}" if isinstance(v, float) else str(v) for v in (self.recorded, self.now)
        )
        share = "" if self.share is None else f" ({self.share:.1e} of the largest)"
        return f"{self.figure}: {values}{share}"


@dataclass(frozen=True, kw_only=True)
class CheckedEngine:
    """An engine file and what differs from its record.

    Attributes:
        engine: Path of the engine file.
        differences: Every figure that moved.
    """

    engine: str
    differences: tuple[Difference, ...]


@dataclass(frozen=True, kw_only=True)
class Check:
    """Engines compared with their recorded results.

    Attributes:
        engines: All that were compared.
    """

    format: Literal["balcli.check/1"] = "balcli.check/1"
    engines: tuple[CheckedEngine, ...]


class _Leaf(NamedTuple):
    """A value of a record.

    Attributes:
        path: Keys from the top of the document, and labels of list items such as `order 2`.
        value: The value.
        parent: The object in which the value stands.
    """

    path: tuple[str, ...]
    value: Any
    parent: Node

    @property
    def group(self) -> str:
        """The first key with a unit: figures of one group are compared with the largest of them."""
        units = ("_N", "_Nm", "_Hz", "_mm", "_Pa", "_J", "_W", "_m", "_m3")
        return next((key for key in self.path if key.endswith(units)), self.path[-1])

    @property
    def cause(self) -> str:
        """The quantity or chapter, as messages name it."""
        names = {kind.key: kind.name for kind in (*KINDS.values(), *GAS_KINDS.values())}
        found = [names[key] for key in self.path if key in names]
        return found[0] if found else next((k for k in self.path if k != "orders"), "")

    @property
    def figure(self) -> str:
        """The path in words."""
        return " ".join(part for part in self.path if part != "orders")


# ------------------------------------------------------------------ files
def find_record(engine_file: Path) -> Path:
    """Return the path at which the result of an engine file is recorded."""
    return engine_file.parent / "expected" / f"{engine_file.stem}.json"


def find_engine_file(record: Path) -> Path:
    """Return the path of the engine file whose result is recorded here, existing or not."""
    return record.parent.with_name(f"{record.stem}.toml")


def find_abandoned(files: Iterable[Path]) -> Iterator[CheckedEngine]:
    """Yield a difference for each record among `files` whose engine file is missing."""
    for record in files:
        engine_file = find_engine_file(record)
        if not engine_file.exists() and _is_record(record):
            reason = (
                f"its result is recorded in {record.parent.name}/{record.name}, but there is no "
                f"{engine_file.name}; bring it back, or delete the record"
            )
            found = (Difference.of_record(reason),)
            yield CheckedEngine(engine=str(engine_file), differences=found)


def _is_record(path: Path) -> bool:
    try:
        return bool(_read(path)["format"] == Analysis.format)
    except _BROKEN:
        return False


def _read(record: Path) -> Any:
    """Return the content of a record.

    Raises:
        BalcliError: The file is larger than an engine file may be, or no regular file.
        OSError, ValueError: The file cannot be read.
    """
    if not record.is_file():
        raise BalcliError("it is no regular file")
    with record.open("rb") as file:
        content = file.read(LARGEST_FILE_BYTES + 1)
    if len(content) > LARGEST_FILE_BYTES:
        raise BalcliError(f"it has more than {LARGEST_FILE_BYTES} bytes")
    return json.loads(content.decode())


def check_target(engine_file: Path) -> Path:
    """Return the path at which to record the result of an engine file.

    Raises:
        BalcliError: A link leads out of the engine's folder, to a file of somebody else.
    """
    record, folder = find_record(engine_file), engine_file.parent.resolve()
    if not record.resolve().is_relative_to(folder):
        raise BalcliError(
            f"{record}: is a link out of the folder of the engine; nothing is recorded there"
        )
    return record


# ------------------------------------------------------------------ what is recorded
def record_result(engine: Engine) -> str:
    """Return the text of the record of an engine."""
    return json.dumps(_describe(engine)[0], indent=1, ensure_ascii=False) + "\n"


def _describe(engine: Engine, orders: Iterable[float] | None = None) -> tuple[Node, Spectra]:
    """Return the record of an engine, and the phasors of the orders in it."""
    only = RECORDED if engine.gas is None else (*RECORDED, GAS.name)
    found = analyze(engine, orders, only)
    document = to_document(found) | _describe_chapters(engine)
    return document, found.spectra


def _describe_chapters(engine: Engine) -> Node:
    """Return the main figures of the chapters that the engine file has."""
    model: EngineFile | None = engine.model
    found: Node = {}
    if engine.gas is not None:
        torque = analyze_torque(engine).to_dict()
        found["torque"] = {
            k: v for k, v in torque.items() if k not in ("orders", "format", "version", "speed_rpm")
        }
    if model is not None and model.body is not None and model.mount:
        mounts = analyze_mounts(engine).to_dict()
        found["mounts"] = {
            "modes": [
                {"mode": n, "frequency_Hz": m["frequency_Hz"]}
                for n, m in enumerate(mounts["modes"], 1)
            ],
            "largest": [{"name": m["name"], **m["worst"]} for m in mounts["response"]["mounts"]],
        }
    if model is not None and model.torsion is not None:
        torsion = analyze_torsion(engine).to_dict()
        found["torsion"] = {
            "modes": [
                {"mode": n, "frequency_Hz": m["frequency_Hz"]}
                for n, m in enumerate(torsion["modes"], 1)
            ],
            "criticals": torsion.get("criticals", []),
        }
    return found


# ------------------------------------------------------------------ comparison
def find_differences(
    engine: Engine, record: Path, tolerance: float = TOLERANCE
) -> list[Difference]:
    """Return every figure of an engine that differs from its record.

    Args:
        engine: The engine.
        record: Path of the record.
        tolerance: Allowed move, as a share of the largest figure of the group.
    """
    where = f"{record.parent.name}/{record.name}"
    if not record.exists():
        reason = f"no result is recorded in {where}; check --update records it"
        return [Difference.of_record(reason)]
    document, spectra = _describe(engine)
    try:
        recorded = _read(record)
        if document == recorded:
            return []
        orders = {entry["order"] for entry in recorded["orders"]}
        if not orders <= set(spectra.orders):
            document, spectra = _describe(engine, {*orders, *spectra.orders})
        old = {leaf.path: leaf for leaf in _list_leaves(recorded)}
        numbers = [leaf.value for leaf in old.values() if isinstance(leaf.value, (int, float))]
        if not all(map(math.isfinite, numbers)):
            raise BalcliError("a figure is not finite")
        new = {leaf.path: leaf for leaf in _list_leaves(document)}
        return list(_compare(engine, old, new, spectra, tolerance))
    except _BROKEN as error:
        broken = f"the result recorded in {where} cannot be read ({_describe_error(error)})"
        return [Difference.of_record(f"{broken}; check --update records it anew")]


def _describe_error(error: Exception) -> str:
    if isinstance(error, OSError):
        return error.strerror or str(error)
    if isinstance(error, json.JSONDecodeError):
        return f"it is not JSON: line {error.lineno}"
    if isinstance(error, KeyError):
        return f"{error.args[0]} is missing"
    return str(error) if isinstance(error, BalcliError) else "it is no result of balcli analyze"


def _list_leaves(
    value: object, path: tuple[str, ...] = (), parent: Node | None = None
) -> Iterator[_Leaf]:
    if isinstance(value, dict):
        for key, part in value.items():
            yield from _list_leaves(part, (*path, key), value)
    elif isinstance(value, list):
        for number, part in enumerate(value, 1):
            labels = (
                [f"{key} {part[key]}" for key in _LABELS if key in part]
                if isinstance(part, dict)
                else []
            )
            pair = path[-1] in ("forward", "backward")
            yield from _list_leaves(
                part,
                (*path, " ".join(labels) or ("xy"[number - 1] if pair else str(number))),
                parent,
            )
    else:
        yield _Leaf(path, value, parent or {})


def _compare(
    engine: Engine,
    old: Mapping[tuple[str, ...], _Leaf],
    new: Mapping[tuple[str, ...], _Leaf],
    spectra: Spectra,
    tolerance: float,
) -> Iterator[Difference]:
    largest: dict[str, float] = {}
    for leaf in (*old.values(), *new.values()):
        if isinstance(leaf.value, float) and not leaf.path[-1].endswith("_deg"):
            largest[leaf.group] = max(largest.get(leaf.group, 0.0), abs(leaf.value))
    roundings = _find_roundings(spectra)
    for path in dict.fromkeys((*new, *old)):
        leaf = new.get(path) or old[path]
        before, after = (table[path].value if path in table else None for table in (old, new))
        scale = largest.get(leaf.group, 0.0)
        order = next((part for part in path if part.startswith("order ")), "")
        allowed = tolerance * scale + roundings.get((leaf.group, order), 0.0)
        figures = [
            value or 0.0 for value in (before, after) if isinstance(value, (float, NoneType))
        ]
        shared = path in old and path in new
        if path[-1] in _ANGLES:
            same = _are_same_angles(path[-1], old.get(path), new.get(path), order, allowed)
        elif path[-1] == "balanced":  # another processor may round an order to exactly balanced
            same = before == after or _differ_by_rounding(old.get(path), new.get(path), allowed)
        elif path[-1].endswith("_deg") and isinstance(before, float) and isinstance(after, float):
            flat = 1e-6 if path[0] == "travel" else PEAK_ANGLE_DEG
            same = abs(after - before) <= flat or _reach_same_peak(engine, path, figures, allowed)
        elif len(figures) == 2 and (None not in (before, after) or not shared):
            same = abs(figures[1] - figures[0]) <= allowed
        else:  # an order that only one of them has is judged by its figures
            same = before == after or (
                path[-1] == "order" and not shared and leaf.value > 2
            )  # 1 and 2 are always recorded
        if not same:
            sized = len(figures) == 2 and scale and not path[-1].endswith("_deg")
            yield Difference(
                cause=leaf.cause,
                figure=leaf.figure,
                recorded=before,
                now=after,
                share=abs(figures[1] - figures[0]) / scale if sized else None,
            )


def _differ_by_rounding(old: _Leaf | None, new: _Leaf | None, allowed: float) -> bool:
    """Return whether the amplitudes of two leaves differ, and are all rounding errors."""
    sizes = [() if leaf is None else _find_sizes(leaf) for leaf in (old, new)]
    return sizes[0] != sizes[1] and all(abs(size) <= allowed for each in sizes for size in each)


def _find_sizes(leaf: _Leaf) -> tuple[float, ...]:
    return tuple(
        leaf.parent.get(key) or 0.0 for key in ("major", "amplitude") if key in leaf.parent
    )


def _are_same_angles(
    key: str, old: _Leaf | None, new: _Leaf | None, order: str, allowed: float
) -> bool:
    """Return whether two angles agree as far as the sizes of their phasors decide it."""
    if old is None or new is None:
        return _differ_by_rounding(old, new, allowed)
    weights = [
        _ellipticity(leaf) if key == "axis_deg" else sum(_find_sizes(leaf)) for leaf in (old, new)
    ]
    if old.value is None or new.value is None:
        return old.value == new.value or (weights[0] != weights[1] and max(weights) <= 4 * allowed)
    number = float(order.removeprefix("order ") or 1)
    turn = {"axis_deg": 180.0, "phase_deg": 360.0, "peak_deg": 360.0 / (number or 1)}[key]
    move = abs(math.remainder(new.value - old.value, turn))
    phase = math.radians(move) * (number if key == "peak_deg" else 1)
    return move <= 1e-9 or phase * min(weights) <= 4 * allowed


def _ellipticity(leaf: _Leaf) -> float:
    return float((leaf.parent.get("major") or 0.0) - abs(leaf.parent.get("minor") or 0.0))


def _reach_same_peak(
    engine: Engine, path: tuple[str, ...], degrees: list[float], allowed: float
) -> bool:
    """Return whether the curve is as large at one angle as at the other."""
    if path[0] != "peak":
        return False
    kind, unit = ("force", "N") if path[-1] == "force_deg" else ("moment", "Nm")
    values = compute_engine_curves(engine, np.array(degrees)).curves
    sizes = np.hypot(values[f"{kind}_x_{unit}"], values[f"{kind}_y_{unit}"])
    return bool(abs(sizes[0] - sizes[1]) <= 4 * allowed)


def _find_roundings(found: Spectra) -> dict[tuple[str, str], float]:
    """Return how far rounding may move a figure, by group and order: what decides whether an order
    is balanced. Where all large orders cancel, this is more than a share of what remains.
    """
    errors: dict[tuple[str, str], float] = {}
    for kind, phasors in found.items():
        each = 2 * np.broadcast_to(phasors.noise, phasors.forward.shape)
        for order, error in zip(phasors.orders, each, strict=True):
            errors[kind.key, f"order {order:g}"] = float(error)
        errors[kind.key, ""] = float(each.sum())
    return errors


def describe_checks(checked: Iterable[CheckedEngine]) -> Node:
    """Return the document `balcli.check/1`."""
    return to_document(Check(engines=tuple(checked)))
