"""Describe an engine in a few lines, for the head of an analysis."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

import numpy as np

from ..core.cylinders import find_travel
from ..core.phasors import Figure
from ..engine.engine import Engine, Placed, SilentCylinders
from ..engine.firing.usual import list_numbers, write_rows
from ..engine.layout import plan_cylinders
from ..file.fields import count_lambda_digits, counted, join_words
from ..forces.spectrum import find_relevant_orders
from ..limits import HIGHEST_ORDER_UNASKED
from .figures import silent_entries
from .sheet import Facts, get_digits, given, number, tell_assumed
from .units import System

AXES_SHOWN = 9  # largest number of banks whose axes are listed
THROWS_SHOWN = 12  # largest number of throws whose angles are listed
EVEN_DEG = 0.05  # firing intervals that differ by less than this count as equal


def speed_facts(engine: Engine, *, steady: bool = False) -> Facts:
    """Return the crank speed, and the cylinders that have no gas or burn nothing.

    Args:
        engine: Engine at this speed.
        steady: Whether the figures ignore an uneven speed.
    """
    return Facts((("speed", tell_speed(engine, steady=steady)), *list_silent(engine.silent)))


def name_cylinders(numbers: Sequence[int]) -> str:
    """Return a text for cylinders, such as "cylinders 1 and 4"."""
    noun = "cylinders" if len(numbers) > 1 else "cylinder"
    return f"{noun} {join_words([*map(str, numbers)])}"


def tell_pivot(engine: Engine) -> str:
    """Return the name of the axis or point about which couple and roll are taken."""
    if any(engine.reference_m[:2]):
        return "the point of reference"
    return "the crank axis"


_TURNING = '"with the crank" means with the cylinders, which carry the counterweights'


def engine_facts(
    engine: Engine, system: System, *, whole: bool, speeds_rpm: Sequence[float] = ()
) -> Facts:
    """Return cylinders, crank, firing, speed, included masses, and devices. If `whole`, the
    highest order, the point of reference of the moments and the source follow. Several engines have
    a line each, followed by the facts that they have in common.

    Args:
        whole: Whether all facts are returned.
        speeds_rpm: Ascending speeds of the figures, if there are several.
    """
    pairs = _list_facts(engine, system, whole, speeds_rpm)
    return Facts(tuple((name, value) for name, value in pairs if value))


def _list_facts(
    engine: Engine, system: System, whole: bool, speeds_rpm: Sequence[float]
) -> Iterator[tuple[str, str]]:
    """Yield names and values of all facts; values without meaning for the engine are empty."""
    single = not engine.placed
    if single:
        yield from _list_mechanism(engine, system)
    else:
        yield from _list_placed(engine, system)
    yield from list_silent(engine.silent)
    yield "speed", _speeds(engine, speeds_rpm) if len(speeds_rpm) > 1 else tell_speed(engine)
    if single:
        yield "masses", _masses(engine, system, whole=whole)
    yield "devices", _tell_devices(engine)
    if single and whole:
        yield "orders", _tell_orders(engine)
    if whole or any(engine.reference_m) or not single:
        yield "reference", tell_reference(engine.reference_m, system, known=engine.places_known)
    yield "assumed", _tell_inferred(engine)
    if whole:
        yield "source", engine.source


def _list_mechanism(engine: Engine, system: System) -> Iterator[tuple[str, str]]:
    """Yield cylinders, crank and firing of a single engine."""
    yield "cylinders", f"{engine.cylinders.count}{_banks(engine)}{_bore(engine, system)}"
    plan = None if engine.model is None else plan_cylinders(engine.model)
    if plan is not None and plan.in_rows:
        yield "numbering", write_rows(list_numbers(plan))
    yield "crank", _crank(engine, system)
    yield "throws", _throws(engine)
    if engine.rotary:
        yield "turning", _TURNING
    yield "firing" if engine.fires_deg else "cycle", _firing(engine)


def _list_placed(engine: Engine, system: System) -> Iterator[tuple[str, str]]:
    """Yield the cylinders of several engines together, then a line for each engine."""
    text = f"{len(engine.numbers)} on {len(engine.placed)} cranks"
    if not math.isnan(engine.displacement_m3):
        text += f", {_volume(engine, system)}"
    yield "cylinders", text
    for placed in engine.placed:
        yield placed.name, _tell_placed(placed, system)


def _tell_orders(engine: Engine) -> str:
    """Return the highest order that is shown by default; empty if no order is higher."""
    if find_relevant_orders(engine)[-1] <= HIGHEST_ORDER_UNASKED:
        return ""
    return f"to {HIGHEST_ORDER_UNASKED}; for higher ones use --orders"


def _tell_devices(engine: Engine) -> str:
    """Return how many devices, and coupling rods in how many places, are included; empty if there
    are none.
    """
    devices = [*engine.devices]
    for placed in engine.placed:
        devices += placed.engine.devices
    coupling = sum(device.is_coupling for device in devices)
    webs = sum(device.web > 0 for device in devices)
    count = len(devices) - coupling - webs
    files = "the files" if engine.placed else "the file"
    origins = []
    if count:
        origins.append(f"{count} from {files}")
    if webs:
        origins.append(counted(webs, "web"))
    if coupling:
        origins.append(f"coupling rods in {counted(coupling, 'place')}")
    if not origins:
        return ""
    return f"{' and '.join(origins)} included"


def tell_reference(point: Iterable[Figure], system: System, *, known: bool) -> str:
    """Return the point of reference of moments in words, or that they are not known."""
    if not known:
        return "moments are not known: crank.spacing is missing"
    return f"moments about {tell_place(point, system)}"


def _tell_placed(placed: Placed, system: System) -> str:
    """Return an engine's file, where it stands and how it turns."""
    words = [placed.file, f"at {tell_place(placed.at_m, system)}"]
    if placed.turn_deg:
        words.append(f"turned by {given(float(placed.turn_deg))} deg")
    if placed.phase_deg:
        words.append(f"leads by {given(float(placed.phase_deg))} deg")
    if placed.ratio < 0:
        words.append("turns against the first")
    if placed.load:
        words.append("drives the load")
    return ", ".join(words)


