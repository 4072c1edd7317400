"""Schemes on the crankshaft: counterweights, the shop's balance factor, and the smallest possible
peak force.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Any

import numpy as np

from ..core import enclosing_circle as circle
from ..core.peaks import peak
from ..core.phasors import EPS, Array, Complex, Phasors, unit
from ..engine.build import Engine, Weighed
from ..errors import BalcliError
from ..forces.orders import find_relevant_orders
from ..forces.spectrum import compute_spectra
from . import planes
from .auto import why_weights
from .effects import Part, Slot, solve, steady
from .fitting import FORWARD, SAME_PLACE, Fitting
from .options import NoNeedError, Wish
from .remedy import Remedy, fitted

DEFINITION = (
    "bobweight of a crank pin = rotating mass + factor x reciprocating mass of the rods on that "
    "pin; rotating: rod big ends, "
    "rod bearings, oil; reciprocating: pistons with rings, pins and clips, rod small ends"
)


def counterweights(engine: Engine, wish: Wish) -> Remedy:
    """All of the forward part of order 1, force and moment, in the planes asked for; in a single
    plane as well as it can be done.
    """
    if wish.order not in (None, 1):
        raise BalcliError(
            f"order {wish.order} cannot be cancelled by anything on the crankshaft, which turns "
            "at order 1: "
            "use a shaft scheme"
        )
    fitting = Fitting.of(engine, "counterweights", 1)
    left = fitting.rest(1)
    if not any(left.at(*part) for part in FORWARD):
        raise NoNeedError(
            "there is no free force or moment of order 1 turning with the crank: no counterweight "
            "is needed"
        )
    where = _planes(engine, wish) if wish.planes is not None else _own_planes(engine, fitting)
    slots = [Slot("counterweight", 1, 1, z) for z in where]
    if len(where) > 1:
        return fitting.cancel(slots, FORWARD, why_weights(left)).remedy
    fit = solve(slots, left, FORWARD)
    fitting = fitting.add(
        slots,
        fit.unbalances,
        "One plane takes the force and moment of order 1 turning with the crank as well as "
        "one can (least squares of force, and of moment over its arm)",
    )
    rest = fitting.rest(1)
    why = {"note": SAME_PLACE} if rest.at("moment", 1) else {}
    return fitting.note(
        left_force_N=abs(rest.at("force", 1)) * rest.newton,
        left_moment_Nm=abs(rest.at("moment", 1)) * rest.newton,
        **why,
    ).remedy


def _own_planes(engine: Engine, fitting: Fitting) -> tuple[float, ...]:
    one = planes.of_part(engine, fitting.rest(1), 1)
    return one if len(set(engine.throws_m)) == 1 else planes.ends(engine)


def _planes(engine: Engine, wish: Wish) -> tuple[float, ...]:
    """Places along z as asked for."""
    if wish.planes == "ends":
        return tuple(dict.fromkeys(planes.ends(engine)))
    if wish.planes == "throws":
        return tuple(dict.fromkeys(float(z) for z in engine.throws_m))
    if isinstance(wish.planes, tuple):
        return wish.planes
    raise BalcliError(
        f'--planes "{wish.planes}": give ends, throws, or places along z in mm, such as -200,200'
    )


# ------------------------------------------------------------------ the shop's factor
def factor(engine: Engine, wish: Wish) -> Remedy:
    """At every throw all rotating mass plus the factor times the reciprocating mass of its rods,
    opposite the pin.

    Of several factors, peaks of all are in the details, and the one of the smallest peak force
    (among equals, moment) is fitted.
    """
    if engine.cylinders.linkage is not None and engine.cylinders.linkage.turning:
        raise BalcliError(
            "scheme factor: the cylinders turn and the crank pins stand still, with all that is "
            "on them: there is no "
            "rotating mass to balance opposite a pin; counterweights or auto can balance what is "
            "left"
        )
    wanted = wish.factor or (0.5,)
    if not all(math.isfinite(k) and -10 <= k <= 10 for k in wanted):
        raise BalcliError(
            "--factor: give a share of the reciprocating mass such as 0.5, or a range such as "
            "0:1:0.1"
        )
    rows = [_peaks(engine, k) for k in wanted]
    best = min(rows, key=lambda row: (round(row["peak_force_N"], 6), row["peak_moment_Nm"]))[
        "factor"
    ]
    fitting = _weights(Fitting.of(engine, "factor", 1), best)
    sweep = {"sweep": rows} if len(rows) > 1 else {}
    own = len(engine.devices) - len(_off_crank(engine))
    note = {"note": "the engine's own counterweights are not counted in the factor"} if own else {}
    return fitting.note(
        factor=best, definition=DEFINITION, card=card(engine, best), **sweep, **note
    ).remedy


def card(engine: Engine, share: float) -> list[dict[str, Any]]:
    """The bobweight card: one entry a crank pin, in grams."""
    entries = []
    for rows in _pins(engine):
        masses = [engine.weighed[row] for row in rows]
        grams = {
            key: 1e3 * sum(float(getattr(m, key)) for m in masses)
            for key in ("piston", "small_end", "big_end", "rod_bearing", "oil")
        }
        rotating = grams["big_end"] + grams["rod_bearing"] + grams["oil"]
        reciprocating = grams["piston"] + grams["small_end"]
        entries.append(
            {
                "throw": masses[0].throw + 1,
                "cylinders": [engine.numbers[row] for row in rows],
                **{f"{key}_g": value for key, value in grams.items()},
                "rotating_g": rotating,
                "reciprocating_g": reciprocating,
                "factor": share,
                "bobweight_g": rotating + share * reciprocating,
            }
        )
    return entries


def _pins(engine: Engine) -> list[list[int]]:
    """Rows of the cylinders on each crank pin, in the order of the throws; split pins are
    several.
    """

    def pin(row: int) -> tuple[int, float]:
        return engine.weighed[row].throw, float(engine.cylinders.pin_deg[row]) % 360

    rows = sorted(range(len(engine.numbers)), key=lambda row: (*pin(row), engine.numbers[row]))
    return [list(group) for _, group in groupby(rows, key=pin)]


def _weights(fitting: Fitting, share: float) -> Fitting:
    """One weight opposite every crank pin, where the masses on it have their centre."""
    engine = fitting.engine
    for rows in _pins(engine):
        masses = np.array([_counted(engine.weighed[row], share) for row in rows])
        total = float(masses.sum())
        if total == 0:
            continue
        z = _middle(masses, engine.cylinders.z[rows])
        pin = complex(unit(engine.first_axis_deg + engine.cylinders.pin_deg[rows[0]]))
        names = ", ".join(str(engine.numbers[row]) for row in rows)
        reason = (
            f"Opposite the pin of cylinder{'s' if len(rows) > 1 else ''} {names}: all rotating "
            f"mass and {share:g} "
            "of the reciprocating mass"
        )
        fitting = fitting.add(
            [Slot("counterweight", 1, 1, z)],
            [-total * float(engine.cylinders.radius) * pin],
            reason,
        )
    return fitting


def _middle(masses: Array, places: Array) -> float:
    """Centre of masses along z; in thousandths of a nanometre where that differs by rounding
    alone.
    """
    z = float(masses @ places) / float(masses.sum())
    short = round(z, 12) + 0.0
    return short if abs(z - short) <= len(places) * EPS * float(np.abs(places).max()) else z


def _counted(masses: Weighed, share: float) -> float:
    return float(masses.big_end + masses.share + share * (masses.piston + masses.small_end))


def _peaks(engine: Engine, share: float) -> dict[str, float]:
    """Largest force and moment with this factor, and components of the force along and across the
    first bank.
    """
    new = fitted(steady(engine), _weights(Fitting.of(engine, "factor"), share).remedy)
    curve = _curve(new, "force")
    along = complex(unit(float(engine.cylinders.axis_deg[0])))
    return {
        "factor": share,
        "peak_force_N": peak(curve).value,
        "along_N": _component(curve, along),
        "across_N": _component(curve, 1j * along),
        "peak_moment_Nm": peak(_curve(new, "moment")).value,
    }


def _component(curve: Phasors, direction: complex) -> float:
    """Largest component along a direction."""
    c: Complex = curve.forward * direction.conjugate() + np.conj(curve.backward) * direction
    return peak(Phasors.from_scalar(curve.orders, c, curve.noise).settled()).value


def _curve(engine: Engine, quantity: str) -> Phasors:
    """Force or moment, all orders."""
    found: Phasors = getattr(
        compute_spectra(engine, find_relevant_orders(engine), (quantity,)), quantity
    )
    return found


# ------------------------------------------------------------------ the smallest peak
def minimax(engine: Engine, wish: Wish) -> Remedy:
    """The counterweight that moves the centre of the smallest circle around `F e^{-i theta}` to the
    origin (docs/theory.md).

    One weight in the middle of the throws, or in the planes asked for such that the moment turning
    with the crank vanishes too.
    """
    fitting = Fitting.of(engine, "minimax", 1)
    found = circle.enclose_curve(_curve(fitting.engine, "force"))
    newton = float(engine.omega) ** 2
    reason = (
        f"The largest force over a revolution, all orders, becomes {found.radius:.5g} N: no "
        "weight on the crankshaft "
        "can make it smaller (smallest circle around the force as seen from the crank)"
    )
    left = fitting.rest(1)
    centred = abs(found.centre) <= max(left.noise[Part("force", 1)] * newton, found.noise)
    idle = (
        "no counterweight makes the largest force smaller than it is: "
        f"{found.radius:.5g} N, which has no part of order 1 turning with the crank"
    )
    if centred and wish.planes is None:
        raise NoNeedError(idle)
    fitting = fitting.add(
        *_split(engine, wish, fitting, 0j if centred else -found.centre / newton), reason
    )
    half = _peaks(replace(fitting.engine, devices=_off_crank(engine)), 0.5)["peak_force_N"]
    return fitting.note(
        peak_force_N=found.radius,
        reached_deg=sorted(round(float(d), 9) % 360 for d in np.degrees(found.theta)),
        relative_error_bound=found.excess / found.radius if found.radius else 0.0,
        factor_half_peak_N=half,
        improvement=_gain(found, half),
        **({} if fitting.fits else {"note": idle}),
    ).remedy


def _gain(found: circle.Circle, half: float) -> float:
    """The share by which the circle is smaller than that peak; 0 where they differ by rounding."""
    return 1 - found.radius / half if abs(half - found.radius) > found.noise else 0.0


def _off_crank(engine: Engine) -> tuple[Any, ...]:
    """Devices that are no counterweights."""
    return tuple(d for d in engine.devices if d.rank)


def _split(
    engine: Engine, wish: Wish, fitting: Fitting, unbalance: complex
) -> tuple[Sequence[Slot], Iterable[complex]]:
    """That unbalance in one plane, or in several such that no forward moment of order 1 is left."""
    if wish.planes is None:
        return [
            Slot(
                "counterweight",
                1,
                1,
                planes.middle(engine) if wish.position is None else wish.position,
            )
        ], (unbalance,)
    slots = [Slot("counterweight", 1, 1, z) for z in _planes(engine, wish)]
    left = fitting.rest(1)
    whole = left._replace(parts={**left.parts, Part("force", 1): -unbalance})
    fit = solve(slots, whole, FORWARD)
    if fit.left > 1e-9:
        raise BalcliError(f"--planes: {SAME_PLACE}")
    return slots, fit.unbalances
