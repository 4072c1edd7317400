"""Read and build engines that are geared together one to one.

Each engine is built alone. `build_geared` joins the engines to one engine, called the whole, whose
`placed` has the place and the direction of rotation of each engine. `Engine.cranks` passes speed,
devices and point of reference of the whole on to each engine.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING, cast

from ..core.cylinders import Device
from ..core.phasors import Figure
from ..errors import BalcliError, InputError, Problem, note
from ..file.model import Counterweight, EngineFile, Operation, Shaft, Slider
from ..file.read import Draft
from ..file.toml import locate_beside, read_bytes
from ..limits import MOST_ENGINES
from .devices import build_device, list_drifting_problems
from .engine import Engine, Placed, Rating
from .figures import AS_GIVEN, FileFigures, find_wheel, place_in_plane, select_varied

if TYPE_CHECKING:
    from ..file.engine_tables import Engine as EngineTable
    from .gas import CylinderGas, EngineGas, GasLaw


# ------------------------------------------------------------------ files
def read_engines(draft: Draft, parse: Callable[[bytes, str], EngineFile]) -> Draft:
    """Return a file with [[engine]], joined with the files of its engines and with the mistakes of
    all these files.

    Args:
        draft: The file, whose engines are not yet read.
        parse: Function that returns the model of one engine from the text and name of its file.
    """
    model = draft.model
    problems = list(draft.problems)
    engines = tuple(filter(None, model.engine))
    if "engine" in draft.readable:
        problems += _check_engines(model)
    models: dict[str, EngineFile | None] = {}
    for k, table in enumerate(model.engine, 1):
        if table is None or table.file in models:
            continue
        models[table.file] = None
        with _collecting(problems, k, table.file):
            path = locate_beside(model.folder, table.file)
            models[table.file] = parse(read_bytes(path), str(path))
    cranks = tuple(filter(None, (models[table.file] for table in engines)))
    _tell_ignored(engines, cranks)
    if not problems:
        operation = _lend_speed(model, cranks[0])
        turning = {"operation": operation}
        # The uneven speed of the other cranks follows from that of the first one.
        steady = {"operation": operation.model_copy(update={"speed_ripple": ()})}
        others = [crank.model_copy(update=steady) for crank in cranks[1:]]
        model = model.model_copy(update=turning)
        model = model.with_cranks([cranks[0].model_copy(update=turning), *others])
    return draft._replace(model=model, problems=tuple(problems))


def _lend_speed(model: EngineFile, first: EngineFile) -> Operation:
    """Return the [operation] of a file, with speed and ripple of its first engine where the file
    gives none.
    """
    own = model.operation
    lent = {}
    for key in ("speed", "speed_ripple"):
        if first.operation.has(key) and not own.has(key):
            lent[key] = getattr(first.operation, key)
    return own.model_copy(update=lent)


def _check_engines(model: EngineFile) -> Iterator[Problem]:
    """Yield the contradictions between valid [[engine]] tables of a file."""
    engines = model.engine
    if len(engines) < 2:
        yield Problem("engine", f"only one engine is given; analyze {engines[0].file} itself")
    if len(engines) > MOST_ENGINES:
        yield Problem("engine", f"{len(engines)} engines; at most {MOST_ENGINES} are read")
        return
    for key in ("ratio", "phase"):
        if getattr(engines[0], key) != type(engines[0]).model_fields[key].default:
            message = "the first engine is the reference; its ratio is 1 and its phase 0"
            yield Problem(f"engine.1.{key}", message)
    names = model.crank_names
    for k, name in enumerate(names):
        if name in names[:k]:
            message = (
                f'"{name}" is also the name of engine {names.index(name) + 1}; give each its own'
            )
            yield Problem(f"engine.{k + 1}.name", message)
    loads = sum(engine.load for engine in engines)
    given = any(engine.has("load") for engine in engines)
    if given and loads not in (1, len(engines)):
        message = f"true for {loads} of {len(engines)} engines; set it for one or for all"
        yield Problem("engine.load", message)
    yield from _check_carriers(model)


def _check_carriers(model: EngineFile) -> Iterator[Problem]:
    """Yield the counterweights whose engine is unknown, or that name an axle."""
    names = model.crank_names
    for k, weight in enumerate(model.counterweight, 1):
        if weight.engine is not None and weight.engine not in names:
            message = f'"{weight.engine}" is no engine; the engines are {", ".join(names)}'
            yield Problem(f"counterweight.{k}.engine", message)
        if weight.axle is not None:
            yield Problem(f"counterweight.{k}.axle", "a file with [[engine]] has no axles")


_IGNORED = ("body", "mount", "point", "torsion", "locomotive")
_OF_FIRST_ENGINE = ("operation", "frame")  # used in the first engine's file, ignored in the others


def _tell_ignored(engines: Sequence[EngineTable], cranks: Sequence[EngineFile]) -> None:
    """Report the tables of the engines' files that are ignored."""
    ignored: tuple[str, ...] = _IGNORED
    for k, (table, crank) in enumerate(zip(engines, cranks, strict=False), 1):
        keys = [key for key in ignored if crank.has(key)]
        if keys:
            note(f"{table.file}: ignored in engine {k}: {', '.join(keys)}")
        ignored = (*_IGNORED, *_OF_FIRST_ENGINE)


