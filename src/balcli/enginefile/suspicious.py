"""Valid but suspicious: figures that no ordinary engine has, most often a slip of the unit.

The limits are wide: engines from models to ships pass. Each warning has the value, the limit and a
remedy.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

from .exclusive import join_words
from .fields import count_lambda_digits
from .model import Counterweight, EngineFile, Layout
from .units import ask_unit

if TYPE_CHECKING:
    from .torsion_tables import Part, Torsion

# Pistons of like design weigh as the cube of the bore: in aluminium with pin and rings 300 to 1000
# kg per m^3 of bore^3 (racing to lorry), in cast iron up to 3000. The limits leave room beyond; a
# slip from g to kg is a factor of 1000.
PISTON_LIGHT, PISTON_HEAVY = 100.0, 5000.0  # kg/m^3
CROSSHEAD_HEAVY = 40_000.0  # with piston rod and crosshead, where the stroke is LONG_STROKE bores
LONG_STROKE = 2.5
CROSSHEAD_LAMBDA = 0.6  # with a crosshead rods are short
LAMBDA_LOW, LAMBDA_HIGH = 0.15, 0.4  # crank radius / rod length: engines have 0.2 to 0.35
BORE_SHORT, BORE_LONG = 0.2, 3.0  # bore / stroke: crosshead from 0.25, racing engines to 2.5
ROD_LIGHT, ROD_HEAVY = 0.1, 8.0  # rod mass / piston mass: engines have 0.7 to 2.5
SMALL_END_HEAVY = 0.55  # share of the rod's mass: rods have 0.2 to 0.4 there
# Moment of inertia / (mass x length^2): a bar of even thickness has 1/12, two equal masses at the
# ends 1/4, and no rod between its two centres can have more; bosses and bolts beyond them add a
# little.
INERTIA_LOW, INERTIA_HIGH = 0.02, 0.4
PISTON_SPEED = 40.0  # m/s, mean; racing engines stay below 30
# Engines with a stroke over 1 m, or so slow with a stroke over two bores, are two-strokes.
CROSSHEAD_STROKE = 1000.0  # mm
SLOW_SPEED, SLOW_BORES = 250.0, 2.0  # rpm, bores
SPEED_LOW = 9.0  # rpm; the largest ship engines idle at 15, and 1 rad/s is 9.55
NEAR_THE_CRANK = 0.02  # strokes; a shaft this near would stand within the crank
NO_DISTANCE = 1e-6  # mm: on the axis, but for rounding
OFFSET_SHARE = 0.2  # of the stroke; pin offsets have up to 0.05, narrow-angle vees up to 0.15
# Indicated or brake mean pressure: 8 to 30 bar is usual, racing engines had 50; 100 psi is 7 bar.
MEAN_PRESSURE = 60.0  # bar
MAX_PRESSURE = 500.0  # bar; engines have 50 to 250
# bar, absolute: at 10 km of height there are 0.26, charged in two stages 10; psi and MPa: beyond.
AROUND = 0.15, 12.0
COMPRESSION = 2.0, 30.0  # engines have 4 (of 1910) to 25
INDEX_MOST = 5 / 3  # of a gas of single atoms that loses nothing; engines have 1.2 to 1.4
# Unbalanced mass of a throw / its rods and pistons: engines have up to 1.4; a whole crankshaft
# weighs some 4 to 10 times as much for each throw, with its counterweights.
THROW_HEAVY = 6.0
BEARING_HEAVY = 0.5  # shells or oil of a rod / rod and piston: engines have up to 0.05
# Cylinders in line need more than their bore from one to the next: engines have 1.05 to 1.8.
NEIGHBOURS_CLOSE = 0.9
# deg, of all throws: cranks have 60 or more, or none; [1, 3, 4, 2] and radians have this little.
THROWS_NEAR = 1.0, 10.0
UNBALANCE_SHARE = 5.0  # of all moving masses x crank radius; balancing needs 1 or 2
# Crankshafts and flywheels have more than the rods and pistons would have on the crank pins; a slip
# from kg m^2 to kg mm^2 is a factor of a million.
TURNING_LIGHT = 0.01
# rad, by the work that a cylinder does at 10 bar as a torque: engines have 2e-4 to 5e-3; much
# less is said of shafts that are taken for rigid.
TWIST_MOST = 0.05
LOSS_MOST = 1.0  # steel has 0.01 to 0.05, rubber to 0.5; what is in percent is a hundred times that
SAME_INERTIA = 0.05  # share by which what is said twice may differ: it is rounded, or has bolts


def find_suspicious(model: EngineFile) -> list[str]:
    """Warnings for what is allowed and yet unlikely; empty for an ordinary engine."""
    of_rods = _piston, _proportions, _rod, _rod_ends, _inertia, _motion
    of_crank = _neighbours, _own_places, _throw_angles, _layout, _throw, _bobweight, _counterweights
    beyond = _shafts, _rotary, _turning, _gas, _torsion
    return [warning for find in (*of_rods, *of_crank, *beyond) for warning in find(model)]


def _piston(model: EngineFile) -> Iterator[str]:
    mass, bore = _piston_mass(model), model.piston.bore
    if mass == 0:
        yield (
            "piston.mass is 0: only the rod moves to and fro; give the mass of piston, pin, rings "
            "and locks"
        )
        return
    stroke = model.crank.stroke
    bores = (BORE_SHORT * stroke, BORE_LONG * stroke) if bore is None else (bore, bore)
    heavy = CROSSHEAD_HEAVY if _has_crosshead(model) else PISTON_HEAVY
    low, high = (k * (b * 1e-3) ** 3 for k, b in zip((PISTON_LIGHT, heavy), bores, strict=True))
    if not low <= mass <= high:
        beside = f"at a stroke of {stroke:g}" if bore is None else f"in a bore of {bore:g}"
        yield (
            f"{_name_piston_mass(model)} {mass:.4g} kg {beside} mm, where {_round(low)} to "
            f"{_round(high)} kg is usual; are the units right? Bare numbers are kg and mm"
        )


def _proportions(model: EngineFile) -> Iterator[str]:
    ratio = _lambda(model)
    most = CROSSHEAD_LAMBDA if _has_crosshead(model) else LAMBDA_HIGH
    if ratio is not None and not LAMBDA_LOW <= ratio <= most:
        shown = f"{ratio:.{count_lambda_digits(ratio)}g}"
        yield (
            f"crank radius / rod length is {shown}, where {LAMBDA_LOW:g} to {most:g} is usual; "
            "crank.stroke is twice the crank radius, rod.length the distance of its two centres"
        )
    if model.piston.bore is not None:
        share = model.piston.bore / model.crank.stroke
        if not BORE_SHORT <= share <= BORE_LONG:
            yield (
                f"piston.bore / crank.stroke is {share:.4g}, where {BORE_SHORT:g} to "
                f"{BORE_LONG:g} is usual; are both in the same unit?"
            )


def _rod(model: EngineFile) -> Iterator[str]:
    rod, mass, length, cg = model.rod, _rod_mass(model), _rod_length(model), model.rod.cg
    piston = _piston_mass(model)
    if mass and piston and not ROD_LIGHT <= mass / piston <= ROD_HEAVY:
        yield (
            f"the rod weighs {mass:.4g} kg, {mass / piston:.3g} times the piston, where "
            f"{ROD_LIGHT:g} to {ROD_HEAVY:g} times is usual; are both in the same unit?"
        )
    if rod.mass and cg is None:
        yield (
            "rod.cg is not given: all of the rod counts at the crank pin; measure it from the "
            "big-end centre"
        )
    if cg is not None and length is not None and not 0 <= cg <= length:
        yield (
            f"rod.cg is {cg:g} mm, outside the rod (0 to {length:g} mm); it is measured from the "
            "big-end centre towards the small end"
        )


def _rod_ends(model: EngineFile) -> Iterator[str]:
    """A rod that is heavier at its small end: measured from there, most likely."""
    rod, length = model.rod, _rod_length(model)
    small, big = rod.small_end, rod.big_end
    if small is not None and big is not None and small > SMALL_END_HEAVY * (small + big):
        yield (
            f"rod.small_end is {small:.4g} kg, more than rod.big_end with {big:.4g} kg; are they "
            "exchanged?"
        )
    if rod.cg is not None and length and SMALL_END_HEAVY * length < rod.cg <= length:
        yield (
            f"rod.cg is {rod.cg:g} mm, nearer to the small end than to the big end ({length:g} mm "
            "apart); it is measured from the big-end centre"
        )


def _inertia(model: EngineFile) -> Iterator[str]:
    mass, length, inertia = _rod_mass(model), _rod_length(model), model.rod.inertia
    if not mass or not length or inertia is None:
        return
    share = inertia / (mass * length**2)
    if not INERTIA_LOW <= share <= INERTIA_HIGH:
        low, high = INERTIA_LOW * mass * length**2, INERTIA_HIGH * mass * length**2
        yield (
            f"rod.inertia is {inertia:.4g} kg mm^2, where {_round(low)} to {_round(high)} is usual "
            f"for {mass:.4g} kg and {length:g} mm; it is taken about the centre of mass, in kg mm^2"
        )


def _motion(model: EngineFile) -> Iterator[str]:
    stroke, speed = model.crank.stroke, model.operation.speed
    piston_speed = 2 * stroke * 1e-3 * speed / 60
    if piston_speed > PISTON_SPEED:
        yield (
            f"the mean piston speed is {piston_speed:.3g} m/s at {speed:g} rpm and a stroke of "
            f"{stroke:g} mm, more than {PISTON_SPEED:g}; are operation.speed and crank.stroke "
            "right?"
        )
    if 0 < speed < SPEED_LOW:
        yield (
            f"operation.speed is {speed:g} rpm; a point parts decimals, not thousands: were "
            f"{1000 * speed:g} rpm meant?"
        )
    bore = model.piston.bore
    slow = speed < SLOW_SPEED and bore is not None and stroke > SLOW_BORES * bore
    if "strokes" not in model.layout.model_fields_set and (stroke > CROSSHEAD_STROKE or slow):
        yield (
            f"layout.strokes is not given, and 4 is taken; engines with a stroke of {stroke:g} mm "
            f"at {speed:g} rpm are two-strokes: say layout.strokes = 2, or 4 if it is so"
        )
    if abs(model.piston.offset) > OFFSET_SHARE * stroke:
        yield (
            f"piston.offset is {model.piston.offset:g} mm, more than {OFFSET_SHARE:.0%} of the "
            f"stroke ({OFFSET_SHARE * stroke:g} mm); is it in mm?"
        )


def _neighbours(model: EngineFile) -> Iterator[str]:
    bore, gap = model.piston.bore, _find_gap_in_bank(model)
    # 0 is said on purpose: all throws in one plane.
    if bore is not None and gap is not None and 0 < gap < NEIGHBOURS_CLOSE * bore:
        key = "spacing" if model.crank.positions is None else "positions"
        yield (
            f"crank.{key} puts neighbouring cylinders of one bank {gap:g} mm apart, which is less "
            f"than their bore of {bore:g} mm; {ask_unit('mm', '4.4 in', '1.02 m')}"
        )


def _own_places(model: EngineFile) -> Iterator[str]:
    """Cylinders of several throws without a place, where others have one of their own."""
    crank, (throws, rods) = model.crank, _throws_and_rods(model)
    placed = [number for number, own in model.cylinder.items() if own.position is not None]
    left = rods - len(placed)
    if crank.spacing is None and crank.positions is None and placed and left > rods / throws:
        yield (
            f"cylinder.{placed[0]}.position is given, but {left} cylinders have no place and all "
            "stand at 0: give the position of each, or crank.spacing"
        )


def _throw_angles(model: EngineFile) -> Iterator[str]:
    throws = model.crank.throws or (0.0,)
    span = max(throws) - min(throws)
    if THROWS_NEAR[0] <= span < THROWS_NEAR[1]:
        yield (
            f"crank.throws are all within {span:.4g} deg of one another; bare numbers are degrees, "
            'another unit is said as in "1/2 turn" or "3.1416 rad", and numbers of cylinders stand '
            "in layout.firing_order"
        )


def _layout(model: EngineFile) -> Iterator[str]:
    spacing = _spacing(model)
    if spacing and abs(model.layout.stagger) > spacing:
        yield (
            f"layout.stagger is {model.layout.stagger:g} mm, more than the distance of "
            f"neighbouring throws ({spacing:g} mm); it is the distance of two rods on one throw"
        )


def _throw(model: EngineFile) -> Iterator[str]:
    throws, rods = _throws_and_rods(model)
    given, moving = model.crank.throw_mass, rods / throws * _rod_and_piston(model)
    beside = "the rods and pistons of a throw"
    for doubt in _too_heavy("crank.throw_mass", given, THROW_HEAVY, beside, moving):
        yield f"{doubt}. It is what one throw has off the axis, not what the crankshaft weighs"


def _bobweight(model: EngineFile) -> Iterator[str]:
    moving = _rod_and_piston(model)
    for key in ("rod_bearing", "oil"):
        given = getattr(model.bobweight, key)
        beside = "a rod with its piston"
        yield from _too_heavy(f"bobweight.{key}", given, BEARING_HEAVY, beside, moving)


def _too_heavy(key: str, given: float, times: float, beside: str, kg: float) -> Iterator[str]:
    """A mass that is more than so many times what it goes with: probably grams."""
    if kg and given > times * kg:
        yield (
            f"{key} is {given:.4g} kg, more than {times:g} times {beside} ({kg:.3g} kg); is it in "
            f'kg? Grams are said as in "{given:.4g} g"'
        )


def _counterweights(model: EngineFile) -> Iterator[str]:
    radius = model.crank.stroke / 2
    throws, rods = _throws_and_rods(model)
    mass = throws * model.crank.throw_mass + rods * _rod_and_piston(model)
    limit = UNBALANCE_SHARE * mass * 1e3 * radius
    for number, weight in enumerate(model.counterweight, 1):
        if limit and abs(_unbalance(weight)) > limit:
            yield (
                f"counterweight.{number}: its unbalance is {abs(_unbalance(weight)):.4g} g mm, "
                f"more than {UNBALANCE_SHARE:g} times all moving masses at the crank radius "
                f"({limit:.3g}); is it in g mm?"
            )


def _shafts(model: EngineFile) -> Iterator[str]:
    """One beside the crank's axis, and yet within the crank: a place in metres, most likely."""
    nearest = NEAR_THE_CRANK * model.crank.stroke
    for number, shaft in enumerate(model.shaft, 1):
        away = max(map(abs, shaft.at))
        if NO_DISTANCE < away < nearest:
            yield (
                f"shaft.{number}.at is within {away:.3g} mm of the crank's axis; "
                f"{ask_unit('mm', f'{away:.3g} m')}"
            )


