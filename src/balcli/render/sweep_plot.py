"""Picture of a sweep: curves over one parameter, contours over two."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import BalcliError
from ..limits import MOST_PICTURE_VARIANTS
from .plot import style
from .units import ShownUnit, name_with_unit, unit_of_name

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..core.phasors import Array
    from ..studies.parameters import Parameter
    from ..studies.sweep import Sweep

LEVELS = 12


def check_drawable(sweep: Sweep) -> None:
    """See that there can be a picture, before anything is computed for it.

    Raises:
        BalcliError: more than two parameters, fewer than two values of one, or too many variants.
    """
    several = len(_varied_parameters(sweep))
    if not 0 < several <= 2:
        raise BalcliError(
            f"a picture shows one or two parameters with several values each, not {several}"
        )
    if sweep.variants > MOST_PICTURE_VARIANTS:
        raise BalcliError(
            f"{sweep.variants} variants are too many for one picture; "
            f"{MOST_PICTURE_VARIANTS} are allowed"
        )


def _varied_parameters(sweep: Sweep) -> list[Parameter]:
    return [p for p in sweep.parameters if len(p) > 1]


def make_sweep(sweep: Sweep, values: Sequence[Array]) -> Figure:
    """Return the picture of a sweep that `check_drawable` accepts.

    Args:
        values: each quantity on the whole grid.
    """
    several, shown = _varied_parameters(sweep), zip(sweep.quantities, values, strict=True)
    name = style.fit_name(sweep.file.name)
    if len(several) == 1:
        names = list(dict.fromkeys(quantity.unit for quantity in sweep.quantities))
        with style.open_figure(7, 1.2 + 3 * len(names)) as page:
            places = page.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
            for axes, unit in zip(places, names, strict=True):
                _draw_curves(axes, several[0], sweep, values, unit)
                axes.label_outer()
            places[0].set_title(name)
        return page
    first, second = several
    with style.open_figure(6 * len(values), 5.1) as page:
        style.put_title(page, name)
        places = page.subplots(1, len(values), squeeze=False)[0]
        for axes, (quantity, value) in zip(places, shown, strict=True):
            fit = _fit(quantity.unit, value)
            filled = axes.contourf(second.values, first.values, value.squeeze() / fit.size, LEVELS)
            page.colorbar(filled, ax=axes)
            axes.set(
                xlabel=name_with_unit(second.path, second.unit),
                ylabel=name_with_unit(first.path, first.unit),
                title=name_with_unit(quantity.name, fit.name),
            )
    return page


def _draw_curves(
    axes: Any, parameter: Parameter, sweep: Sweep, values: Sequence[Array], name: str
) -> None:
    """Draw the quantities of one unit, all in the one that fits the largest of them."""
    shown = [
        (quantity.name, value.ravel())
        for quantity, value in zip(sweep.quantities, values, strict=True)
        if quantity.unit == name
    ]
    unit = _fit(name, np.concatenate([value for _, value in shown]))
    for (label, value), (line, colour) in zip(shown, cycle(style.MANY_LOOKS), strict=False):
        axes.plot(parameter.values, value / unit.size, color=colour, linestyle=line, label=label)
    axes.set(xlabel=name_with_unit(parameter.path, parameter.unit), ylabel=unit.name)
    axes.ticklabel_format(axis="y", useOffset=False, style="plain")
    axes.legend()


def _fit(name: str, value: Array) -> ShownUnit:
    """Return the unit for the largest of these values, which are in SI units of this name."""
    return unit_of_name(name).fit(float(np.nan_to_num(abs(value)).max(initial=0)))
