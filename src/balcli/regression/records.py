"""Records of the result of `balcli check`: what differs between engines and their recorded results.

They hold facts only; `show` makes lines, annotations and JUnit reports of them.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from enum import Enum, auto
from typing import Annotated, Any, Literal, NamedTuple

from ..core.records import HIDDEN

FigurePath = tuple[str, ...]  # keys from the top of a record, and labels: `2` for order 2


def spell_path(path: object) -> str:
    """Return the path of a file as text that every format can hold. A byte that is not UTF-8 is
    spelled: a file name with the byte 255 has `\\xff`.
    """
    return os.fsencode(str(path)).decode("utf-8", errors="backslashreplace")


class Fault(Enum):
    """Why an engine could not be compared with its record."""

    MISSING = auto()  # no result is recorded
    UNREADABLE = auto()
    ABANDONED = auto()  # the engine file of the record is missing


class ChangedInput(NamedTuple):
    """A value of an engine file that differs from the value with which the result was recorded.

    Attributes:
        key: Key of the engine file, such as `crank.stroke`; a key of an engine in [[engine]] begins
            with the name of its file.
        recorded: Recorded value in the unit of the file; null if the key was left out.
        now: Present value; null if the key is left out.
        unit: Unit of both values; empty for plain numbers and texts.
        line: Line of the key in the engine file; null if it is not found.
    """

    key: str
    recorded: Any
    now: Any
    unit: str = ""
    line: int | None = None


class Difference(NamedTuple):
    """A figure that differs from its record, or the reason why a record could not be compared.

    Attributes:
        cause: Quantity (`force`) or part of the record (`torsion`) that has the figure; null for a
            missing or broken record.
        figure: Figure in words, or the reason.
        recorded: Recorded value; null if there is none.
        now: Present value; null if there is none.
        share: Change / largest figure of the same quantity; null for angles and texts.
        unit: Unit of both values; empty for plain numbers and texts.
        path: Place of the figure in the record.
    """

    cause: str | None
    figure: str
    recorded: float | bool | str | None = None
    now: float | bool | str | None = None
    share: float | None = None
    unit: str = ""
    path: Annotated[FigurePath, HIDDEN] = ()


class BrokenLimit(NamedTuple):
    """A quantity that is beyond a limit in [check.limits].

    Attributes:
        quantity: Name of the quantity.
        value: Value; null if the quantity has none, such as the axis of a circle.
        unit: Unit of the value and of the limits.
        below: Limit that the value must be below; null if there is none.
        above: Limit that the value must be above; null if there is none.
        line: Line of the limit in the engine file; null if it is not found.
    """

    quantity: str
    value: float | None
    unit: str
    below: float | None
    above: float | None
    line: int | None = None


class Mistake(NamedTuple):
    """A mistake in an engine file.

    Attributes:
        key: Key with the mistake; empty for the file as a whole.
        message: The mistake, then the remedy.
        line: Line in the engine file; null if it is not known.
    """

    key: str
    message: str
    line: int | None = None


@dataclass(frozen=True, kw_only=True)
class CheckedEngine:
    """An engine file and the differences from its record.

    Attributes:
        engine: Path of the engine file.
        changed_inputs: Values of the engine file that changed; null if the record has no inputs,
            because an earlier version of balcli made it.
        differences: Every figure that changed.
        broken_limits: Quantities beyond a limit of the engine file.
        mistakes: Mistakes of the engine file.
        error: Reason why the file could not be compared; None if it was compared.
        recorded_with: Version of balcli that made the record; left out if it is not known.
        fault: Why the engine could not be compared with its record.
        written: Whether the result was recorded anew.
    """

    engine: str
    changed_inputs: tuple[ChangedInput, ...] | None = ()
    differences: tuple[Difference, ...] = ()
    broken_limits: tuple[BrokenLimit, ...] = ()
    mistakes: tuple[Mistake, ...] = ()
    error: str | None = None
    recorded_with: str | None = None
    fault: Annotated[Fault | None, HIDDEN] = None
    written: Annotated[bool, HIDDEN] = False


@dataclass(frozen=True, kw_only=True)
class Check:
    """Engines compared with their recorded results.

    Attributes:
        engines: All engines, compared or not.
    """

    format: Literal["balcli.check/1"] = "balcli.check/1"
    engines: tuple[CheckedEngine, ...]