def _rotary(model: EngineFile) -> Iterator[str]:
    if model.layout.rotary and model.crank.inertia is not None:
        yield (
            "crank.inertia counts for nothing: the crank of a rotary engine stands still; give "
            "what turns with its cylinders as flywheel.inertia"
        )


def _turning(model: EngineFile) -> Iterator[str]:
    """What turns with the crank, each inertia beside that of all rods and pistons on the pins."""
    _, rods = _throws_and_rods(model)
    beside = rods * _rod_and_piston(model) * (model.crank.stroke / 2) ** 2
    for what, inertia in _list_turning(model):
        if 0 < inertia < TURNING_LIGHT * beside:
            yield (
                f"{what} is {inertia:.4g} kg mm^2, less than {TURNING_LIGHT:g} of what all rods "
                f"and pistons have at the crank radius ({beside:.4g}); "
                f"{ask_unit('kg mm^2', f'{inertia:.4g} kg m^2')}"
            )


def _list_turning(model: EngineFile) -> Iterator[tuple[str, float]]:
    """What it is, in words, with its inertia, kg mm2; 0 where the file gives none."""
    yield "crank.inertia", model.crank.inertia or 0.0
    yield "flywheel.inertia", _flywheel_inertia(model)
    if model.torsion is not None:
        yield "torsion.throw_inertia, of all throws,", _throw_inertia(model.torsion, model)
        parts = {p.name: p.inertia or 0.0 for p in (*model.torsion.front, *model.torsion.rear)}
        if parts:
            name = max(parts, key=parts.__getitem__)
            yield f"the heaviest part of [torsion], '{name}',", parts[name]


