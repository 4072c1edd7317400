"""Build an engine from its file, in stages. Read this module first.

An engine is a crankshaft with throws, and cylinders in banks. The cylinders of one throw share a
crank pin, unless the pin is split. Each stage is a function of earlier stages; `engine.parts` runs
a stage when its result is first needed:

1. plan: the cylinders with their banks and throws (`plan_cylinders`),
2. running gears: piston and rod of each cylinder, from the keys that describe them (`find_gears`),
3. pins: axes of the cylinders and angles of their crank pins, from the throws that the file gives
   or from its firing order (`set_pins`),
4. masses: masses as a workshop weighs them (`weigh_cylinders`),
5. places: positions along the crank (`find_places`),
6. cylinders: arrays of all these figures, one row for each cylinder (`arrange_cylinders`).

An engine must obey rules: a rod lets its crank turn, every cylinder is at top dead centre when it
fires, and so on. The groups of `RULES` are checked from early stages to late ones. The first group
with mistakes ends the check, because later rules presuppose earlier ones. Mistakes in tables that
the rules do not need do not prevent these checks (`engine.parse`).

Variants of an engine are built in the same way: the argument `varied` of `build` has arrays that
replace figures of the file, and every stage accepts arrays as well as numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, cast

import numpy as np

from ..core.cylinders import Device
from ..core.mechanisms import harmonics
from ..core.mechanisms.linkage import STEPS, Articulated, Linkage, Rotary, revolution
from ..core.mechanisms.motion import Motion
from ..core.phasors import Array, Figure
from ..core.speed_ripple import RippleLine, find_slowest
from ..errors import InputError, Problem
from ..file.fields import counted
from ..file.model import EngineFile
from ..file.read import Draft
from ..limits import MOST_SAMPLES, NEAREST_TO_LOCK
from .devices import build_devices, check_drifting, check_shafts
from .engine import Bearings, Engine, Rating
from .figures import column, find_wheel, value_or
from .firing.rules import check_numbering
from .layout import Plan, are_places_known
from .left_out import list_inferred
from .parts import Parts
from .placed import build_geared
from .rods import check_ends, check_harmonic, check_rod_inertia, check_turning

if TYPE_CHECKING:
    from .gas import EngineGas


def build(
    model: EngineFile,
    varied: Mapping[str, Figure] | None = None,
    *,
    rank: int = 0,
    gas: EngineGas | None = None,
) -> Engine:
    """Return the engine that a file describes, or variants of this engine.

    Args:
        model: Engine file whose tables are valid.
        varied: Numbers or arrays that replace figures, by dotted name (`rod.ratio`,
            `crank.throws.2`). The arrays broadcast against each other. If a figure varies and the
            file gives throws, the firing order is ignored, unless the file has [gas] and all
            values are numbers.
            Arrays of the figures of a computed gas cycle (`parts.list_joint_paths`) give only the
            gas trailing axes, and count as numbers otherwise.
        rank: Minimum number of trailing axes (the last axes of each array, along which figures
            differ from variant to variant). A figure that does not vary along one of these axes
            has length 1 there; so has a result that depends only on such figures.
        gas: Gas of the engine, if it is already known.

    Raises:
        InputError: Tables do not fit together; the error lists the mistakes by path.
        BalcliError: These figures cannot vary together, or not in this file (`FileFigures`).
    """
    if model.engine:
        return build_geared(model, varied, partial(build, rank=rank))
    parts = assemble(model, varied, rank=rank, gas=gas)
    figures = parts.figures
    places = parts.places
    bore = figures.take_optional("piston.bore", model.piston.bore)
    devices = tuple(build_devices(parts))
    bearings = None
    power = model.operation.power
    if (table := model.bearing) is not None:
        pairs = (table.pin_diameter, table.pin_width), (table.main_diameter, table.main_width)
        pin, main = (None if a is None or b is None else a * b * 1e-6 for a, b in pairs)
        rings = (table.pin_diameter, table.pin_bore), (table.main_diameter, table.main_bore)
        pin_m, main_m = (
            None if outer is None else (outer / 1e3, inner / 1e3) for outer, inner in rings
        )
        mains = table.main_positions
        mains_m = None if mains is None else tuple(place / 1e3 for place in mains)
        bearings = Bearings(pin, main, pin_m, main_m, mains_m)
    return Engine(
        name=model.name,
        source=model.source,
        numbers=parts.numbers,
        cylinders=parts.cylinders,
        fires_deg=parts.fires_deg,
        strokes=model.layout.strokes,
        bore_m=math.nan if bore is None else bore / 1e3,
        bores_m=_find_bores(parts, math.nan if bore is None else bore),
        throws_m=places.throws,
        throw_radii_m=column([stroke / 2e3 for stroke in parts.throw_strokes], parts.rank),
        pins_m=places.pins,
        speed_rpm=figures.take("operation.speed", model.operation.speed),
        ripple=parts.find_ripple(),
        reference_m=places.reference,
        up_deg=model.frame.up,
        devices=devices,
        weighed=tuple(parts.weighed[number] for number in parts.numbers),
        places_known=are_places_known(model, parts.plan, varied or ()),
        gas=parts.gas,
        crank_inertia=find_crank_inertia(parts, devices),
        webs=parts.webs,
        flywheel_inertia=None if model.flywheel is None else find_wheel(figures, model.flywheel),
        bearings=bearings,
        rated=Rating(model.operation.speed, None if power is None else 1e3 * power),
        inferred=() if varied else tuple(list_inferred(parts)),
        model=None if varied else model,
        of_locomotive=model.locomotive is not None,
    )


def _find_bores(parts: Parts, general: Figure) -> tuple[Figure, ...]:
    """Return the bore of each cylinder, m; empty if all have that of [piston] (`general`, mm)."""
    bores = [parts.override(number, "bore") for number in parts.numbers]
    if all(bore is None for bore in bores):
        return ()
    return tuple(value_or(bore, general) / 1e3 for bore in bores)


def find_crank_inertia(parts: Parts, devices: Iterable[Device]) -> Figure | None:
    """Return the polar moment of inertia of the crankshaft, kg m2: `crank.inertia`, or that of
    webs, pins and counterweights together; None if it is not known.

    Args:
        parts: Stages of the engine.
        devices: All devices of the file.
    """
    given = parts.figures.take_optional("crank.inertia", parts.model.crank.inertia)
    if given is not None:
        return given / 1e6
    if parts.webs is None or parts.webs.inertia is None:
        return None
    of_weights = [device.spin for device in devices if device.is_counterweight]
    return sum(of_weights, parts.webs.inertia)


def assemble(
    model: EngineFile,
    varied: Mapping[str, Figure] | None = None,
    *,
    rank: int = 0,
    gas: EngineGas | None = None,
) -> Parts:
    """Return the stages of an engine that obeys all rules; arguments and errors as for `build`."""
    parts = Parts(model, varied, rank, known_gas=gas)
    if problems := find_contradictions(parts):
        raise InputError(problems)
    return parts


# ------------------------------------------------------------------ rules between the stages
# Tables that are needed to find contradictions between tables.
_NEEDED = frozenset(
    {
        *("crank", "rod", "piston", "layout", "articulation", "cylinder", "gas"),
        *("locomotive", "axle", "counterweight", "bearing", "web"),
    }
)


def list_contradictions(draft: Draft) -> list[Problem]:
    """Return the contradictions between the tables of a file that has other mistakes; empty if a
    table in `_NEEDED` has mistakes.
    """
    return find_contradictions(Parts(draft.model)) if draft.readable >= _NEEDED else []


def find_contradictions(parts: Parts) -> list[Problem]:
    """Return the contradictions between tables of a file.

    The rules of a group presuppose those of earlier groups, so only the first group with mistakes
    is reported. Each mistake is reported once.
    """
    for rules in RULES:
        problems: list[Problem] = []
        for check in rules:
            try:
                problems += check(parts)
            except InputError as error:  # a stage cannot be computed
                problems += error.problems
        if problems:
            return list(dict.fromkeys(problems))
    return []


def check_cylinders(parts: Parts) -> Iterator[Problem]:
    """Check that throws and banks make the cylinder of every [cylinder.N]."""
    made = f"crank.throws and layout make {counted(len(parts.plan.cells), 'cylinder')}"
    strangers = [number for number in parts.model.cylinder if number not in parts.plan.numbers]
    if strangers:
        message = f"there is no cylinder {', '.join(map(str, strangers))}"
        yield Problem(
            f"cylinder.{strangers[0]}", f"{message}: {made}; put all throws in crank.throws"
        )


def check_rods(parts: Parts) -> Iterator[Problem]:
    """Check that every rod has a moment of inertia and lets its crank turn.

    `check_knuckles` checks articulated rods, because their motion depends on the master rod.
    """
    model = parts.model
    harmonic = parts.model.rod.motion == "harmonic"
    fixed = model.articulation is None and not model.layout.rotary
    each = (parts.find_rod(number, number in parts.masters) for number in parts.plan.numbers)
    # Rods with equal figures are checked once.
    for place in {parts.kind_of_rod(place): place for place in each}.values():
        gear = parts.weigh_gear(place)
        one_end = list(check_ends(place))
        if harmonic:
            yield from one_end or check_harmonic(place, fixed=fixed)
            continue
        yield from one_end or check_rod_inertia(place, gear)
        if not place.articulated:
            yield from check_turning(place, gear, parts.find_radius(place.number))


def check_main_bearings(parts: Parts) -> Iterator[Problem]:
    """Check that there are at least two main bearings, ascending, and none at a throw."""
    bearing = parts.model.bearing
    places = () if bearing is None else bearing.main_positions or ()
    listed = ", ".join(f"{place:g}" for place in places)
    if len(places) == 1:
        message = f"[{listed}] is a single place; give two or more"
        yield Problem("bearing.main_positions", message)
    for before, after in pairwise(places):
        if before >= after:
            message = f"[{listed}]: {after:g} follows {before:g}; give the places ascending"
            yield Problem("bearing.main_positions", message)
            return
    throws = {round(1e3 * float(z), 9) for z in np.ravel(parts.places.throws)}
    for place in places:
        if round(place, 9) in throws:
            message = (
                f"{place:g} mm is the position of a throw; give the middle of each main bearing"
            )
            yield Problem("bearing.main_positions", message)


def check_webs(parts: Parts) -> Iterator[Problem]:
    """Check that [[web]] fits the crank: the rules of `engine.web_rules`."""
    if parts.model.web:
        from .web_rules import check_webs  # loaded only for files with [[web]]

        yield from check_webs(parts)


def check_web_places(parts: Parts) -> Iterator[Problem]:
    """Check that throws with webs have places of their own."""
    if parts.model.web:
        from .web_rules import check_web_places

        yield from check_web_places(parts)


def check_carriers(parts: Parts) -> Iterator[Problem]:
    """Check that no counterweight names an engine in a file without [[engine]]."""
    for number, weight in enumerate(parts.model.counterweight, 1):
        if weight.engine is not None:
            message = f'"{weight.engine}": this file has no [[engine]]; leave it out'
            yield Problem(f"counterweight.{number}.engine", message)


def check_articulation(parts: Parts) -> Iterator[Problem]:
    """Check that articulated rods have a master rod on their throw, one knuckle angle for each
    bank, and no crank pins of their own.
    """
    if (articulation := parts.model.articulation) is None:
        return
    if fault := _find_no_place(articulation.masters, parts.plan):
        yield fault
        return
    yield from _check_knuckle_angles(parts)
    if np.any(np.asarray(parts.figures.take("crank.splay", parts.model.crank.splay)) != 0):
        message = "articulated rods have no crank pins to split: leave out splay or [articulation]"
        yield Problem("crank.splay", message)
    for number in parts.masters:
        if parts.override(number, "throw") is not None:
            message = "its articulated rod is carried by the master rod: leave this out"
            yield Problem(f"cylinder.{number}.throw", message)
        if parts.override(number, "stroke") is not None:
            message = (
                "an articulated rod moves with its master's throw; set the stroke of the throw"
            )
            yield Problem(f"cylinder.{number}.stroke", message)


def _check_knuckle_angles(parts: Parts) -> Iterator[Problem]:
    """Check that the knuckle angle of the master rod's bank is 0 on every throw."""
    rows = parts.find_knuckle_angles() or ()
    for master, angles in zip(parts.find_master_places(), rows, strict=False):
        if np.any(np.asarray(angles[master - 1]) != 0):
            angle = max(np.ravel(angles[master - 1]), key=abs)
            message = f"has {angle:g} for bank {master}, which carries the master rod; give 0"
            yield Problem("articulation.knuckle_angles", message)


