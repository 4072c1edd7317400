"""Compare lengths, unbalances, inertias and pressures of a file with other figures of the file.

A figure in another unit than that of bare numbers is wrong by 10, 25.4, 1000 or a million; the
ranges are narrower than these factors, and wide enough for engines from models to ships. A figure
that is 0, or whose reference the file lacks, is not doubted. Of a list, and of the devices of a
kind, only the value farthest out is named.
"""

import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from .doubt import Figure, walk_figures
from .fields import WrittenFigure
from .model import (
    PISTON_PARTS,
    Counterweight,
    Crank,
    EngineFile,
    Gear,
    Layout,
    Override,
    Sector,
    Shaft,
    Slider,
)
from .plain_tables import list_tables
from .table import FileTable
from .units import ANGLE, LENGTH, MASS, PRESSURE, UNBALANCE, Dimension, convert


class Sizes(NamedTuple):
    """Figures of an engine with which others are compared.

    Attributes:
        stroke: Largest stroke, mm.
        bore: Bore, mm; the stroke if the file gives none.
        bore_known: Whether the file gives the bore.
        rod: Length of the rod, mm; 0: not known.
        mass: Mass of a piston with its crosshead and of a rod, kg; 0: not known.
    """

    stroke: float
    bore: float
    bore_known: bool
    rod: float
    mass: float

    @property
    def radius(self) -> float:
        """Crank radius, mm."""
        return self.stroke / 2

    @property
    def wide(self) -> float:
        """The larger of stroke and bore, mm."""
        return max(self.stroke, self.bore)


def weigh_piston(model: EngineFile) -> float:
    """Return the mass of a whole piston with its crosshead, kg."""
    parts = sum(getattr(model.piston, key) or 0.0 for key in ("mass", *PISTON_PARTS))
    return parts + model.crosshead.mass


def weigh_rod(model: EngineFile) -> float:
    """Return the mass of a rod, kg; 0 if the file gives none."""
    rod = model.rod
    return rod.mass or (rod.small_end or 0.0) + (rod.big_end or 0.0)


def measure(model: EngineFile) -> Sizes:
    """Return the figures of a file with which others are compared."""
    stroke = max(model.crank.strokes)
    rod = model.rod
    piston = model.piston
    length = rod.length or 0.0
    if rod.ratio:
        length = stroke / 2 / rod.ratio
    return Sizes(
        stroke=stroke,
        bore=piston.bore or stroke,
        bore_known=piston.bore is not None,
        rod=length,
        mass=weigh_piston(model) + weigh_rod(model),
    )


class Range(NamedTuple):
    """A usual range of the figures of one kind.

    Attributes:
        figures: Figures with their dotted names.
        least: Lower end.
        most: Upper end.
        dimension: Dimension of the figures, with the unit of bare numbers.
        others: Other units that may be meant.
        basis: Figure on which the range depends, in words.
        subject: Name of the figure with a verb, if it is not the value of the key itself.
        hint: Remedy; empty: that the figure has another unit.
        also: Further keys on which the range depends.
    """

    figures: Sequence[tuple[str, float]]
    least: float
    most: float
    dimension: Dimension
    others: tuple[str, ...]
    basis: str
    subject: str = ""
    hint: str = ""
    also: tuple[str, ...] = ()


# Units that may be meant, the likeliest first
LENGTHS = ("in", "cm", "m")
_PRESSURES = ("MPa", "psi", "kPa")
INERTIAS = ("kg m^2", "kg cm^2", "g m^2")
_UNBALANCES = ("kg mm", "g cm", "oz in", "kg m")
# Absolute pressures: 0.26 bar at an altitude of 10 km, 10 bar after two stages of charging; figures
# in psi or MPa lie outside.
ABSOLUTE_PRESSURE = 0.15, 12.0  # bar
# Keys on which ranges depend
_STROKE = ("crank.stroke",)
_BORE = ("piston.bore", *_STROKE)
_ROD = ("rod.length", "rod.ratio")
MASSES_OF_PISTON = (*(f"piston.{key}" for key in ("mass", *PISTON_PARTS)), "crosshead.mass")
MASSES = (*_STROKE, *MASSES_OF_PISTON, "rod.mass", "rod.small_end", "rod.big_end")
# Mass of the flywheel / mass of a rod and piston: cars have 3 to 20, engines with one cylinder and
# two large wheels up to 200. The radius of gyration is in strokes.
_FLYWHEEL_MASS = 0.05, 2000.0
_FLYWHEEL_RADIUS = 0.05, 20.0
_JOURNAL = 0.1, 3.0  # diameter of a crank pin or main journal, strokes
_GRAMS = 1e3  # in a kg: unbalances are in g mm


