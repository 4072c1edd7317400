"""Compute the data of a page of pictures: forces and moments of an engine without and with a
scheme's devices, over the balance factor, or over the bank angle.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..analysis.answer import DEFAULT_ORDERS, Analysis, analyze, find_inner_loads
from ..balancing.answer import balance
from ..core.phasors import Array, Phasors, unit
from ..engine.engine import Engine, refuse_geared
from ..errors import ArgumentError, Message
from ..file.fields import counted
from ..forces.crankshaft import InnerLoads
from ..forces.kinds import FREE
from ..forces.spectrum import compute_spectra
from ..forces.symmetry import with_reciprocating_only
from ..sizing.bobweights import FactorPeaks
from ..sizing.factor import find_best_peaks
from ..sizing.ladder import Ladder, find_ladder
from ..sizing.options import SchemeOptions
from ..sizing.remedy import Remedy, fit_devices
from ..sizing.sizing import size
from .names import OF_GAS, OF_PARTS

FACTORS = tuple(k / 50 for k in range(51))
_NO_RADIUS = 1e-9  # a force below this share of the largest one counts as 0
_OF_ONE_CRANK = ("bank", "factor", "inner", "pressure", "p-v", "pin", "main", *OF_PARTS)
_ALONE = ("ladder", "bank", *OF_GAS, *OF_PARTS)  # pages that show the engine without a scheme


class Banks(NamedTuple):
    """Free force of one order over the bank angle of a vee; all other figures stay the same.

    Attributes:
        order: Order of the force.
        angles_deg: Bank angles, shape (angles,).
        own_deg: Bank angle of the engine.
        middle_deg: Direction of the middle of the vee, deg from x.
        force: Force, N, shape (1, angles).
    """

    order: float
    angles_deg: Array
    own_deg: float
    middle_deg: float
    force: Phasors

    def find_radii(self) -> tuple[Array, Array, Array]:
        """Return the distances from the crank axis (radii) at which two shafts cancel the force
        without a roll moment, as shares of the longest radius: first of the shaft that turns with
        the crank, then of the other one; and the ratio first / second, which is nan where no force
        turns with the crank. Each has the shape (angles,).

        Radii are inversely proportional to the forces. The first radius, and so the ratio, has the
        sign of Liu's paper (docs/theory.md): positive if one shaft is above and one below the
        crank, on the same side of the middle plane of the vee; negative if both shafts are above or
        both below the crank, on opposite sides of this plane.
        """
        forward = self.force.forward[0]
        backward = self.force.backward[0]
        alike = forward * backward * unit(-2 * self.middle_deg)
        signed = np.where(alike.real > 0, -1, 1) * np.abs(backward)
        against = np.abs(forward)
        longest = float(np.abs([forward, backward]).max())
        there = against > _NO_RADIUS * longest
        ratio = np.divide(signed, against, where=there, out=np.full(signed.shape, np.nan))
        return signed / longest, against / longest, ratio


class Study(NamedTuple):
    """Data of a page.

    Attributes:
        now: Analysis of the engine.
        before: Analysis of the engine without the scheme's devices; None without a scheme.
        remedy: Fitted devices.
        factors: Peaks by balance factor, ascending, including the best factor.
        banks: Force of one order over the bank angle, for the page "bank".
        pair: Whether the page shows the two shafts that cancel the force at each bank angle.
        bent: Loads along the crankshaft now, then those before devices were fitted.
        steps: Analysis of the engine with the devices of each step of the ladder (balancing in
            steps), by number and name of the step.
    """

    now: Analysis
    before: Analysis | None = None
    remedy: Remedy | None = None
    factors: Sequence[FactorPeaks] = ()
    banks: Banks | None = None
    pair: bool = False
    bent: tuple[InnerLoads, ...] = ()
    steps: Mapping[str, Analysis] = {}


def analyze_steps(
    engine: Engine, ladder: Ladder, orders: Iterable[float] | None
) -> dict[str, Analysis]:
    """Return free forces and moments of an engine with the devices of each step of a ladder, by
    number and name of the step.
    """
    kinds = [kind.name for kind in FREE]
    analyses = {}
    for k, step in enumerate(ladder.steps):
        balanced = fit_devices(engine, step.remedy)
        analyses[f"{k}: {step.step}"] = analyze(balanced, orders, kinds)
    return analyses


def compute_study(
    engine: Engine,
    what: str,
    orders: Sequence[float] | None = None,
    scheme: str | None = None,
    options: SchemeOptions | None = None,
) -> Study:
    """Return the data of the page `what`.

    Args:
        engine: A single engine, not an array of variants.
        orders: Orders to show; "bank" shows the first one.
        scheme: Balance scheme; the page compares the engine without and with the scheme's devices.
        options: Options of the scheme; the page "factor" uses only `planes`, "ladder" only
            `small`.

    Raises:
        BalcliError: The scheme is unknown, cannot be fitted, or does not suit the page, or "bank"
            is requested for an engine that is not a vee.
    """
    if what in _OF_ONE_CRANK:
        refuse_geared(engine)
    if what == "factor":
        return Study(analyze(engine, orders), factors=_sweep_factors(engine, scheme, options))
    asked = options or SchemeOptions()
    pair = what == "bank" and scheme == "two-shaft"
    if what in _ALONE and not (pair and asked._replace(order=None, small=None) == SchemeOptions()):
        refuse_scheme(scheme, what)
    if what == "webs" and engine.webs is None:
        raise ArgumentError(
            "{what} webs: the file has no [[web]]; describe the webs of the crankshaft there"
        )
    if what == "bank":
        now = analyze(engine, orders)
        force = now.spectra["force"]
        free = force.orders[(force.orders >= 1) & ~force.balanced].tolist()
        order = asked.order or [*(orders or free), 2][0]
        # The shafts cancel the force of the reciprocating masses; counterweights cancel the rest.
        swung = with_reciprocating_only(engine) if pair else engine
        return Study(now, banks=swing_banks(swung, order), pair=pair)
    if scheme is not None:
        found = balance(engine, scheme, options, orders)
        engines = (found.after.engine, engine) if what == "inner" else ()
        bent = tuple(map(find_inner_loads, engines))
        return Study(found.after, found.before, found.remedy, bent=bent)
    if what == "stars":
        return Study(analyze(engine, orders or DEFAULT_ORDERS))
    now = analyze(engine, orders)
    if what == "ladder":
        ladder = find_ladder(engine, asked.read_small())
        return Study(now, steps=analyze_steps(engine, ladder, orders))
    bent = (find_inner_loads(engine),) if what == "inner" else ()
    return Study(now, bent=bent)


def refuse_scheme(scheme: str | None, what: str) -> None:
    """Raise ArgumentError if a scheme is given for a page that shows the engine without one."""
    if scheme is not None:
        hint = Message("; bank takes only {scheme} two-shaft with {order}")
        raise ArgumentError(
            "{what} {page} shows the engine as it is: leave {scheme} and its options out{hint}",
            page=what,
            hint=hint if what == "bank" else "",
        )


def _sweep_factors(
    engine: Engine, scheme: str | None, options: SchemeOptions | None
) -> tuple[FactorPeaks, ...]:
    """Return the peaks over the balance factor, ascending, including the best factor."""
    asked = options or SchemeOptions()
    if scheme not in (None, "factor"):
        raise ArgumentError(
            "{what} factor shows the scheme factor: leave {scheme} {other} out", other=scheme
        )
    if asked.factor is not None or asked.measured is not None:
        raise ArgumentError("{what} factor shows all factors: leave {factor} and {measured} out")
    asked = asked._replace(factor=FACTORS)
    found = size(engine, "factor", asked)
    return tuple(sorted({*found.sweep, find_best_peaks(engine, asked, found)}))


def swing_banks(engine: Engine, order: float) -> Banks:
    """Return the free force of an order for bank angles of a vee from 0 to 180 degrees, with an
    unchanged crankshaft.

    Raises:
        ArgumentError: The engine is not a vee.
    """
    c = engine.cylinders
    axes = np.ravel(c.axis_deg)
    if len(axes) != 2 or c.linkage is not None:
        others = " and articulated rods or turning cylinders"
        raise ArgumentError(
            "{what} bank needs the two banks of a vee; this engine has {banks}{others}",
            banks=counted(len(axes), "bank"),
            others=others if c.linkage is not None else "",
        )
    middle = axes.mean()
    side = np.sign(axes - axes.mean())
    angles = np.arange(0.0, 180.5, 1.0)
    forces = []
    for angle in angles:
        swung = replace(c, axis_deg=middle + side * angle / 2)
        alone = replace(engine, cylinders=swung, devices=(), ripple=())
        forces.append(compute_spectra(alone, [order], ["force"])["force"].vectors)
    force = Phasors(np.array([float(order)]), np.stack(forces, axis=2), np.zeros(1))
    return Banks(order, angles, float(np.ptp(axes)), float(middle), force)