def _find_no_place(masters: Sequence[int], plan: Plan) -> Problem | None:
    """Return the mistake if no throw carries rods of several banks, or if the master's bank is
    missing.
    """
    banks = plan.banks
    needs = f"needs a throw that carries the rods of several banks; this engine has {banks} bank"
    if banks < 2:
        return Problem("articulation", f"{needs}: give bank_angle, banks or radial")
    if plan.rods_on_throw < banks:
        message = f'{needs}s with rods = "alternating", one rod a throw: give rods = "shared"'
        return Problem("articulation", message)
    if (master := max(masters)) > banks:
        message = f"there is no bank {master}; this engine has banks 1 to {banks}"
        return Problem("articulation.master", message)
    return None


def check_knuckles(parts: Parts) -> Iterator[Problem]:
    """Check that every articulated rod can follow its knuckle pin through a revolution, in every
    variant.
    """
    if parts.model.articulation is None:
        return
    cylinders = parts.cylinders
    numbers = parts.numbers
    linkage = cast(Linkage, cylinders.linkage)
    lam = cylinders.lam
    eps = cylinders.eps
    hung = cast(Articulated, linkage.hung if isinstance(linkage, Rotary) else linkage)
    # A knuckle pin is at most crank radius + knuckle radius away from the crank axis.
    if np.all(lam * (1 + np.abs(hung.knuckle)) + np.abs(eps) <= 1 - NEAREST_TO_LOCK):
        return

    def find_largest(motion: Motion) -> Array:
        lean = np.abs(motion.lean)
        return lean.reshape(len(numbers), -1, lean.shape[-1]).max(axis=1)

    with np.errstate(invalid="ignore"):  # a rod that is too short has no angle
        leans = hung.sample(find_largest, revolution(STEPS), lam, eps)
    turned = cylinders.angle_deg.reshape(len(numbers), -1)[:, 0]
    for row, number in enumerate(numbers):
        worst = int(leans[row].argmax())
        before, at, after = (leans[row, (worst + k) % STEPS] for k in (-1, 0, 1))
        bend = 2 * at - before - after
        # The vertex of the parabola through the sampled maximum and its neighbours.
        lean = at + ((after - before) ** 2 / (8 * bend) if bend > 0 else 0.0)
        if hung.master[row] == row or lean <= 1 - NEAREST_TO_LOCK:
            continue
        own = parts.model.cylinder.get(number)
        crank_deg = (360 / STEPS * worst - turned[row]) % 360
        general = own is None or (own.rod_length is None and own.rod_ratio is None)
        yield Problem(
            "articulation.rod.length" if general else f"cylinder.{number}.rod_length",
            f"the crank cannot turn: at crank angle {crank_deg:.4g} deg the knuckle pin of "
            f"cylinder {number} is {lean:.9g} rod lengths off the path of its piston pin; at "
            f"most 1 - {NEAREST_TO_LOCK:g} is allowed: make the articulated rod longer or the "
            "knuckle radius smaller",
        )


