"""Build the gas in an engine's cylinders from [gas] and the gas keys of single cylinders.

The pressure in a cylinder is measured (an indicator diagram, `engine.indicator`) or computed from a
cycle (`core.gas_cycle`). Instead of a pressure, tables of engine builders give harmonics of the
torque. Cylinders with equal mechanism, diagram and heat share one torque curve.

Some figures of [gas] may be arrays of variants (`list_together`), while all others are numbers. The
curves of the gas then have a figure with the shape of the variants.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import fields, replace
from functools import cache, lru_cache, partial
from typing import NamedTuple, TypeVar

import numpy as np

from ..core.compressor import Compression, compress
from ..core.cylinder_pressure import (
    CRANK_END,
    HEAD_END,
    GasEnd,
    GasError,
    GasPiston,
    GasTorque,
    blend,
    pistons,
    press_both,
)
from ..core.cylinders import find_travel
from ..core.gas_cycle import GasCycle, Goal, Process, find_least_imep, gas_cycle
from ..core.phasors import Array, Figure
from ..core.piecewise import resolved
from ..errors import BalcliError, InputError, Problem
from ..file.csv_columns import Head, NumberColumns, list_heads, read_columns
from ..file.doubt import Doubt
from ..file.fields import WrittenFigure
from ..file.gas_tables import (
    COMPRESSOR,
    DIAGRAM_KEYS,
    MEAN_PRESSURES,
    CrankEnd,
    Gas,
    GasOf,
    take_crank_end,
    take_of,
)
from ..file.model import EngineFile, Override
from ..file.table import FileTable
from ..file.toml import locate_beside
from ..file.units import BAR, ask_unit
from ..limits import HIGHEST_TABLE_ORDER, MOST_DIFFERENT_GAS
from .card import draw_card
from .engine import Engine
from .gas import CylinderGas, EngineGas, GasLaw
from .indicator import HEADS, build_diagram, choose_heads, find_absolute, list_doubts
from .layout import find_first
from .parts import Parts

_HARMONICS = (Head("order"), Head("cos"), Head("sin"))
# A warning is given if the heat, divided by the product of the charge's pressure and volume, is
# above this ratio. If the fuel uses all the air, the ratio is 34: 2.95 MJ per kg of air at 300 K,
# for petrol and Diesel fuel alike.
HEAT_MOST = 40.0
# Pressure in bar over the least possible one, where its figure may be meant in MPa (10 bar)
_SHARE_IN_MPA = 0.05, 0.5
_NO_KEYS = Override.model_construct()  # table of a cylinder that has none
_KEPT = 512  # number of speeds for which the gas is cached
_OVERSPEED = 1.6  # beyond this multiple of the rated speed, the gas is not interpolated
Table = TypeVar("Table", bound=FileTable)
TableWithEnd = TypeVar("TableWithEnd", Gas, GasOf)


class _Source(NamedTuple):
    """The gas keys that apply to one cylinder.

    Attributes:
        number: Cylinder number.
        gas: Gas of the cylinder, in the form of [gas].
        table: Number of the [[gas.of]] with this gas; 0: [gas] itself.
        path: Key that names the file with the indicator diagram of the cylinder.
        indicator: Name of the file with this diagram; None without a diagram.
        heat: Heat supplied in a computed cycle, J; None if the file gives none.
        heat_path: Key that gives this heat.
        share: Factor by which the gas force is multiplied.
    """

    number: int
    gas: Gas
    table: int
    path: str
    indicator: str | None
    heat: Figure | None
    heat_path: str
    share: float

    @property
    def place(self) -> str:
        """Path of the table with the gas of the cylinder."""
        return f"gas.of.{self.table}" if self.table else "gas"

    @property
    def compresses(self) -> bool:
        """Whether the head end has a compressor cycle."""
        return self.indicator is None and self.gas.cycle == COMPRESSOR

    @property
    def burns_nothing(self) -> bool:
        """Whether the cylinder compresses and expands its charge without heat."""
        return self.heat is not None and not np.any(self.heat)


def build_gas(parts: Parts) -> EngineGas:
    """Return the gas of an engine with [gas] whose other tables fit together. If the gas depends on
    the speed, return the gas at the first speed of the file, with a law for other speeds.

    Raises:
        InputError: [gas], gas keys of single cylinders or files named there have mistakes; the
            error lists all of them.
    """
    gas = _vary(parts)
    bores = [_find_diameter(parts, number, "bore", "bore") for number in parts.numbers]
    rods = [
        _find_diameter(parts, number, "piston_rod_diameter", "rod_diameter")
        for number in parts.numbers
    ]
    sources = [_find_source(parts, gas, number) for number in parts.numbers]
    if problems := list(_list_contradictions(parts, gas, sources, bores, rods)):
        raise InputError(problems)
    areas = [math.pi / 4 * (bore / 1e3) ** 2 for bore in bores]
    rod_areas = [math.pi / 4 * (rod / 1e3) ** 2 for rod in rods]
    gas_pistons = pistons(parts.cylinders, np.array(areas), np.array(rod_areas))

    @cache
    def read(name: str, heads: tuple[Head, ...]) -> NumberColumns:
        return read_columns(locate_beside(parts.model.folder, name), heads)

    make = partial(_build_steady, parts, gas_pistons, read)
    rows = [row for row, one in enumerate(sources) if one.heat is None and one.indicator is None]
    if not gas.speeds or (gas.law and not rows):  # no cylinder follows the law
        return make(gas)
    strokes = parts.model.layout.strokes
    following = [gas_pistons[k] for k in rows]
    return _follow_speed(gas, make, partial(_find_knees, gas, following, strokes))


def _find_knees(gas: Gas, gas_pistons: Sequence[GasPiston], strokes: int) -> list[Array]:
    """Return, for each piston, the speed (as a share of the rated speed) up to which the propeller
    law demands less imep than the cycle has without heat. For a dual cycle, a second array follows:
    the speeds up to which the law demands less imep than the cycle needs to reach `max_pressure`.
    """
    process = _describe_process(gas, strokes)
    rated = _find_goal(gas, None).value
    kinds = ("otto", "dual") if gas.cycle == "dual" else (process.cycle,)
    processes = [replace(process, cycle=kind) for kind in kinds]
    least = [[find_least_imep(piston, one) for piston in gas_pistons] for one in processes]
    return [np.sqrt(np.maximum(each, 0.0) / rated) for each in least]


def _follow_speed(
    gas: Gas, make: Callable[..., EngineGas], find_knees: Callable[[], list[Array]]
) -> EngineGas:
    """Return the gas at the first speed of the file, with its law for other speeds.

    Args:
        gas: Table of a gas that depends on the speed.
        make: Function that returns the gas for the table of one speed, such as `_build_steady`.
        find_knees: Function that returns the arrays of `_find_knees`; used for a propeller law.

    Raises:
        InputError: The same errors as for `build_gas`.
    """
    nodes: dict[float, EngineGas] = {}
    problems: list[Problem] = []
    doubts: list[Doubt] = []
    for number, speed in enumerate(gas.speeds, 1):
        locate = partial(_locate_at_point, gas, number)
        try:
            nodes[speed] = make(_take_at(gas, speed))
        except InputError as error:
            problems += (one._replace(path=locate(one.path)) for one in error.problems)
            continue
        for path, message, also, _ in nodes[speed].doubts:
            doubts.append(Doubt(locate(path), message, tuple(map(locate, also))))
    if problems:
        raise InputError(list(dict.fromkeys(problems)))

    @lru_cache(_KEPT)
    def solve(speed: float) -> EngineGas:
        if speed in nodes:
            return nodes[speed]
        if gas.cycle is None:
            return _blend(nodes, speed)
        return make(_take_at(gas, speed), at_least=gas.law is not None and speed < gas.speeds[-1])

    first = nodes[gas.speeds[0]]
    speeds = gas.speeds
    least = 0.0
    if gas.law is not None:
        (rated,) = gas.speeds
        knees = find_knees()
        low = {0.0, *(rated * share for share in np.ravel(knees).tolist() if share < 1)}
        speeds = (*sorted(low), rated)
        least = rated * float(knees[0].max())
        with suppress(InputError):  # the cycle may not reach this imep
            solve(rated * _OVERSPEED)
            speeds = (*speeds, rated * _OVERSPEED)
    law = GasLaw(solve, speeds, gas.cycle is None, 2 if gas.law else 1, least)
    return replace(first, doubts=tuple(dict.fromkeys(doubts)), law=law)


def _blend(nodes: Mapping[float, EngineGas], speed: float) -> EngineGas:
    """Return the gas at a speed, with pressures interpolated linearly between given speeds."""
    low = max((node for node in nodes if node < speed), default=min(nodes))
    high = min((node for node in nodes if node > speed), default=low)
    if high == low or speed < low:
        return nodes[low]
    share = (speed - low) / (high - low)
    slower = nodes[low].cylinders
    faster = nodes[high].cylinders
    rows = {cylinder.like for cylinder in slower}
    torques = {row: blend(slower[row].torque, faster[row].torque, share) for row in rows}
    each = (cylinder._replace(torque=torques[cylinder.like]) for cylinder in slower)
    return replace(nodes[low], cylinders=tuple(each))


def _take_at(gas: Gas, speed: float) -> Gas:
    """Return [gas] without [[gas.at]] and law: a table whose figures are those of `gas` at one
    speed (rpm), and whose texts are those of the point of [[gas.at]] nearest to this speed.
    """
    if gas.rated_speed is not None:
        grown = (speed / gas.rated_speed) ** 2
        figures = {key: getattr(gas, key) * grown for key in MEAN_PRESSURES if gas.has(key)}
    else:
        nearest = min(gas.at, key=lambda point: abs(point.speed - speed))
        figures = {key: getattr(nearest, key) for key in gas.keys_of_points}
        for key in filter(lambda key: isinstance(figures[key], float), gas.keys_of_points):
            values = [getattr(point, key) for point in gas.at]
            figures[key] = float(np.interp(speed, gas.speeds, values))
    kept = gas.model_fields_set - {"at", "law", "rated_speed"}
    return Gas.model_construct(**{key: getattr(gas, key) for key in kept} | figures)


def _locate_at_point(gas: Gas, number: int, path: str) -> str:
    """Return the path `gas.at.1.imep` for `gas.imep` if the points of [[gas.at]] give this key;
    other paths are returned unchanged.

    Args:
        gas: Table [gas] of the file.
        number: Number of the point.
        path: Path of a key.
    """
    table, _, key = path.rpartition(".")
    return f"gas.at.{number}.{key}" if table == "gas" and key in gas.keys_of_points else path


def _build_steady(
    parts: Parts,
    gas_pistons: Sequence[GasPiston],
    read: Callable[[str, tuple[Head, ...]], NumberColumns],
    gas: Gas,
    *,
    at_least: bool = False,
) -> EngineGas:
    """Return the gas of a table whose figures hold at all speeds.

    Args:
        parts: Stages of the engine.
        gas_pistons: Piston of each row of the cylinders.
        read: Function that returns the columns of a file by its name and headings.
        gas: Table of the gas.
        at_least: Whether the table may ask for too little imep. A dual cycle then need not reach
            `max_pressure`, and a cycle burns nothing if the table asks for less imep than the
            cycle has without heat.

    Raises:
        InputError: The same errors as for `build_gas`.
    """
    strokes = parts.model.layout.strokes
    problems = list[Problem]()
    sources = [_find_source(parts, gas, number) for number in parts.numbers]
    keys = [
        (*mechanism, piston.area, piston.rod_area, source.indicator, source.heat, source.table)
        for mechanism, piston, source in zip(
            parts.cylinders.mechanisms, gas_pistons, sources, strict=True
        )
    ]
    like = [keys.index(key) for key in keys]  # row of the first cylinder with an equal torque
    if (different := len(set(like))) > MOST_DIFFERENT_GAS:
        many = f"{different} cylinders differ in mechanism, heat or diagram; at most "
        message = f"{MOST_DIFFERENT_GAS} are computed: give more of them the same figures"
        raise InputError([Problem("gas", many + message)])

    torques = dict[int, GasTorque]()
    doubts: list[Doubt] = []
    overfed: list[Doubt] = []
    for row in sorted(set(like)):
        source = sources[row]
        piston = gas_pistons[row]
        own = source.gas if source.table else gas
        name = source.indicator or own.harmonics
        if source.indicator is None and name is not None:
            try:
                torques[row] = _read_harmonics(name, read(name, _HARMONICS), piston, strokes)
            except BalcliError as error:
                problems.append(Problem("gas.harmonics", str(error)))
            continue
        single_acting = own.crank_end is None
        heads = partial(_list_heads, parts)
        made = _EndMaker(piston, read, strokes, heads, doubts, overfed, fires=single_acting)
        try:
            head, breaks = made.make_head(own, source, at_least=at_least)
            ends = [head, *made.make_crank_end(own, source)]
        except InputError as error:
            problems += error.problems
            continue
        under = own.crankcase * BAR
        torques[row] = press_both(piston, ends, breaks, under, strokes * np.pi)
    if problems:
        raise InputError(list(dict.fromkeys(problems)))
    measured = any(source.indicator is not None for source in sources)
    idle = gas.list_idle_keys(strokes, measured, computed=gas.cycle is not None)
    given = [key for key in ("crankcase", "exhaust") if key in gas.model_fields_set & idle]
    doubts += overfed[:1]
    doubts += [Doubt(f"gas.{key}", "changes nothing in this engine") for key in given]
    nominal = _find_nominal(parts, [piston.top for piston in gas_pistons])
    cylinders = (
        CylinderGas(piston, torques[row], angle, source.share, source.heat, row, source.compresses)
        for piston, row, angle, source in zip(gas_pistons, like, nominal, sources, strict=True)
    )
    return EngineGas(
        tuple(cylinders),
        180 * strokes,
        gas.mechanical_efficiency,
        gas.compression_ratio,
        tuple(doubts),
    )


def vary_pistons(
    model: EngineFile, varied: Mapping[str, Figure], gas: EngineGas, arrays: Engine
) -> EngineGas:
    """Return the gas of variants of an engine whose cylinders are equal and have their dead centres
    at 0 and 180 degrees in all variants.

    Args:
        model: Engine file.
        varied: Figures of the gas that vary, as numbers or arrays, by dotted name.
        gas: Gas of one of the variants.
        arrays: The variants, as an engine with a trailing axis.

    Raises:
        InputError: The cycle of a variant is not possible.
    """
    parts = Parts(model, varied)
    table = _vary(parts)
    c = arrays.cylinders
    first = gas.cylinders[0]
    piston = replace(
        first.piston,
        area=math.pi / 4 * arrays.bore_m**2,
        stroke=find_travel(c).stroke[0],
        radius=c.radius[0],
        lam=c.lam[0],
        eps=c.eps[0],
    )
    source = _find_source(parts, table, parts.numbers[0])
    cycle = _compute_cycle(table, source, piston, model.layout.strokes, at_least=False)
    end = GasEnd(HEAD_END, piston, cycle.pressure)
    torque = press_both(piston, [end], cycle.breaks, first.torque.crankcase, gas.cycle)
    cylinders = [each._replace(piston=piston, torque=torque) for each in gas.cylinders]
    return replace(gas, cylinders=tuple(cylinders))


# ------------------------------------------------------------------ keys of the file
def _vary(parts: Parts) -> Gas:
    """Return [gas] with the varied figures in place of those of the file, and without keys that
    the varied figures exclude.
    """
    gas = _vary_table(parts, "gas", parts.model.gas or Gas.model_construct())
    points = (_vary_table(parts, f"gas.at.{k}", point) for k, point in enumerate(gas.at, 1))
    gas = gas.model_copy(update={"at": tuple(points)}) if gas.at else gas
    if gas.of:
        tables = [_vary_of(parts, f"gas.of.{k}", table) for k, table in enumerate(gas.of, 1)]
        gas = gas.model_copy(update={"of": tuple(tables)})
    return _vary_crank_end(parts, "gas", gas)


def _vary_of(parts: Parts, path: str, table: GasOf) -> GasOf:
    return _vary_crank_end(parts, path, _vary_table(parts, path, table))


def _vary_crank_end(parts: Parts, path: str, table: TableWithEnd) -> TableWithEnd:
    """Return a table with the varied figures of its crank end."""
    end: CrankEnd | None = table.crank_end
    if end is None:
        return table
    varied = _vary_table(parts, f"{path}.crank_end", end)
    return table.model_copy(update={"crank_end": varied})


def _vary_table(parts: Parts, path: str, table: Table) -> Table:
    """Return the table at a path with its varied figures, and without keys that the varied figures
    exclude.
    """
    varied = parts.figures.of_table(path)
    if not varied:
        return table
    displaced = {rival for key in varied for rival in table.rivals(key)}
    kept = {key: getattr(table, key) for key in table.model_fields_set - displaced}
    changed = kept | {key: np.asarray(value, float)[()] for key, value in varied.items()}
    return type(table).model_construct(**changed)


def _take(parts: Parts, path: str, given: float | None) -> float | None:
    found = parts.figures.take_optional(path, given)
    return None if found is None else float(found)


def _list_heads(parts: Parts, name: str) -> list[str]:
    """Return the heads of the columns of a file next to the engine file."""
    return list_heads(locate_beside(parts.model.folder, name))


def _find_diameter(parts: Parts, number: int, key: str, general: str) -> float:
    """Return a diameter of a cylinder, mm: that of [cylinder.N], or that of [piston]; 0 if the file
    gives none.

    Args:
        parts: Stages of the engine.
        number: Number of the cylinder.
        key: Key in [cylinder.N].
        general: Key in [piston].
    """
    own = parts.override(number, key)
    if own is not None:
        return float(own)
    return _take(parts, f"piston.{general}", getattr(parts.model.piston, general)) or 0.0


def _find_source(parts: Parts, gas: Gas, number: int) -> _Source:
    path = f"cylinder.{number}"
    own_table = next((k for k, one in enumerate(gas.of, 1) if number in one.cylinders), 0)
    if own_table:
        gas = take_of(gas, gas.of[own_table - 1])
    general = f"gas.of.{own_table}" if own_table else "gas"
    table = parts.model.cylinder.get(number, _NO_KEYS)
    heat = _take(parts, f"{path}.heat", table.heat)
    heat_path = f"{general}.heat" if heat is None else f"{path}.heat"
    share = _take(parts, f"{path}.gas", 1.0 if table.gas is None else table.gas) or 0.0
    if table.indicator is not None:
        own_path = f"{path}.indicator"
        return _Source(number, gas, own_table, own_path, table.indicator, None, heat_path, share)
    heat = (gas.heat if heat is None else heat) if gas.indicator is None else None
    heat = None if gas.cycle == COMPRESSOR else heat
    own_path = f"{general}.indicator"
    return _Source(number, gas, own_table, own_path, gas.indicator, heat, heat_path, share)


def _list_pump_mistakes(
    parts: Parts,
    gas: Gas,
    sources: Sequence[_Source],
    bores: Sequence[float],
    rods: Sequence[float],
) -> Iterator[Problem]:
    """Yield the mistakes in [[gas.of]], crank ends, compressor cycles and diameters of rods."""
    yield from _check_numbers_of(parts, gas)
    if gas.harmonics is not None and gas.crank_end is not None:
        message = (
            "is the torque of whole cylinders; with crank_end, give each end a diagram or a cycle"
        )
        yield Problem("gas.harmonics", message)
    for source in {source.table: source for source in sources}.values():
        yield from _check_ends(source)
    all_compress = all(source.compresses for source in sources)
    if parts.model.layout.strokes == 4 and all_compress:
        yield Problem(
            "layout.strokes", "is 4, but all cylinders compress in every turn; give strokes = 2"
        )
    compressing = sum(source.compresses for source in sources)
    if gas.mechanical_efficiency is not None and 0 < compressing < len(sources):
        yield Problem(
            "gas.mechanical_efficiency",
            "has no meaning where some cylinders drive and others compress; leave it out",
        )
    yield from _check_rod_diameters(parts, bores, rods)


def _check_ends(source: _Source) -> Iterator[Problem]:
    """Check the keys of the gas in both ends of a cylinder."""
    head = source.gas
    if source.table:
        yield from (Problem(source.place, fault) for fault in head.contradictions())
        if not (head.has("cycle") or head.has("indicator")):
            yield Problem(source.place, "has no gas; give cycle or indicator")
    faults = [*head.list_compressor_faults()]
    for key, fault in faults:
        yield Problem(f"{source.place}.{key}".removesuffix("."), fault)
    end = take_crank_end(head)
    of_end = [] if end is None else [*end.list_compressor_faults()]
    for key, fault in of_end:
        if (key, fault) not in faults:  # a key of the head end, which it takes
            yield Problem(f"{source.place}.crank_end.{key}".removesuffix("."), fault)


def _check_diagram_keys(parts: Parts, gas: Gas) -> Iterator[Problem]:
    """Check that every table with a key of a diagram has the diagram to which it applies."""
    own = any(table.indicator is not None for table in parts.model.cylinder.values())
    yield from _list_idle_diagram_keys("gas", gas, has_diagram=own or gas.has("indicator"))
    yield from _check_keys_of_crank_end("gas", gas, gas.crank_end)
    for k, table in enumerate(gas.of, 1):
        path = f"gas.of.{k}"
        merged = take_of(gas, table)
        has_diagram = merged.indicator is not None
        yield from _list_idle_diagram_keys(path, table, has_diagram=has_diagram)
        yield from _check_keys_of_crank_end(path, merged, table.crank_end)


def _check_keys_of_crank_end(path: str, head: Gas, own: CrankEnd | None) -> Iterator[Problem]:
    """Check the keys of a diagram in a crank end.

    Args:
        path: Path of the table with the crank end.
        head: Gas of the head end, with the crank end.
        own: Crank end as the table gives it; None without one.
    """
    merged = take_crank_end(head)
    if own is not None and merged is not None:
        has_diagram = merged.indicator is not None
        yield from _list_idle_diagram_keys(f"{path}.crank_end", own, has_diagram=has_diagram)


def _list_idle_diagram_keys(path: str, table: FileTable, *, has_diagram: bool) -> Iterator[Problem]:
    """Yield a problem for each key of a diagram in a table that has none."""
    for key in () if has_diagram else DIAGRAM_KEYS:
        if table.has(key):
            message = "has no meaning without an indicator diagram in the same table; leave it out"
            yield Problem(f"{path}.{key}", message)


def _check_rod_diameters(
    parts: Parts, bores: Sequence[float], rods: Sequence[float]
) -> Iterator[Problem]:
    """Check that the first piston rod that is too thick is below its bore."""
    for number, bore, rod in zip(parts.numbers, bores, rods, strict=True):
        if bore and rod >= bore:
            own = parts.override(number, "piston_rod_diameter") is not None
            path = f"cylinder.{number}.piston_rod_diameter" if own else "piston.rod_diameter"
            yield Problem(path, f"{rod:g} mm is not below the bore of {bore:g} mm")
            return


def _check_numbers_of(parts: Parts, gas: Gas) -> Iterator[Problem]:
    """Check that every [[gas.of]] names cylinders of the engine that no other table names, and that
    these have no gas keys of their own.
    """
    tables = dict[int, int]()
    for k, table in enumerate(gas.of, 1):
        path = f"gas.of.{k}.cylinders"
        for number in table.cylinders:
            if number not in parts.numbers:
                listed = ", ".join(map(str, sorted(parts.numbers)))
                yield Problem(path, f"{number} is no cylinder of this engine; there are {listed}")
            elif number in tables:
                other = tables[number]
                message = (
                    f"has cylinder {number}, and so does gas.of.{other}; give it in one of them"
                )
                yield Problem(path, message)
            tables[number] = k
    for number, override in parts.model.cylinder.items():
        for key in ("indicator", "heat"):
            if number in tables and getattr(override, key) is not None:
                message = (
                    f"cylinder {number} has its gas in gas.of.{tables[number]}; give {key} there"
                )
                yield Problem(f"cylinder.{number}.{key}", message)


def _list_contradictions(
    parts: Parts,
    gas: Gas,
    sources: Sequence[_Source],
    bores: Sequence[float],
    rods: Sequence[float],
) -> Iterator[Problem]:
    """Yield the contradictions between [gas], keys of single cylinders and the engine.

    Args:
        parts: Stages of the engine.
        gas: Table [gas] with the varied figures.
        sources: Gas keys that apply to each row of the cylinders.
        bores: Bore of each row, mm; 0: not given.
        rods: Diameter of the piston rod of each row, mm; 0: none.
    """
    two_stroke = parts.model.layout.strokes == 2
    yield from (Problem("gas", fault) for fault in gas.contradictions())  # from varied figures
    yield from _list_pump_mistakes(parts, gas, sources, bores, rods)
    if not all(bores):
        yield Problem.of_missing("piston.bore", "the gas force needs it, such as bore = 86")
    compressor_only = all(source.compresses for source in sources)
    needs_order = not two_stroke and not compressor_only
    if needs_order and parts.order is None and len(parts.numbers) > 1:
        message = "it sets in which of two turns each cylinder fires; example: [1, 3, 4, 2]"
        yield Problem.of_missing("layout.firing_order", message)
    with_own_gas = {number for table in gas.of for number in table.cylinders}
    for number, table in parts.model.cylinder.items():
        if table.heat is not None and number not in with_own_gas:
            yield from _refuse_heat(gas, number)
        for key in sorted(gas.keys_of_points & table.model_fields_set):
            message = (
                f"[[gas.at]] gives {key} of all cylinders at each speed; leave one of the two out"
            )
            yield Problem(f"cylinder.{number}.{key}", message)
    yield from _check_diagram_keys(parts, gas)
    if two_stroke and gas.intake_closes is not None:
        message = "has no meaning in a two-stroke cycle, whose ports close where they opened"
        yield Problem("gas.intake_closes", f"{message}: leave it out")
    if two_stroke and gas.zero == "gas-exchange":
        message = 'a two-stroke cycle has no gas-exchange dead centre; give "firing"'
        yield Problem("gas.zero", message)


def _refuse_heat(gas: Gas, number: int) -> Iterator[Problem]:
    """Yield a problem if the gas in [gas] has no heat that a cylinder could replace."""
    path = f"cylinder.{number}.heat"
    if gas.cycle is None:
        message = "belongs to a computed cycle, and [gas] has none; give an indicator diagram"
        yield Problem(path, message)
    elif gas.cycle == COMPRESSOR:
        message = "belongs to a cycle with combustion, and the cylinder compresses; leave it out"
        yield Problem(path, message)


# ------------------------------------------------------------------ builders' tables
def _read_harmonics(
    name: str, columns: NumberColumns, piston: GasPiston, strokes: int
) -> GasTorque:
    """Return the torque of a builders' table: the torque divided by piston area and crank radius,
    in bar, is the sum of `a cos(n c) + b sin(n c)` over all orders n. Here c is the crank angle
    after the firing dead centre, and a and b are the columns cos and sin of the table.

    Raises:
        BalcliError: The first mistake in the table, with its line number.
    """
    orders, cosines, sines = (np.array(columns.column(k)) for k in range(3))
    if not len(orders):
        raise BalcliError(f"{name}: has no rows; give rows of order,cos,sin")
    step = 2 / strokes
    before = -math.inf
    for order, sine, line in zip(orders.tolist(), sines.tolist(), columns.lines, strict=True):
        wrong = ""
        if order <= before:
            wrong = f"order {order:g} is not above the order {before:g} before it"
        elif order > HIGHEST_TABLE_ORDER:
            wrong = f"order {order:g} is above {HIGHEST_TABLE_ORDER}, the highest order of a table"
        elif order == 0 and sine:
            wrong = f"order 0 has sin {sine:g}; it is the mean, which has no sine: write 0"
        elif order < 0 or order % step:
            wrong = f"order {order:g}: orders of {strokes}-stroke engines are multiples of {step:g}"
        if wrong:
            raise BalcliError(f"{name}: line {line}: {wrong}")
        before = order
    size = piston.area * piston.radius * BAR

    def torque(angle: Array) -> Array:
        turned = np.multiply.outer(angle, orders)
        return size * (np.cos(turned) @ cosines + np.sin(turned) @ sines)

    breaks = np.array([0.0, strokes * np.pi])
    return GasTorque(piston, breaks, resolved(torque, breaks))


# ------------------------------------------------------------------ ends of a cylinder
class _EndMaker(NamedTuple):
    """Makes the gas in the ends of a cylinder.

    Attributes:
        piston: Piston of the cylinder.
        read: Function that returns the columns of a file by its name and headings.
        strokes: 4 or 2.
        list_heads: Function that returns the heads of the columns of a file.
        doubts: List to which warnings are added.
        overfed: List to which warnings of too much heat are added.
        fires: Whether the highest pressure is expected near the dead centre at angle 0.
    """

    piston: GasPiston
    read: Callable[[str, tuple[Head, ...]], NumberColumns]
    strokes: int
    list_heads: Callable[[str], list[str]]
    doubts: list[Doubt]
    overfed: list[Doubt]
    fires: bool

    def make_head(self, gas: Gas, source: _Source, *, at_least: bool) -> tuple[GasEnd, Array]:
        """Return the gas of the head end, and the angles between which its pressure is smooth.

        Raises:
            InputError: The cycle is not possible, or the diagram has a mistake.
        """
        if source.indicator is not None:
            head = self._read_end(gas, source.path, source.indicator, crank_end=False)
            return head, head.pressure.breaks
        if gas.cycle == COMPRESSOR:
            head = self._compress(gas, source.place, crank_end=False)
            return head, head.pressure.breaks
        cycle = _compute_cycle(gas, source, self.piston, self.strokes, at_least=at_least)
        self.overfed.extend(_doubt_heat(gas, source, self.piston, cycle))
        clearance = None if gas.compression_ratio is None else 1 / (gas.compression_ratio - 1)
        end = GasEnd(HEAD_END, self.piston, cycle.pressure, clearance=clearance)
        return end, cycle.breaks

    def make_crank_end(self, gas: Gas, source: _Source) -> list[GasEnd]:
        """Return the gas of the crank end in a list, which is empty for a single-acting cylinder.

        Raises:
            InputError: The cycle is not possible, or the diagram has a mistake.
        """
        end = take_crank_end(gas)
        if end is None:
            return []
        place = f"{source.place}.crank_end"
        if end.indicator is not None:
            path = f"{place}.indicator"
            return [self._read_end(end, path, end.indicator, crank_end=True)]
        if end.cycle == COMPRESSOR:
            return [self._compress(end, place, crank_end=True)]
        message = 'has no gas; give indicator, or cycle = "compressor" with its keys'
        raise InputError([Problem(place, message)])

    def _compress(self, gas: Gas, place: str, *, crank_end: bool) -> GasEnd:
        expands = gas.expansion_index if gas.has("expansion_index") else gas.compression_index
        process = Compression(
            suction=(gas.suction or math.nan) * BAR,
            discharge=(gas.discharge or math.nan) * BAR,
            clearance=gas.clearance or math.nan,
            compression_index=gas.compression_index,
            expansion_index=expands,
        )
        try:
            pressure = compress(self.piston, process, crank_end=crank_end)
        except GasError as error:
            raise InputError([Problem(f"{place}.{error.field}", str(error))]) from None
        efficiency = process.volumetric_efficiency
        name = CRANK_END if crank_end else HEAD_END
        return GasEnd(name, self.piston, pressure, efficiency, process.clearance)

    def _read_end(self, gas: Gas, path: str, name: str, *, crank_end: bool) -> GasEnd:
        try:
            heads = choose_heads(self.list_heads(name))
            columns = self.read(name, heads)
            if heads is HEADS:
                pressure, notes = build_diagram(gas, path, name, columns, self.strokes)
            else:
                notes = []
                pressure = draw_card(
                    gas,
                    name,
                    columns,
                    find_absolute(gas, name, columns),
                    self.piston,
                    self.strokes,
                    from_volume=heads[0].usual == "volume",
                    crank_end=crank_end,
                )
        except BalcliError as error:
            raise InputError([Problem(path, str(error))]) from None
        if heads is not HEADS and gas.has("phase"):
            message = "has no meaning for a card over volume or stroke; leave it out"
            raise InputError([Problem(f"{path.rpartition('.')[0]}.phase", message)])
        clearance = None
        if not crank_end and gas.compression_ratio is not None:
            clearance = 1 / (gas.compression_ratio - 1)
        end_name = CRANK_END if crank_end else HEAD_END
        end = GasEnd(end_name, self.piston, pressure, clearance=clearance)
        imep = end.work / end.swept
        doubts = list_doubts(gas, path, columns, pressure, imep, fires=self.fires)
        self.doubts.extend([*notes, *doubts])
        return end


# ------------------------------------------------------------------ computed cycles
def _compute_cycle(
    gas: Gas, source: _Source, piston: GasPiston, strokes: int, *, at_least: bool
) -> GasCycle:
    """Return the computed cycle of a cylinder; arguments as for `_build_steady`.

    Raises:
        InputError: No cycle is possible with the value of a key.
    """
    process = _describe_process(gas, strokes)
    goal = _find_goal(gas, source.heat)
    if source.heat is not None:
        process = _reverse_without_heat(process, source.heat)
    try:
        if at_least and goal.name == "imep":
            if process.cycle == "dual" and goal.value < find_least_imep(piston, process):
                process = replace(process, cycle="otto")
            goal = Goal("imep", max(goal.value, find_least_imep(piston, process)))
        return gas_cycle(piston, process, goal)
    except GasError as error:
        raise InputError([_locate(error, gas, source)]) from None


def _reverse_without_heat(process: Process, heat: Figure) -> Process:
    """Return a process whose expansion reverses its compression in variants without heat."""
    burns = np.asarray(heat) != 0
    index = np.where(burns, process.expansion_index, process.compression_index)[()]
    cycle = process.cycle if burns.any() else "otto"
    return replace(process, cycle=cycle, expansion_index=index)


def _describe_process(gas: Gas, strokes: int) -> Process:
    """Return the process of a computed cycle, in SI units."""
    keys = [field.name for field in fields(Process) if field.name != "strokes"]
    given = {key: getattr(gas, key) for key in keys}
    for key in ("intake", "exhaust", "max_pressure"):
        given[key] = None if given[key] is None else given[key] * BAR
    return Process(strokes=strokes, **given)


def _find_goal(gas: Gas, heat: Figure | None) -> Goal:
    """Return the figure that a computed cycle has to reach: `heat` (J), or the figure of [gas] if
    `heat` is None.
    """
    if heat is not None:
        return Goal("heat", heat)
    if gas.cut_off is not None:
        return Goal("cut_off", gas.cut_off)
    if gas.bmep is not None:
        return Goal("imep", gas.bmep * BAR / (gas.mechanical_efficiency or math.nan))
    if gas.imep is not None:
        return Goal("imep", gas.imep * BAR)
    most = 0.0 if gas.max_pressure is None else gas.max_pressure
    return Goal("max_pressure", most * BAR)


def _locate(error: GasError, gas: Gas, source: _Source) -> Problem:
    """Return the mistake in a cylinder's cycle with its path in the file."""
    if error.field == "heat":
        return Problem(source.heat_path, str(error))
    if error.field == "expansion_index" and source.burns_nothing:
        what = f"cylinder {source.number} burns nothing; its expansion has the same index"
        return Problem("gas.compression_index", f"{error}; {what}")
    if error.field == "imep" and gas.bmep is not None:
        asked = _ask_pressure_unit(error, gas.bmep)
        return Problem("gas.bmep", f"imep = bmep / mechanical_efficiency {error}{asked}")
    asked = ""
    if error.field in ("imep", "max_pressure"):
        asked = _ask_pressure_unit(error, getattr(gas, error.field))
    return Problem(f"gas.{error.field}", f"{error}{asked}")


