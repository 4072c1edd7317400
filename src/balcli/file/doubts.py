"""Warn of valid figures that no ordinary engine has; most often, such a figure has a wrong unit.

The limits are wide enough for engines from models to ships. A warning states the value, the usual
range and a remedy.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np

from .fields import WrittenFigure, count_lambda_digits, printable
from .model import PISTON_PARTS, EngineFile
from .plain_tables import list_tables
from .units import ask_unit

# The mass of similar pistons grows with the cube of the bore. With pin and rings, aluminium pistons
# have 300 (racing) to 1000 (lorry) kg per m^3 of bore^3, pistons of cast iron up to 3000. The
# limits are wider; a confusion of g and kg is a factor of 1000.
PISTON = 100.0, 5000.0  # mass of a piston over bore^3, kg/m^3
CROSSHEAD_HEAVY = 40_000.0  # largest mass of piston and crosshead over bore^3, kg/m^3
LONG_STROKE = 2.5  # stroke / bore above which an engine must have crossheads
LAMBDA = 0.15, 0.4  # crank radius / rod length: engines have 0.2 to 0.35
CROSSHEAD_LAMBDA = 0.6  # largest crank radius / rod length of crosshead engines
BORE = 0.2, 3.0  # bore / stroke: crosshead engines have 0.25 or more, racing engines up to 2.5
ROD = 0.1, 8.0  # rod mass / piston mass: engines have 0.7 to 2.5
SMALL_END = 0.55  # largest share of the rod's mass at the small end: rods have 0.2 to 0.4
# Moment of inertia / (mass x length^2): a bar of even thickness has 1/12, two equal masses at its
# ends 1/4. A rod has more only if bosses and bolts extend beyond its centres.
INERTIA = 0.02, 0.4
TWO_MASSES = 1.6  # largest rod inertia / inertia of two masses at its ends: rods have 0.6 to 1.35
PISTON_SPEED = 40.0  # largest mean piston speed, m/s; racing engines have up to 30
SPEED = 9.0  # lowest speed, rpm; the largest ship engines idle at 15, and 1 rad/s is 9.55
# Engines with a stroke above 1 m, and slow engines with a stroke above two bores, are usually
# two-strokes.
CROSSHEAD_STROKE = 1000.0  # mm
SLOW_SPEED = 250.0
SLOW_BORES = 2.0  # rpm, bores
OFFSET = 0.2  # largest offset / stroke: up to 0.05 is usual, in narrow-angle vees up to 0.15
MAX_PRESSURE = 500.0  # largest cylinder pressure, bar; engines have 50 to 250
# Absolute pressures: 0.26 bar at an altitude of 10 km, 10 bar after two stages of charging; figures
# in psi or MPa lie outside. Mean pressures: 8 to 30 bar is usual, racing engines had 50; 7 bar
# are 100 psi, and 100 lies outside.
PRESSURES = {
    **dict.fromkeys(("intake", "exhaust", "crankcase"), (0.15, 12.0, " bar absolute")),
    **dict.fromkeys(("imep", "bmep"), (0.0, 60.0, " bar")),
    "max_pressure": (0.0, MAX_PRESSURE, " bar"),
}
# Largest unbalanced mass of a throw / mass of its rods and pistons: engines have up to 1.4; a whole
# crankshaft, with counterweights, weighs 4 to 10 times as much as the rods and pistons.
THROW = 6.0
BEARING = 0.5  # largest mass of shells or oil / mass of rod and piston: engines have up to 0.05
# Doubtful range of the largest difference between two throw angles, deg. In a real crankshaft this
# difference is 0, or 60 and more. A difference of 1 to 10 comes from a firing order such as
# [1, 3, 4, 2], or from angles in radians.
THROWS = 1.0, 10.0
BANK = 4.0  # smallest bank angle, deg: narrow vees have 10 or more; 180 deg in radians are 3.14
UNBALANCE = 5.0  # largest unbalance / (all moving masses x crank radius); balancing needs 1 or 2
# Least inertia of a crankshaft or flywheel / inertia of rods and pistons at the crank radius:
# engines have more than 1. A slip from kg m^2 to kg mm^2 is a factor of a million.
TURNING = 0.01
# Largest loss factor: steel has 0.01 to 0.05, rubber up to 0.5. Figures in percent are above 1.
LOSS = 1.0
WHEEL_LOAD = 1000  # smallest load of a wheel on its rail, N; only models have less
SAME_UNIT = "are both in the same unit?"
DEGREES = (
    'bare numbers are degrees; give another unit as in "1/2 turn" or "3.1416 rad"; a sequence '
    "of cylinders belongs in layout.firing_order"
)
RADIANS = 'bare numbers are degrees; give radians as in "1.3 rad"'
OFF_AXIS = "is it in kg? It is the unbalanced mass of one throw, not the mass of the crankshaft"
GRAMS = 'is it in kg? Give grams as in "47 g"'


class Figure(NamedTuple):
    """A figure of a file and its usual range.

    Attributes:
        name: Name of the figure with a verb, such as "rod.cg is".
        value: Value in the file.
        least: Lower end of the usual range.
        most: Upper end of the usual range.
        unit: Unit of value and range, with a space before it; empty for a plain number.
        hint: Text about the probable mistake.
        digits: Number of digits of the value that are shown.
    """

    name: str
    value: float
    least: float
    most: float
    unit: str
    hint: str
    digits: int = 4


def find_suspicious(model: EngineFile) -> list[str]:
    """Return warnings for figures that are allowed but unlikely; empty for an ordinary engine.

    Args:
        model: Engine file.
    """
    figures = [*_list_pistons(model), *_list_rods(model), *_list_cranks(model)]
    if model.locomotive is not None and model.locomotive.wheel_load is not None:
        load = model.locomotive.wheel_load
        hint = ask_unit("N", "40 kN", "9.5 t")
        figures.append(Figure("locomotive.wheel_load is", load, WHEEL_LOAD, math.inf, " N", hint))
    question = ask_unit("bar", "130 psi", "0.9 MPa")
    for path, key, value in walk_figures("gas", list_tables(model.gas)):
        if key in PRESSURES:
            figures.append(Figure(f"{path} is", value, *PRESSURES[key], question))
    return [*_find_missing(model), *_doubt(figures), *doubt_losses("torsion", model.torsion)]


def doubt_losses(path: str, tables: object) -> Iterator[str]:
    """Yield warnings for impossibly large loss factors, which are probably given in percent.

    Args:
        path: Path of the tables; empty: the tables are a whole file.
        tables: Table or tables in which each key `loss` is checked.
    """
    hint = "{0:g} % is {1:g}, and a relative damping psi is a loss factor of psi/(2 pi)"
    yield from _doubt(
        Figure(f"{place} is", loss, 0, LOSS, "", hint.format(loss, loss / 100))
        for place, key, loss in walk_figures(path, list_tables(tables))
        if key == "loss"
    )


def walk_figures(path: str, tables: Any) -> Iterator[tuple[str, Any, Any]]:
    """Yield path, key and value of each figure or text in tables, and in the tables and lists
    within them. Members of lists count from 1 in paths, and have their number as key.

    Args:
        path: Path of the tables; empty: they are a whole file.
        tables: Result of `plain_tables.list_tables`; None: there are no tables.
    """
    parts = tables.items() if isinstance(tables, dict) else enumerate(tables or (), 1)
    for key, value in parts:
        place = f"{path}.{key}".removeprefix(".")
        if isinstance(value, (dict, list)):
            yield from walk_figures(place, value)
        else:
            yield place, key, value


def _doubt(figures: Iterable[Figure]) -> Iterator[str]:
    """Yield a warning for each figure outside its usual range."""
    for name, value, least, most, unit, hint, digits in figures:
        if least <= value <= most:
            continue
        usual = f"{_round(least)} to {_round(most)}"
        if most == math.inf:
            usual = f"at least {_round(least)}"
        elif least == 0 <= value:
            usual = f"at most {_round(most)}"
        written = f' ("{printable(value.text)}")' if isinstance(value, WrittenFigure) else ""
        yield f"{name} {value:.{digits}g}{unit}{written}, where {usual} is usual; {hint}"


def _round(value: float) -> str:
    """Return two significant digits, without an exponent if the number is not too long."""
    return f"{float(f'{value:.2g}'):.12g}"


def _find_missing(model: EngineFile) -> Iterator[str]:
    """Yield warnings for keys that were probably forgotten, and for keys that contradict others."""
    if _weigh_piston(model) == 0:
        yield "piston.mass is 0; give the mass of piston, pin, rings and locks"
    if model.rod.mass and model.rod.cg is None:
        yield "rod.cg is not given, and 0 is taken; measure it from the big-end centre"
    crank = model.crank
    throws, rods = _count_throws_and_rods(model)
    # A single figure is repeated for all throws; lists of a wrong length are rejected elsewhere.
    masses, strokes = (np.resize(each, throws) for each in (crank.throw_masses, crank.strokes))
    of_throws = float(masses @ (strokes / 2) ** 2)
    if crank.inertia is not None and crank.inertia < of_throws and not model.layout.rotary:
        yield (
            f"crank.inertia is {crank.inertia:.4g} kg mm^2, less than the {of_throws:.4g} kg mm^2 "
            "of its throws alone (crank.throw_mass at the crank radius)"
        )
    placed = [number for number, own in model.cylinder.items() if own.position is not None]
    left = rods - len(placed)
    if crank.spacing is None and crank.positions is None and placed and left > rods / throws:
        yield (
            f"cylinder.{placed[0]}.position is given, but {left} cylinders have no position and "
            "are all at 0: give the position of each, or crank.spacing"
        )
    stroke = max(crank.strokes)
    speed = model.operation.speed
    bore = model.piston.bore
    slow = speed < SLOW_SPEED and bore is not None and stroke > SLOW_BORES * bore
    if "strokes" not in model.layout.model_fields_set and (stroke > CROSSHEAD_STROKE or slow):
        yield (
            f"layout.strokes is not given, and 4 is taken; engines with a stroke of {stroke:g} mm "
            f"at {speed:g} rpm are mostly two-strokes: give layout.strokes = 2, or 4 if it is right"
        )
    torsion = model.torsion
    if model.flywheel is not None and torsion is not None and not (torsion.front or torsion.rear):
        yield "`torsion` does not use [flywheel]; also write it as [[torsion.rear]]"


def _list_pistons(model: EngineFile) -> Iterator[Figure]:
    strokes = model.crank.strokes
    bore = model.piston.bore
    speed = model.operation.speed
    stroke = max(strokes)
    narrow, wide = (BORE[0] * min(strokes), BORE[1] * stroke) if bore is None else (bore, bore)
    heavy = CROSSHEAD_HEAVY if _has_crosshead(model) else PISTON[1]
    least = PISTON[0] * (narrow * 1e-3) ** 3
    most = heavy * (wide * 1e-3) ** 3
    unit = f" kg at a stroke of {stroke:g} mm" if bore is None else f" kg in a bore of {bore:g} mm"
    units = "are the units right? Bare numbers are kg and mm"
    name = "the parts of [piston] weigh" if model.piston.mass is None else "piston.mass is"
    if model.crosshead.mass:
        name = "piston and crosshead weigh"
    if mass := _weigh_piston(model):
        yield Figure(name, mass, least, most, unit, units)
    if bore is not None:
        for each in dict.fromkeys(strokes):
            yield Figure("piston.bore / crank.stroke is", bore / each, *BORE, "", SAME_UNIT)
    most = OFFSET * stroke
    yield Figure("piston.offset is", model.piston.offset, -most, most, " mm", "is it in mm?")
    mean = stroke * speed / 30e3
    right = "are operation.speed and crank.stroke right?"
    yield Figure("the mean piston speed is", mean, 0, PISTON_SPEED, " m/s", right)
    thousands = "a point separates decimals, not thousands"
    yield Figure("operation.speed is", speed, SPEED, math.inf, " rpm", thousands)


def _list_rods(model: EngineFile) -> Iterator[Figure]:
    rod = model.rod
    mass = _weigh_rod(model)
    piston = _weigh_piston(model)
    length = rod.length or (max(model.crank.strokes) / 2 / rod.ratio if rod.ratio else math.inf)
    most = CROSSHEAD_LAMBDA if _has_crosshead(model) else LAMBDA[1]
    meaning = "crank.stroke is twice the crank radius, rod.length the distance between its centres"
    for stroke in dict.fromkeys(model.crank.strokes) if rod.motion == "exact" else ():
        ratio = rod.ratio or stroke / 2 / length
        digits = count_lambda_digits(ratio)
        yield Figure("crank radius / rod length is", ratio, LAMBDA[0], most, "", meaning, digits)
    if mass and piston:
        name = f"the rod weighs {mass:.4g} kg,"
        yield Figure(name, mass / piston, *ROD, " times the piston", SAME_UNIT)
    if rod.small_end is not None and rod.big_end is not None:
        exchanged = "are small_end and big_end exchanged?"
        yield Figure("rod.small_end is", rod.small_end, 0, SMALL_END * mass, " kg", exchanged)
    if rod.cg is not None:
        measured = f"it is measured from the big-end centre; the small end is at {length:g} mm"
        yield Figure("rod.cg is", rod.cg, 0, SMALL_END * length, " mm", measured)
    if mass and rod.inertia is not None:
        least, most = (share * mass * length**2 for share in INERTIA)
        about = "it is taken about the centre of mass, in kg mm^2"
        if rod.cg is not None and 0 < rod.cg < length:
            two_masses = TWO_MASSES * mass * rod.cg * (length - rod.cg)
            if two_masses < rod.inertia <= most:
                most = two_masses
                about = "does it belong to this mass, cg and length?"
        yield Figure("rod.inertia is", rod.inertia, least, most, " kg mm^2", about)


def _list_cranks(model: EngineFile) -> Iterator[Figure]:
    """Yield figures of the crankshaft and of parts that turn with it. Their usual ranges follow
    from the rods and pistons.
    """
    crank = model.crank
    shares = model.bobweight
    wheel = model.flywheel
    angles = crank.throws or (0.0,)
    if (span := max(angles) - min(angles)) >= THROWS[0]:
        name = "crank.throws: the largest difference between two is"
        yield Figure(name, span, THROWS[1], math.inf, " deg", DEGREES)
    if bank := model.layout.bank_angle:
        yield Figure("layout.bank_angle is", bank, BANK, math.inf, " deg", RADIANS)
    throws, rods = _count_throws_and_rods(model)
    one = _weigh_piston(model) + _weigh_rod(model)
    radius = max(crank.strokes) / 2
    throw_mass = max(crank.throw_masses)
    if one:
        most = THROW * rods / throws * one
        yield Figure("crank.throw_mass is", throw_mass, 0, most, " kg", OFF_AXIS)
        per_rod = (shares.oil_per_pin or 0.0) * throws / rods
        for key, mass in (
            ("rod_bearing", shares.rod_bearing),
            ("oil", shares.oil),
            ("oil_per_pin, for each rod,", per_rod),
        ):
            yield Figure(f"bobweight.{key} is", mass, 0, BEARING * one, " kg", GRAMS)
    most = UNBALANCE * (throws * throw_mass + rods * one) * 1e3 * radius
    for number, weight in enumerate(model.counterweight if most else (), 1):
        unbalance = weight.unbalance or (weight.mass or 0.0) * 1e3 * (weight.radius or 0.0)
        name = f"counterweight.{number}: its unbalance is"
        yield Figure(name, abs(unbalance), 0, most, " g mm", "is it in g mm?")
    turning = {"crank": crank.inertia}
    if wheel:
        arm = wheel.radius_of_gyration or 0.0
        turning["flywheel"] = wheel.inertia or (wheel.mass or 0.0) * arm**2
    least = TURNING * rods * one * radius**2
    for name, inertia in turning.items():
        if inertia:
            question = ask_unit("kg mm^2", f"{inertia:.4g} kg m^2")
            yield Figure(f"{name}.inertia is", inertia, least, math.inf, " kg mm^2", question)


def _has_crosshead(model: EngineFile) -> bool:
    """Return whether the file gives a crosshead, or a stroke so long that there must be one."""
    bore = model.piston.bore
    return model.crosshead.mass > 0 or (
        bore is not None and max(model.crank.strokes) > LONG_STROKE * bore
    )


def _weigh_piston(model: EngineFile) -> float:
    """Return the mass of a whole piston with its crosshead, kg."""
    parts = sum(getattr(model.piston, key) or 0.0 for key in ("mass", *PISTON_PARTS))
    return parts + model.crosshead.mass


def _weigh_rod(model: EngineFile) -> float:
    """Return the mass of a rod, kg; 0 if the file gives none."""
    rod = model.rod
    return rod.mass or (rod.small_end or 0.0) + (rod.big_end or 0.0)


def _count_throws_and_rods(model: EngineFile) -> tuple[int, int]:
    """Return the numbers of throws and of rods. Without crank.throws, each cylinder in the
    firing order has a rod.
    """
    layout = model.layout
    banks = 2 if layout.bank_angle is not None else len(layout.banks or ()) or layout.radial or 1
    rods_on_a_throw = banks if layout.rods == "shared" else 1
    if model.crank.throws is None and layout.firing_order:
        return max(len(layout.firing_order) // rods_on_a_throw, 1), len(layout.firing_order)
    throws = len(model.crank.throws or ()) or layout.rows or 1
    return throws, throws * rods_on_a_throw