def tell_place(point: Iterable[Figure], system: System) -> str:
    """Return a point in words: "x, y, z = 0, 0, 100 mm"."""
    unit = system.length
    return f"x, y, z = {', '.join(number(unit.of(float(v))) for v in point)} {unit.name}"


def _tell_inferred(engine: Engine) -> str:
    """Return the assumed values of keys that the file leaves out. Throws and intervals of a single
    engine are named without values where other lines show these.
    """
    shown = set[str]()
    if not engine.placed:
        shown.add("layout.firing_intervals")
        if _throws(engine):
            shown.add("crank.throws")
    return tell_assumed(engine.list_assumed("gas") or (), shown)


def tell_speed(engine: Engine, *, steady: bool = False) -> str:
    """Return the mean speed, with a remark if the speed is uneven.

    Args:
        engine: Engine at this speed.
        steady: Whether the figures ignore an uneven speed.
    """
    speed = f"{given(float(engine.speed_rpm))} rpm"
    if not engine.ripple:
        return speed
    if steady:
        return f"{speed}, steady; the uneven speed of the file is not used"
    return f"{speed}, uneven; all figures take this into account"


def _speeds(engine: Engine, speeds_rpm: Sequence[float]) -> str:
    first = given(float(speeds_rpm[0]))
    last = given(float(speeds_rpm[-1]))
    text = f"{first} to {last} rpm, {len(speeds_rpm)} speeds"
    if engine.gas is not None and engine.gas.law is None:
        text += "; gas as in the file at every speed"
    return text


def _throws(engine: Engine) -> str:
    """Return the angles of the throws relative to cylinder 1's pin, from the free end to the
    flywheel end. With split pins, these are the angles of one bank, followed by the lead of the
    next bank. The text is empty for one throw with one pin.
    """
    pins: dict[int, list[float]] = {}
    for weighed, pin in zip(engine.weighed, engine.pins_deg.values(), strict=True):
        pins.setdefault(weighed.throw, []).append(float(pin))
    first, *others = pins[min(pins)]
    lead = round((others[0] - first + 180) % 360 - 180, 6) if others else 0
    if (len(pins) == 1 and not lead) or engine.rotary:
        return ""
    angles = [f"{round(round(pins[throw][0], 6), 1) % 360:g}" for throw in sorted(pins)]
    text = ", ".join(angles[:THROWS_SHOWN])
    if len(pins) > THROWS_SHOWN:
        text += ", …"
    text += " deg"
    if angles[0] != "0":
        text += " from cylinder 1's pin"
    if lead:
        text += f", split pins: the next bank's pin at {lead:+g} deg"
    return text


def _banks(engine: Engine) -> str:
    if engine.rotary:
        return " that turn about a crank at rest"
    axes = np.ravel(engine.cylinders.axis_deg)
    if len(axes) == 1:
        return " in line"
    shown = ", ".join(f"{axis:.4g}" for axis in axes[:AXES_SHOWN])
    if len(axes) > AXES_SHOWN:
        shown += " …"
    return f", banks at {shown} deg"


def _bore(engine: Engine, system: System) -> str:
    """Return bore, stroke and displacement; empty if the file gives no bore."""
    bore_m = float(engine.bore_m)
    if math.isnan(bore_m):
        return ""
    unit = system.length
    bore = number(unit.of(bore_m), 5)
    stroke = _list_strokes(engine, system)
    first = engine.numbers.index(1)
    if len(engine.cylinders.radius) == 1:
        nominal = number(unit.of(2 * float(engine.cylinders.radius[0])))
        true = number(unit.of(float(find_travel(engine.cylinders).stroke[first])))
        if true != nominal:
            stroke += f" (true stroke {true} {unit.name})"
    return f", bore × stroke {bore} × {stroke}, {_volume(engine, system)}"