def _throw_inertia(torsion: Torsion, model: EngineFile) -> float:
    """Of all throws, as [torsion] gives it, kg mm2; 0 where it gives none."""
    each = torsion.throw_inertia or ()
    return sum(each) * (_throws_and_rods(model)[0] if len(each) == 1 else 1)


def _gas(model: EngineFile) -> Iterator[str]:
    if model.gas is None:
        return
    mean = 0.0, MEAN_PRESSURE, ""
    pressures = dict.fromkeys(("intake", "exhaust", "crankcase"), (*AROUND, " absolute"))
    pressures |= {"imep": mean, "bmep": mean, "max_pressure": (0.0, MAX_PRESSURE, "")}
    for key, (low, high, absolute) in pressures.items():
        value = getattr(model.gas, key)
        if value is not None and not low <= value <= high:
            usual = f"{low:g} to {high:g}" if low else f"at most {high:g}"
            yield (
                f"gas.{key} is {value:.4g} bar{absolute}, where {usual} is usual; "
                f"{ask_unit('bar', '130 psi', '0.9 MPa')}"
            )
    if model.gas.cycle is None:
        return  # a compressor, which has a diagram, leaves less clearance
    for key, low, high, meaning in (
        ("compression_ratio", *COMPRESSION, "the largest volume over the smallest"),
        ("compression_index", 1.0, INDEX_MOST, "n of p V^n = const"),
        ("expansion_index", 1.0, INDEX_MOST, "n of p V^n = const"),
    ):
        value = getattr(model.gas, key)
        if value is not None and not low <= value <= high:
            yield (
                f"gas.{key} is {value:.4g}, where {low:g} to {high:.3g} is usual; it is {meaning}"
            )


