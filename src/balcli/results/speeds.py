"""One engine at several speeds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

from ..engine.build import Engine
from .analysis import Analysis
from .comparison import Line, analyze_alike, list_lines


@dataclass(frozen=True, eq=False)
class SpeedSeries:
    """Analyses of one engine by the same orders, a speed each, as the speeds were asked for.

    Attributes:
        every_order: whether orders were asked for, so that none of them is left out.
    """

    analyses: tuple[Analysis, ...]
    every_order: bool = False

    @property
    def speeds_rpm(self) -> list[float]:
        """Of each analysis."""
        return [float(one.engine.speed_rpm) for one in self.analyses]

    @property
    def lines(self) -> tuple[Line, ...]:
        """Every figure, with a value a speed."""
        return list_lines(self.analyses, every_order=self.every_order)


def analyze_speeds(
    engine: Engine,
    speeds_rpm: Sequence[float],
    orders: Iterable[float] | None,
    analyze_one: Callable[[Engine, Iterable[float] | None], Analysis],
) -> SpeedSeries:
    """An engine at each of these speeds.

    Args:
        engine: without trailing axes.
        orders: default: all that are shown at one of the speeds.
        analyze_one: of an engine, with the orders asked for or None.

    Raises:
        BalcliError: whatever `analyze_one` raises.
    """
    engines = [replace(engine, speed_rpm=speed) for speed in speeds_rpm]
    asked = None if orders is None else list(orders)
    return SpeedSeries(analyze_alike(engines, asked, analyze_one), asked is not None)
