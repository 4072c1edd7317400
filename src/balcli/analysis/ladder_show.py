"""Show the ladder: a table with one row for each step, and notes on what is fitted by default, what
is left out, and what the steps do to the loads of the bearings.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from ..core.records import list_figures, remove_unit, to_document
from ..engine.half_orders import list_half_orders, list_shafts_of_order
from ..file.fields import join_words
from ..forces.kinds import FORCE, MOMENT, Kind
from ..forces.power import LIKELY
from ..limits import (
    FEWEST_CYLINDERS_COUNTED,
    SMALL,
    WORTH_A_SHAFT_OF_ORDER_1,
    WORTH_A_SHAFT_OF_ORDER_2,
)
from ..show.sheet import (
    NEGLIGIBLE,
    UNKNOWN,
    Column,
    Grid,
    Shade,
    capitalized,
    given,
    number,
    sentence,
    size_cell,
    size_text,
    tell_assumed,
)
from ..sizing.ladder import NO_SHAFTS, SHAFTS, SINGLE_SHAFTS, Ladder, LeftOut, Step
from ..sizing.room import assume_skirt
from ..sizing.ship_engines import is_type_open
from .verdict_words import GIVE_GAS, GIVE_POWER, name_order, tell_own_shafts

if TYPE_CHECKING:
    from ..engine.engine import Engine
    from ..show.units import ShownUnit, System

_ROUNDING = 1e-12  # a smaller share of one cylinder's value is rounding
_HARDLY = 0.05  # a smaller share of one cylinder's first order, %, would be printed as 0.0
_HARDLY_ANYTHING = "<0.1 %"  # forces and moments below NEGLIGIBLE of one cylinder's
_BEARINGS = "main bearing: inertia alone, with a bearing on both sides of every throw."
_GIVEN_BEARINGS = "main bearing: inertia alone, with the bearings of the file."


def ladder_grid(
    ladder: Ladder,
    engine: Engine,
    system: System,
    *,
    tell_fitted: bool = True,
    tell_skirt: bool = False,
) -> Grid:
    """Return a table with one row for each step of the ladder, and notes, one on each line.

    Args:
        ladder: Ladder to show.
        engine: Engine as drawn.
        system: System of units.
        tell_fitted: Whether a note names the steps that `balcli balance` fits.
        tell_skirt: Whether a note names the piston skirt that is assumed for the masses; wanted
            where no line above the table names it.
    """
    steps = ladder.steps
    scale = ladder.scale
    names = [f"{row} {step.step}" for row, step in enumerate(steps)]
    applied = {row: Shade.APPLIED for row, step in enumerate(steps) if step.step in ladder.auto}
    columns = [Column("step", names, words=True, shades=applied)]
    forces = [step.peak_force_N for step in steps]
    columns.append(_size_column(FORCE, forces, scale.force_N, system))
    if scale.moment_Nm is not None:
        moments = [step.peak_moment_Nm or 0.0 for step in steps]
        columns.append(_size_column(MOMENT, moments, scale.moment_Nm, system))
    has_loads = steps[0].main_bearing_N is not None
    if has_loads:
        columns.append(_load_column(ladder, system))
    columns.append(Column("weights", [str(step.counterweights or UNKNOWN) for step in steps]))
    columns.append(Column("shafts", [str(step.shafts or UNKNOWN) for step in steps]))
    masses = [_mass_cell(step, system) for step in steps]
    columns.append(Column(f"steel, {system.mass.name}", masses))
    notes = []
    if has_loads:
        notes.append(_GIVEN_BEARINGS if engine.has_given_bearings else _BEARINGS)
    if tell_skirt:
        notes += _tell_skirt(ladder, engine)
    notes += _tell_loads(ladder, system)
    has_gas = engine.gas is not None
    for out in ladder.left_out:
        notes.append(_tell_left_out(out, ladder, system, has_gas=has_gas))
    if ladder.of_locomotive:
        notes.append(sentence(NO_SHAFTS))
    notes += _tell_half_orders(engine)
    notes += _tell_roll(ladder, system)
    if tell_fitted:
        notes.append(" ".join(_tell_fitted(ladder, engine)))
    if _has_percentages(ladder, tell_fitted=tell_fitted):
        notes.append(_tell_scale(ladder, system))
    at = "mean " if engine.ripple else ""
    title = f"What balances it, step by step ({at}{given(float(engine.speed_rpm))} rpm)"
    return Grid(title, columns, "\n".join(filter(None, notes)))


# ------------------------------------------------------------------ columns
def _size_column(kind: Kind, sizes: list[float], of_one: float, system: System) -> Column:
    """Return the column of the largest forces or moments.

    Args:
        kind: FORCE or MOMENT.
        sizes: Largest value of every step, SI.
        of_one: First order of one cylinder, SI.
        system: System of units.
    """
    unit = system.unit(kind).fit(max(sizes))
    cells = [_size_cell(size, of_one, unit) for size in sizes]
    limit = _ROUNDING * of_one
    shades = {row: Shade.BALANCED for row, size in enumerate(sizes) if size <= limit}
    return Column(f"{kind.name}, {unit.name}", cells, shades=shades)


def _size_cell(size: float, of_one: float, unit: ShownUnit) -> str:
    """Return the cell of a size: a number, or `<0.1 %` if it is negligible compared with that of
    one cylinder.
    """
    if size <= _ROUNDING * of_one:
        return size_cell(0.0, unit)
    if _is_share(size, of_one):
        return _HARDLY_ANYTHING
    return size_cell(size, unit)


def _is_share(size: float, of_one: float) -> bool:
    """Return whether a size is printed as a share of that of one cylinder: it is negligible, but
    more than rounding.
    """
    return _ROUNDING * of_one < size < NEGLIGIBLE * of_one


def _load_column(ladder: Ladder, system: System) -> Column:
    """Return the column of the largest main bearing loads."""
    loads = [step.main_bearing_N or 0.0 for step in ladder.steps]
    unit = system.force.fit(max(loads))
    cells = [_size_cell(load, ladder.scale.force_N, unit) for load in loads]
    return Column(f"main bearing, {unit.name}", cells)


def _mass_cell(step: Step, system: System) -> str:
    """Return the cell of the mass of all new devices in steel; a dash if it is not known."""
    return number(system.mass.of(step.steel_kg), 3) if step.steel_kg else UNKNOWN


# ------------------------------------------------------------------ notes
def _tell_skirt(ladder: Ladder, engine: Engine) -> Iterator[str]:
    """Yield a sentence on the assumed piston skirt, on which the mass of counterweights depends."""
    assumed = assume_skirt(engine, [step.remedy for step in ladder.steps])
    if assumed:
        yield f"steel: assumed {tell_assumed(assumed)}."


def _tell_loads(ladder: Ladder, system: System) -> Iterator[str]:
    """Yield sentences on counterweights of the file that raise bearing loads or that a step takes
    back, and on steps that raise bearing loads.
    """
    least = SMALL * ladder.scale.force_N
    of_file = ladder.file_counterweights
    if of_file is not None and _rises(of_file.without_N, of_file.with_N, least):
        change = _tell_rise(of_file.without_N, of_file.with_N, system)
        yield f"The counterweights of the file raise the largest main bearing load {change}."
    for row, step in enumerate(ladder.steps):
        if step.takes_back:
            yield f"Step {row} takes back counterweights of the file."
    for row, step in enumerate(ladder.steps[1:], 1):
        before = ladder.steps[row - 1].main_bearing_N
        after = step.main_bearing_N
        if before is None or after is None:
            continue
        if _rises(before, after, least):
            change = _tell_rise(before, after, system)
            yield f"Step {row} raises the largest main bearing load {change}."


def _rises(before: float, after: float, least: float) -> bool:
    """Return whether a load rises by at least `least`, which may be 0."""
    return after - before > _ROUNDING * after and after - before >= least * (1 - _ROUNDING)


def _tell_rise(before: float, after: float, system: System) -> str:
    """Return the change of a load in words: `from 11.59 to 15.23 kN`."""
    unit = system.force.fit(after)
    return f"from {number(unit.of(before))} to {number(unit.of(after))} {unit.name}"


def _tell_left_out(out: LeftOut, ladder: Ladder, system: System, *, has_gas: bool) -> str:
    """Return a sentence on an omitted step: the force or the moment that it would remove, or the
    change of the main bearing load. Empty if its effect would be printed as 0, or if the engine has
    no room for it.

    Args:
        out: Omitted step.
        ladder: Ladder without it.
        system: System of units.
        has_gas: Whether the gas of the engine is known.
    """
    percent = abs(ladder.measure_percent(out))
    fall = out.main_bearing_N
    if percent < _HARDLY or not out.buildable:
        return ""
    share = ""
    if not math.isnan(percent):
        share = f" ({_percent_below(percent, 100 * ladder.small)} of one cylinder's first order)"
    name = f"a {out.step}" if out.step in SINGLE_SHAFTS else out.step
    why = "left out"
    if fall is None:
        force = out.force_N
        moment = out.moment_Nm or 0.0
        scale = ladder.scale
        by_moment = moment * scale.force_N > force * (scale.moment_Nm or 0.0)
        largest = size_text(moment, system.moment) if by_moment else size_text(force, system.force)
        does = f"each remove up to {largest}" if out.step == SHAFTS else f"remove {largest}"
    else:
        verb = "lower" if fall >= 0 else "raise"
        does = f"{verb} the largest main bearing load by {size_text(abs(fall), system.force)}"
        if ladder.by_power and has_gas:
            why = "left out, because gas, not inertia, governs these bearings"
        elif ladder.by_power:
            why = "left out; these bearings also carry gas forces, which the file does not give"
    return f"{capitalized(name)} would {does}{share}: {why}."


def _percent_below(size: float, limit: float) -> str:
    """Return a size below a limit, both in %, with as many digits as show that it is below."""
    digits = f"{size:.1f}" if round(size, 1) < limit else f"{size:.3g}"
    return f"{digits} %"


def _tell_half_orders(engine: Engine) -> Iterator[str]:
    """Yield a sentence on each half order that shafts of the engine cause; no step cancels it."""
    for order in list_half_orders(engine):
        causes = tell_own_shafts(list_shafts_of_order(engine, order))
        yield f"{name_order(order)} {causes}."


def _tell_roll(ladder: Ladder, system: System) -> Iterator[str]:
    """Yield a sentence on the distance at which listed shafts at +2 and -2 also cancel the roll."""
    roll = ladder.roll
    if roll is None or roll.shafts_at_mm is None or roll.distance_m is None:
        return
    pair = [step for step in ladder.steps if step.order == 2 and step.own.shafts]
    if not pair:
        return
    option = "--roll zero"
    if roll.of == "total":  # the option is for the roll of inertia alone
        against, with_crank = (roll.shafts_at_mm[ratio] for ratio in ("-2", "+2"))
        places = [f"--at={number(x)},{number(y)}" for x, y in (against, with_crank)]
        option = " ".join(places)
    yield (
        f"{capitalized(pair[0].step)}: {size_text(roll.distance_m, system.length)} apart, they "
        f"take the roll of order 2, too (`--scheme two-shaft --order 2 {option}`)."
    )


def tell_usual(ladder: Ladder) -> str:
    """Return a sentence on the steps that are fitted by default."""
    last = len(ladder.steps) - 1
    if ladder.auto:
        option = "" if ladder.small == SMALL else f" --small {100 * ladder.small:g}%"
        fits = f"By default, `balcli balance{option}` fits"
        steps = _number_steps(ladder, ladder.auto)
        row = ladder.find_row(ladder.auto[-1])
        of_row = ladder.list_fitted(row)
        if of_row == ladder.auto:
            return f"{fits} {steps}."
        skipped = [name for name in of_row if name not in ladder.auto]
        return (
            f"{fits} the devices of {steps} without those of {_number_steps(ladder, skipped)}; "
            f"`--step {row}` fits all of row {row}."
        )
    if last > 1:
        return f"Nothing is worth fitting by default; `--step 1` to `--step {last}` fit a row."
    if last == 1:
        return "Nothing is worth fitting by default; `--step 1` fits its row."
    return "Nothing is worth fitting."


def _number_steps(ladder: Ladder, names: Sequence[str]) -> str:
    """Return the numbers of listed steps in words: `step 3`, `steps 1 and 2`."""
    numbers = [str(ladder.find_row(name)) for name in names]
    return f"{'step' if len(numbers) == 1 else 'steps'} {join_words(numbers)}"


def _tell_fitted(ladder: Ladder, engine: Engine) -> Iterator[str]:
    """Yield sentences on the steps that are fitted by default, and on the reasons."""
    yield tell_usual(ladder)
    if ladder.by_power:
        yield from _tell_power(ladder, engine)
        return
    if any(step.takes_back for step in ladder.steps):
        yield "The counterweights of the file settle order 1 in their own way."
    below = _list_below_limit(ladder)
    if not below:
        return
    told = []
    for step in below:
        row = ladder.find_row(step.step)
        limit = _find_limit(step)
        size = _percent_below(100 * step.share, 100 * limit)
        does = f"step {row} cancels {size}"
        if step.step == SHAFTS:
            does = f"each shaft of step {row} cancels up to {size}"
        told.append(f"{does} (limit {100 * limit:.4g} %)")
    yield f"Below the limit of a shaft: {', '.join(told)}."
    yield _tell_limits({step.order for step in below})


def _list_below_limit(ladder: Ladder) -> list[Step]:
    """Return the steps with shafts that are not worth it; none if power decides."""
    return [step for step in ladder.steps if step.limit is not None and not step.worth_it]


def _find_limit(step: Step) -> float:
    """Return the limit of a step that is judged by its share of one cylinder's first order."""
    assert step.limit is not None
    return step.limit