def check_half_orders(parts: Parts) -> Iterator[Problem]:
    """Check that the uneven speed has half orders only with gas and four strokes."""
    if parts.model.gas is not None and parts.model.layout.strokes == 4:
        return
    for number, line in enumerate(parts.model.operation.speed_ripple, 1):
        if line.order % 1:
            message = (
                f"{line.order:g} is not a whole number; half orders need four strokes and [gas]"
            )
            yield Problem(f"operation.speed_ripple.{number}.order", message)


def check_speed(parts: Parts) -> Iterator[Problem]:
    """Check that an uneven speed stays above 0, for every variant."""
    if not (lines := parts.find_ripple()):
        return
    orders = [line.order for line in lines]
    figures = [figure for line in lines for figure in (line.amplitude, line.angle_deg)]
    columns = map(np.ravel, np.broadcast_arrays(*figures))
    for variant in zip(*columns, strict=True):
        amplitudes = variant[::2]
        angles = variant[1::2]
        if sum(map(abs, amplitudes)) < 1 - STANDSTILL:
            continue
        slowest = find_slowest(list(map(RippleLine, orders, amplitudes, angles)))
        if slowest.value <= STANDSTILL:
            share = slowest.value if abs(slowest.value) > STANDSTILL else 0.0
            turns = "turn back" if share else "stop"
            message = (
                f"the crank would {turns}: at crank angle {math.degrees(slowest.theta):.4g} deg "
                f"its speed is {share:.4g} of the mean: make the amplitudes smaller; they are "
                "shares of the mean speed"
            )
            yield Problem("operation.speed_ripple", message)
            return


