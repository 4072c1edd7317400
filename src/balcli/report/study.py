"""Compute the data of a page of pictures: an engine without or with a scheme's devices, over the
balance factor, or over the bank angle.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..analysis.answer import Analysis, analyze, find_inner_loads
from ..balancing.answer import balance_engine as balance
from ..core.phasors import Array, Phasors
from ..engine.engine import Engine
from ..errors import BalcliError
from ..forces.crankshaft import InnerLoads
from ..forces.kinds import VECTORS
from ..forces.spectrum import compute_spectra
from ..sizing.bobweights import FactorPeaks
from ..sizing.factor import find_best_peaks
from ..sizing.ladder import Ladder, find_ladder
from ..sizing.options import SchemeOptions
from ..sizing.remedy import Remedy, fit_devices
from ..sizing.sizing import size
from .names import OF_GAS

FACTORS = tuple(k / 50 for k in range(51))
_ALONE = ("ladder", "bank", *OF_GAS)  # pages of the engine without a scheme


class Banks(NamedTuple):
    """Free force of one order over the bank angle of a vee; all else is unchanged.

    Attributes:
        angles_deg: Bank angles, shape (angles,).
        own_deg: Bank angle of the engine.
        force: Force, N, shape (1, angles).
    """

    order: float
    angles_deg: Array
    own_deg: float
    force: Phasors


class Study(NamedTuple):
    """Data of a page.

    Attributes:
        now, before: Analysis of the engine with fitted devices, if any, and without them.
        remedy: Fitted devices.
        factors: Peaks over the balance factor, ascending, including the best factor.
        banks: Force of one order over the bank angle.
        bent: Loads along the crankshaft with fitted devices, and without.
        steps: Engine with the devices of each step of the ladder, by name.
    """

    now: Analysis
    before: Analysis | None = None
    remedy: Remedy | None = None
    factors: Sequence[FactorPeaks] = ()
    banks: Banks | None = None
    bent: tuple[InnerLoads, ...] = ()
    steps: Mapping[str, Analysis] = {}


def analyze_steps(
    engine: Engine, ladder: Ladder, orders: Iterable[float] | None
) -> dict[str, Analysis]:
    """Return free forces and moments of an engine with the devices of each step of a ladder, by
    number and name of the step.
    """
    return {
        f"{k} {step.step}": analyze(
            fit_devices(engine, step.remedy), orders, [kind.name for kind in VECTORS]
        )
        for k, step in enumerate(ladder.steps)
    }


def compute_study(
    engine: Engine,
    what: str,
    orders: Sequence[float] | None = None,
    scheme: str | None = None,
    options: SchemeOptions | None = None,
) -> Study:
    """Return the data of the page `what`.

    Args:
        engine: Single engine (no trailing axes).
        orders: Orders to show; "bank" shows the first one.
        scheme: Balance scheme to compare with, if any.
        options: Options of the scheme; "factor" uses only planes, "ladder" only small.

    Raises:
        BalcliError: the scheme is unknown, cannot be fitted, or does not suit the page, or "bank"
            is requested for an engine that is not a vee.
    """
    if what == "factor":
        return Study(analyze(engine, orders), factors=_sweep_factors(engine, scheme, options))
    if what in _ALONE:
        refuse_scheme(scheme, what)
    if scheme is not None:
        found = balance(engine, scheme, options, orders)
        engines = (found.after.engine, engine) if what == "inner" else ()
        bent = tuple(map(find_inner_loads, engines))
        return Study(found.after, found.before, found.remedy, bent=bent)
    now = analyze(engine, orders)
    if what == "ladder":
        ladder = find_ladder(engine, (options or SchemeOptions()).read_small())
        return Study(now, steps=analyze_steps(engine, ladder, orders))
    if what == "inner":
        return Study(now, bent=(find_inner_loads(engine),))
    if what == "bank":
        force = now.spectra["force"]
        free = force.orders[(force.orders >= 1) & ~force.balanced].tolist()
        return Study(now, banks=swing_banks(engine, orders[0] if orders else [*free, 2][0]))
    return Study(now)


def refuse_scheme(scheme: str | None, what: str) -> None:
    """Raise BalcliError if a scheme is given for a page that shows the engine without one."""
    if scheme is not None:
        raise BalcliError(
            f"--what {what} shows the engine as it is: leave --scheme and its options out"
        )


def _sweep_factors(
    engine: Engine, scheme: str | None, options: SchemeOptions | None
) -> tuple[FactorPeaks, ...]:
    """Return the peaks over the balance factor, ascending, including the best factor."""
    asked = options or SchemeOptions()
    if scheme not in (None, "factor"):
        raise BalcliError(f"--what factor is of the scheme factor: leave --scheme {scheme} out")
    if asked.factor is not None or asked.measured is not None:
        raise BalcliError("--what factor shows all factors: leave --factor and --measured out")
    asked = asked._replace(factor=FACTORS)
    found = size(engine, "factor", asked)
    return tuple(sorted({*found.sweep, find_best_peaks(engine, asked, found)}))


def swing_banks(engine: Engine, order: float) -> Banks:
    """Return the free force of an order for bank angles of a vee from 0 to 180 degrees, with an
    unchanged crankshaft.

    Raises:
        BalcliError: the engine is not a vee.
    """
    c = engine.cylinders
    axes = np.ravel(c.axis_deg)
    if len(axes) != 2 or c.linkage is not None:
        raise BalcliError(
            f"--what bank swings the two banks of a vee; this engine has {len(axes)} "
            f"bank{'s' if len(axes) > 1 else ''}"
            f"{' and articulated or turning cylinders' if c.linkage is not None else ''}"
        )
    middle, side = axes.mean(), np.sign(axes - axes.mean())
    angles = np.arange(0.0, 180.5, 1.0)
    forces = []
    for angle in angles:
        swung = replace(c, axis_deg=middle + side * angle / 2)
        alone = replace(engine, cylinders=swung, devices=(), ripple=())
        forces.append(compute_spectra(alone, [order], ["force"])["force"].vectors)
    force = Phasors(np.array([float(order)]), np.stack(forces, axis=2), np.zeros(1))
    return Banks(order, angles, float(np.ptp(axes)), force)
