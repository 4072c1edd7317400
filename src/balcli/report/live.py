"""Describe an engine for the HTML page, on which the reader can change the engine's numbers.

The page computes the engine itself (`assets/engine.js`). Axes, crank pins and positions of the
cylinders are linear functions of numbers of the file (throws, splay, bank angle, spacing, stagger).
The page gets the constant and the coefficients of each function. The coefficients are found by
adding 1 to one number at a time. For each other figure of a cylinder, the page gets the
dotted name of a number of the file.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from operator import itemgetter
from pathlib import Path
from typing import Any

from ..analysis.couple import WORTH_NAMING
from ..core.mechanisms.linkage import Rotary
from ..core.records import Node
from ..engine.engine import Engine, take_model
from ..engine.firing.usual import list_numbers
from ..engine.layout import Cell
from ..engine.load import SPEED
from ..engine.parts import Parts
from ..errors import MOMENTS_UNKNOWN
from ..file.edit import HEADER, format_value
from ..file.fields import Number
from ..file.model import EngineFile
from ..file.units import (
    ANGLE,
    INERTIA,
    LENGTH,
    MASS,
    SPEED as SPEED_OF_ROTATION,
    UNBALANCE,
    convert,
)
from ..forces.kinds import FORCE, FREE, GAS_KINDS
from ..forces.power import LIKELY, find_power
from ..forces.spectrum import (
    SHOWN,
    choose_orders,
    compute_spectra,
    find_relevant_orders,
    list_gas_orders,
    merge_orders,
)
from ..limits import (
    FEWEST_CYLINDERS_COUNTED,
    SMALL,
    WORTH_A_SHAFT_OF_ORDER_1,
    WORTH_A_SHAFT_OF_ORDER_2,
)
from ..show.engine_facts import engine_facts
from ..show.figures import clean
from ..show.sheet import NEGLIGIBLE, sentence
from ..show.units import SI, ShownUnit, System
from ..sizing.fitting import LEFT
from ..sizing.ship_engines import (
    find_crosshead_stroke,
    is_judged_by_power,
    may_be_ship_engine,
)
from ..studies.parameters import find_places

# tables with numbers to change
_TABLES = ("crank", "rod", "piston", "crosshead", "layout", "operation", "cylinder")
_DEVICES = ("counterweight", "shaft", "slider")
# Numbers that have an effect only at an uneven speed.
_UNUSED = r"crank\.inertia|operation\.speed_ripple|(counterweight|shaft)\..*(inertia|sector)"
# Numbers that move axes, pins or positions.
_MOVING = ("crank.s", "crank.throws", "crank.positions", "layout.")
_UNITS = {  # further units that the page reads, by dimension
    LENGTH: ("um", "cm", "m", "in", "inch", "inches", "thou", "ft", "feet", "yd"),
    MASS: ("mg", "g", "gram", "grams", "t", "lb", "lbs", "pounds", "oz", "ounces"),
    UNBALANCE: ("kg mm", "kg m", "g cm", "g m", "g in", "oz in", "lb in", "lb ft"),
    ANGLE: ("degree", "degrees", "rad", "turn"),
    SPEED_OF_ROTATION: ("1/min", "min^-1", "rps", "Hz", "rad/s"),
    INERTIA: ("kg m^2", "kg cm^2", "g mm^2", "g cm^2", "lb in^2", "lb ft^2", "oz in^2"),
}
_LARGEST = 1e9  # limit of the size of most numbers
_WHOLE = {"unit": "", "whole": True, "least": -1000, "most": 1000}  # limits of ratios and orders
_NEW_LENGTH = {"unit": LENGTH.unit, "usual": 0}
_NEW_WEIGHT = {
    "unbalance": {"unit": UNBALANCE.unit, "usual": 1e4, "least": 0},
    "angle": {"unit": ANGLE.unit, "usual": 0},
    "position": _NEW_LENGTH,
}
_NEW = {  # keys of a new device with their units, limits and initial values
    "counterweight": _NEW_WEIGHT,
    "shaft": {
        "ratio": {**_WHOLE, "usual": -1},
        **_NEW_WEIGHT,
        "at.1": _NEW_LENGTH,
        "at.2": _NEW_LENGTH,
    },
}
# Facts that the page computes; it has the words of the others.
_COMPUTED = ("cylinders", "crank", "throws", "speed", "masses", "devices")
_OF_ROD = ("mass", "cg", "length", "ratio", "small_end", "big_end", "inertia")


def explain_still(engine: Engine) -> str:
    """Return the reason why the page cannot compute an engine itself; empty if it can."""
    if engine.placed:
        return "it has several cranks"
    if engine.webs is not None:
        return "its webs are described by [[web]]"
    return next(_list_obstacles(engine), "")


def _list_obstacles(engine: Engine) -> Iterator[str]:
    """Yield what the page cannot compute of a single engine."""
    c = engine.cylinders
    model = take_model(engine)
    of_throws = (model.crank.stroke, model.crank.throw_mass)
    if isinstance(c.linkage, Rotary):
        yield "its cylinders turn"
    if c.linkage is not None:
        yield "it has articulated rods"
    if c.harmonic:
        yield "its pistons have harmonic motion"
    if model.locomotive is not None:
        yield "it is a locomotive"
    if len(c.radius) > 1 or any(isinstance(figure, tuple) for figure in of_throws):
        yield "its throws differ"
    if engine.bores_m:
        yield "its cylinders have different bores"
    if engine.ripple:
        yield "its speed is uneven"
    yield from _list_obstacles_of_devices(engine, model)
    if is_judged_by_power(engine) and _has_power_of_gas(engine):
        yield "its compensators depend on the power of its gas"


def _list_obstacles_of_devices(engine: Engine, model: EngineFile) -> Iterator[str]:
    """Yield which devices of a single engine the page cannot compute."""
    weights = (*model.counterweight, *model.shaft)
    if any(weight.unbalance is None and weight.mass is None for weight in weights):
        yield "a counterweight or shaft has no unbalance in the file"
    if any(device.compensates for device in engine.devices):
        yield "it has moment compensators"
    if any(shaft.ratio % 1 for shaft in model.shaft):
        yield "a shaft turns at another speed than a whole multiple of crank speed"


def _has_power_of_gas(engine: Engine) -> bool:
    """Return whether the power of an engine is that of its gas, which the page does not compute."""
    power = find_power(engine)
    return power is not None and power.kind != "file"


def describe_engine(model: EngineFile, engine: Engine, text: str) -> Node:
    """Return the input of `assets/engine.js` for an engine with plain slider-cranks at steady
    speed.

    Args:
        model: Engine file.
        engine: Engine of the file.
        text: Text of the file, which the page rewrites with changed numbers.
    """
    parts = Parts(model)
    numbers = list(_list_numbers(model))
    values = {number["name"]: number["value"] for number in numbers}
    speed = float(engine.speed_rpm)
    throws: dict[int, int] = {}  # by throw, the cylinder whose firing sets the throw's angle
    if not parts.throws_given and parts.order is not None:
        for cell in reversed(parts.plan.cells):
            if cell.number in parts.order:
                throws[cell.throw] = cell.number
    forms = _find_forms(model, parts, throws, values)
    crossheads = find_crosshead_stroke(engine)
    return {
        "name": model.name,
        "text": text if _is_plain(text) else _write_plainly(text),
        "start": {} if speed == model.operation.speed else {SPEED: speed},
        "frees": _free_throws(model, parts),
        "known": engine.places_known,
        "look": describe_look(engine),
        "crossheadStroke": crossheads._asdict() if may_be_ship_engine(engine) else None,
        "fires": [*engine.fires_deg] if engine.fires_deg else None,
        "facts": [
            (name, "" if name in _COMPUTED else text)
            for name, text in engine_facts(engine, SI, whole=False).pairs
        ],
        "gasOrders": _list_orders_of_gas(engine),
        "powerOfGas": _has_power_of_gas(engine),
        "up": engine.up_deg,
        "bore": clean(engine.bore_m * 1e3),
        "reference": model.frame.reference,
        "skirt": model.piston.skirt,
        "crankcase": model.frame.crankcase,
        "bearings": _list_bearings(engine),
        "numbers": numbers,
        "throws": forms["throws"],
        "pins": forms["pins"],
        **_list_cylinders(model, parts, throws, forms),
    }


def _list_cylinders(
    model: EngineFile, parts: Parts, throws: Mapping[int, int], forms: Mapping[str, list[Node]]
) -> Node:
    """Return the entries of the cylinders, and apart from them what all have in common."""
    entries = [
        {
            "number": cell.number,
            "throw": cell.throw,
            "axis": forms["axis"][k],
            "lead": forms["lead"][k],
            "z": forms["z"][k],
            "by": _find_leader(parts, cell, throws),
            **_list_masses(model, parts, cell),
        }
        for k, cell in enumerate(parts.plan.cells)
    ]
    first, *others = entries
    common = {
        key: value for key, value in first.items() if all(each[key] == value for each in others)
    }
    own = [{key: entry[key] for key in entry if key not in common} for entry in entries]
    return {"ofEachCylinder": common, "cylinders": own}


def describe_one(
    model: EngineFile,
    engine: Engine,
    text: str,
    name: str = "",
    small: float = SMALL,
) -> Node | None:
    """Return the data of the page's panel for changing numbers; None if the page cannot compute the
    engine itself.

    Args:
        model: Engine file.
        engine: Engine of the file.
        text: Text of the file.
        name: Name of the file; empty if unknown.
        small: Share of one cylinder's first order below which a force or moment is ignored.
    """
    if explain_still(engine):
        return None
    engines = {"": describe_engine(model, engine, text)}
    return make_book(engines, Path(name).name, small=small, site=find_site())


def make_book(
    engines: Mapping[str, Node],
    file: str = "",
    *,
    choice: str = "",
    small: float = SMALL,
    site: str = "",
) -> Node:
    """Return the data of the panel for changing numbers, for one or more engines.

    Args:
        engines: Engines from `describe_engine`, by key.
        file: Name of the file; empty if unknown.
        choice: Initial engine if the reader can choose among several; empty if there is one engine.
        small: Share of one cylinder's first order below which a force or moment is ignored.
        site: Address of the live page, for links that contain the engine; empty: links have the
            address of this page.
    """
    units = {}
    for dimension, others in _UNITS.items():
        units[dimension.unit] = {unit: convert(f"1 {unit}", dimension) for unit in others}
    return {
        "engines": engines,
        "file": file.removesuffix(".toml"),
        "source": file if file.endswith(".toml") else "",
        "choice": choice,
        "site": site,
        "limits": describe_limits(small),
        "options": "" if small == SMALL else f" --small {100 * small:g}%",
        "devices": _NEW,
        "units": units,
    }


def find_site() -> str:
    """Return the address of the live page on the site of the documentation; empty if the package
    does not know it.
    """
    from importlib.metadata import PackageNotFoundError, metadata

    try:
        links = metadata("balcli").get_all("Project-URL") or []
    except PackageNotFoundError:
        return ""
    for link in links:
        label, _, address = link.partition(", ")
        if label == "Documentation":
            return f"{address}/play.html"
    return ""


def describe_page(engine: Engine, system: System, file: str, small: float) -> Node:
    """Return what charts and tables of the page need beside the figures.

    Args:
        engine: Engine of the page.
        system: Units of figures and pictures.
        file: Name of the engine file; empty if unknown.
        small: Share of one cylinder's first order below which a force or moment is ignored.
    """
    units = ("force", "moment", "mass", "length", "volume", "unbalance")
    return {
        "file": Path(file).name,
        "units": {name: _describe_unit(getattr(system, name)) for name in units},
        "limits": describe_limits(small),
        "look": describe_look(engine),
        "unknown": sentence(MOMENTS_UNKNOWN),
    }


def describe_look(engine: Engine) -> Node:
    """Return the direction that is drawn upwards, the names of directions, and whether the engine
    has gas.
    """
    return {
        "up": engine.up_deg,
        "names": {kind.name: kind.name_components(engine.up_deg) for kind in FREE},
        "axes": ("x", "y") if engine.up_deg is None else FORCE.upright,
        "gas": engine.gas is not None,
    }


def describe_limits(small: float) -> Node:
    """Return the limits that the page shares with the command."""
    return {
        "small": small,
        "shown": SHOWN,
        "rounding": LEFT,
        "worth1": WORTH_A_SHAFT_OF_ORDER_1,
        "worth2": WORTH_A_SHAFT_OF_ORDER_2,
        "fewest": FEWEST_CYLINDERS_COUNTED,
        "likely": LIKELY,
        "worthNaming": WORTH_NAMING,
        "negligible": NEGLIGIBLE,
        "mostOfNumbers": _LARGEST,
    }


def _describe_unit(unit: ShownUnit) -> Node:
    """Return a unit with the larger units that take its place for large values."""
    found: Node = {"name": unit.name, "size": unit.size}
    if unit.larger is not None:
        found |= {"larger": _describe_unit(unit.larger), "most": unit.most}
    return found


def _list_numbers(model: EngineFile) -> Iterator[Node]:
    """Yield the numbers of the file that the page may change, with values, units and limits."""
    for name, place in find_places(model).items():
        shown = name.startswith((*_TABLES, *_DEVICES)) and not re.match(_UNUSED, name)
        if shown and isinstance(place.value, (int, float)):
            yield {"name": name, "value": float(place.value), **_describe_limits(place.reader)}
    for path, table in model.tables():
        for key in ("ratio", "order"):
            if path.startswith(_DEVICES) and hasattr(table, key):
                yield {"name": f"{path}.{key}", "value": getattr(table, key), **_WHOLE}


def _describe_limits(number: Number) -> Node:
    """Return the unit of a number, and the limits that differ from those of most numbers."""
    limits = {"above": number.above, "least": number.least, "most": number.most}
    finite = {key: v for key, v in limits.items() if v is not None and abs(v) < math.inf}
    own = {key: v for key, v in finite.items() if abs(v) != _LARGEST}
    return {"unit": number.dimension.unit, **own}


def _list_bearings(engine: Engine) -> list[float] | None:
    """Return the positions of the main bearings in the file, mm; None if it gives none."""
    if engine.bearings is None or engine.bearings.main_positions_m is None:
        return None
    return [1e3 * z for z in engine.bearings.main_positions_m]


def _list_orders_of_gas(engine: Engine) -> list[int]:
    """Return the whole orders that `analyze` shows because gas has them; the page does not compute
    gas.
    """
    if engine.gas is None:
        return []
    of_gas = list_gas_orders(engine)
    every = merge_orders(find_relevant_orders(engine), of_gas)
    spectra = compute_spectra(engine, every, GAS_KINDS)
    return [int(order) for order in choose_orders(spectra, of_gas) if order > 0 and not order % 1]


# ------------------------------------------------------------------ the text of the file
def _is_plain(text: str) -> bool:
    """Return whether each table has a header, and each key a line of its own, so that the page can
    change the text line by line.
    """
    _, *parts = HEADER.split(text.replace("\r\n", "\n"))
    sections = zip(parts[::2], map(_read_lines, parts[1::2]), strict=True)
    tables = ((head.strip("[]"), own) for head, own in _list_tables(tomllib.loads(text)))
    return _sort_changeable(sections) == _sort_changeable(tables)


def _sort_changeable(tables: Iterable[tuple[str, Node]]) -> list[tuple[str, Node]]:
    """Return the tables with numbers to change, sorted by name; equal names keep their order."""
    shown = (table for table in tables if table[0].startswith((*_TABLES, *_DEVICES)))
    return sorted(shown, key=itemgetter(0))


def _read_lines(body: str) -> Node:
    """Return the keys that have a line of their own."""
    keys: Node = {}
    for line in body.splitlines():
        with suppress(tomllib.TOMLDecodeError):
            keys |= tomllib.loads(line)
    return keys


def _list_tables(data: Mapping[str, Any]) -> Iterator[tuple[str, Node]]:
    """Yield header and content of each table of a file; keys above all tables have no header."""
    yield "", {key: value for key, value in data.items() if not isinstance(value, (dict, list))}
    for name, content in data.items():
        if name == "cylinder":
            for number, own in content.items():
                yield f"[cylinder.{number}]", own
        elif isinstance(content, list):
            for table in content:
                yield f"[[{name}]]", table
        elif isinstance(content, dict):
            yield f"[{name}]", content


def _write_plainly(text: str) -> str:
    """Return the text of a file with a line for each key, without comments."""
    blocks = []
    for head, table in _list_tables(tomllib.loads(text)):
        keys = (f"{key} = {format_value(value)}" for key, value in table.items())
        blocks.append("\n".join(filter(None, (head, *keys))))
    return "\n\n".join(filter(None, blocks)) + "\n"


def _free_throws(model: EngineFile, parts: Parts) -> Node | None:
    """Return the keys of [layout] that the page must change when the reader changes throws, banks
    or splay; None if no change is needed. A firing order that fits only the given throws becomes
    "none", and the numbering that follows from that order is written.
    """
    layout = model.layout
    if model.crank.throws is None or layout.firing_order is None or model.gas is not None:
        return None
    keys: Node = {} if layout.numbering else {"numbering": format_value(list_numbers(parts.plan))}
    return keys | {"firing_order": "none", "firing_intervals": "none"}


# ------------------------------------------------------------------ axes, pins and positions
def _find_forms(
    model: EngineFile, parts: Parts, throws: Mapping[int, int], numbers: Mapping[str, float]
) -> dict[str, list[Node]]:
    """Return the linear functions for axes and crank pins (deg) and positions (mm) of the
    cylinders, and for positions of the throws and their pins. Each function has a constant, and
    coefficients by the names of numbers.

    If the firing of a cylinder determines the angle of a throw, the angles of this throw's pins do
    not include the shift of top dead centre by the piston offset: the page adds this shift.
    """
    start = _measure(parts, throws)
    forms: dict[str, list[Node]] = {}
    for key, values in start.items():
        forms[key] = [{"value": value, "by": {}} for value in values]
    for name, value in numbers.items():
        if not (name.startswith(_MOVING) or name.endswith((".bank", ".throw", ".position"))):
            continue
        moved = _measure(Parts(model, {name: value + 1.0}), throws)
        for key, values in moved.items():
            for form, new, old in zip(forms[key], values, start[key], strict=True):
                if coefficient := round(new - old, 9):
                    form["by"][name] = coefficient
                    form["value"] -= coefficient * value
    return forms


def _measure(parts: Parts, throws: Mapping[int, int]) -> dict[str, list[float]]:
    """Return the values of the functions of `_find_forms`: cylinder axes, and angles of crank pins
    from cylinder 1's pin (deg); positions of cylinders, throws and their pins (mm).
    """
    cells = parts.plan.cells
    pins = parts.pins
    places = parts.places
    first = next(cell for cell in cells if cell.number == 1)

    def find_shift(cell: Cell) -> float:
        """Return the shift of top dead centre of the cylinder that sets this cell's pin."""
        leader = _find_leader(parts, cell, throws)
        return 0.0 if leader is None else float(pins.tops_deg[leader] - pins.axes_deg[leader])

    def find_lead(cell: Cell) -> float:
        return float(pins.leads_deg[cell.number]) - find_shift(cell) + find_shift(first)

    return {
        "axis": [float(pins.axes_deg[cell.number]) for cell in cells],
        "lead": [find_lead(cell) for cell in cells],
        "z": [1e3 * float(places.z[cell.number]) for cell in cells],
        "throws": [1e3 * float(z) for z in places.throws.ravel()],
        "pins": [1e3 * float(z) for z in places.pins.ravel()],
    }


