"""Warn of valid figures that no ordinary engine has; most often, such a figure has a wrong unit.

The limits are wide enough for engines from models to ships. A warning states the value, the usual
range and a remedy.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from .doubt import Doubt, Figure, doubt_figures, walk_figures
from .fields import count_lambda_digits, join_words
from .model import EngineFile
from .plain_tables import list_tables
from .ranges import (
    ABSOLUTE_PRESSURE,
    MASSES_OF_PISTON,
    find_radians,
    find_unusual,
    list_ranges,
    weigh_piston,
    weigh_rod,
)
from .units import ask_unit

# The mass of similar pistons grows with the cube of the bore. With pin and rings, aluminium pistons
# have 300 (racing) to 1000 (lorry) kg per m^3 of bore^3, pistons of cast iron up to 3000. The
# limits are wider; a confusion of g and kg is a factor of 1000.
PISTON = 100.0, 5000.0  # mass of a piston over bore^3, kg/m^3
# Largest mass of piston and crosshead over bore^3, kg/m^3: engines have up to 40000, plunger pumps
# with a small bore for their stroke up to 80000
CROSSHEAD_HEAVY = 250_000.0
LONG_STROKE = 2.5  # stroke / bore above which an engine must have crossheads
LAMBDA = 0.15, 0.4  # crank radius / rod length: engines have 0.2 to 0.35
# The same with crossheads: locomotives and pumps have 0.09 or more, engines up to 0.55
CROSSHEAD_LAMBDA = 0.05, 0.6
BORE = 0.2, 3.0  # bore / stroke: crosshead engines have 0.25 or more, racing engines up to 2.5
ROD = 0.1, 8.0  # rod mass / piston mass: engines have 0.7 to 2.5
SMALL_END = 0.55  # largest share of the rod's mass at the small end: rods have 0.2 to 0.4
# Moment of inertia / (mass x length^2): a bar of even thickness has 1/12, two equal masses at its
# ends 1/4. A rod has more only if bosses and bolts extend beyond its centres.
INERTIA = 0.02, 0.4
TWO_MASSES = 1.6  # largest rod inertia / inertia of two masses at its ends: rods have 0.6 to 1.35
PISTON_SPEED = 40.0  # largest mean piston speed, m/s; racing engines have up to 30
SPEED = 9.0  # lowest speed, rpm; the largest ship engines idle at 15, and 1 rad/s is 9.55
SLOWEST_PISTON = 0.05  # lowest mean piston speed, m/s: starters turn engines at 0.3 or more
# Engines with a stroke above 1 m, and slow engines with a stroke above two bores, are usually
# two-strokes.
CROSSHEAD_STROKE = 1000.0  # mm
SLOW_SPEED = 250.0  # rpm
SLOW_BORES = 2.0  # largest usual stroke of a slow four-stroke engine, bores
OFFSET = 0.2  # largest offset / stroke: up to 0.05 is usual, in narrow-angle vees up to 0.15
MAX_PRESSURE = 500.0  # largest cylinder pressure, bar; engines have 50 to 250
# Mean pressures: 8 to 30 bar is usual, racing engines had 50; 7 bar are 100 psi, and 100 lies
# outside.
PRESSURES = {
    **dict.fromkeys(("intake", "exhaust", "crankcase"), (*ABSOLUTE_PRESSURE, " bar absolute")),
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
TURNING_MOST = 1e4  # largest; engines with one cylinder and two large wheels have up to 1000
# Largest loss factors: steel has 0.01 to 0.05, rubber up to 0.5. Figures in percent are above 1;
# relative dampings of couplings, 0.8 to 2, are above 0.5.
LOSS_OF_MOUNTS = 1.0
LOSS_OF_SHAFTS = 0.5
WHEEL_LOAD = 1000  # smallest load of a wheel on its rail, N; only models have less
SAME_UNIT = "are both in the same unit?"
DEGREES = (
    'bare numbers are degrees; give another unit as in "1/2 turn" or "3.1416 rad"; a sequence '
    "of cylinders belongs in layout.firing_order"
)
RADIANS = 'bare numbers are degrees; give radians as in "1.3 rad"'
OFF_AXIS = "is it in kg? It is the unbalanced mass of one throw, not the mass of the crankshaft"
GRAMS = 'is it in kg? Give grams as in "47 g"'


def find_suspicious(model: EngineFile) -> list[Doubt]:
    """Return warnings for figures that are allowed but unlikely; empty for an ordinary engine.

    Args:
        model: Engine file.
    """
    figures = list[Figure]()
    if model.locomotive is not None:
        from .locomotive_ranges import list_locomotive_ranges  # only for files with [locomotive]

        figures += find_unusual(list_locomotive_ranges(model, model.locomotive))
        if model.locomotive.wheel_load is not None:
            load = model.locomotive.wheel_load
            hint = ask_unit("N", "40 kN", "9.5 t")
            figures.append(Figure("locomotive.wheel_load", load, WHEEL_LOAD, math.inf, " N", hint))
    figures += [*_list_pistons(model), *_list_rods(model), *_list_cranks(model)]
    question = ask_unit("bar", "130 psi", "0.9 MPa")
    for path, key, value in walk_figures("gas", list_tables(model.gas)):
        if key in PRESSURES:
            figures.append(Figure(path, value, *PRESSURES[key], question))
    figures += find_unusual(list_ranges(model))
    if model.web:
        from .web_ranges import list_web_ranges  # loaded only for files with [[web]]

        figures += find_unusual(list_web_ranges(model))
    if model.torsion is not None:
        from .torsion_ranges import list_torsion_ranges  # loaded only for files with [torsion]

        throws, _ = _count_throws_and_rods(model)
        figures += find_unusual(list_torsion_ranges(model, model.torsion, throws))
    doubts = [
        *doubt_drifting(model),
        *_doubt_single_throw(model),
        *_find_missing(model),
        *_doubt_piston_rods(model),
        *doubt_figures(figures),
        *doubt_losses(walk_figures("torsion", list_tables(model.torsion)), LOSS_OF_SHAFTS),
    ]
    doubted = {doubt.path for doubt in doubts}
    for path, value in find_radians(model):
        if path not in doubted:
            message = f"{value:.4g} deg is a round part of a turn in radians; {RADIANS}"
            doubts.append(Doubt(path, message))
    return doubts


def doubt_drifting(model: EngineFile) -> Iterator[Doubt]:
    """Yield one warning that names the shafts without a fixed phase to the crank, such as those
    behind a belt, which only `analyze` lists.
    """
    paths = {}
    for number, shaft in enumerate(model.shaft, 1):
        if shaft.drifts:
            paths[f"shaft.{number}"] = f"{shaft.name or f'shaft {number}'} ({shaft.ratio:g})"
    if paths:
        first, *others = paths
        names = join_words(list(dict.fromkeys(paths.values())))
        message = (
            f"{names}: a speed that is no multiple of half the crank speed has no fixed phase to "
            "the crank, so it is left out here; analyze lists it"
        )
        yield Doubt(f"{first}.ratio", message, tuple(others))


def doubt_losses(figures: Iterable[tuple[str, Any, Any]], most: float) -> Iterator[Doubt]:
    """Yield warnings for loss factors that are too large. They are probably percentages or relative
    dampings.

    Args:
        figures: Result of `walk_figures`; each key `loss` is checked.
        most: Largest usual loss factor.
    """
    hint = "{0:g} % is {1:g}, and a relative damping psi is a loss factor of psi/(2 pi)"
    yield from doubt_figures(
        Figure(place, loss, 0, most, "", hint.format(loss, loss / 100))
        for place, key, loss in figures
        if key == "loss"
    )


def _find_missing(model: EngineFile) -> Iterator[Doubt]:
    """Yield warnings for keys that were probably forgotten, and for keys that contradict others."""
    if weigh_piston(model) == 0:
        yield Doubt("piston.mass", "0 kg; give the mass of piston, pin, rings and locks")
    if model.rod.mass and model.rod.cg is None:
        yield Doubt("rod.cg", "is not given, and 0 is taken; measure it from the big-end centre")
    for number, weight in enumerate(model.counterweight, 1):
        if not weight.has("angle") and not weight.to_fit:
            message = (
                "is not given, and 0 is taken: the side of cylinder 1's crank pin; opposite it is "
                "180"
            )
            yield Doubt(f"counterweight.{number}.angle", message)
            break
    crank = model.crank
    throws, rods = _count_throws_and_rods(model)
    # A single figure is repeated for all throws; lists of a wrong length are rejected elsewhere.
    masses, strokes = (np.resize(each, throws) for each in (crank.throw_masses, crank.strokes))
    of_throws = float(masses @ (strokes / 2) ** 2)
    if crank.inertia is not None and crank.inertia < of_throws and not model.layout.rotary:
        message = (
            f"{crank.inertia:.4g} kg mm^2, less than the {of_throws:.4g} kg mm^2 of its throws "
            "alone (crank.throw_mass at the crank radius)"
        )
        yield Doubt("crank.inertia", message, ("crank.throw_mass",))
    placed = [number for number, own in model.cylinder.items() if own.position is not None]
    left = rods - len(placed)
    if crank.spacing is None and crank.positions is None and placed and left > rods / throws:
        message = (
            f"is given, but {left} cylinders have no position and are all at 0: give the position "
            "of each, or crank.spacing"
        )
        yield Doubt(f"cylinder.{placed[0]}.position", message)
    if crank.positions is not None and list(crank.positions) != sorted(crank.positions):
        message = (
            "do not rise; throws count from the free end, and z grows towards the flywheel: is "
            "each position that of its throw?"
        )
        yield Doubt("crank.positions", message)
    stroke = max(crank.strokes)
    speed = model.operation.speed
    bore = model.piston.bore
    slow = speed < SLOW_SPEED and bore is not None and stroke > SLOW_BORES * bore
    if not model.layout.has("strokes") and (stroke > CROSSHEAD_STROKE or slow):
        message = (
            f"is not given, and 4 is taken; engines with a stroke of {stroke:g} mm at {speed:g} "
            "rpm are mostly two-strokes: give layout.strokes = 2, or 4 if it is right"
        )
        yield Doubt("layout.strokes", message)
    torsion = model.torsion
    if model.flywheel is not None and torsion is not None and not (torsion.front or torsion.rear):
        message = "is missing; `torsion` does not use [flywheel]: also write it as [[torsion.rear]]"
        yield Doubt("torsion.rear", message)


def list_keys_between_throws(model: EngineFile) -> tuple[str, ...]:
    """Return the keys of a file that are about neighbouring throws, if the file gives neither the
    angles of throws nor a firing order, so that a single throw is taken. That is usual in a radial.
    """
    layout = model.layout
    if model.crank.throws is not None or layout.firing_order is not None or layout.radial:
        return ()
    keys = []
    if model.crank.spacing:
        keys.append("crank.spacing")
    if model.torsion is not None and model.torsion.throw_stiffness is not None:
        keys.append("torsion.throw_stiffness")
    return tuple(keys)


def _doubt_single_throw(model: EngineFile) -> Iterator[Doubt]:
    """Yield a warning if a single throw is taken in a file that seems to be about several."""
    keys = list_keys_between_throws(model)
    if keys:
        message = (
            f"is not given, and one throw is taken, although the file has {join_words(keys)}, for "
            "several throws; give layout.firing_order, or the angle of every throw"
        )
        yield Doubt("crank.throws", message, keys)


def _doubt_piston_rods(model: EngineFile) -> Iterator[Doubt]:
    """Yield a warning for the diameter of a piston rod that no crank end uses."""
    if model.gas is not None and model.gas.has_crank_ends:
        return
    diameters = {"piston.rod_diameter": model.piston.rod_diameter}
    for number, own in model.cylinder.items():
        diameters[f"cylinder.{number}.piston_rod_diameter"] = own.piston_rod_diameter or 0.0
    for path, diameter in diameters.items():
        if diameter:
            message = (
                f"{diameter:g} mm; it changes nothing without gas at the crank end: give "
                "[gas.crank_end], or leave it out"
            )
            yield Doubt(path, message)
            return


def _list_pistons(model: EngineFile) -> Iterator[Figure]:
    strokes = model.crank.strokes
    bore = model.piston.bore
    stroke = max(strokes)
    if mass := weigh_piston(model):
        yield _describe_piston(model, mass)
    if bore is not None:
        for length in dict.fromkeys(strokes):
            subject = "bore / stroke is"
            also = ("crank.stroke",)
            yield Figure("piston.bore", bore / length, *BORE, "", SAME_UNIT, subject, also)
    most = OFFSET * stroke
    yield Figure("piston.offset", model.piston.offset, -most, most, " mm", "is it in mm?")
    yield from _list_speeds(model, stroke)


def _list_speeds(model: EngineFile, stroke: float) -> Iterator[Figure]:
    """Yield the mean piston speed and the speed; `stroke` is the largest stroke, mm."""
    speed = model.operation.speed
    path = "operation.speed"
    also: tuple[str, ...] = ("crank.stroke",)
    # operation.speed is then computed from it (`read_tables`)
    if model.locomotive is not None and model.locomotive.has("speed"):
        path = "locomotive.speed"
        also = ("locomotive.wheel_diameter", "crank.stroke")
    yield Figure(
        path=path,
        value=stroke * speed / 30e3,
        least=0,
        most=PISTON_SPEED,
        unit=" m/s",
        hint=f"are {join_words((path, *also))} right?",
        subject="the mean piston speed is",
        also=also,
    )
    yield Figure(
        path=path,
        value=speed,
        least=max(SPEED, SLOWEST_PISTON * 30e3 / stroke),
        most=math.inf,
        unit=" rpm",
        hint="a point separates decimals, not thousands",
        subject="" if path == "operation.speed" else "the crank speed is",
        also=also,
        basis=f"a stroke of {stroke:g} mm",
    )


def _describe_piston(model: EngineFile, mass: float) -> Figure:
    """Return the mass of a piston with its crosshead, kg, and its usual range for the bore, or for
    the bores that are usual with the strokes of the engine.
    """
    strokes = model.crank.strokes
    bore = model.piston.bore
    if bore is None:
        narrow = BORE[0] * min(strokes)
        wide = BORE[1] * max(strokes)
        unit = f" kg at a stroke of {max(strokes):g} mm"
    else:
        narrow = bore
        wide = bore
        unit = f" kg in a bore of {bore:g} mm"
    heavy = CROSSHEAD_HEAVY if _has_crosshead(model) else PISTON[1]
    path = "piston.mass"
    subject = ""
    if model.piston.mass is None:
        path = "piston.piston"
        subject = "the parts of [piston] weigh"
    if model.crosshead.mass:
        subject = "piston and crosshead weigh"
    return Figure(
        path=path,
        value=mass,
        least=PISTON[0] * (narrow * 1e-3) ** 3,
        most=heavy * (wide * 1e-3) ** 3,
        unit=unit,
        hint="are the units right? Bare numbers are kg and mm",
        subject=subject,
        also=MASSES_OF_PISTON,
    )


def _list_rods(model: EngineFile) -> Iterator[Figure]:
    rod = model.rod
    mass = weigh_rod(model)
    piston = weigh_piston(model)
    length = rod.length or (max(model.crank.strokes) / 2 / rod.ratio if rod.ratio else math.inf)
    for stroke in dict.fromkeys(model.crank.strokes) if rod.motion == "exact" else ():
        yield _describe_ratio(model, rod.ratio or stroke / 2 / length)
    if mass and piston:
        yield Figure(
            path="rod.small_end" if rod.mass is None else "rod.mass",
            value=mass / piston,
            least=ROD[0],
            most=ROD[1],
            unit=" times the piston",
            hint=SAME_UNIT,
            subject=f"the rod weighs {mass:.4g} kg,",
            also=("rod.big_end", *MASSES_OF_PISTON),
        )
    if rod.small_end is not None and rod.big_end is not None:
        exchanged = "are small_end and big_end exchanged?"
        also = ("rod.big_end",)
        most = SMALL_END * mass
        yield Figure("rod.small_end", rod.small_end, 0, most, " kg", exchanged, also=also)
    if rod.cg is not None:
        measured = f"it is measured from the big-end centre; the small end is at {length:g} mm"
        yield Figure("rod.cg", rod.cg, 0, SMALL_END * length, " mm", measured)
    if mass and rod.inertia is not None:
        least, most = (share * mass * length**2 for share in INERTIA)
        about = "it is taken about the centre of mass, in kg mm^2"
        if rod.cg is not None and 0 < rod.cg < length:
            two_masses = TWO_MASSES * mass * rod.cg * (length - rod.cg)
            if two_masses < rod.inertia <= most:
                most = two_masses
                about = "does it belong to this mass, cg and length?"
        yield Figure("rod.inertia", rod.inertia, least, most, " kg mm^2", about)


def _describe_ratio(model: EngineFile, ratio: float) -> Figure:
    """Return the ratio of crank radius to rod length, and its usual range."""
    least, most = CROSSHEAD_LAMBDA if _has_crosshead(model) else LAMBDA
    return Figure(
        path="rod.length" if model.rod.ratio is None else "rod.ratio",
        value=ratio,
        least=least,
        most=most,
        unit="",
        hint="crank.stroke is twice the crank radius, rod.length the distance between its centres",
        subject="crank radius / rod length is",
        also=("crank.stroke",) if model.rod.ratio is None else (),
        digits=count_lambda_digits(ratio),
    )


def _list_cranks(model: EngineFile) -> Iterator[Figure]:
    """Yield figures of the crankshaft and of parts that turn with it. Their usual ranges follow
    from the rods and pistons.
    """
    crank = model.crank
    shares = model.bobweight
    angles = crank.throws or (0.0,)
    if (span := max(angles) - min(angles)) >= THROWS[0]:
        subject = "the largest difference between two is"
        yield Figure("crank.throws", span, THROWS[1], math.inf, " deg", DEGREES, subject)
    if bank := model.layout.bank_angle:
        yield Figure("layout.bank_angle", bank, BANK, math.inf, " deg", RADIANS)
    throws, rods = _count_throws_and_rods(model)
    reciprocating = weigh_piston(model) + weigh_rod(model)
    radius = max(crank.strokes) / 2
    throw_mass = max(crank.throw_masses)
    if reciprocating:
        most = THROW * rods / throws * reciprocating
        yield Figure("crank.throw_mass", throw_mass, 0, most, " kg", OFF_AXIS)
        most = BEARING * reciprocating
        yield Figure("bobweight.rod_bearing", shares.rod_bearing, 0, most, " kg", GRAMS)
        yield Figure("bobweight.oil", shares.oil, 0, most, " kg", GRAMS)
        per_rod = (shares.oil_per_pin or 0.0) * throws / rods
        yield Figure("bobweight.oil_per_pin", per_rod, 0, most, " kg for each rod", GRAMS)
    most = UNBALANCE * (throws * throw_mass + rods * reciprocating) * 1e3 * radius
    for number, weight in enumerate(model.counterweight if most else (), 1):
        path = f"counterweight.{number}"
        question = "is it in g mm?"
        if weight.unbalance and not weight.to_fit:
            size = abs(weight.unbalance)
            yield Figure(f"{path}.unbalance", size, 0, most, " g mm", question)
        elif weight.mass and weight.radius:
            size = weight.mass * 1e3 * weight.radius
            subject = "mass times radius is"
            also = (f"{path}.radius",)
            yield Figure(f"{path}.mass", size, 0, most, " g mm", question, subject, also)
    yield from _list_turning(model, rods * reciprocating * radius**2)


def _list_turning(model: EngineFile, swung: float) -> Iterator[Figure]:
    """Yield the inertias of crankshaft and flywheel.

    Args:
        model: Engine file.
        swung: Inertia of all rods and pistons at the crank radius, kg mm2.
    """
    turning = {"crank.inertia": model.crank.inertia}
    if model.flywheel is not None:
        turning["flywheel.inertia"] = model.flywheel.inertia
    for path, inertia in turning.items():
        if inertia:
            yield Figure(
                path=path,
                value=inertia,
                least=TURNING * swung,
                most=TURNING_MOST * swung if swung else math.inf,
                unit=" kg mm^2",
                hint=ask_unit("kg mm^2", f"{inertia:.4g} kg m^2"),
            )


def _has_crosshead(model: EngineFile) -> bool:
    """Return whether the engine has crossheads: the file gives one, or a locomotive, a compressor
    or a crank end with gas, or a stroke so long that there must be one.
    """
    bore = model.piston.bore
    if model.crosshead.mass > 0 or model.locomotive is not None:
        return True
    if model.gas is not None and model.gas.is_of_pump:
        return True
    return bore is not None and max(model.crank.strokes) > LONG_STROKE * bore


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
