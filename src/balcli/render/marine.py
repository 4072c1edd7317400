"""The sheet of builders of large engines: external forces and moments, guide-force moments and
torque by order, at one speed an order a row, at several a speed a row.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..documents.records import remove_unit
from ..results.marine import FIGURES
from .csv import Rows, name_cell
from .engine_facts import engine_facts
from .figures import clean, clean_each
from .formats import Renderer
from .guide_moments import define_guide_moments
from .sheet import (
    NAMELESS,
    NEGLIGIBLE,
    Grid,
    Sheet,
    Text,
    given,
    order_name,
    order_number,
    size_cell,
)
from .view import NamedResult

if TYPE_CHECKING:
    from ..core.phasors import Array
    from ..results.marine import MarineSheet
    from .units import ShownUnit, System

_NAMES = (
    "FnV, FnH, MnV, MnH: n is the order, so that M1V and M2V stand in column MnV. Amplitudes; a "
    "vertical force makes a vertical moment."
)


# Names of the figures as engineers write them, `n` for the order.
_SYMBOLS = dict(zip(FIGURES, ("FnV", "FnH", "MnV", "MnH", "Hn", "Xn", "Tn"), strict=True))
_EXTERNAL, _INNER = FIGURES[:4], FIGURES[4:]


def sheet(one: NamedResult[MarineSheet], system: System) -> Sheet:
    """Return what the engine is, what acts on its frame and on its crank, and what the names
    mean.
    """
    result = one.result
    head = engine_facts(
        result.engine, system, higher=False, whole=False, speeds_rpm=result.speeds_rpm.tolist()
    )
    alone = "of inertia alone, without gas"
    of_what = alone if result.engine.gas is None else "of inertia and gas"
    if len(result.speeds_rpm) == 1:
        title = f"Guide-force moments Hn, Xn and torque on the crank Tn, {of_what}"
        groups = {"External forces and moments": _EXTERNAL, title: _INNER}
        draw = _grid_by_order
    else:
        groups = {
            "External forces": _EXTERNAL[:2],
            "External moments": _EXTERNAL[2:],
            f"H-type guide-force moments {of_what}": _INNER[:1],
            f"X-type guide-force moments {of_what}": _INNER[1:2],
            f"Torque on the crank {of_what}": _INNER[2:],
        }
        draw = _grid_by_speed
    grids = (draw(title, names, result, system) for title, names in groups.items())
    notes = (_tell_axes(result), define_guide_moments(result.height_m, system))
    return Sheet(result.engine.name or NAMELESS, (head, *grids, Text("", notes)))


def document(one: NamedResult[MarineSheet]) -> dict[str, Any]:
    """Return `balcli.marine/1`: SI."""
    result = one.result

    def entry(i: int, k: int) -> dict[str, Any]:
        figures = {name: clean(values[i, k]) for name, values in result.figures.items()}
        return {"order": order_number(result.orders[k]), **figures}

    return {
        "format": "balcli.marine/1",
        "engine": {"name": result.engine.name, "cylinders": result.engine.cylinders.count},
        "includes": "inertia, without gas" if result.engine.gas is None else "inertia and gas",
        "axes": {"v": "x", "h": "y"},
        "height_m": clean_each(result.height_m),
        "speeds": [
            {"speed_rpm": speed, "orders": [entry(i, k) for k in range(len(result.orders))]}
            for i, speed in enumerate(result.speeds_rpm.tolist())
        ],
    }


def rows(one: NamedResult[MarineSheet], system: System) -> Rows:
    """Return CSV: an order of a speed a line, a column a figure."""
    result = one.result
    units = {name: _unit(name, system) for name in FIGURES}
    heads = (f"{remove_unit(name)}_{unit.name.replace('·', '')}" for name, unit in units.items())
    lines = (
        (
            name_cell(one.name),
            speed,
            order_number(order),
            *(clean(unit.of(result.figures[name][i, k])) for name, unit in units.items()),
        )
        for i, speed in enumerate(result.speeds_rpm)
        for k, order in enumerate(result.orders)
    )
    return Rows(("engine", "speed_rpm", "order", *heads), lines)


def _unit(name: str, system: System) -> ShownUnit:
    return system.force if name.endswith("_N") else system.moment


def _find_least(name: str, result: MarineSheet) -> Array:
    """Return above which size a figure matters, shape (speeds, 1)."""
    if name.startswith("force"):
        largest = result.force_of_one
    elif name.startswith("moment"):
        largest = result.moment_of_one
    else:
        alike = [values for key, values in result.figures.items() if key[:5] == name[:5]]
        largest = np.nan_to_num(np.hstack(alike)).max(axis=1)
    return NEGLIGIBLE * largest[:, None]


def _find_orders_that_matter(name: str, result: MarineSheet) -> Array:
    """Return which orders do at one of the speeds, shape (orders,); all that are not 0 if every
    one is asked for.
    """
    least = 0.0 if result.every_order else _find_least(name, result)
    return np.asarray(np.any(np.nan_to_num(result.figures[name]) > least, axis=0))


# ------------------------------------------------------------------ tables
def _grid_by_order(
    title: str, names: tuple[str, ...], result: MarineSheet, system: System
) -> Grid | Text:
    """Return a table at one speed: an order a row."""
    matter = np.any([_find_orders_that_matter(name, result) for name in names], axis=0)
    shown = np.flatnonzero(matter | (result.orders <= 2) & (result.orders % 1 == 0))
    units = {name: _fit(names, name, result, system) for name in names}
    rows = tuple(
        (
            order_name(result.orders[k]),
            *(_cell(name, 0, k, unit, result) for name, unit in units.items()),
        )
        for k in map(int, shown)
    )
    heads = (f"{_SYMBOLS[name]}, {unit.name}" for name, unit in units.items())
    return Grid(title, ("order", *heads), rows, _NAMES if names == _EXTERNAL else "")


def _grid_by_speed(
    title: str, names: tuple[str, ...], result: MarineSheet, system: System
) -> Grid | Text:
    """Return a table of several speeds: a speed a row, a column an order; one sentence where none
    matters.
    """
    matter = {name: _find_orders_that_matter(name, result) for name in names}
    orders = range(len(result.orders))
    chosen = [(name, k) for k in orders for name in names if matter[name][k]]
    if not chosen:
        unknown = all(np.isnan(result.figures[name]).all() for name in names)
        return Text("", (f"{title}: {'not known' if unknown else 'balanced'}.",))
    unit = _fit(tuple(name for name, _ in chosen), names[0], result, system)
    heads = (_SYMBOLS[name].replace("n", order_name(result.orders[k])) for name, k in chosen)
    lines = tuple(
        (given(speed), *(_cell(name, i, k, unit, result) for name, k in chosen))
        for i, speed in enumerate(result.speeds_rpm.tolist())
    )
    return Grid(f"{title}, {unit.name}", ("rpm", *heads), lines, words=())


def _fit(names: tuple[str, ...], like: str, result: MarineSheet, system: System) -> ShownUnit:
    """Return one unit for all forces or all moments of a table."""
    unit = _unit(like, system)
    alike = [result.figures[name] for name in names if _unit(name, system) == unit]
    return unit.fit(max(float(np.nan_to_num(values).max()) for values in alike))


def _cell(name: str, i: int, k: int, unit: ShownUnit, result: MarineSheet) -> str:
    value, least = float(result.figures[name][i, k]), float(_find_least(name, result)[i, 0])
    return size_cell(value, unit, negligible=not result.every_order and value < least)


def _tell_axes(result: MarineSheet) -> str:
    """Where vertical is, by the banks of the file."""
    axes = [round(float(axis), 6) + 0.0 for axis in np.ravel(result.engine.cylinders.axis_deg)]
    if axes == [0.0]:
        return "V is along the cylinders (x), H across them (y)."
    mirrored = sorted(axes) == sorted(0.0 - axis for axis in axes)
    stand = ", ".join(f"{axis:g}" for axis in axes)
    what = "midway between the banks" if mirrored and len(axes) == 2 else f"banks at {stand} deg"
    return f"V is along x, from which bank angles count ({what}), H along y."


RENDERER = Renderer(sheet=sheet, document=document, rows=rows)
