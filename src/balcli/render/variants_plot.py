"""Picture of a sweep: curves over one parameter, contours over two."""
from __future__ import annotations

from io import BytesIO
from typing import TYPE_CHECKING, Any

from ..errors import BalcliError

if TYPE_CHECKING:
    from ..sweep import Array, Sweep

LEVELS = 12


def draw(sweep: Sweep, values: list[Array]) -> bytes:
    """SVG.

    Raises:
        BalcliError: more than two parameters, or fewer than two values of one.
    """
    several = [p for p in sweep.parameters if len(p) > 1]
    if not 0 < len(several) <= 2:
        raise BalcliError(f"--plot draws one or two parameters with several values each, not {len(several)}")
    from matplotlib.figure import Figure

    if len(several) == 1:
        figure = Figure(figsize=(7, 4.2), layout="constrained")
        _curves(figure.subplots(), sweep, values)
    else:
        figure = Figure(figsize=(6 * len(values), 4.8), layout="constrained")
        for axes, quantity, value in zip(figure.subplots(1, len(values), squeeze=False)[0], sweep.quantities, values, strict=True):
            _contours(figure, axes, several, value.squeeze(), f"{quantity.name}, {quantity.unit}")
    buffer = BytesIO()
    figure.savefig(buffer, format="svg", metadata={"Date": None})
    return buffer.getvalue()


def _curves(axes: Any, sweep: Sweep, values: list[Array]) -> None:
    parameter = next(p for p in sweep.parameters if len(p) > 1)
    for quantity, value in zip(sweep.quantities, values, strict=True):
        axes.plot(parameter.values, value.ravel(), label=f"{quantity.name}, {quantity.unit}")
    axes.set_xlabel(parameter.path)
    axes.grid(alpha=0.3)
    axes.legend()


def _contours(figure: Any, axes: Any, parameters: Any, value: Array, title: str) -> None:
    first, second = parameters
    filled = axes.contourf(second.values, first.values, value, LEVELS)
    figure.colorbar(filled, ax=axes)
    axes.set(xlabel=second.path, ylabel=first.path, title=title)
