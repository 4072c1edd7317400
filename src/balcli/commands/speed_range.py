"""Ranges of crank speeds, of `--speeds` and of `analyze --speed`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from ..errors import BalcliError
from ..limits import LONGEST_SHOWN, MOST_SPEEDS, SMALLEST_POSITIVE
from .amounts import convert_speed, doubt_thousands
from .declare import optional

if TYPE_CHECKING:
    from ..core.vibration import Real

Speeds = Annotated[
    str | None,
    optional(
        "RPM:RPM:STEP|RPM,...",
        "Crank speeds; default: from an eighth of the file's speed to this.",
        "--speeds",
        "--speed",
    ),
]


def parse_speeds(
    text: str | None, option: str = "--speeds", most: int = MOST_SPEEDS
) -> Real | None:
    """Speeds of `1000:2500:25` (first, last, step), `1000:2500` (100 steps) or `1500,2000`, rpm,
    rising.

    Args:
        option: by which they were given, for messages.
        most: how many there may be.

    Raises:
        BalcliError: anything else, with the text.
    """
    if text is None:
        return None
    import numpy as np

    right = "give first:last:step in rpm, such as 1000:2500:25, or speeds such as 1500,2000"
    start = f'{option} "{text[:LONGEST_SHOWN]}": '
    try:
        ranged = ":" in text
        figures = [convert_speed(part) for part in text.split(":" if ranged else ",")]
    except ValueError:
        raise BalcliError(start + right) from None
    if ranged and len(figures) > 3:
        raise BalcliError(start + right)
    if not all(SMALLEST_POSITIVE <= figure < 1e9 for figure in figures):
        wrong = "speeds and their step are" if ranged else "speeds are"
        raise BalcliError(f"{start}{wrong} above 0 and below 1e9 rpm; {right}")
    doubt_thousands(option, text)
    if not ranged:
        return np.array(sorted(set(figures)))
    first, last, step = (*figures, (figures[1] - figures[0]) / 100)[:3]
    if not (first <= last and (step > 0 or first == last)):
        raise BalcliError(f"{start}must rise; {right}")
    if first == last:
        return np.array([first])
    count = int((last - first) / step + 1e-9) + 1
    if count > most:
        raise BalcliError(f"{start}has {count} speeds; at most {most} are computed")
    speeds = np.round(first + step * np.arange(count), 9)
    return speeds if speeds[-1] >= last - 1e-9 * step else np.append(speeds, last)
