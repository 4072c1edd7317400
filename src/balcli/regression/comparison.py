"""Compare recorded results of engines with what balcli computes now.

A record is the JSON document of `analyze` (orders, peaks, displacement, dead centres) and the
main figures of `torque`, `mounts` and `torsion` if the engine file has tables for them.
Two records agree if every value agrees: texts and whole numbers exactly, figures within a share of
the largest figure of the same quantity, such as `force_N`. Axes, phases, peak angles and the
balance of an order are not compared, because they follow from its vectors, which are compared. The
angle of a peak over all orders may move to another peak that is equally high.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import NoneType
from typing import Any, Literal

import numpy as np

from ..analysis.answer import Analysis, analyze
from ..core.records import Node, to_document
from ..crank_torque.answer import torque
from ..engine.engine import Engine
from ..errors import BalcliError
from ..file.model import EngineFile
from ..forces.kinds import GAS, GAS_KINDS, KINDS
from ..forces.spectrum import Spectra, compute_spectra, find_relevant_orders
from ..limits import LARGEST_FILE_BYTES
from ..mounting.answer import mounts
from ..torsional_vibration.answer import torsion

TOLERANCE = 1e-9  # share of the largest figure of a quantity; rounding is allowed in addition
PEAK_ANGLE_DEG = 1e-3  # allowed change of a peak's angle; rounding changes it more than the value
DEAD_CENTER_DEG = 1e-6  # allowed change of the angle of a dead centre
RECORDED = (*KINDS, "peak")
# Keys by which members of lists are matched; an assumed value has `path`, and may have `engine`.
_LABELS = ("order", "mode", "name", "cylinder", "path", "engine")
_DERIVED = ("axis_deg", "phase_deg", "peak_deg", "balanced")
_MALFORMED = (LookupError, TypeError, AttributeError, RecursionError)
_BROKEN = (OSError, ValueError, OverflowError, BalcliError, *_MALFORMED)


@dataclass(frozen=True, kw_only=True)
class Difference:
    """A figure that differs from its record, or the reason why a record could not be compared.

    Attributes:
        cause: Quantity (`force`) or part of the record (`torsion`) that has the figure; null for a
            missing or broken record.
        figure: Name of the figure that changed, or the reason.
        recorded: Recorded value; null if there is none.
        now: Present value; null if there is none.
        share: Change / largest figure of the same quantity; null for angles and texts.
    """

    cause: str | None
    figure: str
    recorded: float | bool | str | None
    now: float | bool | str | None
    share: float | None

    @classmethod
    def of_record(cls, reason: str) -> Difference:
        """Return the difference for a record that cannot be compared."""
        return cls(cause=None, figure=reason, recorded=None, now=None, share=None)

    def __str__(self) -> str:
        if self.cause is None:
            return self.figure
        values = " -> ".join(
            f"{v:.10g}" if isinstance(v, float) else str(v) for v in (self.recorded, self.now)
        )
        share = "" if self.share is None else f" ({self.share:.1e} of the largest figure)"
        return f"{self.figure}: {values}{share}"


@dataclass(frozen=True, kw_only=True)
class CheckedEngine:
    """An engine file and the differences from its record.

    Attributes:
        engine: Path of the engine file.
        differences: Every figure that changed.
        error: Reason why the file could not be compared; None if it was compared.
    """

    engine: str
    differences: tuple[Difference, ...]
    error: str | None = None


@dataclass(frozen=True, kw_only=True)
class Check:
    """Engines compared with their recorded results.

    Attributes:
        engines: All engines, compared or not.
    """

    format: Literal["balcli.check/1"] = "balcli.check/1"
    engines: tuple[CheckedEngine, ...]


_Path = tuple[str, ...]  # keys from the top of the document, and labels such as `order 2`


def _find_group(path: _Path) -> str:
    """Return the group of a figure: the first key of its path that ends in a unit, or the label of
    an assumed value. The tolerance is a share of the largest figure of the group.
    """
    units = ("_N", "_Nm", "_Hz", "_mm", "_Pa", "_J", "_W", "_m", "_m3")
    for key in path:
        if key.endswith(units) or key.startswith("path "):
            return key
    return path[-1]


def _name_cause(path: _Path) -> str:
    """Return the quantity of a figure, or the part of the record that has it, for messages."""
    names = {kind.key: kind.name for kind in (*KINDS.values(), *GAS_KINDS.values())}
    found = [names[key] for key in path if key in names]
    return found[0] if found else next((key for key in path if key != "orders"), "")


# ------------------------------------------------------------------ files
def find_record(engine_file: Path) -> Path:
    """Return the path at which the result of an engine file is recorded."""
    return engine_file.parent / "expected" / f"{engine_file.stem}.json"


def find_abandoned(files: Iterable[Path]) -> Iterator[CheckedEngine]:
    """Yield a difference for each record among `files` whose engine file is missing."""
    for record in files:
        engine_file = record.parent.with_name(f"{record.stem}.toml")
        if not engine_file.exists() and _is_record(record):
            reason = (
                f"its result is recorded in {record.parent.name}/{record.name}, but there is no "
                f"{engine_file.name}; restore it, or delete the record"
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
        BalcliError: The file is not a regular file, or is larger than an engine file may be.
        OSError, ValueError: The file cannot be read.
    """
    if not record.is_file():
        raise BalcliError("it is not a regular file")
    with record.open("rb") as file:
        content = file.read(LARGEST_FILE_BYTES + 1)
    if len(content) > LARGEST_FILE_BYTES:
        raise BalcliError(f"it has more than {LARGEST_FILE_BYTES} bytes")
    return json.loads(content.decode())


