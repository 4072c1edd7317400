"""Compare the record of an engine with the figures that balcli computes now.

Every figure and text of the record is compared:

* Texts and whole numbers have to be equal.
* Sizes may differ by a share of the largest figure of their group (such as `force_N`), and by
  rounding. An order that one of the two does not show has the figure 0.
* Directions and phases of a vector may turn as far as a change of the vector within its tolerance
  can turn it; if the vector itself is within the tolerance, they are not compared. Axes are
  compared modulo 180 deg.
* Whether an order is balanced is not compared if both vectors are within the tolerance.
* Angles of peaks may differ by 0.001 deg, those of dead centres by 0.000001 deg. The angle of a
  peak over all orders may move to another peak that is equally high.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..core.records import Node
from ..engine.engine import Engine, take_model
from ..errors import BalcliError
from ..file.fields import order_number
from ..file.lines import LineFinder
from ..forces.spectrum import Spectra, compute_spectra, find_relevant_orders
from .inputs import find_changed
from .naming import (
    ASSUMED,
    describe_figure,
    find_group,
    find_unit_of,
    list_figures,
    name_cause,
    name_quantities,
)
from .recording import (
    BROKEN,
    INPUTS,
    TRAVEL,
    Described,
    describe_engine,
    explain_unreadable,
    find_record,
    list_abandoned,
    read_record,
)
from .records import CheckedEngine, Difference, Fault, FigurePath, spell_path
from .rules import Rules, Tolerances, find_broken_limits

PEAK_ANGLE_DEG = 1e-3  # allowed change of a peak's angle; rounding changes it more than the value
DEAD_CENTER_DEG = 1e-6  # allowed change of the angle of a dead centre
DIRECTION_DEG = 1e-9  # allowed change of a direction; rounding of its computation
ALWAYS_RECORDED = (1, 2)  # orders that every record shows
_UNCOMPARED = ("version", INPUTS)  # parts of a record that are no result
_DIRECTIONS = {"axis_deg": 180.0, "phase_deg": 360.0, "peak_deg": 360.0}  # with their periods
_PEAKS: Mapping[FigurePath, str] = {
    ("peak", "force_deg"): "force",
    ("peak", "moment_deg"): "moment",
}


Figures = Mapping[FigurePath, Any]


# ------------------------------------------------------------------ engines and records
def check_engine(engine: Engine, file: Path, rules: Rules, lines: LineFinder) -> CheckedEngine:
    """Compare an engine with its record, and its quantities with their limits.

    Args:
        engine: Engine of the file.
        file: Path of the engine file.
        rules: Its tolerances and limits.
        lines: Finder of the lines in the file.

    Raises:
        BalcliError, InputError: A figure of the engine cannot be computed.
    """
    compared = _compare_with_record(engine, file, rules.tolerances, lines)
    return replace(compared, broken_limits=find_broken_limits(engine, rules.limited, lines))


def find_abandoned(files: Iterable[Path]) -> Iterator[CheckedEngine]:
    """Yield a difference for each record among `files` whose engine file is missing."""
    for engine_file, record in list_abandoned(files):
        reason = (
            f"its result is recorded in {record.parent.name}/{spell_path(record.name)}, but there "
            f"is no {spell_path(engine_file.name)}; restore it, or delete the record"
        )
        yield _refuse(engine_file, Fault.ABANDONED, reason)


def _refuse(file: Path, fault: Fault, reason: str) -> CheckedEngine:
    """Return the result for an engine that cannot be compared, with the reason as a difference."""
    difference = Difference(cause=None, figure=reason)
    return CheckedEngine(engine=spell_path(file), differences=(difference,), fault=fault)


def _compare_with_record(
    engine: Engine, file: Path, tolerances: Tolerances, lines: LineFinder
) -> CheckedEngine:
    record = find_record(file)
    where = f"{record.parent.name}/{spell_path(record.name)}"
    if not record.exists():
        reason = f"no result is recorded in {where}; check --update records it"
        return _refuse(file, Fault.MISSING, reason)
    present = describe_engine(engine)
    try:
        recorded = read_record(record)
        differences = tuple(find_differences(engine, recorded, present, tolerances))
        changed = None
        if isinstance(recorded.get(INPUTS), dict):
            changed = find_changed(take_model(engine), recorded[INPUTS], lines)
        version = recorded.get("version")
        return CheckedEngine(
            engine=spell_path(file),
            changed_inputs=changed,
            differences=differences,
            recorded_with=str(version) if version else None,
        )
    except BROKEN as error:
        reason = (
            f"the result recorded in {where} cannot be read ({explain_unreadable(error)}); "
            "check --update records it anew"
        )
        return _refuse(file, Fault.UNREADABLE, reason)


# ------------------------------------------------------------------ figures
def find_differences(
    engine: Engine, recorded: Node, present: Described, tolerances: Tolerances
) -> Iterator[Difference]:
    """Yield every figure of an engine that differs from its record.

    Args:
        engine: The engine.
        recorded: Content of the record.
        present: Record that the engine would have now.
        tolerances: Allowed changes.

    Raises:
        BalcliError, ValueError, LookupError, TypeError, ...: The record is malformed (`BROKEN`).
    """
    if present.document == recorded:
        return
    shown = set(present.spectra.orders)
    orders = {entry["order"] for entry in recorded["orders"]}
    if not orders <= shown:
        present = describe_engine(engine, orders | shown)
    old = _list_compared(recorded)
    new = _list_compared(present.document)
    if INPUTS not in recorded and TRAVEL not in recorded:  # a record of balcli 0.1.0
        old = _leave_out_new(old)
        new = _leave_out_new(new)
    numbers = [value for value in old.values() if isinstance(value, (int, float))]
    if not all(map(math.isfinite, numbers)):
        raise BalcliError("a figure is not finite")
    comparison = _Comparison(old, new, tolerances, _find_roundings(present.spectra))
    for path in dict.fromkeys((*new, *old)):
        if not comparison.is_same(path) and not comparison.is_equal_peak(engine, path):
            yield comparison.describe(path)


def _list_compared(document: Node) -> Figures:
    """Return the compared figures and texts of a record by their paths."""
    compared = {key: part for key, part in document.items() if key not in _UNCOMPARED}
    return dict(list_figures(compared))


def _leave_out_new(figures: Figures) -> Figures:
    """Return the figures that balcli 0.1.0 recorded in the same form."""
    return {path: v for path, v in figures.items() if path[0] != TRAVEL and ASSUMED not in path}


def _find_roundings(spectra: Spectra) -> dict[FigurePath, float]:
    """Return the largest change of a figure that rounding can cause, by key and order of the
    quantity; by key alone for peaks. The same bound decides whether an order is balanced. Where
    large forces cancel, the bound may exceed the tolerated share of the remaining force.
    """
    roundings: dict[FigurePath, float] = {}
    for kind, phasors in spectra.items():
        noise = 2 * np.broadcast_to(phasors.noise, phasors.forward.shape)
        for order, error in zip(phasors.orders, noise, strict=True):
            roundings[kind.key, str(order_number(order))] = float(error)
        roundings[(kind.key,)] = float(noise.sum())
    return roundings


class _Comparison:
    """Comparison of the figures of one engine.

    Args:
        old: Recorded figures.
        new: Present figures.
        tolerances: Allowed changes.
        roundings: Changes that rounding can cause, from `_find_roundings`.
    """

    def __init__(
        self,
        old: Figures,
        new: Figures,
        tolerances: Tolerances,
        roundings: Mapping[FigurePath, float],
    ) -> None:
        self._old = old
        self._new = new
        self._tolerances = tolerances
        self._roundings = roundings
        self._largest: dict[FigurePath, float] = {}
        for path, value in (*old.items(), *new.items()):
            if isinstance(value, float) and not path[-1].endswith("_deg"):
                group = find_group(path)
                self._largest[group] = max(self._largest.get(group, 0.0), abs(value))

    def is_same(self, path: FigurePath) -> bool:
        """Return whether recorded and present figure agree."""
        key = path[-1]
        if path in self._old and path in self._new and self._old[path] == self._new[path]:
            return True
        if key in _DIRECTIONS:
            return self._is_same_direction(path)
        if key == "balanced":
            return self._is_same_balance(path)
        if key == "order" and path[0] == "orders":
            return self._is_same_order(path)
        if key.endswith("_deg"):
            return self._is_same_angle(path)
        return self._is_same_size(path)

    def is_equal_peak(self, engine: Engine, path: FigurePath) -> bool:
        """Return whether a difference is only that between the angles of two equally high peaks."""
        kind = _PEAKS.get(path)
        if kind is None:
            return False
        angles = self._get_both(path)
        if None in angles:  # a peak of 0 has no angle; its value is compared
            return True
        curve = compute_spectra(engine, find_relevant_orders(engine), [kind])[kind]
        then, now = np.abs(curve.values(np.radians(np.array(angles, float)))).tolist()
        return bool(then >= now * (1 - self._find_share(path)))

    def describe(self, path: FigurePath) -> Difference:
        """Return the record of a difference."""
        before, after = self._get_both(path)
        largest = self._largest.get(find_group(path), 0.0)
        share = None
        are_numbers = _counts_as_number(before) and _counts_as_number(after)
        if are_numbers and largest and not path[-1].endswith("_deg"):
            share = self._find_change(path) / largest
        is_number = isinstance(after if before is None else before, float)
        unit = find_unit_of(path) if is_number else ""
        return Difference(name_cause(path), describe_figure(path), before, after, share, unit, path)

    def _get_both(self, path: FigurePath) -> tuple[Any, Any]:
        """Return recorded and present value; None for one that is missing."""
        return self._old.get(path), self._new.get(path)

    # -------------------------------------------------------------- kinds of figures
    def _is_same_size(self, path: FigurePath) -> bool:
        before, after = self._get_both(path)
        are_recorded = path in self._old and path in self._new
        if are_recorded and None in (before, after):  # null is no number; a missing figure is 0
            return False
        if not (_counts_as_number(before) and _counts_as_number(after)):
            return False
        return self._find_change(path) <= self._find_allowed(path)

    def _is_same_order(self, path: FigurePath) -> bool:
        """Return whether an order may be shown by only one of the two: its figures are compared
        with 0.
        """
        order = self._old.get(path, self._new.get(path))
        return order not in ALWAYS_RECORDED

    def _is_same_angle(self, path: FigurePath) -> bool:
        before, after = self._get_both(path)
        if before is None or after is None:
            return False
        least = DEAD_CENTER_DEG if path[0] == TRAVEL else PEAK_ANGLE_DEG
        allowed = max(least, 360 * self._find_share(path))
        return _find_turn(before, after, self._find_cycle(path)) <= allowed

    def _find_cycle(self, path: FigurePath) -> float:
        """Return the period of an angle, deg: a cycle for angles of torque, else a revolution."""
        cycle = self._new.get((path[0], "cycle_deg"), 360)
        return float(cycle)

    def _is_same_direction(self, path: FigurePath) -> bool:
        """Compare the axis of a vector, its phase along an axis, or the peak of a scalar."""
        sizes = (*_find_sizes(self._old, path), *_find_sizes(self._new, path))
        allowed = self._find_allowed(path)
        if min(sizes, default=0.0) <= allowed:
            return True
        before, after = self._get_both(path)
        if before is None or after is None:
            return False
        turn = math.degrees(allowed * sum(1 / size for size in sizes) / len(sizes))
        period = _DIRECTIONS[path[-1]]
        if path[-1] == "peak_deg":
            order = float(path[1])
            turn /= order
            period /= order
        return _find_turn(before, after, period) <= turn + DIRECTION_DEG

    def _is_same_balance(self, path: FigurePath) -> bool:
        """Return whether rounding or a tolerated change explains that only one is balanced."""
        then = _find_sizes(self._old, path)
        now = _find_sizes(self._new, path)
        if not then or not now:  # an order that is not shown
            return True
        return then != now and max(*then, *now) <= self._find_allowed(path)

    # -------------------------------------------------------------- allowed changes
    def _find_change(self, path: FigurePath) -> float:
        """Return the change of a number; a missing one counts as 0."""
        return abs((self._new.get(path) or 0.0) - (self._old.get(path) or 0.0))

    def _find_allowed(self, path: FigurePath) -> float:
        """Return the allowed change of a size, or of the size to which a direction belongs."""
        group = find_group(path)
        tolerance = self._tolerances.find(name_quantities(path))
        rounding = 0.0
        if path[0] == "orders":
            rounding = self._roundings.get((group[-1], path[1]), 0.0)
        elif path[0] == "peak":
            rounding = self._roundings.get((group[-1],), 0.0)
        return tolerance.find_change(self._largest.get(group, 0.0)) + rounding

    def _find_share(self, path: FigurePath) -> float:
        """Return the allowed change as a share of the largest figure of the group."""
        tolerance = self._tolerances.find(name_quantities(path))
        return tolerance.find_share(self._largest.get(find_group(path), 0.0))


def _counts_as_number(value: object) -> bool:
    """Return whether a value is a number, or missing, which counts as 0."""
    return value is None or (isinstance(value, (int, float)) and not isinstance(value, bool))


def _find_turn(one: float, other: float, period: float) -> float:
    """Return the smallest turn between two angles with a period, deg."""
    return abs((other - one + period / 2) % period - period / 2)


def _find_sizes(figures: Figures, path: FigurePath) -> tuple[float, ...]:
    """Return the sizes of the vectors to which a direction or `balanced` belongs: the two rotating
    vectors of a force or moment, or the amplitude of a component or scalar. Return () if the
    figures do not have them.
    """
    place = path[:-1]
    amplitude = figures.get((*place, "amplitude"))
    if amplitude is not None:
        return (abs(amplitude),)
    if (*place, "forward", "x") not in figures:
        return ()
    sizes = []
    for sense in ("forward", "backward"):
        sizes.append(math.hypot(figures[*place, sense, "x"], figures[*place, sense, "y"]))
    return tuple(sizes)