def check_samples(parts: Parts) -> Iterator[Problem]:
    """Check that not too many different mechanisms are close to locking, because these need many
    samples.
    """
    c = parts.cylinders
    if parts.rank or c.count * harmonics.HARDEST <= MOST_SAMPLES:
        return
    different, samples = c.count_all_samples()
    if samples > MOST_SAMPLES:
        message = (
            f"{different} different mechanisms need {samples} samples of a revolution; at most "
            f"{MOST_SAMPLES} are taken: make the shortest rods longer, or more of them equal"
        )
        yield Problem("cylinder", message)


def check_locomotive(parts: Parts) -> Iterator[Problem]:
    """Check that cranks and counterweights of a locomotive stand on its axles."""
    model = parts.model
    if model.locomotive is not None:
        weights = [weight.axle for weight in model.counterweight]
        rpm = model.operation.speed if model.operation.has("speed") else None
        yield from model.locomotive.find_faults(model.axle, parts.plan.numbers, weights, rpm)
    elif model.axle or any(weight.axle for weight in model.counterweight):
        yield Problem.of_missing("locomotive", "[[axle]] needs it; write [locomotive]")


def check_gas(parts: Parts) -> Iterator[Problem]:
    """Build the gas of all cylinders. Without [gas], check that no cylinder has gas keys.

    Raises:
        InputError: [gas], or a file that it names, has mistakes.
    """
    if parts.model.gas is None:
        order = parts.model.layout.firing_order or ()
        for number, own in parts.model.cylinder.items():
            for key in ("gas", "heat", "indicator"):
                dummy = key == "gas" and own.gas == 0 and number not in order
                if getattr(own, key) is not None and not dummy:
                    message = "needs [gas], which describes the gas in all cylinders"
                    yield Problem(f"cylinder.{number}.{key}", message)
    elif not parts.rank:
        from .build_gas import build_gas  # loaded only for files with [gas]

        speed = parts.figures.take("operation.speed", parts.model.operation.speed)
        parts.gas = (parts.gas or build_gas(parts)).at(float(speed))


STANDSTILL = 1e-12  # speeds below this share of the mean speed count as 0
RULES: tuple[tuple[Callable[[Parts], Iterator[Problem]], ...], ...] = (
    # plan and running gears
    (check_cylinders, check_articulation, check_rods, check_half_orders, check_speed),
    (check_carriers, check_main_bearings),
    (check_webs,),
    (check_web_places,),
    (check_knuckles, check_shafts, check_drifting),  # pins and balancer shafts
    (check_numbering,),  # firing angles
    (check_samples,),  # cylinders
    (check_gas, check_locomotive),
)