def _torsion(model: EngineFile) -> Iterator[str]:
    if model.torsion is None:
        return
    yield from doubt_losses(_list_losses(model.torsion))
    yield from _throw_stiffness(model.torsion, model)
    yield from _crank_inertia(model.torsion, model)
    yield from _parts_in_water(model.torsion)
    yield from _flywheels(model.torsion, model)


def _crank_inertia(torsion: Torsion, model: EngineFile) -> Iterator[str]:
    """What `torque` takes of [crank], less than what `torsion` takes of its own table."""
    throws, whole = _throw_inertia(torsion, model), model.crank.inertia
    if whole is not None and throws > (1 + SAME_INERTIA) * whole:
        yield (
            f"crank.inertia is {whole / 1e6:.4g} kg m^2, and all throws of torsion.throw_inertia "
            f"together have {throws / 1e6:.4g}: the whole has no less than its parts"
        )


def _parts_in_water(torsion: Torsion) -> Iterator[str]:
    """Damping that was meant against ground."""
    for part in (*torsion.front, *torsion.rear):
        in_water = any(word in part.name.lower() for word in ("propeller", "impeller"))
        if in_water and part.damping and not part.node_damping:
            yield (
                f"the part '{part.name}' of [torsion]: damping is of a dashpot between the ends of "
                "its shaft; of the part against ground, as water damps it, it is node_damping"
            )