def _tell_limits(orders: Collection[int]) -> str:
    """Return a sentence on what sets the limits of shafts of these orders."""
    limits = []
    if 1 in orders:
        limits.append(f"{100 * WORTH_A_SHAFT_OF_ORDER_1:g} % in order 1")
    if 2 in orders:
        each = f"{100 * WORTH_A_SHAFT_OF_ORDER_2:g} % in order 2"
        limits.append(f"{each} for each cylinder, counted as at least {FEWEST_CYLINDERS_COUNTED}")
    return f"Limits from makers' practice: {', '.join(limits)}."


def _tell_power(ladder: Ladder, engine: Engine) -> Iterator[str]:
    """Yield sentences on the power related unbalance that each step of a ship's two-stroke
    engine faces.
    """
    if len(ladder.steps) == 1:
        return
    if ladder.power is None:
        yield GIVE_POWER
        if is_type_open(engine):
            yield GIVE_GAS
        return
    related = []
    for row, step in enumerate(ladder.steps):
        if step.pru_Nm_per_kW is not None:
            related.append(f"step {row}: {number(step.pru_Nm_per_kW, 3)}")
    if related:
        yield (
            "A step is fitted if its power related unbalance (PRU) is above "
            f"{LIKELY:g} N·m/kW ({', '.join(related)})."
        )


