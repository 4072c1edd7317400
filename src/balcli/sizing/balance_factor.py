"""The scheme `factor`, as balancing shops do it: opposite each crank pin all rotating mass and a
share of the reciprocating mass of the rods on it.
"""

from __future__ import annotations

import math

import numpy as np

from ..core.peaks import peak
from ..core.phasors import EPS, Array, Phasors, unit
from ..engine.build import Engine, Weighed
from ..errors import BalcliError
from ..forces.orders import find_relevant_orders
from ..forces.spectrum import compute_spectra
from ..limits import LARGEST_FACTOR
from .bobweight_card import DEFINITION, fill_card
from .details import Detail, FactorPeaks
from .effects import Slot
from .fitting import Fitting
from .options import SchemeOptions
from .remedy import Remedy, fit_devices


def size_by_factor(engine: Engine, options: SchemeOptions) -> Remedy:
    """Counterweights by the factor asked for, 0.5 if none is.

    Of several factors all peaks are told, and the one that leaves the smallest peak force (among
    equals, moment) is fitted.

    Raises BalcliError for a factor that is no share, or if the crankshaft stands still.
    """
    if engine.cylinders.linkage is not None and engine.cylinders.linkage.turning:
        raise BalcliError(
            "scheme factor: the cylinders turn and the crank pins stand still, with all that is "
            "on them: there is no rotating mass to balance opposite a pin; counterweights or auto "
            "can balance what is left"
        )
    factors = options.factor or (0.5,)
    if not all(math.isfinite(k) and abs(k) <= LARGEST_FACTOR for k in factors):
        raise BalcliError(
            "--factor: give a share of the reciprocating mass such as 0.5, or a range such as "
            "0:1:0.1"
        )
    sweep = tuple(find_factor_peaks(engine, factor) for factor in factors)
    best = min(sweep, key=lambda peaks: (round(peaks.force, 6), peaks.moment)).factor
    fitting = _add_weights(Fitting.start(engine, "factor", 1), best).note(
        Detail("factor", "", best), Detail("definition", "", DEFINITION)
    )
    own = any(device.rank == 0 for device in engine.devices)
    return fitting.remedy._replace(
        note="the engine's own counterweights are not counted in the factor" if own else "",
        card=fill_card(engine, best),
        sweep=sweep if len(sweep) > 1 else (),
    )


def find_factor_peaks(engine: Engine, factor: float) -> FactorPeaks:
    """Largest force and moment at steady speed with weights of this factor besides the engine's own
    devices.
    """
    fitting = _add_weights(Fitting.start(engine, "factor"), factor)
    new = fit_devices(fitting.engine, fitting.remedy)
    force, moment = find_curve(new, "force"), find_curve(new, "moment")
    along = complex(unit(float(engine.cylinders.axis_deg[0])))
    return FactorPeaks(
        factor=factor,
        force=peak(force).value,
        along=_find_largest_component(force, along),
        across=_find_largest_component(force, 1j * along),
        moment=peak(moment).value,
    )


def find_curve(engine: Engine, quantity: str) -> Phasors:
    """Free force or moment of all orders."""
    spectra = compute_spectra(engine, find_relevant_orders(engine), (quantity,))
    curve: Phasors = getattr(spectra, quantity)
    return curve


def _add_weights(fitting: Fitting, factor: float) -> Fitting:
    """With one weight opposite every crank pin, where the masses on it have their centre."""
    engine = fitting.engine
    for rows in engine.rows_by_pin:
        masses = np.array([_count(engine.weighed[row], factor) for row in rows])
        total = float(masses.sum())
        if total == 0:
            continue
        z = _find_centre(masses, engine.cylinders.z[rows])
        pin = complex(unit(engine.first_axis_deg + engine.cylinders.pin_deg[rows[0]]))
        numbers = ", ".join(str(engine.numbers[row]) for row in rows)
        reason = (
            f"Opposite the pin of cylinder{'s' if len(rows) > 1 else ''} {numbers}: all rotating "
            f"mass and {factor:g} of the reciprocating mass"
        )
        unbalance = -total * float(engine.cylinders.radius) * pin
        fitting = fitting.add([Slot("counterweight", 1, 1, z)], [unbalance], reason)
    return fitting


def _count(masses: Weighed, factor: float) -> float:
    """The mass of one cylinder that is balanced opposite its pin, kg."""
    return float(masses.rotating + masses.share + factor * masses.reciprocating)


def _find_centre(masses: Array, places: Array) -> float:
    """Centre along z of masses at these places, m; in thousandths of a nanometre where that differs
    by rounding alone.
    """
    z = float(masses @ places) / float(masses.sum())
    legible = round(z, 12) + 0.0
    rounding = len(places) * EPS * float(np.abs(places).max())
    return legible if abs(z - legible) <= rounding else z


def _find_largest_component(curve: Phasors, direction: complex) -> float:
    """Largest component of a force along a direction (a unit vector), N."""
    coefficients = curve.forward * direction.conjugate() + np.conj(curve.backward) * direction
    return peak(Phasors.from_scalar(curve.orders, coefficients, curve.noise).settled()).value