def _flywheels(torsion: Torsion, model: EngineFile) -> Iterator[str]:
    """One in [flywheel], and another in [torsion] or none."""
    flywheel = _flywheel_inertia(model)
    if not flywheel:
        return
    own = f"[flywheel] has {flywheel / 1e6:.4g} kg m^2"
    named = [
        (part.name, part.inertia)
        for part in (*torsion.front, *torsion.rear)
        if part.inertia and "flywheel" in part.name.lower()
    ]
    if len(named) == 1:
        name, inertia = named[0]
        if abs(inertia - flywheel) > SAME_INERTIA * flywheel:
            yield (
                f"{own}, and the part '{name}' of [torsion] {inertia / 1e6:.4g}: `torque` takes "
                "the one, `torsion` the other"
            )
    elif not named and not torsion.rear and not _has_inertia(torsion.front, flywheel):
        yield (
            f"{own}, and [torsion] nothing behind the throws: `torsion` has no flywheel; write "
            "it as [[torsion.rear]], too"
        )


def _has_inertia(parts: Iterable[Part], inertia: float) -> bool:
    """Whether one of them is as heavy: a propeller or rotor at the free end is a flywheel, too."""
    return any(abs((part.inertia or 0.0) - inertia) <= SAME_INERTIA * inertia for part in parts)


def doubt_losses(losses: Iterable[tuple[str, float | None]]) -> Iterator[str]:
    """Loss factors, by their paths, that nothing has: in percent, most likely."""
    for path, loss in losses:
        if loss is not None and loss > LOSS_MOST:
            yield (
                f"{path} is {loss:g}, where at most {LOSS_MOST:g} is usual; {loss:g} % is "
                f"{loss / 100:g}, and of a relative damping psi the loss factor is psi/(2 pi)"
            )


def _list_losses(torsion: Torsion) -> Iterator[tuple[str, float | None]]:
    """Of all shafts and dampers, by their paths."""
    yield "torsion.loss", torsion.loss
    for end, parts in (("front", torsion.front), ("rear", torsion.rear)):
        for number, part in enumerate(parts, 1):
            yield f"torsion.{end}.{number}.loss", part.loss
            if part.damper is not None:
                yield f"torsion.{end}.{number}.damper.loss", part.damper.loss