def _has_percentages(ladder: Ladder, *, tell_fitted: bool) -> bool:
    """Return whether the table or its notes have a percentage of one cylinder's first order.

    Args:
        ladder: Ladder to show.
        tell_fitted: Whether a note names the steps that `balcli balance` fits.
    """
    scale = ladder.scale
    in_cells = []
    for step in ladder.steps:
        in_cells.append(_is_share(step.peak_force_N, scale.force_N))
        in_cells.append(_is_share(step.main_bearing_N or 0.0, scale.force_N))
        in_cells.append(_is_share(step.peak_moment_Nm or 0.0, scale.moment_Nm or 0.0))
    shares = [abs(ladder.measure_percent(out)) for out in ladder.left_out if out.buildable]
    is_left_out = any(share >= _HARDLY for share in shares)  # False for nan
    is_below = tell_fitted and not ladder.by_power and bool(_list_below_limit(ladder))
    return any(in_cells) or is_left_out or is_below


def _tell_scale(ladder: Ladder, system: System) -> str:
    """Return a sentence on the force and moment of one cylinder, with which others are compared."""
    scale = ladder.scale
    sizes = size_text(scale.force_N, system.force)
    if scale.moment_Nm is not None:
        moment = size_text(scale.moment_Nm, system.moment)
        if scale.length is None:
            sizes = f"{sizes}, {moment}"
        else:
            length = size_text(scale.length.metres, system.length)
            what = ", twice the crank radius" if scale.length.of_crank else " of engine length"
            sizes = f"{sizes}; times {length}{what}: {moment}"
    return f"Percentages are of one cylinder's first order ({sizes})."


# ------------------------------------------------------------------ CSV
def list_ladder(ladder: Ladder) -> Iterator[tuple[str, str, Any, str]]:
    """Yield step, name, value and SI unit of every figure of a ladder."""
    for step in ladder.steps:
        for name, value, unit in list_figures(to_document(step), ("step",)):
            yield step.step, remove_unit(name), value, unit
    if ladder.roll is not None:
        for name, value, unit in list_figures(to_document(ladder.roll)):
            yield "roll", remove_unit(name), value, unit
    if ladder.file_counterweights is not None:
        for name, value, unit in list_figures(to_document(ladder.file_counterweights)):
            yield "counterweights of the file", remove_unit(name), value, unit
