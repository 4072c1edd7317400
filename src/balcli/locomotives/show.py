"""Show the balance of a locomotive as tables, JSON and CSV; and several factors in one table."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from ..core.records import Node, angle_deg, find_unit, list_figures, remove_unit, to_document
from ..show.formats import Renderer, Rows, name_cell
from ..show.sheet import (
    NAMELESS,
    NOTHING,
    UNKNOWN,
    Column,
    Facts,
    Grid,
    Sheet,
    Text,
    degrees,
    given,
    number,
    size_text,
)
from ..show.units import SI, ShownUnit, System, name_with_unit
from .answer import LocomotiveBalance

Results = Sequence[LocomotiveBalance]
Values = list[float | None]  # in SI units; None: unknown


class _Series(NamedTuple):
    """A figure of several wheels or factors, for a column.

    Attributes:
        name: Name of the figure.
        values: Values in SI units.
        unit: Unit in which they are shown.
    """

    name: str
    values: Values
    unit: ShownUnit

    def write(self, *, words: bool = False) -> Column:
        """Return a column in the unit that fits the values; `words`: as for `Column`."""
        unit = self.unit.fit(max((v for v in self.values if v is not None), default=0.0))
        return Column(name_with_unit(self.name, unit.name), _write(self.values, unit), words)


_LEFT_OUT = ("format", "axles", "rails", "name", "wheels", "plane_mm")


# ------------------------------------------------------------------ CSV
def rows(result: LocomotiveBalance, system: System) -> Rows:
    """Return the rows of CSV, one for each figure of a wheel, an axle, a rail or the locomotive.
    The cell `plane` is empty for an axle, `axle` for a rail, and both for the locomotive.
    """
    document = to_document(result)
    planes = [system.length.of(wheel.plane_mm / 1e3) for wheel in result.axles[0].wheels]
    places: list[tuple[str, float | None, Node]] = [("", None, document)]
    places += zip(("", ""), planes, document["rails"], strict=True)
    for axle in document["axles"]:
        name = name_cell(axle["name"])
        places.append((name, None, axle))
        places += zip((name, name), planes, axle["wheels"], strict=True)
    lines = [
        (name, z, *_convert(figure, value, system))
        for name, z, part in places
        for figure, value, _ in list_figures(part, _LEFT_OUT)
    ]
    return Rows(("axle", "plane", "figure", "value", "unit"), lines)


def _convert(name: str, value: object, system: System) -> tuple[str, object, str]:
    """Return name, value and unit of a figure in the units of the system."""
    written = find_unit(name)
    unit = system.unbalance if written == "kg·m" else system.instead_of(written)
    if isinstance(value, float):
        value = unit.of(value * SI.instead_of(written).size)
    return (name if unit.name in ("deg", "rpm") else remove_unit(name)), value, unit.name


# ------------------------------------------------------------------ for people
def sheet(result: LocomotiveBalance, system: System) -> Sheet:
    """Return the verdict, a table of the wheels, and the forces and moments of all wheels."""
    force = system.force
    tractive = result.tractive_variation_N, result.tractive_variation_peak_N
    swaying = result.swaying_couple_Nm, result.swaying_couple_peak_Nm
    middle = size_text(result.swaying_couple_z_mm / 1e3, system.length)
    blows = [size_text(rail.hammer_blow_N, force) for rail in result.rails]
    pairs = (
        ("balance factor", UNKNOWN if result.factor is None else given(result.factor, 4)),
        ("hammer blow per rail", " and ".join(blows)),
        ("hammer blow of engine", size_text(result.hammer_blow_N, force)),
        ("tractive effort", _tell_variation(*tractive, force)),
        ("swaying couple", f"{_tell_variation(*swaying, system.moment)}; about z = {middle}"),
    )
    blow = size_text(max(wheel.hammer_blow_N for wheel in result.wheels), force)
    speed = _tell_speed(result.speed_rpm, result.speed_km_h, system)
    lifts = [(w.lift_rpm, w.lift_km_h) for w in result.wheels if w.lift_rpm is not None]
    verdict = (
        f"Hammer blow up to {blow} per wheel at {speed}.",
        *(f"The first wheel lifts at {_tell_speed(*at, system)}." for at in sorted(lifts)[:1]),
    )
    title = f"{result.engine.name or NAMELESS}: balance of the wheels"
    wheels = _make_wheel_table(result, system)
    return Sheet(title, (Text("", verdict), wheels, Facts(pairs, "In all")))


def _tell_variation(first: float, peak: float, unit: ShownUnit) -> str:
    amplitude = f"±{size_text(first, unit)}" if first else NOTHING
    return f"order 1 {amplitude}, sum of orders at most {size_text(peak, unit)}"


def _tell_speed(rpm: float, km_h: float | None, system: System) -> str:
    unit = system.velocity
    on_track = "" if km_h is None else f"{number(unit.of(km_h / 3.6))} {unit.name}, "
    return f"{on_track}{number(rpm)} rpm"


def _make_wheel_table(result: LocomotiveBalance, system: System) -> Grid:
    wheels = result.wheels
    blow, least, most = (
        _list_values(wheels, f"{key}_N")
        for key in ("hammer_blow", "least_rail_load", "most_rail_load")
    )
    force = system.force.fit(max(value or 0.0 for value in (*blow, *most)))
    loads = zip(_write(least, force), _write(most, force), strict=True)
    angles = [degrees(angle_deg(w.unbalance)) if w.unbalance else "" for w in wheels]
    columns = [
        Column("axle", [axle.name for axle in result.axles for _ in axle.wheels], words=True),
        _Series("wheel z", _list_values(wheels, "plane_mm"), system.length).write(),
        _Series("mass", _list_values(wheels, "mass_kg"), system.mass).write(),
        _Series("unbalance", [abs(wheel.unbalance) for wheel in wheels], system.unbalance).write(),
        Column("angle, deg", angles),
        _Series("hammer blow", blow, force).write(),
        Column(f"rail load, {force.name}", ["…".join(pair) for pair in loads]),
        _Series("lifts at", _list_values(wheels, "lift_km_h"), system.velocity).write(),
    ]
    note = "Angles count from cylinder 1's crank pin, in the direction of rotation."
    if result.factor is None:
        note = "No factor is given: the figures are those of the counterweights in the file."
    return Grid("Wheels", columns, note)


def _list_values(parts: Iterable[object], key: str) -> Values:
    """Return a figure of every part, in SI units."""
    size = SI.instead_of(find_unit(key)).size
    values = (getattr(part, key) for part in parts)
    return [None if value is None else value * size for value in values]


def _write(values: Values, unit: ShownUnit) -> list[str]:
    return [UNKNOWN if value is None else number(unit.of(value)) for value in values]


# ------------------------------------------------------------------ several factors
def sheet_of_factors(results: Results, system: System) -> Sheet:
    """Return a table with a row for each factor."""
    factors, *others = _list_series(results, system)
    columns = [factors.write(words=True), *(series.write() for series in others)]
    speed = _tell_speed(results[0].speed_rpm, results[0].speed_km_h, system)
    title = f"{results[0].engine.name or NAMELESS}: balance factors"
    note = "Blows: worst wheel and worst rail. Lifts at: speed at which the first wheel lifts."
    return Sheet(title, (Facts((("speed", speed),)), Grid("", columns, note)))


def rows_of_factors(results: Results, system: System) -> Rows:
    """Return a row of CSV for each factor."""
    heads = []
    cells = []
    for name, values, unit in _list_series(results, system):
        heads.append(name_with_unit(name, unit.name))
        cells.append([value and unit.of(value) for value in values])
    return Rows(heads, zip(*cells, strict=True))


def _list_series(results: Results, system: System) -> Iterator[_Series]:
    """Yield the figures of every column."""
    yield _Series("factor", _list_values(results, "factor"), ShownUnit("", 1))
    for name, choose, of_which, key, unit in (
        ("largest mass", max, "wheels", "mass_kg", system.mass),
        ("wheel blow", max, "wheels", "hammer_blow_N", system.force),
        ("rail blow", max, "rails", "hammer_blow_N", system.force),
        ("tractive effort", max, "", "tractive_variation_N", system.force),
        ("swaying couple", max, "", "swaying_couple_Nm", system.moment),
        ("lifts at", min, "wheels", "lift_km_h", system.velocity),
    ):
        each = [getattr(result, of_which) if of_which else [result] for result in results]
        known = ([v for v in _list_values(parts, key) if v is not None] for parts in each)
        yield _Series(name, [choose(values) if values else None for values in known], unit)


RENDERER = Renderer(sheet=sheet, rows=rows)
OF_FACTORS = Renderer(sheet=sheet_of_factors, rows=rows_of_factors)
