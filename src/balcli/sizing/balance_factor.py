"""The scheme `factor`, as balancing shops do it: opposite each crank pin all rotating mass and a
share of the reciprocating mass of the rods on it; less what the file's own counterweights do.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..core.cylinders import DeviceKind
from ..core.golden_section import find_least
from ..core.levers import share_by_lever
from ..core.peaks import find_peak
from ..core.phasors import EPS, Array, Complex, Phasors, unit
from ..engine.build import Engine
from ..engine.positions import MOMENTS_UNKNOWN
from ..errors import BalcliError
from ..forces.orders import find_relevant_orders
from ..forces.spectrum import compute_spectra
from ..limits import LARGEST_FACTOR
from .bobweight_card import DEFINITION, NO_THROW, fill_card
from .details import Detail
from .device_tables import find_unbalance
from .effects import LEFT, Slot
from .fitting import Fitting
from .options import SchemeOptions
from .planes import SAME_PLACE, read_planes
from .remedy import Remedy, fit_devices
from .scheme_figures import FactorPeaks, PlaneNeed

_NEARLY = 0.05  # of one cylinder's: pistons of one engine, weighed, differ by less
COMPLETE = "nothing is missing: the counterweights of the file balance this factor"
IN_SUM = (
    "nothing is missing in sum; opposite which pin the counterweights of the file stand is not "
    "known, as moments are not"
)
OF_ITSELF = "nothing is missing: what the pins carry balances itself in these planes"
OWN_PLACES = (
    "these planes are where the counterweights of the file stand; --planes throws asks what is "
    "missing at every throw instead"
)


class PinUnbalance(NamedTuple):
    """What one crank pin asks for.

    Attributes:
        cylinders: numbers of those whose rods are on it.
        unbalance: of what is to be balanced opposite it, with the throw, at crank angle 0, kg m.
        z: where the masses on the pin have their centre, m.
    """

    cylinders: tuple[int, ...]
    unbalance: complex
    z: float


def size_by_factor(engine: Engine, options: SchemeOptions) -> Remedy:
    """Counterweights by the factor asked for, 0.5 if none is, or by what was measured on a pin.

    What the file's own counterweights do counts, and what is missing is fitted: in the planes asked
    for, to which pins and weights are carried by the lever; by default where the file's own stand,
    or opposite each pin if they stand in fewer than two places (of pins in one plane in sum).

    Of several factors all peaks are told, and the one that leaves the smallest peak force is
    fitted, or moment, where the pins balance each other (`FactorPeaks.by_moment`).

    Raises BalcliError for a factor that is no share, planes where moments are not known, or if the
    crankshaft stands still.
    """
    if engine.rotary:
        raise BalcliError(
            "scheme factor: the cylinders turn and the crank pins stand still, with all that is "
            "on them: there is no rotating mass to balance opposite a pin; counterweights or auto "
            "can balance what is left"
        )
    planes = _choose_planes(engine, options)
    factors = _choose_factors(engine, options)
    sweep = tuple(find_factor_peaks(engine, factor, planes) for factor in factors)
    best = min(sweep, key=lambda peaks: peaks.cost).factor
    fitting = _fit_factor(engine, best, planes).add_details(*_describe(engine, options, best))
    own = bool(_find_counterweights(engine)[1].any())
    needs = _find_needs(engine, best, planes)
    unasked = options.planes is None and planes is not None
    return fitting.remedy._replace(
        note=_note(fitting, best, needs, own=own, unasked=unasked),
        card=fill_card(engine, best),
        needs=tuple(_count_from_pin(engine, need) for need in needs) if own else (),
        sweep=sweep if len(sweep) > 1 else (),
    )


def find_best_factor(
    engine: Engine, options: SchemeOptions, sweep: Sequence[FactorPeaks]
) -> FactorPeaks:
    """The peaks at the best factor of all between those of a sweep, to 1e-4 of its step.

    The peak of a force that grows evenly with the factor at each crank angle is a convex function
    of it, and so is that of the moment: the best of all stands beside the best of the sweep.
    """
    planes = _choose_planes(engine, options)
    k = min(range(len(sweep)), key=lambda k: sweep[k].cost)
    low, high = sweep[max(k - 1, 0)].factor, sweep[min(k + 1, len(sweep) - 1)].factor
    found = find_least(lambda f: find_factor_peaks(engine, f, planes).cost, low, high)
    return min(sweep[k], find_factor_peaks(engine, found, planes), key=lambda peaks: peaks.cost)


def _note(
    fitting: Fitting, factor: float, needs: Sequence[PlaneNeed], *, own: bool, unasked: bool
) -> str:
    """What to know besides; the file may have counterweights of its `own`, and planes may have been
    chosen `unasked`, where these stand.
    """
    if _loses_moment(fitting.engine, factor, needs):
        return SAME_PLACE
    if factor < 0:
        return "a factor below 0: not even all rotating mass is balanced"
    if factor > 1:
        return "a factor above 1: more than all reciprocating mass on the pin is balanced"
    if not fitting.remedy.devices:
        complete = COMPLETE if fitting.engine.places_known else IN_SUM
        return complete if own else OF_ITSELF
    return OWN_PLACES if unasked else ""


def _loses_moment(engine: Engine, factor: float, needs: Sequence[PlaneNeed]) -> bool:
    """Whether there is one plane alone, about which pins or weights elsewhere make a moment."""
    z = {need.z for need in needs}
    if len(z) != 1 or not engine.places_known:
        return False
    loads, (places, weights) = _list_loads(engine, factor), _find_counterweights(engine)
    arms = np.array([*(load.z for load in loads), *places]) - z.pop()
    vectors = np.array([*(load.unbalance for load in loads), *weights])
    return bool(abs(arms @ vectors) > LEFT * (np.abs(arms) @ np.abs(vectors)))


def find_factor_peaks(
    engine: Engine, factor: float, planes: tuple[float, ...] | None = None
) -> FactorPeaks:
    """Largest force and moment at steady speed when the crankshaft is balanced by this factor."""
    fitting = _fit_factor(engine, factor, planes)
    new = fit_devices(fitting.engine, fitting.remedy)
    force, moment = find_curve(new, "force"), find_curve(new, "moment")
    along = complex(unit(float(engine.cylinders.axis_deg[0])))
    return FactorPeaks(
        factor=factor,
        force=find_peak(force).value,
        along=_find_largest_component(force, along),
        across=_find_largest_component(force, 1j * along),
        moment=find_peak(moment).value,
        bobweight_g=fill_card(engine, factor)[0].bobweight_g,
        counterweight=max(map(find_unbalance, fitting.remedy.counterweights), default=0.0),
        by_moment=engine.places_known and _do_pins_balance(engine),
    )


def _do_pins_balance(engine: Engine) -> bool:
    """Whether what goes to and fro adds up to nearly nothing, taken at the crank pins: the share of
    it that a factor adds to the counterweights is then a moment.
    """
    masses = np.array([float(weighed.reciprocating) for weighed in engine.weighed])
    pins = unit(np.array([float(pin) for pin in engine.cylinders.pin_deg]))
    return bool(abs(masses @ pins) < _NEARLY * masses.max())


def find_curve(engine: Engine, quantity: str) -> Phasors:
    """Free force or moment of all orders."""
    return compute_spectra(engine, find_relevant_orders(engine), (quantity,))[quantity]


# ------------------------------------------------------------------ which factor, which planes
def _choose_factors(engine: Engine, options: SchemeOptions) -> tuple[float, ...]:
    """The factors asked for, or the one that was measured."""
    if options.measured is not None:
        if options.factor is not None:
            raise BalcliError(
                "--factor and --measured say the same: what balances a pin stands for a factor; "
                "give one of them"
            )
        return (find_measured_factor(engine, options.measured),)
    factors = options.factor or (0.5,)
    for factor in factors:
        if not (math.isfinite(factor) and abs(factor) <= LARGEST_FACTOR):
            meant = f"did you mean {factor:g}%? " if LARGEST_FACTOR < factor <= 100 else ""
            raise BalcliError(
                f"--factor {factor:g}: is no share of the reciprocating mass; {meant}give one such "
                "as 0.5 or 51%, or a range such as 50%:54%:1%"
            )
    return factors


def find_measured_factor(engine: Engine, measured: float) -> float:
    """The factor of a crankshaft that is in balance with this mass (kg) on each bare pin, at the
    crank radius, without rods: that mass stands for rotating + factor x reciprocating mass.

    Raises BalcliError where nothing goes to and fro, or for a mass that no crankshaft can have.
    """
    if measured < 0:
        raise BalcliError(f"--measured {1e3 * measured:g} g: a mass on the pin is not negative")
    card = fill_card(engine, 0.0)
    reciprocating = sum(one.reciprocating_g for one in card)
    rotating = sum(one.rotating_g for one in card)
    if not reciprocating:
        raise BalcliError("--measured: nothing goes to and fro in this engine: there is no factor")
    factor = (1e3 * measured * len(card) - rotating) / reciprocating
    if not abs(factor) <= LARGEST_FACTOR:
        raise BalcliError(
            f"--measured {1e3 * measured:g} g: would balance {factor:.3g} times the reciprocating "
            f"mass; {rotating / len(card):.5g} g balance none of it on a pin, and "
            f"{(rotating + reciprocating) / len(card):.5g} g all; is the unit right?"
        )
    return factor


def _choose_planes(engine: Engine, options: SchemeOptions) -> tuple[float, ...] | None:
    """The planes asked for (z, m), ascending, each once; by default those of the file's own
    counterweights if they stand in at least two; None: those of the pins.
    """
    if options.planes is None:
        places = np.round(_find_counterweights(engine)[0], 12)  # decimals of one place: one
        own = np.unique(places)
        return tuple(own.tolist()) if len(own) > 1 and engine.places_known else None
    if not engine.places_known:
        raise BalcliError(f"--planes: {MOMENTS_UNKNOWN}")
    return tuple(sorted(set(read_planes(engine, options))))


def _describe(engine: Engine, options: SchemeOptions, factor: float) -> list[Detail]:
    """The factor by both definitions, and what was measured."""
    rods = len(engine.rows_by_pin[0])
    said = "of all reciprocating mass on the pin"
    details = [
        Detail("factor", "share", factor, what=said),
        Detail(
            "factor of one cylinder",
            "share",
            factor * rods,
            what=f"of {name_one_cylinder(engine)}: the same weight",
        ),
        Detail("definition", "", DEFINITION),
    ]
    if not any(float(weighed.share) for weighed in engine.weighed):
        details.append(Detail("throw", "", NO_THROW))
    if options.measured is not None:
        what = "balance each bare pin, at the crank radius, without rods"
        details.insert(0, Detail("measured", "grams", options.measured, what=what))
    return details


def name_one_cylinder(engine: Engine) -> str:
    """What a factor of one cylinder is a share of: any of them, or the mean of unequal ones."""
    masses = {round(float(weighed.reciprocating), 9) for weighed in engine.weighed}
    return f"one cylinder's reciprocating mass{', in the mean' if len(masses) > 1 else ''}"


# ------------------------------------------------------------------ what is wanted, what is there
def _fit_factor(engine: Engine, factor: float, planes: tuple[float, ...] | None) -> Fitting:
    """With a weight in each plane for what is missing there."""
    fitting = Fitting.start(engine, "factor", 1)
    counted = "; what the counterweights of the file do is counted"
    less = counted if _find_counterweights(engine)[1].any() else ""
    taken = f"all rotating mass and {factor:.6g} of the reciprocating mass"
    needs = _find_needs(engine, factor, planes)
    if planes is not None:
        reason = f"In these planes, carried to them by the lever: {taken} of every pin{less}"
        slots = [Slot("counterweight", 1, 1, need.z) for need in needs]
        return fitting.add(slots, [need.missing for need in needs], reason)
    for need, pins in zip(needs, _share_out(engine, _list_loads(engine, factor)), strict=True):
        numbers = [str(number) for pin in pins for number in pin.cylinders]
        cylinders = f"cylinder{'s' * (len(numbers) > 1)} {', '.join(numbers)}"
        where = "Opposite the pin" if len(pins) == 1 else "In the plane"
        reason = f"{where} of {cylinders}: {taken}{less}"
        fitting = fitting.add([Slot("counterweight", 1, 1, need.z)], [need.missing], reason)
    return fitting


def _find_needs(
    engine: Engine, factor: float, planes: tuple[float, ...] | None
) -> tuple[PlaneNeed, ...]:
    """What each plane asks for and has, directions at crank angle 0; without planes one for each
    set of pins of `_share_out`.
    """
    loads = _list_loads(engine, factor)
    if not loads:
        return ()
    pins = np.array([load.unbalance for load in loads], complex)
    if planes is None:
        sets = _share_out(engine, loads)
        z = np.array([members[0].z for members in sets])
        of_pins = np.array([[float(load in members) for load in loads] for members in sets])
    else:
        z = np.array(planes)
        of_pins = share_by_lever(np.array([load.z for load in loads]), z)
    places, weights = _find_counterweights(engine)
    of_weights = np.zeros((len(z), len(places)))
    if weights.any():
        of_weights[np.argsort(z)] = share_by_lever(places, np.sort(z))
    wanted, present = -(of_pins @ pins), of_weights @ weights
    parts = np.abs(of_pins) @ np.abs(pins) + np.abs(of_weights) @ np.abs(weights)
    vectors = np.stack([wanted, present, wanted - present])
    settled = np.where(np.abs(vectors) <= LEFT * parts, 0, vectors)  # dust of what cancels is none
    return tuple(PlaneNeed(*row) for row in zip(z.tolist(), *settled.tolist(), strict=True))


def _count_from_pin(engine: Engine, need: PlaneNeed) -> PlaneNeed:
    """What a plane asks for and has, its directions counted from cylinder 1's crank pin."""
    turned = complex(unit(-float(engine.first_axis_deg)))
    return PlaneNeed(need.z, *(turned * vector for vector in need[1:]))


