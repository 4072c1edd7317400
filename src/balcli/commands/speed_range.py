"""The option `--speeds`: a range of crank speeds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import BalcliError
from ..limits import MOST_MOUNT_SPEEDS
from .amounts import convert_speed

if TYPE_CHECKING:
    from ..core.singular_values import Real

_WANTED = "first:last:step in rpm, such as 600:6500:25, or speeds such as 750,3000"

Speeds = Annotated[
    str | None,
    typer.Option(
        "--speeds",
        metavar="RPM:RPM:STEP|RPM,...",
        show_default=False,
        help="Crank speeds; default: from an eighth of the file's speed to this.",
    ),
]


def parse_speeds(text: str | None) -> Real | None:
    """Speeds of `600:6500:25` (both ends included) or `750,3000`, rpm, rising.

    Raises:
        BalcliError: anything else, with the text.
    """
    if text is None:
        return None
    import numpy as np

    start = f'--speeds "{text[:60]}": '
    ranged = ":" in text
    try:
        figures = [convert_speed(part) for part in text.split(":" if ranged else ",")]
    except ValueError:
        raise BalcliError(f"{start}give {_WANTED}") from None
    if not all(0 < figure < 1e9 for figure in figures) or (ranged and len(figures) != 3):
        raise BalcliError(f"{start}give {_WANTED}")
    if not ranged:
        return np.unique(figures)
    first, last, step = figures
    if last < first:
        raise BalcliError(f"{start}a range rises; give {_WANTED}")
    count = (last - first) / step
    if count >= MOST_MOUNT_SPEEDS:
        raise BalcliError(
            f"{start}at most {MOST_MOUNT_SPEEDS} speeds are computed; take longer steps"
        )
    found = first + step * np.arange(int(count + 1e-9) + 1)
    return found if found[-1] >= last - 1e-9 * step else np.append(found, last)