def _ask_pressure_unit(error: GasError, pressure: Figure | None) -> str:
    """Return the question for the unit of a pressure that is too small by so much that it may be in
    MPa; empty if it is not, or if it is no bare number of the file.
    """
    least, most = _SHARE_IN_MPA
    is_bare = isinstance(pressure, (int, float)) and not isinstance(pressure, WrittenFigure)
    if not is_bare or not least <= error.share <= most:
        return ""
    return f"; {ask_unit('bar', f'{pressure:g} MPa')}"


def _doubt_heat(gas: Gas, source: _Source, piston: GasPiston, cycle: GasCycle) -> Iterator[Doubt]:
    """Yield a warning if the heat is more than the air of the charge can burn; none for arrays."""
    if np.ndim(cycle.heat):
        return
    ratio = gas.compression_ratio or math.nan
    charge = gas.intake * BAR * float(piston.volume(cycle.breaks[0], ratio))
    if cycle.heat > HEAT_MOST * charge:
        path = _locate(GasError(_find_goal(gas, source.heat).name, ""), gas, source).path
        message = (
            f"needs {cycle.heat:.4g} J of heat in each cycle, more than the air of the charge can "
            f"burn; is the intake pressure of {gas.intake:.4g} bar right? It is absolute, and "
            "higher in a supercharged engine"
        )
        yield Doubt(path, message, ("gas.intake",))


# ------------------------------------------------------------------ firing
def _find_nominal(parts: Parts, tops: Sequence[float]) -> Iterator[float]:
    """Yield `CylinderGas.nominal_deg` of each row. The first cylinder (`find_first`) fires at its
    dead centre in [-180, 180) deg, every other cylinder at its dead centre nearest to the angle
    that the firing order gives.

    Args:
        parts: Stages of the engine.
        tops: Top dead centre of each row's mechanism, rad.
    """
    fires = parts.fires_deg
    cycle = 180.0 * parts.model.layout.strokes
    origin = find_first(fires) if fires else 1
    first = parts.numbers.index(origin)
    for row, number in enumerate(parts.numbers):
        at = 0.0 - float(parts.cylinders.angle_deg[row])
        top = math.degrees(tops[row] - tops[first])
        wanted = float(fires[number] - fires[origin]) if number in fires else 0.0
        yield (at + 360.0 * round((wanted - top - at) / 360.0)) % cycle