def _find_counterweights(engine: Engine) -> tuple[Array, Complex]:
    """Places (m) and unbalances at crank angle 0 (kg m) of the file's counterweights."""
    own = [device for device in engine.devices if device.kind is DeviceKind.COUNTERWEIGHT]
    places = np.array([float(device.z) for device in own])
    return places, np.array([complex(device.forward) for device in own], complex)


def _share_out(engine: Engine, loads: list[PinUnbalance]) -> list[list[PinUnbalance]]:
    """The pins that ask for a weight together: each by itself, or, where the file has
    counterweights, all pins of a plane, for nobody knows to which of them a weight there belongs.
    """
    if not _find_counterweights(engine)[1].any():
        return [[load] for load in loads]
    planes: dict[float, list[PinUnbalance]] = {}
    for load in loads:
        planes.setdefault(load.z, []).append(load)
    return list(planes.values())


def _list_loads(engine: Engine, factor: float) -> list[PinUnbalance]:
    """What each crank pin asks for; pins that carry nothing are left out."""
    loads = []
    for rows in engine.rows_by_pin:
        weighed = [engine.weighed[row] for row in rows]
        masses = np.array([float(w.rotating + w.share + factor * w.reciprocating) for w in weighed])
        total = float(masses.sum())
        if total == 0:
            continue
        pin = complex(unit(engine.first_axis_deg + engine.cylinders.pin_deg[rows[0]]))
        cylinders = tuple(engine.numbers[row] for row in rows)
        unbalance = total * float(engine.cylinders.radius) * pin
        loads.append(
            PinUnbalance(cylinders, unbalance, _find_centre(masses, engine.cylinders.z[rows]))
        )
    return loads


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
    return find_peak(
        Phasors.from_scalar(curve.orders, coefficients, curve.noise).drop_noise()
    ).value