def list_ranges(model: EngineFile) -> Iterator[Range]:
    """Yield the usual ranges of the figures of a file."""
    size = measure(model)
    stroke = f"a stroke of {size.stroke:g} mm"
    bore = f"a bore of {size.bore:g} mm" if size.bore_known else stroke
    yield from _list_places_of_throws(model, size, bore)
    yield Range(
        figures=[("layout.stagger", model.layout.stagger)],
        least=0.02 * size.bore,
        most=size.wide,
        dimension=LENGTH,
        others=LENGTHS,
        basis=bore,
        also=_BORE,
    )
    if size.rod:
        cg = model.rod.cg or 0.0
        share = f"as a share of the length it is {cg * size.rod:.4g} mm" if cg < 1 else ""
        yield Range(
            figures=[("rod.cg", cg)],
            least=0.1 * size.rod,
            most=math.inf,
            dimension=LENGTH,
            others=LENGTHS,
            basis=f"a rod of {size.rod:g} mm",
            hint=share,
            also=_ROD,
        )
    yield Range(
        figures=[("piston.offset", model.piston.offset)],
        least=0.001 * size.stroke,
        most=math.inf,
        dimension=LENGTH,
        others=LENGTHS,
        basis=stroke,
        also=_STROKE,
    )
    if model.articulation is not None:
        yield Range(
            figures=[("articulation.knuckle_radius", model.articulation.knuckle_radius)],
            least=0.2 * size.radius,
            most=1.5 * size.radius,
            dimension=LENGTH,
            others=LENGTHS,
            basis=f"a crank radius of {size.radius:g} mm",
            also=_STROKE,
        )
    yield from _list_devices(model, size, stroke)
    yield from _list_points(model, size, stroke)
    yield from _list_pressures(model)
    yield from _list_flywheels(model, size)
    yield from _list_bearings(model, size)
    yield from _list_room(model, size, bore)


def _list_places_of_throws(model: EngineFile, size: Sizes, bore: str) -> Iterator[Range]:
    crank = model.crank
    least = size.bore
    if not size.bore_known or model.layout.rods == "alternating":
        least *= 0.3
    gaps = [("crank.spacing", crank.spacing or 0.0)]
    if crank.positions is not None:
        places = sorted(crank.positions)
        steps = [after - before for before, after in pairwise(places)]
        gaps = [("crank.positions", step) for step in steps]
    yield Range(
        figures=gaps,
        least=least,
        most=10 * size.wide,
        dimension=LENGTH,
        others=LENGTHS,
        basis=bore,
        subject="" if crank.positions is None else "the distance of two neighbours is",
        also=_BORE,
    )


def _list_devices(model: EngineFile, size: Sizes, stroke: str) -> Iterator[Range]:
    unbalance = size.mass * _GRAMS * size.radius
    for kind in (Counterweight, Shaft, Slider):
        places = []
        radii = []
        given = []
        for path, table in model.tables():
            if not isinstance(table, kind):
                continue
            places.append((f"{path}.position", table.position))
            radii.append((f"{path}.radius", table.radius or 0.0))
            if table.unbalance is not None and not table.to_fit:
                given.append((f"{path}.unbalance", abs(table.unbalance)))
        yield Range(places, 0.005 * size.stroke, math.inf, LENGTH, LENGTHS, stroke, also=_STROKE)
        yield Range(
            radii, 0.1 * size.stroke, 5 * size.stroke, LENGTH, LENGTHS, stroke, also=_STROKE
        )
        if unbalance:
            basis = f"rods and pistons of {size.mass:.4g} kg"
            yield Range(
                given, 0.001 * unbalance, math.inf, UNBALANCE, _UNBALANCES, basis, also=MASSES
            )