def _throw_stiffness(torsion: Torsion, model: EngineFile) -> Iterator[str]:
    """A crankshaft that the torque of a cylinder would wind up."""
    if model.piston.bore is None or not torsion.throw_stiffness:
        return
    work = 1e-3 * math.pi / 4 * model.piston.bore**2 * model.crank.stroke  # J at 10 bar, N m
    twist = work / min(torsion.throw_stiffness)
    if twist > TWIST_MOST:
        yield (
            "torsion.throw_stiffness: a mean pressure of 10 bar would twist a throw by "
            f"{twist:.2g} rad, where at most {TWIST_MOST:g} is usual; "
            f"{ask_unit('N m/rad', '1.2 MN m/rad')}"
        )


def _flywheel_inertia(model: EngineFile) -> float:
    """In kg mm2; 0 where the file gives none."""
    if model.flywheel is None:
        return 0.0
    given = model.flywheel
    return given.inertia or (given.mass or 0.0) * (given.radius_of_gyration or 0.0) ** 2


def _has_crosshead(model: EngineFile) -> bool:
    """Whether the stroke is as long as only engines with a crosshead have it."""
    bore = model.piston.bore
    return bore is not None and model.crank.stroke > LONG_STROKE * bore


def _round(value: float) -> str:
    """Two significant digits, without an exponent where it can be read."""
    return f"{float(f'{value:.2g}'):.12g}"


def _lambda(model: EngineFile) -> float | None:
    length = model.rod.length
    return model.rod.ratio if length is None else model.crank.stroke / 2 / length


def _rod_length(model: EngineFile) -> float | None:
    ratio = model.rod.ratio
    return model.rod.length if ratio is None else model.crank.stroke / 2 / ratio


def _piston_mass(model: EngineFile) -> float:
    """Of a whole piston, kg."""
    piston = model.piston
    parts = (piston.mass, piston.piston, piston.pin, piston.rings, piston.locks)
    return sum(mass for mass in parts if mass is not None)


def _name_piston_mass(model: EngineFile) -> str:
    """The keys that it is read from, with their verb."""
    keys = ("piston", "pin", "rings", "locks")
    parts = {key: mass for key in keys if (mass := getattr(model.piston, key)) is not None}
    if not parts:
        return "piston.mass is"
    heaviest = max(parts, key=parts.__getitem__)
    together = join_words([f"piston.{key}" for key in parts])
    return f"{together} (most of it piston.{heaviest}, {parts[heaviest]:.4g} kg) are together"


def _rod_mass(model: EngineFile) -> float | None:
    rod = model.rod
    return rod.mass if rod.small_end is None or rod.big_end is None else rod.small_end + rod.big_end


def _rod_and_piston(model: EngineFile) -> float:
    """One of each, kg."""
    return _piston_mass(model) + (_rod_mass(model) or 0.0)


def _find_gap_in_bank(model: EngineFile) -> float | None:
    """Least distance of two cylinders of one bank, mm; None where it is not known, or where rows
    of a radial or cylinders with axes of their own may reach between one another.
    """
    layout, crank = model.layout, model.crank
    own = [c for c in model.cylinder.values() if c.bank is not None or c.position is not None]
    if layout.radial is not None or own:
        return None
    throws, _ = _throws_and_rods(model)
    # from one throw of a bank to its next
    step = _count_banks(layout) if layout.rods == "alternating" else 1
    if step >= throws:
        return None
    if crank.positions is None:
        return None if crank.spacing is None else step * crank.spacing
    return min(abs(b - a) for a, b in zip(crank.positions, crank.positions[step:], strict=False))


def _spacing(model: EngineFile) -> float | None:
    places = sorted(model.crank.positions or ())
    return min((b - a for a, b in pairwise(places)), default=model.crank.spacing)


def _throws_and_rods(model: EngineFile) -> tuple[int, int]:
    """How many there are; without throws, the firing order tells the number of rods."""
    layout = model.layout
    rods_on_a_throw = _count_banks(layout) if layout.rods == "shared" else 1
    if model.crank.throws is None and layout.firing_order:
        return max(len(layout.firing_order) // rods_on_a_throw, 1), len(layout.firing_order)
    throws = len(model.crank.throws or (0.0,))
    return throws, throws * rods_on_a_throw


def _count_banks(layout: Layout) -> int:
    return 2 if layout.bank_angle is not None else len(layout.banks or ()) or layout.radial or 1


def _unbalance(weight: Counterweight) -> float:
    """In g mm."""
    if weight.unbalance is not None:
        return weight.unbalance
    return (weight.mass or 0.0) * 1e3 * (weight.radius or 0.0)
