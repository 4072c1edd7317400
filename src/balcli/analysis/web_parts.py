"""Describe the webs of a crankshaft, its throws and what balances them (`analyze --only parts`).

With the unbalance U of pin, webs and nearest counterweights along the crank pin, the rotating mass
m_rot and the reciprocating mass m_rec of the rods on it, and the crank radius r, the *balance
factor* is `K = -(U + m_rot r)/(m_rec r)`. The *degree of balance* is the unbalance of the weights
over that of throw and rotating mass, `-U_weights/(U_throw + m_rot r)`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from ..engine.engine import Engine
from ..show.figures import FigureRow, record_rows
from ..show.sheet import UNKNOWN, Column, Facts, Grid, number, size_text
from ..sizing.throws import Throw, list_throws, sum_counterweights
from .records import BalanceParts, CrankPart, ThrowPart, WebPart

if TYPE_CHECKING:
    from ..engine.webs.build import CrankWeb
    from ..show.units import ShownUnit, System
    from ..sizing.remedy import FittedWeb


# ------------------------------------------------------------------ webs
def describe_webs(engine: Engine) -> tuple[WebPart, ...] | None:
    """Return the webs of an engine; None for a file without [[web]]."""
    if engine.webs is None or engine.model is None:
        return None
    return tuple(describe_web(engine, web) for web in engine.webs.webs)


def describe_web(engine: Engine, web: CrankWeb) -> WebPart:
    """Return the figures of a web, with its gaps to pistons and crankcase and its tolerances."""
    from ..engine.webs.tolerance import find_deviation, measure_own_deg
    from ..sizing.web_clearance import find_gap

    body = web.body
    model = engine.model
    assert model is not None
    table = model.web[web.table - 1]
    cg = body.unbalance / body.mass if body.mass else None
    part = WebPart(
        web=web.number,
        table=web.table,
        throw=web.throw + 1,
        position_mm=1e3 * float(web.z),
        mass_kg=body.mass,
        cg_m=None if cg is None else (cg.real, cg.imag),
        unbalance_kg_m=abs(body.unbalance),
        unbalance_own_deg=measure_own_deg(body.unbalance),
        inertia_kg_m2=body.inertia,
        thickness_m=body.thickness,
        asked_clearance_m=table.clearance / 1e3,
    )
    if body.shape is None:
        return part
    if (sector := body.shape.sector) is not None:
        part = part._replace(
            outer_radius_m=sector.radius,
            opening_deg=sector.opening,
            angle_own_deg=sector.angle % 360,
        )
    swing = body.shape.swing_radius
    part = part._replace(swing_radius_m=swing)
    if model.frame.crankcase is not None:
        part = part._replace(crankcase_m=model.frame.crankcase / 1e3 - swing)
    if (gap := find_gap(engine, web)) is not None:
        part = part._replace(
            clearance_m=gap.size, clearance_deg=gap.crank_deg, clearance_cylinder=gap.cylinder
        )
    if (deviation := find_deviation(table, body.shape)) is not None:
        part = part._replace(worst_kg_m=deviation.worst, rss_kg_m=deviation.rss)
    return part


def add_fitted(
    webs: Iterable[WebPart] | None, fitted: Iterable[FittedWeb]
) -> tuple[WebPart, ...] | None:
    """Return webs with what was wanted of those that were fitted, and what did not fit.

    Args:
        webs: Webs of the engine with what was fitted.
        fitted: Fitted webs.
    """
    if webs is None:
        return None
    from ..engine.webs.tolerance import measure_own_deg

    by_number = {web.web: web for web in fitted}
    parts = []
    for part in webs:
        own = by_number.get(part.web)
        if own is None:
            parts.append(part)
            continue
        fit = part._replace(
            wanted_kg_m=abs(own.wanted),
            wanted_own_deg=measure_own_deg(own.wanted),
            room_kg_m=own.room,
            missing_kg_m=own.missing,
            remedies=own.cures or None,
        )
        parts.append(fit)
    return tuple(parts)


def describe_crank(engine: Engine) -> CrankPart | None:
    """Return mass and inertia of webs and pins together; None for a file without [[web]]."""
    if engine.webs is None:
        return None
    return CrankPart(engine.webs.mass, engine.webs.inertia)


# ------------------------------------------------------------------ throws
def describe_throws(engine: Engine) -> tuple[ThrowPart, ...] | None:
    """Return the throws of an engine; None where counterweights do not turn with crank pins, or for
    split pins.
    """
    if engine.rotary or engine.of_locomotive or engine.placed:
        return None
    throws = list_throws(engine)
    if throws is None:
        return None
    added = sum_counterweights(engine, throws)
    return tuple(
        _describe_throw(engine, index, throw, weights)
        for index, (throw, weights) in enumerate(zip(throws, added, strict=True))
    )


def _describe_throw(engine: Engine, index: int, throw: Throw, weights: complex) -> ThrowPart:
    """Return a throw and what balances it.

    Args:
        engine: Engine.
        index: Index of the throw.
        throw: The throw.
        weights: Sum of its counterweights, kg m.
    """
    own_weights = (weights * throw.pin.conjugate()).real
    of_throw: float | None = throw.mass * throw.radius
    total = throw.mass * throw.radius + own_weights
    if engine.webs is not None:
        webs = [web for web in engine.webs.webs if web.throw == index]
        sum_of_webs = sum(web.body.unbalance.real for web in webs)
        total += sum_of_webs
        at_pin = [web.body.at_pin for web in webs]
        of_known_webs = [unbalance.real for unbalance in at_pin if unbalance is not None]
        if len(of_known_webs) < len(webs):
            of_throw = None
        else:
            of_throw = throw.mass * throw.radius + sum(of_known_webs)
            own_weights += sum_of_webs - sum(of_known_webs)
    rotating = throw.rotating * throw.radius
    reciprocating = throw.reciprocating * throw.radius
    degree = None
    if of_throw is not None and of_throw + rotating > 0:
        degree = -own_weights / (of_throw + rotating) + 0.0
    return ThrowPart(
        throw=index + 1,
        throw_mass_kg=None if of_throw is None else of_throw / throw.radius,
        degree_of_balance=degree,
        factor=-(total + rotating) / reciprocating if reciprocating else None,
    )


# ------------------------------------------------------------------ how it is shown
_WEBS_NOTE = (
    "Angles count from each web's own crank pin in the direction of rotation. Clearance: smallest "
    "gap to a piston over a revolution."
)
_ROUNDING = 1e-9  # a smaller balance factor is 0
_THROWS_NOTE = (
    "Factor: share of the reciprocating mass that is balanced besides all rotating mass. Degree: "
    "unbalance of the weights over that of throw and big ends."
)


class WebRow(NamedTuple):
    """Webs that are alike: their numbers, those of their throws, one of them, and the crank angles
    at which they have their clearance.
    """

    webs: list[int]
    throws: list[int]
    part: WebPart
    clearances_deg: list[float]


def lay_out_webs(parts: BalanceParts, system: System) -> Iterator[Grid | Facts]:
    """Yield a table of the webs, a table of the throws, and mass and inertia of the crankshaft.

    Args:
        parts: Parts of an engine.
        system: System of units.
    """
    if parts.webs:
        yield _lay_out_webs(parts.webs, system)
    if parts.throws:
        yield _lay_out_throws(parts.throws, system)
    if parts.crank is not None:
        pairs = [("mass", size_text(parts.crank.mass_kg, system.mass))]
        if parts.crank.inertia_kg_m2 is not None:
            inertia = size_text(parts.crank.inertia_kg_m2, system.of_parts["kg·m²"])
            pairs.append(("polar inertia", inertia))
        yield Facts(tuple(pairs), "Webs and crank pins")


def group_webs(parts: Iterable[WebPart]) -> list[WebRow]:
    """Return webs with equal figures as one row. Places and crank angles of the clearance may
    differ.
    """
    rows: dict[tuple[object, ...], WebRow] = {}
    for part in parts:
        alike = tuple(
            round(value, 9) if isinstance(value, float) else None
            for key, value in part._asdict().items()
            if key not in ("position_mm", "clearance_deg")
        )
        row = rows.setdefault((part.table, *alike), WebRow([], [], part, []))
        row.webs.append(part.web)
        row.throws.append(part.throw)
        row.clearances_deg.append(part.clearance_deg or 0.0)
    return list(rows.values())


def write_ranges(numbers: Iterable[int]) -> str:
    """Return numbers with ranges: 1-4,7."""
    runs: list[list[int]] = []
    for web in sorted(set(numbers)):
        if runs and web == runs[-1][1] + 1:
            runs[-1][1] = web
        else:
            runs.append([web, web])
    return ",".join(str(low) if low == high else f"{low}-{high}" for low, high in runs)


def _lay_out_webs(webs: Iterable[WebPart], system: System) -> Grid:
    rows = group_webs(webs)
    length = system.length
    unbalance = system.unbalance.fit(max(row.part.unbalance_kg_m for row in rows))
    columns = [
        Column("web", [write_ranges(row.webs) for row in rows], words=True),
        Column("throw", [write_ranges(row.throws) for row in rows], words=True),
        Column(f"mass, {system.mass.name}", [number(system.mass.of(r.part.mass_kg)) for r in rows]),
        Column(unbalance.name, [number(unbalance.of(row.part.unbalance_kg_m)) for row in rows]),
        Column("at, deg", [_cell(row.part.unbalance_own_deg) for row in rows]),
        Column("opening, deg", [_cell(row.part.opening_deg) for row in rows]),
    ]
    radii = [row.part.outer_radius_m or row.part.swing_radius_m for row in rows]
    columns.append(Column(f"R, {length.name}", [_cell(r, length.size) for r in radii]))
    clearances = [_tell_clearance(row, length) for row in rows]
    columns.append(Column(f"clearance, {length.name}", clearances, words=True))
    if any(row.part.worst_kg_m is not None for row in rows):
        for label, key in (("worst ±", "worst_kg_m"), ("rss ±", "rss_kg_m")):
            cells = []
            for row in rows:
                deviation = getattr(row.part, key)
                cells.append(UNKNOWN if deviation is None else number(unbalance.of(deviation)))
            columns.append(Column(f"{label}, {unbalance.name}", cells))
    shown = [column for column in columns if {*column.cells} != {UNKNOWN}]
    return Grid("Webs", shown, _WEBS_NOTE)


def _tell_clearance(row: WebRow, length: ShownUnit) -> str:
    """Return the clearance of a row of webs, with the crank angles at which they have it."""
    gap = row.part.clearance_m
    cell = _cell(gap, length.size, digits_m=6)
    if gap is None:
        return cell
    angles = dict.fromkeys(number(angle) for angle in row.clearances_deg)
    return f"{cell} at {' or '.join(angles)} deg"


def _cell(value: float | None, size: float = 1.0, digits_m: int = 12) -> str:
    """Return a figure for a table.

    Args:
        value: Figure; None: not known.
        size: Size of the unit, in SI units.
        digits_m: Decimals to which the figure is rounded.
    """
    return UNKNOWN if value is None else number((round(value, digits_m) + 0.0) / size)


def _lay_out_throws(throws: Iterable[ThrowPart], system: System) -> Grid:
    rows = list(throws)
    degrees = [throw.degree_of_balance for throw in rows]
    factors = [throw.factor for throw in rows]
    masses = [throw.throw_mass_kg for throw in rows]
    columns = [
        Column("throw", [str(throw.throw) for throw in rows], words=True),
        Column(f"throw itself, {system.mass.name}", [_cell(m, system.mass.size) for m in masses]),
        Column("degree of balance, %", [_percent(degree) for degree in degrees]),
        Column("balance factor, %", [_percent(factor) for factor in factors]),
    ]
    shown = [column for column in columns if {*column.cells} != {UNKNOWN}]
    note = _THROWS_NOTE
    if any(factor is not None and factor < -_ROUNDING for factor in factors):
        note += " A negative factor: not even all rotating mass is balanced."
    return Grid("Throws", shown, note)


def _percent(share: float | None) -> str:
    return UNKNOWN if share is None else number(round(100 * share, 9) + 0.0)


def list_web_rows(parts: BalanceParts) -> Iterator[FigureRow]:
    """Yield every figure of webs, throws and crankshaft in SI units."""
    for web in parts.webs or ():
        name = f"web {web.web}"
        yield from record_rows(0, name, None, web, "web")
        for number_of_axis, place in enumerate(web.cg_m or (), 1):  # CSV has no lists
            yield FigureRow(0, name, None, f"cg_m.{number_of_axis}", place + 0.0, "m")
    for throw in parts.throws or ():
        yield from record_rows(0, f"throw {throw.throw}", None, throw, "throw")
    if parts.crank is not None:
        yield from record_rows(0, "crank", None, parts.crank)