@contextmanager
def _collecting(problems: list[Problem], number: int, file: str) -> Iterator[None]:
    """Collect the mistakes of an engine's file, each with the path `engine.N.file`."""
    try:
        yield
    except InputError as error:
        path = f"engine.{number}.file"
        problems += [Problem(path, f"{file}: {problem}") for problem in error.problems]
    except BalcliError as error:
        problems.append(Problem(f"engine.{number}.file", str(error)))


# ------------------------------------------------------------------ one engine of several
def build_geared(
    model: EngineFile,
    varied: Mapping[str, Figure] | None,
    build: Callable[[EngineFile, Mapping[str, Figure] | None], Engine],
) -> Engine:
    """Return the engine that a file with [[engine]] describes. Figures of an engine's own file vary
    by names such as `engine.2.rod.length`.

    Args:
        model: Engine file whose tables are valid.
        varied: Numbers or arrays that replace figures, by dotted name.
        build: Function that builds a single engine (`engine.build`).

    Raises:
        InputError: As `build` raises it for one of the engines.
    """
    changes = varied or {}
    problems = list[Problem]()
    engines: list[Engine] = []
    for k, (table, crank) in enumerate(zip(model.engine, model.cranks, strict=True), 1):
        own = dict(select_varied(changes, k))
        with _collecting(problems, k, table.file):
            engines.append(build(crank, own or None))
    problems += list_drifting_problems(model)
    if problems:
        raise InputError(list(dict.fromkeys(problems)))
    figures = FileFigures(changes, model)
    if model.flywheel is not None:
        wheels = [engines[0].flywheel_inertia, find_wheel(figures, model.flywheel)]
        engines[0] = replace(engines[0], flywheel_inertia=_add(wheels))
    whole = gear_engines([*_place_engines(model, figures, engines)])
    given = model.frame.reference
    power = model.operation.power
    if given is not None:
        x, y, z = figures.take_each("frame.reference", given)
        whole = replace(whole, reference_m=(x / 1e3, y / 1e3, z / 1e3))
    devices = []
    for path, entry in model.tables():
        drifts = isinstance(entry, Shaft) and entry.drifts
        if isinstance(entry, Counterweight | Shaft | Slider) and not drifts:
            devices.append(build_fitted(entry, whole, figures, path))
    return replace(
        whole,
        name=model.name,
        source=model.source,
        up_deg=model.frame.up,
        devices=tuple(devices),
        rated=Rating(model.operation.speed, None if power is None else 1e3 * power),
        model=None if varied else model,
    )


def build_fitted(
    table: Counterweight | Shaft | Slider,
    engine: Engine,
    figures: FileFigures = AS_GIVEN,
    path: str = "",
) -> Device:
    """Return a device of an engine, in SI units. If engines are geared together, the angle of a
    counterweight counts from cylinder 1's crank pin in the engine that carries the counterweight,
    in that engine's direction of rotation. The z of every device is in the axes of `engine`, which
    joins these engines.

    Args:
        table: Table of the device in an engine file.
        engine: Engine that has the device.
        figures: Figures of the file.
        path: Dotted name of the table.
    """
    carrier = getattr(table, "engine", None)
    names = [placed.name for placed in engine.placed]
    row = names.index(carrier) if carrier else 0
    own = engine.placed[row].engine if engine.placed else engine
    return build_device(table, own.first_axis_deg, figures, path)._replace(crank=row)