def _list_flywheels(model: EngineFile, size: Sizes) -> Iterator[Range]:
    """Yield ranges of mass and radius of gyration of the flywheel."""
    wheel = model.flywheel
    if wheel is None:
        return
    if size.mass:
        yield Range(
            figures=[("flywheel.mass", wheel.mass or 0.0)],
            least=_FLYWHEEL_MASS[0] * size.mass,
            most=_FLYWHEEL_MASS[1] * size.mass,
            dimension=MASS,
            others=("g", "lb", "t"),
            basis=f"rods and pistons of {size.mass:.4g} kg",
            also=MASSES,
        )
    radius = wheel.radius_of_gyration
    yield compare_with_stroke("flywheel.radius_of_gyration", radius, _FLYWHEEL_RADIUS, size)


def _list_bearings(model: EngineFile, size: Sizes) -> Iterator[Range]:
    """Yield ranges of the diameters of crank pins and main journals."""
    if model.bearing is not None:
        for key in ("pin_diameter", "main_diameter"):
            diameter = getattr(model.bearing, key)
            yield compare_with_stroke(f"bearing.{key}", diameter, _JOURNAL, size)


def compare_with_stroke(
    path: str, length: float | None, shares: tuple[float, float], size: Sizes
) -> Range:
    """Return the range of a length.

    Args:
        path: Dotted name of the length.
        length: The length, mm; None: the file does not give it.
        shares: Lower and upper end of its range, strokes.
        size: Sizes of the engine.
    """
    least, most = shares
    return Range(
        figures=[(path, length or 0.0)],
        least=least * size.stroke,
        most=most * size.stroke,
        dimension=LENGTH,
        others=LENGTHS,
        basis=f"a stroke of {size.stroke:g} mm",
        also=_STROKE,
    )


def _list_room(model: EngineFile, size: Sizes, bore: str) -> Iterator[Range]:
    """Yield ranges of what bounds the room around the crank, and of the places of main bearings."""
    yield Range(
        figures=[("frame.crankcase", model.frame.crankcase or 0.0)],
        least=0.55 * size.stroke,
        most=6 * size.stroke,
        dimension=LENGTH,
        others=LENGTHS,
        basis=f"a stroke of {size.stroke:g} mm",
        also=_STROKE,
    )
    yield Range(
        figures=[("piston.skirt", model.piston.skirt or 0.0)],
        least=0.05 * size.bore,
        most=2 * size.wide,
        dimension=LENGTH,
        others=LENGTHS,
        basis=bore,
        also=_BORE,
    )
    mains = () if model.bearing is None else model.bearing.main_positions or ()
    steps = [after - before for before, after in pairwise(sorted(mains))]
    yield Range(
        figures=[("bearing.main_positions", step) for step in steps],
        least=0.2 * size.bore,
        most=40 * size.wide,
        dimension=LENGTH,
        others=LENGTHS,
        basis=bore,
        subject="the distance of two neighbours is",
        also=_BORE,
    )


def _list_points(model: EngineFile, size: Sizes, stroke: str) -> Iterator[Range]:
    """Yield ranges of places: of each, the largest coordinate."""
    for kind in ("mount", "point", "shaft", "slider"):
        places = []
        for number, table in enumerate(getattr(model, kind, ()), 1):
            place = max(map(abs, table.at))
            places.append((f"{kind}.{number}.at", place))
        yield Range(places, 0.05 * size.stroke, math.inf, LENGTH, LENGTHS, stroke, also=_STROKE)


def _list_pressures(model: EngineFile) -> Iterator[Range]:
    gas = model.gas
    if gas is None:
        return
    intake = getattr(gas, "intake", None) or 1.0
    least, most = ABSOLUTE_PRESSURE
    if not least <= intake <= most:
        return  # the intake is doubted itself
    for path, key, value in walk_figures("gas", list_tables(gas)):
        if key in ("imep", "bmep"):
            basis = f"an intake of {intake:g} bar"
            yield Range(
                [(path, value)],
                1.3 * intake,
                math.inf,
                PRESSURE,
                _PRESSURES,
                basis,
                also=("gas.intake",),
            )


