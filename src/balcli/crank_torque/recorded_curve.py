"""Split a recorded curve of any quantity, such as the tension of a belt, into its orders."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal, NamedTuple

import numpy as np

from ..core.piecewise import PiecewiseCurve
from ..core.records import HIDDEN, INLINE
from ..errors import BalcliError
from ..file.csv_columns import Head, list_heads
from ..file.fields import join_words
from ..show.figures import Harmonic
from .flywheel import degrees_in_cycle
from .given_curve import ANGLE_HEAD, TORQUE_HEAD, list_harmonics, read_column
from .records import write_whole


class RecordedOrder(NamedTuple):
    """One order of a recorded curve.

    Attributes:
        order: Order: oscillations per turn.
        harmonic: Its cosine, sine and amplitude.
    """

    order: float
    harmonic: Annotated[Harmonic, INLINE]


@dataclass(frozen=True, kw_only=True)
class RecordedCurve:
    """A recorded curve over the crank angle, in the unit of its file.

    Attributes:
        quantity: Head of its column in the file, with the unit.
        cycle_deg: Length of its period.
        mean: Mean value.
        max: Largest value.
        max_deg: Crank angle of the largest value.
        min: Smallest value.
        min_deg: Crank angle of the smallest value.
        orders: The curve by order.
        name: Name of the file, without its ending.
    """

    format: Literal["balcli.record/1"] = "balcli.record/1"
    quantity: str
    cycle_deg: float
    mean: float
    max: float
    max_deg: float
    min: float
    min_deg: float
    orders: tuple[RecordedOrder, ...]
    name: Annotated[str, HIDDEN]


def find_quantity(path: Path) -> str:
    """Return the head of the only column besides the angle; empty if the file has a torque, with
    or without its unit, or no angle.

    Raises:
        BalcliError: The file cannot be read, or has several columns besides the angle and none of
            them is a torque.
    """
    heads = list_heads(path)
    others = [head for head in heads if not _matches(ANGLE_HEAD, head)]
    if len(others) == len(heads) or any(_is_torque(head) for head in others):
        return ""
    if len(others) > 1:
        raise BalcliError(
            f"{path}: has the columns {join_words(others)}; keep one of them besides the angle, or "
            "name the torque torque_Nm"
        )
    return "".join(others)


def _is_torque(head: str) -> bool:
    return _matches(TORQUE_HEAD, head) or head.partition(" ")[0].lower() in ("torque", "moment")


def _matches(wanted: Head, head: str) -> bool:
    return any(wanted.read(head, by_symbol=by_symbol) for by_symbol in (False, True))


def analyze_record(
    name: str, quantity: str, curve: PiecewiseCurve, orders: list[float] | None = None
) -> RecordedCurve:
    """Return the orders of a recorded curve.

    Args:
        name: Name of the result.
        quantity: Name of the quantity, with its unit.
        curve: Curve over the angle.
        orders: Orders (cycles in 360 degrees) to show; default: as for a torque.

    Raises:
        BalcliError: A requested order is not a harmonic of the period.
    """
    lowest, highest = curve.extremes()
    return RecordedCurve(
        name=name,
        quantity=quantity,
        cycle_deg=write_whole(float(np.degrees(curve.period))),
        mean=curve.mean,
        max=highest.value,
        max_deg=degrees_in_cycle(highest.angle, curve.period),
        min=lowest.value,
        min_deg=degrees_in_cycle(lowest.angle, curve.period),
        orders=tuple(RecordedOrder(*pair) for pair in list_harmonics(curve, orders)),
    )


def read_record(path: Path, quantity: str) -> PiecewiseCurve:
    """Return the curve in the column with this head, linear between rows.

    Raises:
        BalcliError: The file has no such column or no angles, or the angles fall.
    """
    return read_column(path, Head(quantity))
