"""Balance an engine: compute the devices of a scheme, and the analyses without and with them. Find
knuckle angles that make strokes or dead centres of articulated rods even. Write a remedy (new
devices or knuckle angles) into an engine file.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import NoneType
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray

from ..analysis.answer import Analysis, analyze, shorten
from ..analysis.comparison import analyze_alike
from ..analysis.parts import find_parts
from ..analysis.records import BalanceParts, Devices, PeaksAndOrders, describe_devices
from ..analysis.web_parts import add_fitted
from ..core.cylinders import find_travel
from ..core.mechanisms.linkage import Articulated
from ..core.phasors import Array, unit
from ..core.records import HIDDEN, INLINE, Asked, Node, WrittenAs, change_attributes
from ..core.unbalance import find_permitted_unbalance
from ..engine.build import build
from ..engine.engine import CylinderNumber, Engine, check_engine, refuse_geared
from ..engine.layout import plan_cylinders
from ..engine.parse import parse, parse_dict
from ..engine.parts import Parts
from ..errors import (
    ArgumentError,
    BalcliError,
    InputError,
    check_type,
    list_values,
    naming_file,
)
from ..file.assumed import Assumed
from ..file.edit import format_value, remove_tables, repeat_table, rewrite, set_keys
from ..file.fields import counted, join_words, limit_digits
from ..file.model import EngineFile, Sector
from ..file.plain_tables import take_tables
from ..file.toml import name_file
from ..forces.crankshaft import find_crank_loads
from ..limits import SMALL
from ..show.result import Result
from ..sizing.fit import list_open_webs, list_to_fit, remove_to_fit, size_fit
from ..sizing.ladder import Ladder, find_ladder
from ..sizing.options import FIT, KNUCKLES, LADDER, SCHEMES, SchemeOptions
from ..sizing.placed_steps import fit_steps
from ..sizing.planes import FIELDS, DeviceTable, find_free, name_kind, take_webs
from ..sizing.remedy import FittedTable, Remedy, fit_devices
from ..sizing.room import assume_skirt
from ..sizing.sizing import size
from ..sizing.workshop import (
    Misfit,
    Practical,
    Shapes,
    Tools,
    find_misfits,
    find_practical,
    shape_devices,
)
from .initial import InitialUnbalance, choose_correction_planes, find_initial

_UNEVEN = "sized for steady speed; before and after are at uneven speed"


@dataclass(frozen=True, kw_only=True)
class PermittedUnbalance:
    """Residual unbalance that a grade of ISO 21940-11 permits.

    Attributes:
        grade: Number of the balance grade (16 for G 16): permitted speed of the centre of mass,
            mm/s.
        mass_kg: Mass of the crankshaft.
        each_g_mm: Permitted unbalance at each new counterweight. If scheme factor compares the
            file's counterweights with what each plane needs, or if there are no new counterweights:
            permitted unbalance in each plane.
        planes_m: Correction planes, if there are no new counterweights.
    """

    grade: float
    mass_kg: float
    each_g_mm: float
    planes_m: Annotated[tuple[float, ...], HIDDEN] = ()


@dataclass(frozen=True, kw_only=True)
class FittedRemedy:
    """A remedy in the form of the JSON output.

    Attributes:
        scheme: Name of the scheme.
        step: Step of the ladder whose row is fitted (scheme step).
        steps: Steps of the ladder whose devices are fitted (scheme auto, and scheme step with
            several steps).
        order: Order that the scheme balances; null if the scheme is not for a single order.
        devices: New devices.
        reasons: Reasons for the devices; that for fitted webs comes first.
    """

    scheme: str
    step: str | None = None
    steps: tuple[str, ...] | None = None
    order: int | None
    devices: Annotated[Devices, INLINE]
    reasons: tuple[str, ...]


def describe_remedy(remedy: Remedy) -> FittedRemedy:
    """Return the devices of a remedy and the reasons for them."""
    return FittedRemedy(
        scheme=remedy.scheme,
        step=remedy.step or None,
        steps=remedy.steps,
        order=remedy.order,
        devices=describe_devices(remedy),
        reasons=remedy.every_reason,
    )


def list_details(remedy: Remedy) -> Node:
    """Return the details of a remedy. Its bobweight card, the unbalance that each plane needs and
    has (`planes`), the peaks for each of several factors (`sweep`), the note and the moments that
    single eccentrics leave (`moments_left`) are added, unless they are empty.
    """
    more = {"card": remedy.card, "planes": remedy.needs, "sweep": remedy.sweep, "note": remedy.note}
    more["moments_left"] = remedy.moments_left
    return {**remedy.details, **{key: value for key, value in more.items() if value}}


def shorten_with_bearings(analysis: Analysis) -> PeaksAndOrders:
    """Return the peaks and orders of an analysis, and the largest loads within the crankshaft."""
    return replace(shorten(analysis), bearings=find_crank_loads(analysis.engine))


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Balance(Result):
    """A remedy, and the free forces of the engine without and with it.

    Attributes:
        remedy: New devices and the reasons for them.
        practical: Figures of each device for the workshop, in the order of `remedy.devices`.
        details: Further figures of the scheme, under names that end in the unit.
        assumed: Values that are used because the engine file leaves them out.
        before: Analysis of the engine without the new devices.
        after: Analysis with the new devices, for the same orders.
        permitted: Residual unbalance that a balance grade permits in each plane, if a grade was
            given.
        ladder: Devices that balance the engine, step by step; left out where articulated rods are
            changed.
        parts: Bearing loads of new shafts and shapes of new counterweights, if bearings or a sector
            were given.
        initial: Initial unbalance of the crankshaft in its correction planes, if the file has
            tolerances of webs.
        misfits: Counterweights whose half discs the room around the crank does not have.
        tools: Tools of the workshop.
        every_order: Whether orders were given; then all given orders are shown.
    """

    format: Literal["balcli.balance/1"] = "balcli.balance/1"
    remedy: Annotated[Remedy, WrittenAs(describe_remedy), INLINE]
    practical: tuple[Practical, ...] = ()
    details: Node
    assumed: tuple[Assumed, ...] | None = None
    before: Annotated[Analysis, WrittenAs(shorten_with_bearings)]
    after: Annotated[Analysis, WrittenAs(shorten_with_bearings)]
    permitted: Asked[PermittedUnbalance] = Asked("the command `balcli balance` with grade and mass")
    ladder: Asked[Ladder] = Asked("a scheme that leaves articulated rods unchanged")
    parts: Asked[BalanceParts] = Asked("shapes=Shapes(bearings=(-0.13, 0.13))")
    initial: Asked[InitialUnbalance] = Asked("a file with tolerances of webs")
    misfits: Annotated[tuple[Misfit, ...], HIDDEN] = ()
    tools: Annotated[Tools, HIDDEN] = field(default_factory=Tools)
    every_order: Annotated[bool, HIDDEN] = False

    @property
    def webs_fit(self) -> bool:
        """Whether all fitted webs have room for their counterweights."""
        return all(web.missing is None for web in self.remedy.webs)

    @property
    def summary(self) -> str:
        """Name of the scheme, its devices and the engine, in words."""
        count = len(self.remedy.devices) + len(self.remedy.beyond)
        fitted = [counted(len(self.remedy.webs), "web")] if self.remedy.webs else []
        if count or not fitted:
            fitted.append(counted(count, "device"))
        return f"{self.remedy.scheme}: {join_words(fitted)} for {self.before.engine.summary}"


def balance(
    engine: Engine,
    scheme: str = "auto",
    options: SchemeOptions | None = None,
    orders: Iterable[float] | None = None,
    tools: Tools | None = None,
    shapes: Shapes | None = None,
) -> Balance:
    """Return the devices that a scheme fits, and the analyses without and with them.

    Devices are sized for a steady speed. If the engine's speed is uneven, both analyses are for
    the uneven speed.

    Args:
        engine: One engine, not an array of variants.
        scheme: Name of the scheme, such as "counterweights" or "factor"; `balcli balance --schemes`
            lists and explains all schemes.
        options: Options of the scheme, such as SchemeOptions(factor=(0.51,), planes="ends").
        orders: Orders to show; default: 1, 2 and all that are not negligible before or after.
        tools: Tools of the workshop, for masses and holes, such as Tools(radius=0.08, drill=0.012).
        shapes: Shapes of new devices, such as Shapes(bearings=(-0.13, 0.13), sector=(0.03, 0.075,
            140)).

    Raises:
        BalcliError: The scheme is unknown, or its options cannot be met; the message
            gives the reason.
        TypeError: An argument has the wrong type.

    Example:
        >>> balance(load("i3.toml"), "counterweights").after.peak.moment.value
    """
    check_engine("balance", engine)
    check_type("balance", scheme, str, 'give the name of a scheme, such as "counterweights"')
    check_type("balance", options, (SchemeOptions, NoneType), "give SchemeOptions(factor=(0.5,))")
    check_type("balance", tools, (Tools, NoneType), "give Tools(radius=0.05)")
    check_type("balance", shapes, (Shapes, NoneType), "give Shapes(bearings=(-0.1, 0.1))")
    orders = None if orders is None else tuple(list_values("orders", orders))
    asked = options or SchemeOptions()
    if scheme == "minimax" and orders is not None:
        asked = asked._replace(orders=orders)
    if tools is not None and tools.radius is not None and "radius" in SCHEMES.get(scheme, ()):
        asked = asked._replace(radius=tools.radius)
    if asked.planes == "webs":
        take_webs(engine)
    if scheme in LADDER:
        asked.check(scheme)
        ladder = find_ladder(engine, asked.read_small())
        remedy = fit_steps(engine, ladder, asked)
        return _answer(engine, remedy, orders, tools, ladder, shapes, options=asked)
    remedy = size(engine, scheme, asked)
    start = engine if remedy.start is None else remedy.start
    ladder = find_ladder(start, asked.read_small())
    return _answer(start, remedy, orders, tools, ladder, shapes, options=asked)


def balance_fit(
    engine: Engine,
    model: EngineFile,
    targets: Sequence[str] | None = None,
    orders: Iterable[float] | None = None,
    tools: Tools | None = None,
    small: float = SMALL,
) -> Balance:
    """Fit the devices whose unbalance is "fit" in an engine file.

    Args:
        engine: Engine without these devices (`sizing.fit.remove_to_fit`).
        model: Engine file with these devices.
        targets: Quantities to cancel: "force", "moment", "roll" or "roll_total".
        orders: Orders to show, as in `balance`.
        tools: Tools of the workshop, as in `balance`.
        small: Share of one cylinder's first order; the ladder cancels no force or moment below
            this share.

    Raises:
        BalcliError: A target does not exist, or the file lacks data for it.
    """
    ladder = find_ladder(engine, small)
    return _answer(engine, size_fit(engine, model, targets), orders, tools, ladder)


def balance_webs(
    engine: Engine,
    model: EngineFile,
    scheme: str = "factor",
    options: SchemeOptions | None = None,
    orders: Iterable[float] | None = None,
    tools: Tools | None = None,
    shapes: Shapes | None = None,
) -> Balance:
    """Fit the dimensions of webs that are "fit" in an engine file. `before` is the engine whose
    fitted webs have no counterweight. What does not fit is in `parts.webs`.

    Args:
        engine: Engine without what is to be fitted (`sizing.fit.remove_to_fit`).
        model: Engine file with "fit".
        scheme: "factor", "step" or "counterweights": what the webs are to balance.
        options: Options of the scheme; with "factor", `planes` are the correction planes.
        orders: Orders to show, as in `balance`.
        tools: Tools of the workshop, as in `balance`.
        shapes: Shapes of new shafts, as in `balance`.

    Raises:
        BalcliError: The scheme or an option is not for such webs, or no dimension makes what is
            wanted.
    """
    from ..sizing.web_fit import size_webs  # loaded only for files with [[web]]

    small = (options or SchemeOptions()).read_small()
    remedy, before, fitted = size_webs(engine, model, scheme, options)
    remedy = remedy.add_details(speed=_UNEVEN) if engine.ripple else remedy
    after = fit_devices(fitted, remedy)
    ladder = find_ladder(before, small)
    return _answer(before, remedy, orders, tools, ladder, shapes, after, options)


def fit_webs(
    source: str | Path | Mapping[str, object],
    scheme: str = "factor",
    options: SchemeOptions | None = None,
    orders: Iterable[float] | None = None,
) -> Balance:
    """Return the balance of an engine file whose webs have a dimension "fit": the figures in its
    place, and the analyses of the engine whose fitted webs have no counterweight, and with them.
    The engine with the fitted webs is `after.engine`; what does not fit, and what helps, is in
    `parts.webs`.

    Args:
        source: Path, text or tables of an engine file, as for `load`.
        scheme: What the webs are to balance: "factor" (all rotating mass and a share of the
            reciprocating mass), "step" (counterweights of a row of the ladder) or "counterweights"
            (the part of order 1 that turns with the crank).
        options: Options of the scheme, such as SchemeOptions(factor=(0.5,)).
        orders: Orders to show, as in `balance`.

    Raises:
        BalcliError: The file cannot be read, the scheme or an option is not for such webs, or no
            dimension makes what is wanted.
        InputError: The file has mistakes; the error lists all of them.
        TypeError: An argument has the wrong type.

    Example:
        >>> file = load_example("i4_webs").to_dict()
        >>> file["web"][0]["opening"] = "fit"
        >>> fit_webs(file).after.peak.moment.value
    """
    check_type("fit_webs", scheme, str, 'give "factor", "step" or "counterweights"')
    check_type("fit_webs", options, (SchemeOptions, NoneType), "give SchemeOptions(factor=(0.5,))")
    wanted = "give the path of an engine file, the text of one, or a dict of its tables"
    tables, name = take_tables("fit_webs", source, wanted)
    model = parse_dict(tables, Path(name).parent, name)
    with naming_file(name_file(name)):
        engine = build(remove_to_fit(model))
        if not list_open_webs(model):
            raise BalcliError('no [[web]] has a dimension that is "fit"; use balance(load(file))')
        listed = None if orders is None else tuple(list_values("orders", orders))
        return balance_webs(engine, model, scheme, options, listed)


def _answer(
    engine: Engine,
    remedy: Remedy,
    orders: Iterable[float] | None,
    tools: Tools | None = None,
    ladder: Ladder | None = None,
    shapes: Shapes | None = None,
    changed: Engine | None = None,
    options: SchemeOptions | None = None,
) -> Balance:
    """Return a remedy with its figures for the workshop, and the analyses without and with it.

    Args:
        engine: Engine without the remedy.
        remedy: Remedy.
        orders: Orders of both analyses; None: 1, 2 and all that are not negligible before or after.
        tools: Tools of the workshop.
        ladder: Ladder of the engine.
        shapes: Shapes of new devices.
        changed: Engine with the remedy; None: `engine` with the devices of the remedy.
        options: Options of the scheme, which may give the correction planes.
    """
    tools = tools or Tools()
    shapes = shapes or Shapes()
    parts = None
    remedy = shape_devices(engine, remedy, shapes)
    has_sectors = any(shaft.sector for shaft in remedy.shafts)
    shafts = remedy.shafts if has_sectors or shapes.bearings is not None else ()
    if changed is None:
        changed = fit_devices(engine, remedy)
        remedy = remedy.add_details(speed=_UNEVEN) if engine.ripple else remedy
    has_webs = engine.webs is not None
    if shafts or has_webs or any(weight.sector for weight in remedy.counterweights):
        parts = find_parts(changed, shafts, remedy.counterweights, throws=has_webs)
        parts = parts._replace(webs=add_fitted(parts.webs, remedy.webs))
    before, after = analyze_alike((engine, changed), orders, analyze)
    initial = None
    if has_webs:
        crank = changed if remedy.webs else engine
        planes = choose_correction_planes(crank, options)
        initial = find_initial(crank, remedy, planes, tools)
    return Balance(
        remedy=remedy,
        practical=find_practical(engine, remedy, tools),
        details=list_details(remedy),
        assumed=_list_assumed(before, remedy, ladder),
        before=before,
        after=after,
        ladder=ladder,
        parts=parts,
        initial=initial,
        misfits=find_misfits(engine, remedy, tools),
        tools=tools,
        every_order=orders is not None,
    )


def _list_assumed(
    before: Analysis, remedy: Remedy, ladder: Ladder | None
) -> tuple[Assumed, ...] | None:
    """Return the values that are assumed for a balance; None if there are none."""
    steps = () if ladder is None else ladder.steps
    fitted = (remedy, *(step.remedy for step in steps))
    return (*(before.assumed or ()), *assume_skirt(before.engine, fitted)) or None


def permit_unbalance(
    remedy: Remedy,
    grade: float | None,
    mass: float | None,
    speed_rpm: float,
    planes: tuple[float, ...],
) -> PermittedUnbalance | None:
    """Return the unbalance that a grade permits at each counterweight, or in each correction plane;
    None without a grade.

    Args:
        remedy: Remedy.
        grade: Grade of ISO 21940-11, mm/s.
        mass: Mass of the crankshaft as it is balanced, bobweights included, kg.
        speed_rpm: Speed of the engine.
        planes: Correction planes of a crankshaft without new counterweights (z, m).

    Raises:
        BalcliError: Only one of grade and mass is given, or one of them is not positive.
    """
    if grade is None and mass is None:
        return None
    if grade is None or mass is None:
        raise ArgumentError(
            "{grade} and {mass} belong together: give the mass of the crankshaft, kg"
        )
    if not (0 < grade < math.inf and 0 < mass < math.inf):
        raise ArgumentError(
            "{grade} {speed_mm_s:g} {mass} {mass_kg:g}: both must be positive numbers",
            speed_mm_s=grade,
            mass_kg=mass,
        )
    whole = find_permitted_unbalance(grade, mass, speed_rpm)
    count = len(remedy.needs or remedy.counterweights)
    if count:
        return PermittedUnbalance(grade=grade, mass_kg=mass, each_g_mm=whole / count)
    each = whole / len(planes)
    return PermittedUnbalance(grade=grade, mass_kg=mass, each_g_mm=each, planes_m=planes)


def judge_unbalance(
    result: Balance,
    options: SchemeOptions,
    tools: Tools,
    grade: float | None,
    mass: float | None,
) -> Balance:
    """Return a balance with the residual unbalance that a grade permits, and with the capacity of
    the holes in the correction planes.

    Args:
        result: Balance without either.
        options: Options of the scheme, which may give the correction planes.
        tools: Tools of the workshop.
        grade: Grade of ISO 21940-11, mm/s; None: not given.
        mass: Mass of the crankshaft as it is balanced, bobweights included, kg; None: not given.

    Raises:
        BalcliError: Only one of grade and mass is given, or one of them is not positive.
    """
    engine = (result.after if result.remedy.webs else result.before).engine
    planes = choose_correction_planes(engine, options)
    speed = float(engine.speed_rpm)
    permitted = permit_unbalance(result.remedy, grade, mass, speed, planes)
    whole = None
    if grade is not None and mass is not None:
        whole = find_permitted_unbalance(grade, mass, speed) / 1e6
    initial = find_initial(engine, result.remedy, planes, tools, whole)
    return change_attributes(result, permitted=permitted, initial=initial)


_STEP_DEG = 1e-3  # step of the difference quotient in Newton's method
_STAYS_DEG = 1e-9  # a smaller turn of a knuckle pin counts as 0
_FARTHEST_DEG = 30.0  # largest turn of a knuckle pin
# Goals of the scheme knuckles: tolerance (degrees or metres), and the result in words.
_GOALS = {
    "dead-centres": (1e-9, "top dead centres at the same angle as the master's"),
    "strokes": (1e-12, "strokes equal to the master's"),
}


def balance_knuckles(
    model: EngineFile,
    goal: str = "dead-centres",
    orders: Iterable[float] | None = None,
    speed_rpm: float | None = None,
) -> Balance:
    """Turn each knuckle pin about the crank pin until its cylinders have the dead centres, or the
    strokes, of the master cylinder. The pins keep the radius that the file gives.

    Args:
        model: Engine file.
        goal: "dead-centres": at top dead centre of every piston, the crank pin has the same angle
            to the axis of this piston's bank. "strokes": every piston has the stroke of the master
            piston. (Both at once would need a different radius for each pin.)
        orders: Orders to show, as in `balance`.
        speed_rpm: Speed of the engine; None: that of the file.

    Raises:
        BalcliError: The engine has no articulated rods, or the goal is unknown.
        InputError: The engine cannot be built.
    """
    if goal not in _GOALS:
        raise ArgumentError(
            '{even} "{goal:.60}": choose from {goals}', goal=goal, goals=", ".join(_GOALS)
        )
    engine = build(model)
    engine = engine if speed_rpm is None else engine.at_speed(speed_rpm)
    angles_deg, reasons = _even_knuckles(engine, model, goal)
    angles_deg = limit_digits(angles_deg)  # as they are written
    better = build(model.with_table("articulation", knuckle_angles=angles_deg))
    after = find_travel(better.cylinders)
    details = {
        "even": goal,
        "knuckle_angles_deg": list(angles_deg),
        "stroke_mm": _find_range(1e3 * after.stroke),
        "top_deg": _find_range(after.top_deg),
    }
    remedy = Remedy(KNUCKLES, reasons=reasons, details=details, knuckle_angles_deg=angles_deg)
    return _answer(engine, remedy, orders, changed=better.at_speed(float(engine.speed_rpm)))


def _even_knuckles(
    engine: Engine, model: EngineFile, goal: str
) -> tuple[tuple[float, ...], tuple[str, ...]]:
    """Return the angle of each bank's knuckle pin, and the changes in words. If the bank has
    cylinders in several rows, the angle is that of the first row. A bank keeps its angle if no turn
    of up to 30 degrees reaches the goal.
    """
    refuse_geared(engine)
    c = engine.cylinders
    linkage = engine.cylinders.linkage
    if not isinstance(linkage, Articulated) or engine.rotary:
        raise BalcliError("scheme knuckles needs articulated rods, and a crank that turns")
    if len(set(Parts(model).find_master_places())) > 1:
        raise BalcliError(
            "knuckles: the master rods of all rows must be in the same bank, because the file has "
            "one list of knuckle angles for all rows"
        )
    masters = linkage.master
    hung = masters != np.arange(c.count)

    def find_error(turn_deg: Array) -> Array:
        """Return the difference of each cylinder from its master, degrees or metres."""
        turned = replace(linkage, knuckle=linkage.knuckle * unit(turn_deg))
        found = find_travel(replace(c, linkage=turned))
        values = found.top_deg if goal == "dead-centres" else found.stroke
        return np.where(hung, values - values[masters], 0.0)

    turn_deg = _solve(find_error, c.count)
    tolerance, result = _GOALS[goal]
    done = np.abs(find_error(turn_deg)) <= tolerance
    rows = _find_first_rows(model, engine.numbers)
    old_deg = np.degrees(np.angle(linkage.knuckle[rows]))
    new_deg = (old_deg + np.where(done, turn_deg, 0.0)[rows]) % 360
    angles_deg = tuple(map(float, np.where(hung[rows], new_deg, 0.0)))
    return angles_deg, _explain(result, hung[rows], done[rows], turn_deg[rows])


def _find_range(values: Array) -> dict[str, float]:
    return {"least": float(values.min()), "largest": float(values.max())}


def _solve(find_error: Callable[[Array], Array], count: int) -> Array:
    """Return the turn of each cylinder's knuckle pin, degrees, at which its error vanishes (if
    possible), by Newton's method for all pins at once.
    """
    turn_deg = np.zeros(count)
    for _ in range(20):
        rise = find_error(turn_deg + _STEP_DEG) - find_error(turn_deg - _STEP_DEG)
        slope = rise / (2 * _STEP_DEG)
        move = -find_error(turn_deg) / np.where(slope, slope, 1.0)
        turn_deg = np.clip(turn_deg + np.clip(move, -5, 5), -_FARTHEST_DEG, _FARTHEST_DEG)
        if np.max(np.abs(move)) < 1e-12:
            break
    return turn_deg


def _find_first_rows(model: EngineFile, numbers: tuple[CylinderNumber, ...]) -> list[int]:
    """Return the row of the arrays that belongs to the first cylinder of each bank."""
    cells = plan_cylinders(model).cells
    from_last = sorted(cells, key=lambda cell: -cell.throw)
    first = {cell.bank: cell.number for cell in from_last}
    return [numbers.index(first[bank]) for bank in sorted(first)]


def _explain(
    result: str, hung: NDArray[np.bool_], done: NDArray[np.bool_], turn_deg: Array
) -> tuple[str, ...]:
    """Return in words the changes, and the banks that cannot be made even.

    Args:
        result: Result of the changes, in words.
        hung: Whether the rods of each bank hang on a master rod.
        done: Whether the knuckle pin of each bank reaches the goal.
        turn_deg: Turn of the knuckle pin of each bank.
    """
    largest = float(np.abs(np.where(hung & done, turn_deg, 0)).max(initial=0.0))
    turned = f"turned by up to {largest:.3g} deg" if largest > _STAYS_DEG else "stay where they are"
    reasons = []
    if np.any(hung & done):
        reasons.append(f"knuckle pins {turned}: {result}")
    if left := [str(bank + 1) for bank in np.flatnonzero(hung & ~done)]:
        reasons.append(
            f"no angle makes bank {', '.join(left)} even: the knuckle pin stays where it is"
        )
    return tuple(reasons)


def insert_remedy(text: bytes, remedy: Remedy, file: str = "") -> str:
    """Return the text of an engine file with the devices of a remedy appended, or with new knuckle
    angles.

    Args:
        text: Text of the file, UTF-8.
        remedy: Remedy.
        file: Name of the file, for messages.

    Raises:
        BalcliError: No engine file can describe the remedy.
    """
    old = text.decode("utf-8-sig")
    if angles := remedy.knuckle_angles_deg:
        new = set_keys(old, "articulation", {"knuckle_angles": list(angles)}, "set by balcli")
        parse(new, file)
        return new
    if remedy.beyond:
        raise BalcliError(f"scheme {remedy.scheme}: no engine file can describe its devices")
    if remedy.scheme == FIT:
        return _fill_in(old, remedy, file)
    if remedy.web_tables:
        old = _fill_webs(old, remedy.web_tables, file)
    model = parse(old, file)
    cranked = sum(axle.has_cranks for axle in model.axle)
    if cranked > 1 and any(weight.axle is None for weight in remedy.counterweights):
        raise BalcliError(
            f"{file}: several axles have cranks, and no scheme divides its weights between them; "
            "balcli locomotive does"
        )
    base = remedy.start or build(model)
    if remedy.start is not None and remedy.start.model is not None:
        weights = remedy.start.model.counterweight
        first = Remedy(remedy.scheme).add_devices(weights, "on the crank, by the measured mass")
        old = _insert_devices(remove_tables(old, "counterweight"), first)
    new = _insert_devices(old, remedy)
    if build(parse(new, file)).devices != fit_devices(base, remedy).devices:
        raise BalcliError(f"{file}: written devices differ from the sized ones: please report this")
    return new


def _fill_in(text: str, remedy: Remedy, file: str) -> str:
    """Return the text with the fitted unbalance in place of each "fit"."""
    for (name, _), device in zip(list_to_fit(parse(text, file)), remedy.devices, strict=True):
        keys = {"unbalance": device.unbalance, "angle": device.angle}
        text = set_keys(text, name, keys, "fitted by balcli")
    build(parse(text, file))
    return text


def _fill_webs(text: str, fitted: Iterable[FittedTable], file: str) -> str:
    """Return the text with figures in place of each "fit" of a web, one table for each result."""
    for own in sorted(fitted, reverse=True):  # from the last, so that earlier ones keep their place
        if len(own.tables) > 1:
            text = repeat_table(text, "web", own.number, len(own.tables))
        for row, table in enumerate(own.tables):
            name = f"web.{own.number + row}"
            given = parse(text, file).web[own.number + row - 1]
            keys: Node = {}
            for key in ("webs", "thickness", "outer_radius", "opening", "angle"):
                before = getattr(given, key) if given.has(key) else None
                figure = getattr(table, key) if table.has(key) else None
                if figure != before:
                    keys[key] = [*figure] if isinstance(figure, tuple) else figure
            text = set_keys(text, name, keys, "fitted by balcli")
    return text


def _insert_devices(text: str, remedy: Remedy) -> str:
    """Return the text with the remedy's tables appended. TOML cannot extend an inline list: a
    file with its devices in such a list is written anew, without its comments.
    """
    end_of_line = "" if text.endswith("\n") or not text else "\n"
    tables = end_of_line + "".join(_write_tables(remedy))
    new = text + (tables.replace("\n", "\r\n") if "\r\n" in text else tables)
    try:
        parse(new)
    except InputError:
        data = tomllib.loads(text)
        for device in remedy.devices:
            data.setdefault(name_kind(device), []).append(_list_entries(device))
        return rewrite(data, "its devices are in an inline list, which TOML cannot extend")
    return new


def _write_tables(remedy: Remedy) -> Iterator[str]:
    """Yield the tables of the devices; each reason is a comment above the first of its devices."""
    if remedy.devices:
        yield f"\n# fitted by balcli, scheme {remedy.scheme}\n"
    reason_before = ""
    rows = zip(remedy.devices, remedy.reasons, find_free(remedy.devices), strict=True)
    for device, reason, anywhere in rows:
        if reason != reason_before:
            yield f"# {reason}\n"
        reason_before = reason
        yield f"[[{name_kind(device)}]]\n"
        for key, value in _list_entries(device).items():
            note = "  # free: it may stand anywhere" if anywhere and key == "at" else ""
            yield f"{key} = {format_value(value)}{note}\n"
        yield "\n"


def _list_entries(device: DeviceTable) -> Node:
    """Return the keys and values of a device for TOML."""
    keys = ("engine", "name", "bearings", "sector", "role", *FIELDS[type(device)])
    given = {key: getattr(device, key, None) for key in keys}
    return {k: _write(value) for k, value in given.items() if value not in (None, "", "balancer")}


def _write(value: object) -> object:
    if isinstance(value, Sector):
        return value.model_dump(include=value.model_fields_set)
    return [*value] if isinstance(value, tuple) else value
