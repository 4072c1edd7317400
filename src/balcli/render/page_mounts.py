"""What the page needs to rock the body on its mounts: plain figures in mm and rad."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..mounting.records import MountReport
from .body_block import PROJECTION, find_corners

_SPEEDS = 48  # of the range, that the page has


def rocking(result: MountReport) -> dict[str, Any] | None:
    """The block and its mounts about the centre of gravity, and its motion by speed and order: six
    cosines, then six sines (mm, rad). None where no engine runs.
    """
    response = result.response
    if response is None:
        return None
    body = result.mounted.body
    count = len(response.speeds_rpm)
    rows = np.linspace(0, count - 1, min(count, _SPEEDS)).round().astype(int)
    motion = np.moveaxis(response.body[:, rows], 1, 0) * np.repeat([1e3, 1.0], 3)
    parts = np.concatenate([motion.real, -motion.imag], axis=-1)
    return {
        "projection": PROJECTION.tolist(),
        "corners": (1e3 * find_corners(body)).round(3).tolist(),
        "mounts": (1e3 * (result.mounted.dynamic.at - body.centre)).round(3).tolist(),
        "speeds": [float(f"{rpm:.5g}") for rpm in response.speeds_rpm[rows]],
        "orders": [passed.order for passed in response.passed],
        "motion": [[[float(f"{v:.5g}") for v in order] for order in speed] for speed in parts],
    }