def gear_engines(placed: Sequence[Placed]) -> Engine:
    """Return one engine, the whole, of engines that are geared together. The whole has the speed
    and the point of reference of the first engine. Its `devices` are empty; each engine keeps its
    own devices.
    """
    placed = _turn_all(placed, placed[0].engine.speed_rpm)
    engines = [crank.engine for crank in placed]
    first = placed[0]
    fired = [engine for engine in engines if engine.gas is not None]
    x, y, z = first.engine.reference_m
    place = first.find_place(place_in_plane(x, y))
    cylinders: list[str] = []
    for crank in placed:
        cylinders += [f"{crank.name}.{number}" for number in crank.engine.numbers]
    strokes = max(engine.strokes for engine in fired or engines)
    weighed = chain.from_iterable(engine.weighed for engine in engines)
    places_known = all(engine.places_known for engine in engines)
    crank_inertia = _add(engine.crank_inertia for engine in engines if not engine.rotary)
    flywheel_inertia = _add(engine.flywheel_inertia for engine in engines)
    return replace(
        first.engine,
        numbers=tuple(cylinders),
        fires_deg={},
        strokes=strokes,
        reference_m=(place.real, place.imag, z + first.at_m[2]),
        devices=(),
        weighed=tuple(weighed),
        places_known=places_known,
        gas=_join_gas(placed),
        crank_inertia=crank_inertia,
        flywheel_inertia=flywheel_inertia,
        model=None,
        of_locomotive=False,
        placed=tuple(placed),
    )


def _turn_all(placed: Sequence[Placed], speed_rpm: Figure) -> list[Placed]:
    """Return the engines at a speed."""
    return [crank._replace(engine=crank.engine.at_speed(speed_rpm)) for crank in placed]


def _place_engines(
    model: EngineFile, figures: FileFigures, engines: Sequence[Engine]
) -> Iterator[Placed]:
    tables = model.engine
    given = any(table.has("load") for table in tables)
    loads = [table.load if given else k == 0 for k, table in enumerate(tables)]
    driving = tables[loads.index(True)].ratio
    for k, (name, table, engine) in enumerate(zip(model.crank_names, tables, engines, strict=True)):
        path = f"engine.{k + 1}"
        phase = figures.take(f"{path}.phase", table.phase)
        turn = figures.take(f"{path}.turn", table.turn)
        x, y, z = figures.take_each(f"{path}.at", table.at)
        at = (x / 1e3, y / 1e3, z / 1e3)
        sense = table.ratio if all(loads) else driving
        yield Placed(engine, name, table.file, table.ratio, phase, turn, at, loads[k], sense)


def _add(figures: Iterable[Figure | None]) -> Figure | None:
    given = [figure for figure in figures if figure is not None]
    if not given:
        return None
    return cast("Figure", sum(given))


def _join_gas(placed: Sequence[Placed]) -> EngineGas | None:
    """Return the gas of all cylinders by the crank angle of the first engine; None if no engine has
    gas. The cylinders of an engine without gas have the share 0.
    """
    burning = [crank.engine.gas for crank in placed if crank.engine.gas is not None]
    if not burning:
        return None
    cylinders: list[CylinderGas] = []
    for crank in placed:
        gas = crank.engine.gas
        start = len(cylinders)
        if gas is None:
            idle = burning[0].cylinders[0]._replace(share=0.0, like=start)
            cylinders += [idle] * len(crank.engine.numbers)
            continue
        for own in gas.cylinders:
            nominal = own.nominal_deg - float(crank.phase_deg)
            cylinders.append(own._replace(nominal_deg=nominal, like=start + own.like))
    efficiencies = {gas.mechanical_efficiency for gas in burning}
    same = efficiencies.pop() if len(efficiencies) == 1 else None
    cycle_deg = max(gas.cycle_deg for gas in burning)
    from .gas import EngineGas  # engines without gas do not load it

    return EngineGas(tuple(cylinders), cycle_deg, same, law=_join_laws(placed))


def _join_laws(placed: Sequence[Placed]) -> GasLaw | None:
    """Return the law for the gas of all cylinders; None if the gas is the same at all speeds."""
    laws = []
    for crank in placed:
        gas = crank.engine.gas
        if gas is not None and gas.law is not None:
            laws.append(gas.law)
    if not laws:
        return None

    def solve(speed_rpm: float) -> EngineGas:
        return cast("EngineGas", _join_gas(_turn_all(placed, speed_rpm)))

    powers = {law.power for law in laws}
    nodes = sorted({speed for law in laws for speed in law.nodes_rpm})
    linear = len(powers) == 1 and all(law.linear for law in laws)
    from .gas import GasLaw  # as above

    return GasLaw(solve, tuple(nodes), linear, max(powers))
