"""Engine file -> engine: the page to read first.

An engine is a crankshaft with throws, and cylinders in banks: the cylinders of one throw share
a crank pin, unless it is split. `build` makes it in stages, each a
function of the stages before it. `engine.parts` makes a stage when it is first needed:

1. plan: which cylinders there are, on which bank and throw (`plan_cylinders`),
2. running gears: piston and rod of each, from the keys that a file may use for them (`find_gears`),
3. pins: axes of the cylinders and angles of their crank pins, from the throws that the file gives
   or from its firing order (`set_pins`),
4. masses: what a workshop would weigh (`weigh_cylinders`),
5. places: positions along the crank (`find_places`),
6. cylinders: arrays of all these, one row a cylinder (`arrange_cylinders`).

An engine has to keep rules: a rod lets its crank turn, every cylinder is at top dead centre when it
fires, and so on. The groups of `RULES` go from early stages to late ones; the first group with
mistakes ends the search, because later rules presuppose earlier ones. A file with mistakes in
tables that do not make the engine is checked by the same rules (`engine.parse`).

Variants take the same way: `varied` puts arrays in place of figures of the file, and every stage
works on arrays as it does on numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, cast

import numpy as np

from ..core.mechanisms import harmonics
from ..core.mechanisms.linkage import STEPS, Articulated, Linkage, Rotary, revolution
from ..core.mechanisms.motion import Motion
from ..core.phasors import Array, Figure
from ..core.speed_ripple import RippleLine, find_slowest
from ..errors import InputError, Problem
from ..file.fields import counted, join_words
from ..file.model import EngineFile
from ..file.read import Draft
from ..limits import MOST_SAMPLES, NEAREST_TO_LOCK
from ..names import GEARED, import_name
from .devices import build_devices
from .engine import Bearings, Engine, Rating
from .figures import FileFigures, divide
from .layout import Plan, are_places_known
from .numbering import check_numbering, list_inferred
from .parts import Parts
from .rods import check_ends, check_rod_inertia, check_turning

if TYPE_CHECKING:
    from ..file.gas_tables import Flywheel
    from .gas import EngineGas


def build(
    model: EngineFile,
    varied: Mapping[str, Figure] | None = None,
    *,
    rank: int = 0,
    gas: EngineGas | None = None,
) -> Engine:
    """Return the engine that a file describes, or variants of it.

    Args:
        model: Engine file, each table of it checked.
        varied: Arrays, which broadcast against each other, in place of some figures, by dotted name
            (`rod.ratio`, `crank.throws.2`). With given throws and without [gas], the firing order
            is then ignored.
        rank: Least number of trailing axes. A figure that does not vary along one has length 1
            there, and so has everything that is computed from it.
        gas: Gas of the engine, if it is known already.

    Raises:
        InputError: Tables do not fit together; the error lists the mistakes by path.
        BalcliError: Figures cannot vary because the file gives others in their place.
    """
    if model.engine:
        return cast(Engine, import_name(GEARED)(model, varied, rank))
    parts = assemble(model, varied, rank=rank, gas=gas)
    figures, places = parts.figures, parts.places
    bore = figures.take_optional("piston.bore", model.piston.bore)
    inertia = figures.take_optional("crank.inertia", model.crank.inertia)
    bearings, power = None, model.operation.power
    if (table := model.bearing) is not None:
        pairs = (table.pin_diameter, table.pin_width), (table.main_diameter, table.main_width)
        bearings = Bearings(*(None if a is None or b is None else a * b * 1e-6 for a, b in pairs))
    return Engine(
        name=model.name,
        source=model.source,
        numbers=parts.numbers,
        cylinders=parts.cylinders,
        fires_deg=parts.fires_deg,
        strokes=model.layout.strokes,
        bore_m=math.nan if bore is None else bore / 1e3,
        throws_m=places.throws,
        pins_m=places.pins,
        speed_rpm=figures.take("operation.speed", model.operation.speed),
        ripple=parts.find_ripple(),
        reference_m=places.reference,
        up_deg=model.frame.up,
        devices=tuple(build_devices(model, figures, parts.pins.axes_deg[1])),
        weighed=tuple(parts.weighed[number] for number in parts.numbers),
        places_known=are_places_known(model, parts.plan, varied or ()),
        gas=parts.gas,
        crank_inertia=divide(inertia, 1e6),
        flywheel_inertia=None if model.flywheel is None else find_wheel(figures, model.flywheel),
        bearings=bearings,
        rated=Rating(model.operation.speed, None if power is None else 1e3 * power),
        inferred=() if varied else tuple(list_inferred(parts)),
        model=None if varied else model,
    )


def assemble(
    model: EngineFile,
    varied: Mapping[str, Figure] | None = None,
    *,
    rank: int = 0,
    gas: EngineGas | None = None,
) -> Parts:
    """Return the stages of an engine that keeps all rules. Arguments and errors are those of
    `build`.
    """
    parts = Parts(model, varied, rank, known_gas=gas)
    if problems := find_contradictions(parts):
        raise InputError(problems)
    return parts


def find_wheel(figures: FileFigures, table: Flywheel) -> Figure | None:
    """Return the moment of inertia of the flywheel, kg m2."""
    inertia, mass, radius = (
        figures.take_optional(f"flywheel.{key}", getattr(table, key))
        for key in ("inertia", "mass", "radius_of_gyration")
    )
    if mass is None or radius is None:
        return divide(inertia, 1e6)
    return mass * (radius * 1e-3) ** 2


# ------------------------------------------------------------------ rules between the stages
# Tables needed to find contradictions between tables.
_NEEDED = frozenset({"crank", "rod", "piston", "layout", "articulation", "cylinder", "gas"})


def list_contradictions(draft: Draft) -> list[Problem]:
    """Return the contradictions between the tables of a file with mistakes; none if a table that
    makes the engine cannot be read.
    """
    return find_contradictions(Parts(draft.model)) if draft.readable >= _NEEDED else []


def find_contradictions(parts: Parts) -> list[Problem]:
    """Return the contradictions between tables of a file.

    The rules of a group presuppose those of the groups before it, so that only the first group with
    mistakes is reported, each mistake once.
    """
    for rules in RULES:
        problems: list[Problem] = []
        for check in rules:
            try:
                problems += check(parts)
            except InputError as error:  # a stage that cannot be made
                problems += error.problems
        if problems:
            return list(dict.fromkeys(problems))
    return []


def check_cylinders(parts: Parts) -> Iterator[Problem]:
    """Check that throws and banks make an engine which has all cylinders that tables name."""
    made = f"crank.throws and layout make {counted(len(parts.plan.cells), 'cylinder')}"
    strangers = [number for number in parts.model.cylinder if number not in parts.plan.numbers]
    if strangers:
        there = join_words([str(number) for number in strangers])
        none = "are no cylinders" if len(strangers) > 1 else "is no cylinder"
        told = f"there {none} {there}: {made}; give every throw its angle"
        yield Problem(f"cylinder.{strangers[0]}", told)


def check_rods(parts: Parts) -> Iterator[Problem]:
    """Check that every rod has a moment of inertia and lets its crank turn.

    Whether an articulated rod can follow its knuckle pin depends on its master: `check_knuckles`.
    """
    checked = set()
    for number in parts.plan.numbers:
        place = parts.find_rod(number, number in parts.masters)
        rod = number if number in parts.tables else 0, place.articulated
        if rod in checked:
            continue
        checked.add(rod)
        gear, one_end = parts.weigh_gear(place), list(check_ends(place))
        yield from one_end or check_rod_inertia(place, gear)
        if not place.articulated:
            yield from check_turning(place, gear, parts.radius)


def check_carriers(parts: Parts) -> Iterator[Problem]:
    """Check that no counterweight names an engine where there is one alone."""
    for number, weight in enumerate(parts.model.counterweight, 1):
        if weight.engine is not None:
            told = f'"{weight.engine}": this file has no [[engine]]; leave it out'
            yield Problem(f"counterweight.{number}.engine", told)


def check_articulation(parts: Parts) -> Iterator[Problem]:
    """Check that articulated rods have a master rod on their throw, one knuckle angle for each
    bank, and no crank pins of their own.
    """
    if (articulation := parts.model.articulation) is None:
        return
    if fault := _find_no_place(articulation.master, parts.plan):
        yield fault
        return
    angles, path = parts.find_knuckle_angles(), "articulation.knuckle_angles"
    banks, master = parts.plan.banks, articulation.master
    if angles is not None and len(angles) != banks:
        told = f"has {counted(len(angles), 'angle')} for {counted(banks, 'bank')}"
        yield Problem(path, f"{told}: give one for each, the master's own is 0")
    elif angles is not None and np.any(np.asarray(angles[master - 1]) != 0):
        angle = max(np.ravel(angles[master - 1]), key=abs)
        told = f"has {angle:g} for bank {master}, which carries the master rod: its own is 0"
        yield Problem(path, told)
    if np.any(np.asarray(parts.figures.take("crank.splay", parts.model.crank.splay)) != 0):
        told = "articulated rods have no crank pins to split: leave splay out, or [articulation]"
        yield Problem("crank.splay", told)
    for number in parts.masters:
        if parts.override(number, "throw") is not None:
            told = "its articulated rod hangs on the master rod: leave this out"
            yield Problem(f"cylinder.{number}.throw", told)


def _find_no_place(master: int, plan: Plan) -> Problem | None:
    """Return the mistake if no throw carries a master rod and others, or the bank is missing."""
    banks = plan.banks
    needs = f"needs a throw that carries the rods of several banks; this engine has {banks} bank"
    if banks < 2:
        return Problem("articulation", f"{needs}: give bank_angle, banks or radial")
    if plan.rods_on_throw < banks:
        told = f'{needs}s with rods = "alternating", one rod a throw: give rods = "shared"'
        return Problem("articulation", told)
    if master > banks:
        told = f"there is no bank {master}; this engine has banks 1 to {banks}"
        return Problem("articulation.master", told)
    return None


def check_knuckles(parts: Parts) -> Iterator[Problem]:
    """Check that every articulated rod can follow its knuckle pin through a revolution, for the
    worst of all variants.
    """
    if parts.model.articulation is None:
        return
    cylinders, numbers = parts.cylinders, parts.numbers
    linkage, lam, eps = cast(Linkage, cylinders.linkage), cylinders.lam, cylinders.eps
    hung = cast(Articulated, linkage.hung if isinstance(linkage, Rotary) else linkage)
    # Knuckle pins are at most a crank and a knuckle radius away.
    if np.all(lam * (1 + np.abs(hung.knuckle)) + np.abs(eps) <= 1 - NEAREST_TO_LOCK):
        return

    def find_largest(motion: Motion) -> Array:
        lean = np.abs(motion.lean)
        return lean.reshape(len(numbers), -1, lean.shape[-1]).max(axis=1)

    with np.errstate(invalid="ignore"):  # beyond 1 there is no angle
        leans = hung.sample(find_largest, revolution(STEPS), lam, eps)
    turned = cylinders.angle_deg.reshape(len(numbers), -1)[:, 0]
    for row, number in enumerate(numbers):
        worst = int(leans[row].argmax())
        before, at, after = (leans[row, (worst + k) % STEPS] for k in (-1, 0, 1))
        bend = 2 * at - before - after
        # The top of the parabola through the sampled maximum and its neighbours
        lean = at + ((after - before) ** 2 / (8 * bend) if bend > 0 else 0.0)
        if hung.master[row] == row or lean <= 1 - NEAREST_TO_LOCK:
            continue
        own, crank_deg = parts.model.cylinder.get(number), (360 / STEPS * worst - turned[row]) % 360
        general = own is None or (own.rod_length is None and own.rod_ratio is None)
        yield Problem(
            "articulation.rod.length" if general else f"cylinder.{number}.rod_length",
            f"the crank cannot turn: at crank angle {crank_deg:.4g} deg the knuckle pin of "
            f"cylinder {number} stands {lean:.9g} rod lengths off the path of its piston pin; at "
            f"most 1 - {NEAREST_TO_LOCK:g} is allowed: make the articulated rod longer or the "
            "knuckle radius smaller",
        )


def check_half_orders(parts: Parts) -> Iterator[Problem]:
    """Check half orders of the speed: they need gas and four strokes, their only cause."""
    if parts.model.gas is not None and parts.model.layout.strokes == 4:
        return
    for number, line in enumerate(parts.model.operation.speed_ripple, 1):
        if line.order % 1:
            told = f"{line.order:g} is no whole number; half orders take four strokes and [gas]"
            yield Problem(f"operation.speed_ripple.{number}.order", told)


def check_speed(parts: Parts) -> Iterator[Problem]:
    """Check that an uneven speed stays above 0, for every variant."""
    if not (lines := parts.find_ripple()):
        return
    orders = [line.order for line in lines]
    figures = [figure for line in lines for figure in (line.amplitude, line.angle_deg)]
    columns = map(np.ravel, np.broadcast_arrays(*figures))
    for variant in zip(*columns, strict=True):
        amplitudes, angles = variant[::2], variant[1::2]
        if sum(map(abs, amplitudes)) < 1 - STANDSTILL:
            continue
        slowest = find_slowest(list(map(RippleLine, orders, amplitudes, angles)))
        if slowest.value <= STANDSTILL:
            share = slowest.value if abs(slowest.value) > STANDSTILL else 0.0
            told = f"the crank would {'turn back' if share else 'stop'}: at crank angle "
            told += f"{math.degrees(slowest.theta):.4g} deg its speed is {share:.4g} of the mean: "
            told += "make the amplitudes smaller, they are shares of the mean speed"
            yield Problem("operation.speed_ripple", told)
            return


def check_samples(parts: Parts) -> Iterator[Problem]:
    """Refuse engines with too many unequal mechanisms whose cranks can barely turn: they would take
    too long.
    """
    c = parts.cylinders
    if parts.rank or c.count * harmonics.HARDEST <= MOST_SAMPLES:
        return
    different, samples = c.count_all_samples()
    if samples > MOST_SAMPLES:
        told = f"{different} different mechanisms need {samples} samples of a revolution; at most "
        told += f"{MOST_SAMPLES} are taken: make the shortest rods longer, or more of them equal"
        yield Problem("cylinder", told)


def check_gas(parts: Parts) -> Iterator[Problem]:
    """Build the gas in every cylinder; check that keys of single cylinders have [gas] to refer to.

    Raises:
        InputError: [gas], or a file that it names, has mistakes.
    """
    if parts.model.gas is None:
        for number, own in parts.model.cylinder.items():
            for key in ("gas", "heat", "indicator"):
                dummy = key == "gas" and parts.order is not None and number not in parts.order
                if getattr(own, key) is not None and not dummy:
                    told = "needs [gas], which says what the gas does in all cylinders"
                    yield Problem(f"cylinder.{number}.{key}", told)
    elif parts.gas is None and not parts.rank:
        from .build_gas import build_gas  # files without [gas] do not load it

        parts.gas = build_gas(parts)


STANDSTILL = 1e-12  # shares of the mean speed below this count as 0
RULES: tuple[tuple[Callable[[Parts], Iterator[Problem]], ...], ...] = (
    # plan and running gears
    (check_cylinders, check_articulation, check_rods, check_half_orders, check_speed),
    (check_carriers,),
    (check_knuckles,),  # pins
    (check_numbering,),  # firing angles
    (check_samples,),  # cylinders
    (check_gas,),
)
