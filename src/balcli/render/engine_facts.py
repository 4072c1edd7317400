"""An engine in a few lines, as it stands at the head of an analysis."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from ..engine.build import Engine
from ..limits import HIGHEST_ORDER_UNASKED
from .sheet import Facts, number
from .units import System

AXES_SHOWN = 9  # of banks
EVEN_DEG = 0.05  # intervals of firing that differ by less are shown as one


def engine_facts(engine: Engine, system: System, *, higher: bool) -> Facts:
    """Cylinders, crank, firing, speed, masses that the figures include, reference and source.

    Args:
        higher: whether there may be orders above those that are shown unless they are asked for.
    """
    about = ", ".join(number(system.length.of(float(v))) for v in engine.reference_m)
    reference = f"moments about x, y, z = {about} {system.length.name}"
    if not engine.places_known:
        reference = "moments are not known: crank.spacing is missing"
    uneven = ", uneven: figures are those of the uneven speed" if engine.ripple else ""
    orders = f"to {HIGHEST_ORDER_UNASKED}; --orders asks for higher ones" if higher else ""
    devices = f"{len(engine.devices)} of the file are included" if engine.devices else ""
    cylinders = f"{engine.cylinders.count}{_banks(engine)}{_bore(engine, system)}"
    pairs = (
        ("cylinders", cylinders),
        ("crank", _crank(engine, system)),
        ("firing", _firing(engine)),
        ("speed", f"{number(float(engine.speed_rpm), 6)} rpm{uneven}"),
        ("masses", _masses(engine, system)),
        ("orders", orders),
        ("reference", reference),
        ("devices", devices),
        ("source", engine.source),
    )
    return Facts(tuple((name, value) for name, value in pairs if value))


def _banks(engine: Engine) -> str:
    if engine.rotary:
        return " that turn about a crank standing still"
    axes = np.ravel(engine.cylinders.axis_deg)
    if len(axes) == 1:
        return " in line"
    shown = ", ".join(f"{axis:.4g}" for axis in axes[:AXES_SHOWN])
    return f", banks at {shown}{' …' if len(axes) > AXES_SHOWN else ''} deg"


def _bore(engine: Engine, system: System) -> str:
    """Bore, stroke and displacement, where the file gives the bore."""
    bore_m = float(engine.bore_m)
    if math.isnan(bore_m):
        return ""
    bore = number(system.length.of(bore_m))
    stroke = number(system.length.of(2 * float(engine.cylinders.radius)))
    volume = number(system.volume.of(float(engine.displacement_m3)), 4)
    return f", bore × stroke {bore} × {stroke} {system.length.name}, {volume} {system.volume.name}"


def _crank(engine: Engine, system: System) -> str:
    """Crank radius, rod length and their ratio, of cylinder 1."""
    c, unit = engine.cylinders, system.length
    first = engine.numbers.index(1)
    radius, lam = float(c.radius), float(c.lam[first if len(c.lam) > 1 else 0])
    radius_shown, rod_shown = number(unit.of(radius)), number(unit.of(radius / lam))
    return (
        f"r = {radius_shown} {unit.name}, rod {rod_shown} {unit.name}, "
        f"λ = {number(lam, 4)}{_unequal(engine)}"
    )


def _masses(engine: Engine, system: System) -> str:
    """Masses that go to and fro and that turn, of cylinder 1, and what turns with its pin where
    that carries several rods.
    """
    row, unit = engine.numbers.index(1), system.mass
    weighed = engine.weighed[row]
    on_pin = next(rows for rows in engine.rows_by_pin if row in rows)
    reciprocating = number(unit.of(float(weighed.reciprocating)), 4)
    text = f"reciprocating {reciprocating} {unit.name} per cylinder (piston, rod's small end)"
    if not engine.rotary:  # else the pins stand still
        rotating = number(unit.of(float(weighed.rotating + weighed.share)), 4)
        shells = ", shells and oil" if weighed.rod_bearing or weighed.oil else ""
        text += f", rotating {rotating} {unit.name} per rod (big end{shells}, share of the throw)"
        if len(on_pin) > 1 and engine.cylinders.linkage is None:
            whole = sum(float(engine.weighed[k].rotating + engine.weighed[k].share) for k in on_pin)
            text += f"; {len(on_pin)} rods on the pin: {number(unit.of(whole), 4)} {unit.name}"
    return text + _unequal(engine)


def _unequal(engine: Engine) -> str:
    return "" if engine.equal else " (cylinder 1; others differ)"


def _firing(engine: Engine) -> str:
    """Firing order, and the intervals between firings."""
    if not engine.fires_deg:
        return ""
    instants = [*engine.fires_deg.values(), 180.0 * engine.strokes]
    gaps = [b - a for a, b in pairwise(instants)]
    if max(gaps) - min(gaps) < EVEN_DEG:
        intervals = f"every {gaps[0]:.4g}"
    else:
        intervals = f"after {', '.join(f'{gap:.4g}' for gap in gaps)}"
    return f"{'-'.join(map(str, engine.fires_deg))}, {intervals} deg"