def check_target(engine_file: Path) -> Path:
    """Return the path at which to record the result of an engine file.

    Raises:
        BalcliError: The record is a link that leads out of the engine's folder.
    """
    record, folder = find_record(engine_file), engine_file.parent.resolve()
    if not record.resolve().is_relative_to(folder):
        raise BalcliError(
            f"{record}: is a link that leads out of the engine's folder; nothing is recorded"
        )
    return record


# ------------------------------------------------------------------ what is recorded
def record_result(engine: Engine) -> str:
    """Return the text of the record of an engine."""
    return json.dumps(_describe(engine)[0], indent=1, ensure_ascii=False) + "\n"


def _describe(engine: Engine, orders: Iterable[float] | None = None) -> tuple[Node, Spectra]:
    """Return the record of an engine and the phasors of its orders."""
    only = RECORDED if engine.gas is None else (*RECORDED, GAS.name)
    found = analyze(engine, orders, only)
    document = to_document(found) | _describe_chapters(engine)
    del document["verdict"]  # it follows from the orders, and would change with every rule of words
    return document, found.spectra


def _describe_chapters(engine: Engine) -> Node:
    """Return main figures of torque, mounts and torsion if the engine file has tables for them."""
    model: EngineFile | None = engine.model
    found: Node = {}
    if engine.gas is not None:
        left_out = {"orders", "format", "version", "speed_rpm"}
        on_crank = torque(engine).to_dict().items()
        found["torque"] = {key: value for key, value in on_crank if key not in left_out}
    if model is not None and model.body is not None and model.mount:
        mounted = mounts(engine).to_dict()
        largest = [{"name": m["name"], **m["worst"]} for m in mounted["response"]["mounts"]]
        found["mounts"] = {"modes": _number_modes(mounted), "largest": largest}
    if model is not None and model.torsion is not None:
        twisted = torsion(engine).to_dict()
        criticals = twisted.get("criticals", [])
        found["torsion"] = {"modes": _number_modes(twisted), "criticals": criticals}
    return found


def _number_modes(document: Node) -> list[Node]:
    modes = enumerate(document["modes"], 1)
    return [{"mode": n, "frequency_Hz": mode["frequency_Hz"]} for n, mode in modes]


