"""Show the balance of a locomotive as tables, JSON and CSV; and several factors in one table."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
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
    unit_cell,
)
from ..show.units import SI, ShownUnit, System, name_with_unit
from .answer import LocomotiveBalance

Results = Sequence[LocomotiveBalance]
Values = list[float | None]  # in SI units; None: unknown


class _Place(NamedTuple):
    """A wheel, axle or rail, or the whole locomotive, with its cells in CSV.

    Attributes:
        axle: Name of the axle; empty for rails and the locomotive.
        plane: Place of the wheel or rail along the axle; None for axles and the locomotive.
        figures: The part of the document that belongs to it.
    """

    axle: str
    plane: float | None
    figures: Node


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
        unit = self.unit.fit_values(self.values)
        return Column(name_with_unit(self.name, unit.name), _write(self.values, unit), words)


_LEFT_OUT = ("format", "axles", "rails", "name", "wheels", "plane_mm")


# ------------------------------------------------------------------ CSV
def rows(result: LocomotiveBalance, system: System) -> Rows:
    """Return the rows of CSV, one for each figure of a wheel, an axle, a rail or the locomotive.
    The cell `plane` is empty for an axle, `axle` for a rail, and both for the locomotive.
    """
    planes = [system.length.of(wheel.plane_mm / 1e3) for wheel in result.axles[0].wheels]
    lines = []
    for place in _list_places(to_document(result), planes):
        for figure, value, _ in list_figures(place.figures, _LEFT_OUT):
            lines.append((place.axle, place.plane, *_convert(figure, value, system)))
    return Rows(("axle", "plane", "figure", "value", "unit"), lines)


def _list_places(document: Node, planes: Sequence[float]) -> Iterator[_Place]:
    """Yield the locomotive, its rails, and each axle with its wheels."""
    yield _Place("", None, document)
    for plane, rail in zip(planes, document["rails"], strict=True):
        yield _Place("", plane, rail)
    for axle in document["axles"]:
        name = name_cell(axle["name"])
        yield _Place(name, None, axle)
        for plane, wheel in zip(planes, axle["wheels"], strict=True):
            yield _Place(name, plane, wheel)


def _convert(name: str, value: object, system: System) -> tuple[str, object, str]:
    """Return name, value and unit of a figure in the units of the system."""
    written = find_unit(name)
    unit = system.unbalance if written == "kg·m" else system.instead_of(written)
    if isinstance(value, float):
        value = unit.of(value * SI.instead_of(written).size)
    if unit.name not in ("deg", "rpm"):
        name = remove_unit(name)
    return name, value, unit.name


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
    title = f"{result.engine.name or NAMELESS}: balance of the wheels"
    verdict = Text("", tuple(_judge(result, system)))
    wheels = _make_wheel_table(result, system)
    return Sheet(title, (verdict, wheels, Facts(pairs, "In all")))


def _judge(result: LocomotiveBalance, system: System) -> Iterator[str]:
    """Yield sentences on the largest hammer blow, and on the first wheel that lifts."""
    blow = size_text(max(wheel.hammer_blow_N for wheel in result.wheels), system.force)
    speed = _tell_speed(result.speed_rpm, result.speed_km_h, system)
    yield f"Hammer blow up to {blow} per wheel at {speed}."
    lifts = [(w.lift_rpm, w.lift_km_h) for w in result.wheels if w.lift_rpm is not None]
    if lifts:
        yield f"The first wheel lifts at {_tell_speed(*min(lifts), system)}."


def _tell_variation(first: float, peak: float, unit: ShownUnit) -> str:
    amplitude = f"±{size_text(first, unit)}" if first else NOTHING
    return f"order 1 {amplitude}, sum of orders at most {size_text(peak, unit)}"


def _tell_speed(rpm: float, km_h: float | None, system: System) -> str:
    turning = f"{number(rpm)} rpm"
    if km_h is None:
        return turning
    unit = system.velocity
    return f"{number(unit.of(km_h / 3.6))} {unit.name}, {turning}"


def _make_wheel_table(result: LocomotiveBalance, system: System) -> Grid:
    wheels = result.wheels
    blow = _list_values(wheels, "hammer_blow_N")
    least = _list_values(wheels, "least_rail_load_N")
    most = _list_values(wheels, "most_rail_load_N")
    force = system.force.fit_values((*blow, *most))
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
    values: Values = []
    for part in parts:
        value = getattr(part, key)
        values.append(None if value is None else value * size)
    return values


def _write(values: Values, unit: ShownUnit) -> list[str]:
    return [unit_cell(value, unit) for value in values]


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
    wheels = [result.wheels for result in results]
    rails = [result.rails for result in results]
    whole = [[result] for result in results]
    for name, choose, parts, key, unit in (
        ("largest mass", max, wheels, "mass_kg", system.mass),
        ("wheel blow", max, wheels, "hammer_blow_N", system.force),
        ("rail blow", max, rails, "hammer_blow_N", system.force),
        ("tractive effort", max, whole, "tractive_variation_N", system.force),
        ("swaying couple", max, whole, "swaying_couple_Nm", system.moment),
        ("lifts at", min, wheels, "lift_km_h", system.velocity),
    ):
        yield _Series(name, [_choose_known(choose, each, key) for each in parts], unit)


def _choose_known(
    choose: Callable[[Sequence[float]], float], parts: Iterable[object], key: str
) -> float | None:
    """Return the value of the parts that `choose` selects; None if all are unknown."""
    known = [value for value in _list_values(parts, key) if value is not None]
    return choose(known) if known else None


RENDERER = Renderer(sheet=sheet, rows=rows)
OF_FACTORS = Renderer(sheet=sheet_of_factors, rows=rows_of_factors)
