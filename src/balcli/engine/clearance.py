"""Warn of cranks that are geared together but stand so close that they would strike each other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ..file.doubt import Doubt

THROW_IN_BORES = 0.3  # least width of a throw along the crank
_ROUNDING = 1e-9  # a smaller share of the distance of two cranks is rounding


class SweptCylinder(NamedTuple):
    """The cylinder that the throws of a crank sweep.

    Attributes:
        axis_m: Position x + iy of its axis, m.
        radius_m: Its radius, the largest crank radius, m.
        start_m: Smallest z, m.
        end_m: Largest z, m.
    """

    axis_m: complex
    radius_m: float
    start_m: float
    end_m: float

    def overlaps(self, other: SweptCylinder) -> bool:
        """Return whether both cylinders have a z in common."""
        return max(self.start_m, other.start_m) <= min(self.end_m, other.end_m)


def doubt_clearances(swept: Sequence[SweptCylinder]) -> Iterator[Doubt]:
    """Yield a warning for each engine whose throws would strike those of an earlier one: the axes
    of both cranks are closer than the sum of their crank radii, and their throws overlap along the
    crank. Of several earlier engines, the first is named.

    Args:
        swept: What the throws of each engine sweep, in the order of [[engine]].
    """
    for number, cylinder in enumerate(swept, 1):
        for before, earlier in enumerate(swept[: number - 1], 1):
            apart = abs(cylinder.axis_m - earlier.axis_m)
            least = cylinder.radius_m + earlier.radius_m
            if apart < least * (1 - _ROUNDING) and cylinder.overlaps(earlier):
                message = (
                    f"the crank axis is {1e3 * apart:.4g} mm from that of engine {before}, where "
                    f"at least {1e3 * least:.4g} mm (both crank radii) is usual for throws that "
                    "overlap along the crank; give x, y, z of each engine"
                )
                also = (f"engine.{before}.at", f"engine.{before}.crank", f"engine.{number}.crank")
                yield Doubt(f"engine.{number}.at", message, also)
                break