# ------------------------------------------------------------------ comparison
def find_differences(
    engine: Engine, record: Path, tolerance: float = TOLERANCE
) -> list[Difference]:
    """Return every figure of an engine that differs from its record.

    Args:
        engine: The engine.
        record: Path of the record.
        tolerance: Allowed change, as a share of the largest figure of the same quantity.
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
        old, new = dict(_list_leaves(recorded)), dict(_list_leaves(document))
        numbers = [value for value in old.values() if isinstance(value, (int, float))]
        if not all(map(math.isfinite, numbers)):
            raise BalcliError("a figure is not finite")
        found = _compare(old, new, _find_roundings(spectra), tolerance)
        return [one for one in found if not _is_equal_peak(engine, one, tolerance)]
    except _BROKEN as error:
        broken = f"the result recorded in {where} cannot be read ({_describe_error(error)})"
        return [Difference.of_record(f"{broken}; check --update records it anew")]


def _is_equal_peak(engine: Engine, moved: Difference, tolerance: float) -> bool:
    """Return whether a difference is only that between the angles of two equally high peaks."""
    kind = {"peak force_deg": "force", "peak moment_deg": "moment"}.get(moved.figure)
    degrees = moved.recorded, moved.now
    if kind is None or None in degrees:  # no angle: a peak of 0, whose value is compared
        return kind is not None
    curve = compute_spectra(engine, find_relevant_orders(engine), [kind])[kind]
    then, now = np.abs(curve.values(np.radians(np.array(degrees, float)))).tolist()
    return bool(then >= now * (1 - tolerance))


def _describe_error(error: Exception) -> str:
    if isinstance(error, OSError):
        return error.strerror or str(error)
    if isinstance(error, json.JSONDecodeError):
        return f"it is not JSON: line {error.lineno}"
    if isinstance(error, KeyError):
        return f"{error.args[0]} is missing"
    return str(error) if isinstance(error, BalcliError) else "it is not a result of balcli analyze"


def _list_leaves(value: object, path: _Path = ()) -> Iterator[tuple[_Path, Any]]:
    """Yield the values of a record that are compared, with their paths."""
    if isinstance(value, dict):
        for key, part in value.items():
            if key not in _DERIVED:
                yield from _list_leaves(part, (*path, key))
    elif isinstance(value, list):
        for number, part in enumerate(value, 1):
            label = "xy"[number - 1] if path[-1] in ("forward", "backward") else str(number)
            if isinstance(part, dict):
                labels = (f"{key} {part[key]}" for key in _LABELS if key in part)
                label = " ".join(labels) or label
            yield from _list_leaves(part, (*path, label))
    else:
        yield path, value


def _compare(
    old: Mapping[_Path, Any],
    new: Mapping[_Path, Any],
    roundings: Mapping[tuple[str, str], float],
    tolerance: float,
) -> Iterator[Difference]:
    largest: dict[str, float] = {}
    for path, value in (*old.items(), *new.items()):
        if isinstance(value, float) and not path[-1].endswith("_deg"):
            group = _find_group(path)
            largest[group] = max(largest.get(group, 0.0), abs(value))
    for path in dict.fromkeys((*new, *old)):
        before, after, shared = old.get(path), new.get(path), path in old and path in new
        if path[-1] == "order" and not shared and (before or after or 0) > 2:
            continue  # its figures are compared, 0 where missing; 1 and 2 are always recorded
        group, is_angle = _find_group(path), path[-1].endswith("_deg")
        scale = largest.get(group, 0.0)
        order = next((part for part in path if part.startswith("order ")), "")
        allowed = tolerance * scale + roundings.get((group, order), 0.0)
        if is_angle and isinstance(before, float) and isinstance(after, float):
            least = DEAD_CENTER_DEG if path[0] == "travel" else PEAK_ANGLE_DEG
            allowed = max(least, tolerance * 360)
        sized = isinstance(before, (float, NoneType)) and isinstance(after, (float, NoneType))
        move = abs((after or 0.0) - (before or 0.0)) if sized else math.inf
        if shared and None in (before, after):  # a figure that only one of the records has
            allowed = -math.inf
        if before != after and not move <= allowed:
            yield Difference(
                cause=_name_cause(path),
                figure=" ".join(part for part in path if part != "orders"),
                recorded=before,
                now=after,
                share=move / scale if sized and scale and not is_angle else None,
            )


def _find_roundings(found: Spectra) -> dict[tuple[str, str], float]:
    """Return the largest change of a figure that rounding can cause, by group and order. The same
    bound decides whether an order is balanced. Where large forces cancel, the bound may exceed the
    tolerated share of the remaining force.
    """
    errors: dict[tuple[str, str], float] = {}
    for kind, phasors in found.items():
        each = 2 * np.broadcast_to(phasors.noise, phasors.forward.shape)
        for order, error in zip(phasors.orders, each, strict=True):
            errors[kind.key, f"order {order:g}"] = float(error)
        errors[kind.key, ""] = float(each.sum())
    return errors