def _volume(engine: Engine, system: System) -> str:
    volume = float(engine.displacement_m3)
    unit = system.volume.fit(volume)
    return f"{number(unit.of(volume))} {unit.name}"


def _crank(engine: Engine, system: System) -> str:
    """Return crank radius, rod length and their ratio for cylinder 1."""
    c = engine.cylinders
    unit = system.length
    first = engine.numbers.index(1)
    radius = float(c.radius_of_each[first])
    lam = float(c.lam[first if len(c.lam) > 1 else 0])
    r = f"r = {number(unit.of(radius))} {unit.name}"
    if len(c.radius) > 1:
        r = f"stroke {_list_strokes(engine, system)}, {r}"
    if c.harmonic:
        return f"{r}, motion harmonic{_unequal(engine)}"
    ratio = given(lam, count_lambda_digits(lam, get_digits(4)))
    rod = f"{number(unit.of(radius / lam))} {unit.name}"
    return f"{r}, rod {rod}, λ = {ratio}{_unequal(engine)}"


def _list_strokes(engine: Engine, system: System) -> str:
    """Return every distinct stroke of the crank pins, in the order of the throws."""
    radii = zip(engine.weighed, engine.cylinders.radius_of_each.tolist(), strict=True)
    along = sorted(radii, key=lambda pair: pair[0].throw)
    strokes = dict.fromkeys(number(system.length.of(2 * radius), 5) for _, radius in along)
    return f"{', '.join(strokes)} {system.length.name}"


def _masses(engine: Engine, system: System, *, whole: bool) -> str:
    """Return the reciprocating and rotating masses of cylinder 1, and the whole rotating mass of
    its pin if the pin carries several rods.
    """
    row = engine.numbers.index(1)
    unit = system.mass
    weighed = engine.weighed[row]

    def shown(kg: Figure) -> str:
        return number(unit.of(float(kg)))

    text = f"reciprocating {shown(weighed.reciprocating)} {unit.name} per cylinder"
    if whole:
        text += " (piston, rod's small end)"
    if not engine.rotary:  # in a rotary engine the pins stand still
        text += f", rotating {shown(weighed.rotating + weighed.share)} {unit.name} per rod"
        if whole:
            shells = ", shells and oil" if weighed.rod_bearing or weighed.oil else ""
            text += f" (big end{shells}, share of the throw)"
        on_pin = next(rows for rows in engine.rows_by_pin if row in rows)
        if len(on_pin) > 1 and engine.cylinders.linkage is None:
            sharing = [engine.weighed[k] for k in on_pin]
            together = shown(sum(float(w.rotating + w.share) for w in sharing))
            text += f" ({together} per pin of {len(on_pin)} rods)"
    return text + _unequal(engine)


def _unequal(engine: Engine) -> str:
    return "" if engine.equal else " (cylinder 1; others differ)"


def _firing(engine: Engine) -> str:
    """Return the firing order, the intervals between firings, and the strokes of a cycle; without a
    firing order, only the strokes, and only if the file gives them or has gas.
    """
    strokes = tell_strokes(engine)
    if not engine.fires_deg:
        written = engine.model is not None and "strokes" in engine.model.layout.model_fields_set
        return strokes if written or engine.gas is not None else ""  # not assumed
    instants = [*engine.fires_deg.values(), 180.0 * engine.strokes]
    gaps = [b - a for a, b in pairwise(instants)]
    intervals = f"every {gaps[0]:.4g} deg"
    if max(gaps) - min(gaps) >= EVEN_DEG:
        intervals = f"after {', '.join(f'{gap:.4g}' for gap in gaps)} deg"
        splay = engine.splay_for_even_firing
        if splay is not None:
            intervals += f" (crank.splay = {splay:g} makes them equal)"
    order = "-".join(map(str, engine.fires_deg))
    return f"{order}, {intervals}, {strokes}"


def tell_strokes(engine: Engine) -> str:
    """Return `four-stroke`, `two-stroke`, or `compressor` if all cylinders compress."""
    if engine.gas is not None and len(engine.compressing) == len(engine.numbers):
        return "compressor"
    return "two-stroke" if engine.strokes == 2 else "four-stroke"


def list_silent(silent: SilentCylinders) -> list[tuple[str, str]]:
    """Return lines on cylinders without gas and on cylinders that compress but burn nothing."""
    return [
        (key.replace("_", " "), ", ".join(map(str, numbers)))
        for key, numbers in silent_entries(silent).items()
    ]
