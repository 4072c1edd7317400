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
from ..file.fields import count_lambda_digits, join_words
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
    return f"cylinder{'s' * (len(numbers) > 1)} {join_words([*map(str, numbers)])}"


def tell_pivot(engine: Engine) -> str:
    """Return the name of the axis or point about which couple and roll are taken."""
    return "the point of reference" if any(engine.reference_m[:2]) else "the crank axis"


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
    single = not engine.placed
    reference = tell_reference(engine.reference_m, system, known=engine.places_known)
    pairs = (
        *(_list_mechanism(engine, system) if single else _list_placed(engine, system)),
        *list_silent(engine.silent),
        ("speed", _speeds(engine, speeds_rpm) if len(speeds_rpm) > 1 else tell_speed(engine)),
        ("masses", _masses(engine, system, whole=whole) if single else ""),
        ("devices", _tell_devices(engine)),
        ("orders", _tell_orders(engine) if whole and single else ""),
        ("reference", reference if whole or any(engine.reference_m) or not single else ""),
        ("assumed", _tell_inferred(engine)),
        ("source", engine.source if whole else ""),
    )
    return Facts(tuple((name, value) for name, value in pairs if value))


def _list_mechanism(engine: Engine, system: System) -> Iterator[tuple[str, str]]:
    """Yield cylinders, crank and firing of a single engine."""
    yield "cylinders", f"{engine.cylinders.count}{_banks(engine)}{_bore(engine, system)}"
    plan = None if engine.model is None else plan_cylinders(engine.model)
    yield "numbering", write_rows(list_numbers(plan)) if plan is not None and plan.in_rows else ""
    yield "crank", _crank(engine, system)
    yield "throws", _throws(engine)
    yield "turning", _TURNING if engine.rotary else ""
    yield "firing" if engine.fires_deg else "cycle", _firing(engine)


def _list_placed(engine: Engine, system: System) -> Iterator[tuple[str, str]]:
    """Yield the cylinders of several engines together, then a line for each engine."""
    volume = "" if math.isnan(engine.displacement_m3) else f", {_volume(engine, system)}"
    yield "cylinders", f"{len(engine.numbers)} on {len(engine.placed)} cranks{volume}"
    yield from ((one.name, _tell_placed(one, system)) for one in engine.placed)


def _tell_orders(engine: Engine) -> str:
    """Return the highest order that is shown by default; empty if no order is higher."""
    higher = find_relevant_orders(engine)[-1] > HIGHEST_ORDER_UNASKED
    return f"to {HIGHEST_ORDER_UNASKED}; for higher ones use --orders" if higher else ""


def _tell_devices(engine: Engine) -> str:
    """Return how many devices are included; empty if there are none."""
    count = len(engine.devices) + sum(len(one.engine.devices) for one in engine.placed)
    return f"{count} from the file{'s' * bool(engine.placed)} included" if count else ""


def tell_reference(point: Iterable[Figure], system: System, *, known: bool) -> str:
    """Return the point of reference of moments in words, or that they are not known."""
    if not known:
        return "moments are not known: crank.spacing is missing"
    return f"moments about {tell_place(point, system)}"


def _tell_placed(one: Placed, system: System) -> str:
    """Return an engine's file, where it stands and how it turns."""
    words = {
        f"at {tell_place(one.at_m, system)}": True,
        f"turned by {given(float(one.turn_deg))} deg": one.turn_deg,
        f"leads by {given(float(one.phase_deg))} deg": one.phase_deg,
        "turns against the first": one.ratio < 0,
        "drives the load": one.load,
    }
    return ", ".join([one.file, *(word for word, counts in words.items() if counts)])


def tell_place(point: Iterable[Figure], system: System) -> str:
    """Return a point in words: "x, y, z = 0, 0, 100 mm"."""
    unit = system.length
    return f"x, y, z = {', '.join(number(unit.of(float(v))) for v in point)} {unit.name}"


