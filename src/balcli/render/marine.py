"""The sheet of builders of large engines: external forces and moments, guide-force moments and
torque by order, at one speed an order a row, at several a speed a row.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .csv import Rows, name_cell
from .engine_facts import engine_facts
from .figures import clean
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


class _Column(NamedTuple):
    """One figure by speed and order.

    Attributes:
        key: in JSON and CSV, without its unit.
        name: as engineers write it, `n` for the order.
        force: whether it is a force; else it is a moment.
        values: SI, shape (speeds, orders).
        least: above which it matters, shape (speeds, 1).
    """

    key: str
    name: str
    force: bool
    values: Array
    least: Array

    def unit(self, system: System) -> ShownUnit:
        """The unit of one value."""
        return system.force if self.force else system.moment

    def find_orders_that_matter(self, every: bool) -> Array:
        """Which orders do at one of the speeds, shape (orders,); all that are not 0 if `every`."""
        least = 0.0 if every else self.least
        return np.asarray(np.any(np.nan_to_num(self.values) > least, axis=0))


def sheet(one: NamedResult[MarineSheet], system: System) -> Sheet:
    """What the engine is, what acts on its frame and on its crank, and what the names mean."""
    result = one.result
    head = engine_facts(
        result.engine, system, higher=False, whole=False, speeds_rpm=result.speeds_rpm.tolist()
    )
    external, inner = _external(result), _inner(result)
    grids: tuple[Grid | Text, ...]
    gas = result.engine.gas
    of_what = "of inertia alone, without gas" if gas is None else "of inertia and gas"
    if len(result.speeds_rpm) == 1:
        title = f"Guide-force moments Hn, Xn and torque on the crank Tn, {of_what}"
        grids = (
            _grid_by_order("External forces and moments", external, result, system),
            _grid_by_order(title, inner, result, system),
        )
    else:
        groups = {
            "External forces": external[:2],
            "External moments": external[2:],
            f"H-type guide-force moments {of_what}": inner[:1],
            f"X-type guide-force moments {of_what}": inner[1:2],
            f"Torque on the crank {of_what}": inner[2:],
        }
        grids = tuple(
            _grid_by_speed(title, columns, result, system) for title, columns in groups.items()
        )
    notes = (_tell_axes(result), define_guide_moments(result.height_m, system))
    return Sheet(result.engine.name or NAMELESS, (head, *grids, Text("", notes)))


def document(one: NamedResult[MarineSheet]) -> dict[str, Any]:
    """`balcli.marine/1`: SI."""
    result = one.result
    columns = (*_external(result), *_inner(result))
    keys = [f"{column.key}_{'N' if column.force else 'Nm'}" for column in columns]

    def entry(i: int, k: int) -> dict[str, Any]:
        figures = (clean(column.values[i, k]) for column in columns)
        return {"order": order_number(result.orders[k]), **dict(zip(keys, figures, strict=True))}

    return {
        "format": "balcli.marine/1",
        "engine": {"name": result.engine.name, "cylinders": result.engine.cylinders.count},
        "includes": "inertia, without gas" if result.engine.gas is None else "inertia and gas",
        "axes": {"v": "x", "h": "y"},
        "height_m": [clean(height) for height in result.height_m],
        "speeds": [
            {"speed_rpm": speed, "orders": [entry(i, k) for k in range(len(result.orders))]}
            for i, speed in enumerate(result.speeds_rpm.tolist())
        ],
    }


def rows(one: NamedResult[MarineSheet], system: System) -> Rows:
    """CSV: an order of a speed a line, a column a figure."""
    result = one.result
    columns = (*_external(result), *_inner(result))
    units = [column.unit(system) for column in columns]
    heads = (
        f"{column.key}_{unit.name.replace('·', '')}"
        for column, unit in zip(columns, units, strict=True)
    )

    def line(i: int, k: int) -> Iterator[Any]:
        yield from (name_cell(one.name), result.speeds_rpm[i], order_number(result.orders[k]))
        for column, unit in zip(columns, units, strict=True):
            yield clean(unit.of(column.values[i, k]))

    return Rows(
        ("engine", "speed_rpm", "order", *heads),
        (
            tuple(line(i, k))
            for i in range(len(result.speeds_rpm))
            for k in range(len(result.orders))
        ),
    )


# ------------------------------------------------------------------ columns
def _external(result: MarineSheet) -> tuple[_Column, ...]:
    force, moment = (
        NEGLIGIBLE * one[:, None] for one in (result.force_of_one, result.moment_of_one)
    )
    return (
        _Column("force_v", "FnV", True, result.force_v, force),
        _Column("force_h", "FnH", True, result.force_h, force),
        _Column("moment_v", "MnV", False, result.moment_v, moment),
        _Column("moment_h", "MnH", False, result.moment_h, moment),
    )


def _inner(result: MarineSheet) -> tuple[_Column, ...]:
    both = np.nan_to_num(np.hstack([result.guide_h, result.guide_x]))
    largest, most = both.max(axis=1), result.torque.max(axis=1)
    guide, torque = NEGLIGIBLE * largest[:, None], NEGLIGIBLE * most[:, None]
    return (
        _Column("guide_h", "Hn", False, result.guide_h, guide),
        _Column("guide_x", "Xn", False, result.guide_x, guide),
        _Column("torque", "Tn", False, result.torque, torque),
    )


# ------------------------------------------------------------------ tables
def _grid_by_order(
    title: str, columns: tuple[_Column, ...], result: MarineSheet, system: System
) -> Grid:
    """At one speed: an order a row."""
    matter = np.any([c.find_orders_that_matter(result.every_order) for c in columns], axis=0)
    shown = np.flatnonzero(matter | (result.orders <= 2) & (result.orders % 1 == 0))
    units = [_fit(columns, column.force, system) for column in columns]

    def cells(k: int) -> tuple[str, ...]:
        figures = (
            _cell(column, 0, k, unit, result.every_order)
            for column, unit in zip(columns, units, strict=True)
        )
        return order_name(result.orders[k]), *figures

    heads = (f"{c.name}, {unit.name}" for c, unit in zip(columns, units, strict=True))
    note = _NAMES if any(column.force for column in columns) else ""
    return Grid(title, ("order", *heads), tuple(map(cells, map(int, shown))), note)


def _grid_by_speed(
    title: str, columns: tuple[_Column, ...], result: MarineSheet, system: System
) -> Grid | Text:
    """At several speeds: a speed a row, a column an order; one sentence where none matters."""
    chosen = [
        (column, int(k))
        for k in range(len(result.orders))
        for column in columns
        if column.find_orders_that_matter(result.every_order)[k]
    ]
    if not chosen:
        unknown = all(np.isnan(column.values).all() for column in columns)
        return Text("", (f"{title}: {'not known' if unknown else 'balanced'}.",))
    unit = _fit(tuple(column for column, _ in chosen), columns[0].force, system)
    heads = (column.name.replace("n", order_name(result.orders[k])) for column, k in chosen)
    lines = tuple(
        (given(speed), *(_cell(column, i, k, unit, result.every_order) for column, k in chosen))
        for i, speed in enumerate(result.speeds_rpm.tolist())
    )
    return Grid(f"{title}, {unit.name}", ("rpm", *heads), lines, words=())


def _fit(columns: tuple[_Column, ...], force: bool, system: System) -> ShownUnit:
    """One unit for all forces or all moments of a table."""
    alike = [column for column in columns if column.force == force]
    largest = max(float(np.nan_to_num(column.values).max()) for column in alike)
    return alike[0].unit(system).fit(largest)


def _cell(column: _Column, i: int, k: int, unit: ShownUnit, every: bool) -> str:
    value = float(column.values[i, k])
    return size_cell(value, unit, negligible=not every and value < float(column.least[i, 0]))


def _tell_axes(result: MarineSheet) -> str:
    """Where vertical is, by the banks of the file."""
    axes = [round(float(axis), 6) + 0.0 for axis in np.ravel(result.engine.cylinders.axis_deg)]
    if axes == [0.0]:
        return "V is along the cylinders (x), H across them (y)."
    mirrored = sorted(axes) == sorted(0.0 - axis for axis in axes)
    stand = ", ".join(f"{axis:g}" for axis in axes)
    what = "midway between the banks" if mirrored and len(axes) == 2 else f"banks at {stand} deg"
    return f"V is along x, from which bank angles count ({what}), H along y."
