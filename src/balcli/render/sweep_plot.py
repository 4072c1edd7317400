"""Picture of a sweep: curves over one parameter, contours over two."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, Any

from ..errors import BalcliError
from .plot import style

if TYPE_CHECKING:
    from ..studies.sweep import Array, Sweep

LEVELS = 12


def draw_sweep(sweep: Sweep, values: list[Array]) -> bytes:
    """Draw the sweep as SVG: curves over one parameter, or contours over two.

    Raises:
        BalcliError: more than two parameters, or fewer than two values of one.
    """
    several = [p for p in sweep.parameters if len(p) > 1]
    if not 0 < len(several) <= 2:
        raise BalcliError(
            f"--plot draws one or two parameters with several values each, not {len(several)}"
        )
    if len(several) == 1:
        with style.open_figure(7, 4.2, "svg") as page:
            _draw_curves(page.subplots(), sweep, values)
            return style.save_figure(page, "svg")
    with style.open_figure(6 * len(values), 4.8, "svg") as page:
        for axes, quantity, value in zip(
            page.subplots(1, len(values), squeeze=False)[0], sweep.quantities, values, strict=True
        ):
            _draw_contours(
                page, axes, several, value.squeeze(), f"{quantity.name}, {quantity.unit}"
            )
        return style.save_figure(page, "svg")


def _draw_curves(axes: Any, sweep: Sweep, values: list[Array]) -> None:
    parameter = next(p for p in sweep.parameters if len(p) > 1)
    looks = [
        (colour, line)
        for line in ("-", "--", ":")
        for colour in (style.BLUE, style.RED, style.GREEN)
    ]
    for quantity, value, (colour, line) in zip(
        sweep.quantities, values, cycle(looks), strict=False
    ):
        axes.plot(
            parameter.values,
            value.ravel(),
            color=colour,
            linestyle=line,
            label=f"{quantity.name}, {quantity.unit}",
        )
    axes.set_xlabel(parameter.path)
    axes.legend()


def _draw_contours(figure: Any, axes: Any, parameters: Any, value: Array, title: str) -> None:
    first, second = parameters
    filled = axes.contourf(second.values, first.values, value, LEVELS)
    figure.colorbar(filled, ax=axes)
    axes.set(xlabel=second.path, ylabel=first.path, title=title)
