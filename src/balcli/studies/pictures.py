"""What a picture shows: an engine as it is or with a scheme's devices, over the balance factor, or
over the bank angle.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.phasors import Array, Phasors
from ..engine.build import Engine
from ..errors import BalcliError
from ..forces.crankshaft import InnerLoads
from ..forces.spectrum import compute_spectra
from ..results.analysis import Analysis, analyze, find_inner_loads
from ..results.balance import balance
from ..sizing.balance_factor import find_best_factor
from ..sizing.options import SchemeOptions
from ..sizing.remedy import Remedy
from ..sizing.scheme_figures import FactorPeaks
from ..sizing.sizing import size
from ..torque.pictures import PAGES, GasPicture, compute_picture

FACTORS = tuple(k / 50 for k in range(51))
_ALONE = ("bank", *PAGES)  # studies of the engine as it is


class Banks(NamedTuple):
    """Free force of one order over the bank angle of a vee, all else unchanged.

    Attributes:
        angles_deg: shape (angles,).
        own_deg: the engine's bank angle.
        force: N, shape (1, angles).
    """

    order: float
    angles_deg: Array
    own_deg: float
    force: Phasors


class Study(NamedTuple):
    """What a page shows.

    Attributes:
        now, before: the engine, and without the devices that were fitted, if any were.
        remedy: those devices.
        factors: rows of peaks over the balance factor, ascending; the best of all among them.
        banks: an order over the bank angle.
        bent: what bends the crankshaft now, and before.
        gas: pressures, torque or loads of an engine with gas.
    """

    now: Analysis
    before: Analysis | None = None
    remedy: Remedy | None = None
    factors: Sequence[FactorPeaks] = ()
    banks: Banks | None = None
    bent: tuple[InnerLoads, ...] = ()
    gas: GasPicture | None = None


def compute_study(
    engine: Engine,
    what: str,
    orders: Sequence[float] | None = None,
    scheme: str | None = None,
    options: SchemeOptions | None = None,
) -> Study:
    """What the page `what` shows.

    Args:
        engine: without trailing axes.
        orders: which to show; of "bank" the first one counts.
        scheme: the balance scheme to compare with, if any.
        options: of the scheme; "factor" takes planes alone.

    Raises:
        BalcliError: an unknown scheme, one that cannot be fitted, or one beside a study that takes
            none; a bank angle is asked of an engine that is no vee.
    """
    if what == "factor":
        return Study(analyze(engine, orders), factors=_sweep_factors(engine, scheme, options))
    if what in _ALONE:
        refuse_scheme(scheme, what)
    if scheme is not None:
        found = balance(engine, scheme, options, orders)
        engines = (found.after.engine, engine) if what == "inner" else ()
        return Study(
            found.after, found.before, found.remedy, bent=tuple(map(find_inner_loads, engines))
        )
    now = analyze(engine, orders)
    if what in PAGES:
        return Study(now, gas=compute_picture(engine, what))
    if what == "inner":
        return Study(now, bent=(find_inner_loads(engine),))
    if what == "bank":
        order = _find_lowest(now) if orders is None else orders[0]
        return Study(now, banks=swing_banks(engine, order))
    return Study(now)


def refuse_scheme(scheme: str | None, what: str) -> None:
    """Refuse devices in a picture of the engine without any.

    Raises:
        BalcliError: there is a scheme.
    """
    if scheme is not None:
        raise BalcliError(
            f"--what {what} shows the engine as it is: leave --scheme and its options out"
        )


def _sweep_factors(
    engine: Engine, scheme: str | None, options: SchemeOptions | None
) -> tuple[FactorPeaks, ...]:
    """Peaks over the balance factor, ascending, the best of all among them.

    Raises:
        BalcliError: another scheme is named, or a factor, or whatever else the scheme refuses.
    """
    asked = options or SchemeOptions()
    if scheme not in (None, "factor"):
        raise BalcliError(f"--what factor is of the scheme factor: leave --scheme {scheme} out")
    if asked.factor is not None or asked.measured is not None:
        raise BalcliError("--what factor shows all factors: leave --factor and --measured out")
    asked = asked._replace(factor=FACTORS)
    sweep = size(engine, "factor", asked).sweep
    return tuple(sorted({*sweep, find_best_factor(engine, asked, sweep)}))


def swing_banks(engine: Engine, order: float) -> Banks:
    """The free force of an order while the two banks of a vee are swung apart from 0 to 180
    degrees, the crankshaft unchanged.
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
    columns = [
        _force(
            replace(engine, cylinders=replace(c, axis_deg=middle + side * angle / 2), devices=()),
            order,
        )
        for angle in angles
    ]
    vectors = np.stack([force.vectors for force in columns], axis=2)
    force = Phasors(np.array([float(order)]), vectors, np.zeros(1))
    return Banks(order, angles, float(np.ptp(axes)), force)


def _force(engine: Engine, order: float) -> Phasors:
    return compute_spectra(replace(engine, ripple=()), [order], ["force"])["force"]


def _find_lowest(now: Analysis) -> int:
    """The lowest order with a free force, or the second."""
    force = now.spectra["force"]
    free = [
        int(n)
        for n, balanced in zip(force.orders, force.balanced, strict=True)
        if n >= 1 and not balanced
    ]
    return free[0] if free else 2