def find_unusual(ranges: Iterable[Range]) -> Iterator[Figure]:
    """Yield the figure of each range that is farthest outside it."""
    for usual in ranges:
        outside = [pair for pair in usual.figures if _is_outside(pair[1], usual)]
        if outside:
            path, value = max(outside, key=lambda pair: _find_distance(pair[1], usual))
            yield Figure(
                path=path,
                value=value,
                least=usual.least if value > 0 else -usual.most,
                most=usual.most if value > 0 else -usual.least,
                unit=f" {usual.dimension.unit}".rstrip(),
                hint=usual.hint or _guess_unit(value, usual),
                subject=usual.subject,
                also=usual.also,
                basis=usual.basis,
            )


def _is_outside(value: float, usual: Range) -> bool:
    return value != 0 and not usual.least <= abs(value) <= usual.most


def _find_distance(value: float, usual: Range) -> float:
    """Return how many times a value lies outside its range."""
    return max(usual.least / abs(value), abs(value) / usual.most)


_UNITS_NAMED = 2  # largest number of units that a remedy names


def _guess_unit(value: float, usual: Range) -> str:
    """Return the remedy: the first units with which the figure lies in its range."""
    fitting = []
    for unit in usual.others:
        meant = abs(value) * convert(f"1 {unit}", usual.dimension)
        if usual.least <= meant <= usual.most:
            fitting.append(f'"{value:g} {unit}"')
    if fitting:
        return f"with another unit, write it: {' or '.join(fitting[:_UNITS_NAMED])}"
    return f"bare numbers are in {usual.dimension.unit}"


# ------------------------------------------------------------------ angles in radians
_TABLES_OF_ANGLES: dict[str, tuple[type[FileTable], ...]] = {
    "crank": (Crank,),
    "layout": (Layout,),
    "cylinder": (Override,),
    "counterweight": (Counterweight, Sector),
    "shaft": (Shaft, Sector, Gear),
    "slider": (Slider,),
}
_PARTS_OF_PI = (math.pi / 4, math.pi / 5, math.pi / 6, 2 * math.pi / 7)
_NEAR = 0.002
_SMALLEST_RADIANS = 0.5
_LARGEST_RADIANS = 6.3


def find_radians(model: EngineFile) -> Iterator[tuple[str, float]]:
    """Yield path and value of bare angles that are round fractions of a turn in radians, one for
    each key.
    """
    tables = list_tables(model)
    of_angles = dict(_TABLES_OF_ANGLES)
    if model.web:
        from .web_tables import Web

        of_angles["web"] = (Web,)
    for name, classes in of_angles.items():
        angles = _list_angles(classes)
        seen = set()
        for path, _, value in walk_figures(name, tables.get(name)):
            key = _name_key(path, angles)
            if key in seen or key.rpartition(".")[2] not in angles:
                continue
            if isinstance(value, float | int) and _is_radian(value):
                seen.add(key)
                yield key, value


def _list_angles(classes: Iterable[type[FileTable]]) -> frozenset[str]:
    """Return the keys of these tables whose bare numbers are degrees."""
    angles = set[str]()
    for table in classes:
        keys = table.keys()
        angles.update(key for key in keys if table.find_unit(key) == ANGLE.unit)
    return frozenset(angles)


def _name_key(path: str, angles: Collection[str]) -> str:
    """Return the key of an angle: without the number of a member of a list."""
    parent, _, last = path.rpartition(".")
    return parent if last.isdigit() and parent.rpartition(".")[2] in angles else path


def _is_radian(value: float) -> bool:
    if isinstance(value, WrittenFigure) or not _SMALLEST_RADIANS <= abs(value) <= _LARGEST_RADIANS:
        return False
    for part in _PARTS_OF_PI:
        nearest = part * round(abs(value) / part)
        if abs(abs(value) - nearest) < _NEAR:
            return True
    return False