def _find_leader(parts: Parts, cell: Cell, throws: Mapping[int, int]) -> int | None:
    """Return the cylinder whose top dead centre determines the crank pin of a cylinder; None if the
    file gives the pin's angle.
    """
    if parts.override(cell.number, "throw") is not None:
        return None
    return throws.get(cell.throw)


# ------------------------------------------------------------------ masses
def _list_masses(model: EngineFile, parts: Parts, cell: Cell) -> Node:
    """Return the masses and rod of a cylinder: names of numbers, or values in the units of the
    file.
    """
    number = cell.number
    own = model.cylinder.get(cell.number)
    weighed = parts.weighed[number]

    def name(key: str, usual: str) -> str:
        given = own is not None and getattr(own, key) is not None
        return f"cylinder.{number}.{key}" if given else usual

    pistons = [f"piston.{key}" for key in parts.find_piston_masses()]
    if own is not None and own.piston_mass is not None:
        pistons = [f"cylinder.{number}.piston_mass"]
    place = parts.find_rod(number)
    rod: Node = {}
    for key in _OF_ROD:
        if getattr(place.rod, key) is not None:
            rod[key] = name(f"rod_{key}", f"rod.{key}")
    if place.rod.pendulum is not None:
        rod["period"] = float(place.rod.pendulum.period)
        rod["pivot"] = place.rod.pendulum.pivot
    return {
        "piston": [*pistons, name("crosshead_mass", "crosshead.mass")],
        "offset": name("piston_offset", "piston.offset"),
        "share": 1 / parts.plan.rods_on_throw,
        "extra": float(weighed.rod_bearing + weighed.oil),
        "rod": rod,
    }