def _tell_inferred(engine: Engine) -> str:
    """Return the assumed values of keys that the file leaves out. Throws and intervals of a single
    engine are named without values, because other lines show these.
    """
    shown = set() if engine.placed else {"crank.throws", "layout.firing_intervals"}
    return tell_assumed(engine.list_assumed("gas") or (), shown)


def tell_speed(engine: Engine, *, steady: bool = False) -> str:
    """Return the mean speed, with a remark if the speed is uneven.

    Args:
        engine: Engine at this speed.
        steady: Whether the figures ignore an uneven speed.
    """
    counts = "uneven; all figures take this into account"
    counts = "steady; the uneven speed of the file is not used" if steady else counts
    uneven = f", {counts}" if engine.ripple else ""
    return f"{given(float(engine.speed_rpm))} rpm{uneven}"


def _speeds(engine: Engine, speeds_rpm: Sequence[float]) -> str:
    first, last = (given(float(speed)) for speed in (speeds_rpm[0], speeds_rpm[-1]))
    same = engine.gas is not None and engine.gas.law is None
    gas = "; gas as in the file at every speed" if same else ""
    return f"{first} to {last} rpm, {len(speeds_rpm)} speeds{gas}"


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
    shown = ", ".join(angles[:THROWS_SHOWN])
    more = ", …" * (len(pins) > THROWS_SHOWN)
    start = "" if angles[0] == "0" else " from cylinder 1's pin"
    splay = f", split pins: the next bank's pin at {lead:+g} deg" if lead else ""
    return f"{shown}{more} deg{start}{splay}"


def _banks(engine: Engine) -> str:
    if engine.rotary:
        return " that turn about a crank at rest"
    axes = np.ravel(engine.cylinders.axis_deg)
    if len(axes) == 1:
        return " in line"
    shown = ", ".join(f"{axis:.4g}" for axis in axes[:AXES_SHOWN])
    return f", banks at {shown}{' …' if len(axes) > AXES_SHOWN else ''} deg"


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
        stroke += f" (true stroke {true} {unit.name})" * (true != nominal)
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
    strokes = f"stroke {_list_strokes(engine, system)}, " if len(c.radius) > 1 else ""
    r = f"{strokes}r = {number(unit.of(radius))} {unit.name}"
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
    text += " (piston, rod's small end)" * whole
    if not engine.rotary:  # in a rotary engine the pins stand still
        shells = ", shells and oil" if weighed.rod_bearing or weighed.oil else ""
        text += f", rotating {shown(weighed.rotating + weighed.share)} {unit.name} per rod"
        text += f" (big end{shells}, share of the throw)" * whole
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
    if not engine.fires_deg:
        said = engine.model is not None and "strokes" in engine.model.layout.model_fields_set
        return tell_strokes(engine) if said or engine.gas is not None else ""  # not assumed
    instants = [*engine.fires_deg.values(), 180.0 * engine.strokes]
    gaps = [b - a for a, b in pairwise(instants)]
    intervals = f"every {gaps[0]:.4g}"
    even = ""
    splay = engine.splay_for_even_firing
    if max(gaps) - min(gaps) >= EVEN_DEG:
        intervals = f"after {', '.join(f'{gap:.4g}' for gap in gaps)}"
        even = "" if splay is None else f" (crank.splay = {splay:g} makes them equal)"
    order = "-".join(map(str, engine.fires_deg))
    return f"{order}, {intervals} deg{even}, {tell_strokes(engine)}"


def tell_strokes(engine: Engine) -> str:
    """Return `four-stroke` or `two-stroke`."""
    return "two-stroke" if engine.strokes == 2 else "four-stroke"


def list_silent(silent: SilentCylinders) -> list[tuple[str, str]]:
    """Return lines on cylinders without gas and on cylinders that compress but burn nothing."""
    return [
        (key.replace("_", " "), ", ".join(map(str, numbers)))
        for key, numbers in silent_entries(silent).items()
    ]
