"""The scheme `factor` of balancing shops: counterweights opposite each crank pin balance all
rotating mass and a share (the factor) of the reciprocating mass of its rods. Counterweights that
the engine file already has are subtracted.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from contextlib import suppress
from functools import partial
from itertools import compress
from typing import NamedTuple

import numpy as np

from ..core.cylinders import Device
from ..core.loads import share_by_lever
from ..core.peaks import find_least, find_peak, find_peaks
from ..core.phasors import EPS, Array, Complex, Phasors, unit
from ..core.records import Node
from ..engine.engine import CylinderNumber, Engine
from ..errors import MOMENTS_UNKNOWN, ArgumentError, BalcliError, Message, warn
from ..forces.crankshaft import compute_bearing_forces, compute_loads, place_bearings
from ..forces.spectrum import compute_spectra, find_relevant_orders
from ..limits import LARGEST_FACTOR
from .bobweights import DEFINITION, NO_THROW, Bobweight, FactorPeaks, PlaneNeed, fill_card
from .fitting import LEFT, Fitting, Slot
from .options import SchemeOptions
from .planes import SAME_PLACE, find_unbalance, move_along, read_planes
from .remedy import Remedy, fit_devices, remove_weights_beside_webs

_NEARLY = 0.05  # masses nearly cancel if their vector sum is below this share of the largest mass
_FLAT = 1e-9  # factors are equally good if their peaks differ by this share of the largest or less
_ROUNDS = (
    40  # largest number of search steps; they narrow the range of factors to 4e-9 of its width
)
_REACHED = 1e-12  # the search ends if the peak exceeds its bound by a smaller share
_MEASURED = "Opposite the pin: the counterweights that the measured mass implies"
_BESIDE_WEBS = "At the pin: what the measured mass implies beyond the webs of the file"
_UNCHANGED = 1e-9  # a bobweight that changes by a smaller share counts as unchanged
# Figures of files have 12 digits: a smaller share of the unbalances is not missing.
_WRITTEN = 1e-10


class _Pin(NamedTuple):
    """Load of one crank pin.

    Attributes:
        cylinders: Numbers of its cylinders.
        unbalance: Unbalance to be balanced (throw included) at crank angle 0, kg m.
        z: Position along the crank of the centre of the masses on the pin, m.
    """

    cylinders: tuple[CylinderNumber, ...]
    unbalance: complex
    z: float


class _Planes(NamedTuple):
    """Planes of counterweights.

    Attributes:
        z: Positions of the planes, m, shape (planes,).
        needs: Unbalance that each plane needs, has and lacks at crank angle 0, kg m, shape (3,
            planes).
        sets: Pins that each plane balances; empty if planes are given.
    """

    z: Array
    needs: Complex
    sets: list[list[_Pin]]


def size_by_factor(engine: Engine, options: SchemeOptions) -> Remedy:
    """Fit counterweights by the given factor (default 0.5), or by the mass measured on a pin.

    Counterweights of the file are subtracted, and the missing unbalance is fitted in the given
    planes. The lever rule divides the unbalance of each pin and of each counterweight of the file
    between these planes. By default, the planes are those of the file's counterweights if these are
    in at least two planes, else those of the pins. Pins at the same z share a plane if the file has
    a counterweight, since it is not known to which of these pins the weight belongs; otherwise each
    pin has its own plane.

    If several factors are given, the peaks for each factor are listed, and the factor with the
    smallest peak force is fitted. If the pins balance each other (`FactorPeaks.by_moment`), the
    factor with the smallest peak moment is fitted instead. The details list the best factors
    between the smallest and the largest given factor; for a single given factor, between 0 and 1.

    Raises:
        BalcliError: A factor is out of range, planes are given but moments are not known, or the
            engine is rotary.
    """
    if engine.placed:
        return _size_each(engine, options)
    if engine.rotary:
        raise BalcliError(
            "scheme factor is for pins that turn; a rotary engine's pin stands still; use auto"
        )
    if options.measured is not None and options.factor is not None:
        return _change_measured(engine, options)
    planes = _choose_planes(engine, options)
    factors = choose_factors(engine, options)
    sweep = tuple(find_factor_peaks(engine, factor, planes) for factor in factors)
    best = min(sweep, key=lambda peaks: peaks.cost).factor
    fitting, fitted = _fit_factor(engine, best, planes)
    fitting = fitting.add_details(**describe_factor(engine, options, best))
    several = len(sweep) > 1
    span = (min(factors), max(factors)) if several else (0.0, 1.0)
    if bests := _find_best_factors(engine, planes, *span):
        fitting = fitting.add_details(best=bests)
    own = bool(_find_counterweights(engine)[1].any())
    note = _note(fitting, best, fitted.z, own)
    if not note and options.planes is None and planes is not None:
        whose = "the file's counterweights" if engine.webs is None else "the webs"
        note = Message(
            "the weights are in the planes of {whose}; {planes} throws computes weights for every "
            "throw instead",
            whose=whose,
        )
    return fitting.remedy._replace(
        note=note,
        card=fill_card(engine, best),
        needs=_list_needs(engine, fitted) if own else (),
        sweep=sweep if several else (),
    )


def _list_needs(engine: Engine, planes: _Planes) -> tuple[PlaneNeed, ...]:
    """Return the unbalance of each plane as a record, with angles from cylinder 1's pin."""
    from_pin = complex(unit(-float(engine.first_axis_deg))) * planes.needs
    needs = []
    for z, (wanted, present, missing) in zip(planes.z.tolist(), from_pin.T.tolist(), strict=True):
        needs.append(
            PlaneNeed(position_mm=1e3 * z, wanted=wanted, present=present, missing=missing)
        )
    return tuple(needs)


def find_best_peaks(engine: Engine, options: SchemeOptions, remedy: Remedy) -> FactorPeaks:
    """Return the peaks at the best factor in the range of a sweep.

    Args:
        engine: Engine.
        options: Options of the scheme.
        remedy: Remedy for several factors.
    """
    planes = _choose_planes(engine, options)
    peaks = list(remedy.sweep)
    for best in remedy.details.get("best", {}).values():
        peaks.append(find_factor_peaks(engine, best["factor"], planes))
    return min(peaks, key=lambda peaks: peaks.cost)


class _Top(NamedTuple):
    """Largest value of a load over a revolution, and what it is made of: at this place and crank
    angle, the load is `lowest + share * change`.
    """

    value: float
    lowest: complex
    change: complex


class _LinearLoad(NamedTuple):
    """A load that is linear in the factor: at the lowest factor, and its change up to the highest
    one. Both may have a trailing axis of places.
    """

    lowest: Phasors
    change: Phasors

    def find_top(self, share: float) -> _Top:
        """Return the largest value over a revolution at a share of the range of factors."""
        load = (self.lowest + share * self.change).drop_noise()
        if load.vectors.ndim == 2:
            peak = find_peak(load)
            parts = (self.lowest, self.change)
        else:
            peaks = find_peaks(load)
            place = max(range(len(peaks)), key=lambda k: peaks[k].value)
            peak = peaks[place]
            parts = (self.lowest.select_place(place), self.change.select_place(place))
        return _Top(peak.value, *(complex(part.values(peak.theta)) for part in parts))

    def find_best_share(self) -> float:
        """Return the share of the range of factors at which the peak is smallest.

        At any share, the peak is at least the size of the load at the place and angle of each top
        found so far. The share at which the largest of these sizes is smallest is tried next, until
        the peak is no larger than this bound.
        """
        share = 0.5
        tops = []
        for _ in range(_ROUNDS):
            tops.append(self.find_top(share))
            lowest = np.array([top.lowest for top in tops])
            change = np.array([top.change for top in tops])
            judge = partial(_find_largest_size, lowest, change)
            better = find_least(judge, 0.0, 1.0, _ROUNDS)
            if tops[-1].value <= judge(better) * (1 + _REACHED):
                break
            share = better
        return share


def _find_largest_size(lowest: Complex, change: Complex, share: float) -> float:
    return float(np.abs(lowest + share * change).max())


def _find_best_factors(
    engine: Engine, planes: tuple[float, ...] | None, low: float, high: float
) -> dict[str, dict[str, float]]:
    """Return the factors between two bounds with the smallest peak force (or moment, if the pins
    balance each other) and with the smallest main bearing load. A load that no factor changes is
    omitted.

    At each crank angle, a load is linear in the factor; so its peak is a convex function of the
    factor, and has one smallest value.
    """
    first = _list_curves(engine, low, planes)
    last = _list_curves(engine, high, planes)
    best: dict[str, dict[str, float]] = {}
    for key, curve in first.items():
        load = _LinearLoad(curve, last[key] - curve)
        share = load.find_best_share()
        factors = [chosen["factor"] for chosen in best.values()]
        factors.append(round(low + share * (high - low), 6))
        peaks = [load.find_top((factor - low) / (high - low)).value for factor in factors]
        least = min(peaks)
        most = max(load.find_top(share).value for share in (0.0, 1.0))
        if most - least > _FLAT * most:
            flat = (peak - least <= _FLAT * most for peak in peaks)
            name = key.removeprefix("peak_").rpartition("_")[0]
            best[name] = {"factor": next(compress(factors, flat)), key: least}
    return best


def _list_curves(
    engine: Engine, factor: float, planes: tuple[float, ...] | None
) -> dict[str, Phasors]:
    """Return the free force or moment for a factor, and the main bearing loads if known, by the
    names of their peaks.
    """
    new = fit_devices(*_fit_factor(engine, factor, planes)[0])
    if _counts_by_moment(engine):
        curves = {"peak_moment_Nm": find_curve(new, "moment")}
    else:
        curves = {"peak_force_N": find_curve(new, "force")}
    bearings = place_bearings(new) if new.places_known else None
    if bearings is not None:
        with suppress(BalcliError):  # too many loads
            loads, z = compute_loads(new, find_relevant_orders(new))
            curves["main_bearing_N"] = compute_bearing_forces(loads, z, bearings)
    return curves


def _note(fitting: Fitting, factor: float, z: Array, own: bool) -> str:
    """Return a note on a moment that remains, or on why nothing is fitted; else an empty text.
    `own`: whether the file has counterweights.
    """
    engine = fitting.engine
    if len(set(z)) == 1 and engine.places_known:  # a single plane cannot take a moment
        pins = _list_pins(engine, factor)
        places, weights = _find_counterweights(engine)
        rod_places, rods = _find_coupling_rods(engine)
        arms = np.array([*(pin.z for pin in pins), *places, *rod_places]) - z[0]
        vectors = np.array([*(pin.unbalance for pin in pins), *weights, *rods])
        if abs(arms @ vectors) > LEFT * (np.abs(arms) @ np.abs(vectors)):
            return SAME_PLACE
    if fitting.remedy.devices:
        return ""
    if own:
        return "nothing is missing: the counterweights of the file balance this factor"
    return "nothing is missing: the masses on the pins balance each other in these planes"


def find_factor_peaks(
    engine: Engine, factor: float, planes: tuple[float, ...] | None = None
) -> FactorPeaks:
    """Return the largest free force and moment of an engine balanced by a factor, at steady speed.

    Args:
        engine: Engine.
        factor: Share of the reciprocating mass.
        planes: Planes of the counterweights (z, m); None: those of the pins.
    """
    fitting, _ = _fit_factor(engine, factor, planes)
    new = fit_devices(fitting.engine, fitting.remedy)
    force = find_curve(new, "force")
    moment = find_curve(new, "moment")
    along = complex(unit(float(engine.cylinders.axis_deg[0])))
    weights = map(find_unbalance, fitting.remedy.counterweights)
    return FactorPeaks(
        factor=factor,
        peak_force_N=find_peak(force).value,
        along_N=_find_largest_component(force, along),
        across_N=_find_largest_component(force, 1j * along),
        peak_moment_Nm=find_peak(moment).value,
        bobweight_g=fill_card(engine, factor)[0].bobweight_g,
        counterweight_kg_m=max(weights, default=0.0),
        by_moment=_counts_by_moment(engine),
    )


def _counts_by_moment(engine: Engine) -> bool:
    """Return whether the reciprocating masses, placed at the crank pins, nearly cancel.
    Counterweights for a share of them then change only the moment. False if moments are not known.
    """
    masses = np.array([float(weighed.reciprocating) for weighed in engine.weighed])
    pins = unit(np.array([float(pin) for pin in engine.cylinders.pin_deg]))
    return engine.places_known and bool(abs(masses @ pins) < _NEARLY * masses.max())


def find_curve(engine: Engine, quantity: str) -> Phasors:
    """Return the free force or moment with all its orders."""
    return compute_spectra(engine, find_relevant_orders(engine), (quantity,))[quantity]


def _find_largest_component(curve: Phasors, direction: complex) -> float:
    """Return the largest component of a force along a direction (a unit vector), N."""
    coefficients = curve.forward * direction.conjugate() + np.conj(curve.backward) * direction
    component = Phasors.from_scalar(curve.orders, coefficients, curve.noise)
    return find_peak(component.drop_noise()).value


# ------------------------------------------------------------------ which factor, which planes
def choose_factors(engine: Engine, options: SchemeOptions) -> tuple[float, ...]:
    """Return the given factors, or the factor of the measured mass."""
    if options.measured is not None:
        return (find_measured_factor(engine, options.measured),)
    factors = options.factor or (0.5,)
    for factor in factors:
        if not (math.isfinite(factor) and abs(factor) <= LARGEST_FACTOR):
            meant = f"did you mean {factor:g}%? " if LARGEST_FACTOR < factor <= 100 else ""
            raise ArgumentError(
                "{factor} {value:g}: {meant}give shares such as 0.5, 51% or 50%:54%:1%",
                value=factor,
                meant=meant,
            )
    return factors


def find_measured_factor(engine: Engine, measured: float) -> float:
    """Return the factor of a crankshaft that is in balance with this mass (kg) on each bare pin, at
    the crank radius: mass = rotating + factor x reciprocating mass.

    Raises:
        BalcliError: The engine has no reciprocating mass, or no crankshaft can have such a mass.
    """
    if measured < 0:
        raise ArgumentError(
            "{measured} {grams:g} g: a mass on the pin cannot be negative", grams=1e3 * measured
        )
    card = fill_card(engine, 0.0)
    reciprocating = sum(pin.reciprocating_g for pin in card)
    rotating = sum(pin.rotating_g for pin in card)
    if not reciprocating:
        raise ArgumentError("{measured}: this engine has no reciprocating mass and so no factor")
    factor = (1e3 * measured * len(card) - rotating) / reciprocating
    turning = rotating / len(card)
    if not abs(factor) <= LARGEST_FACTOR:
        raise ArgumentError(
            "{measured} {grams:g} g would balance {share:.3g} times the reciprocating mass "
            "({turning:.5g} g on a pin rotate); is the unit right?",
            grams=1e3 * measured,
            share=factor,
            turning=turning,
        )
    if factor < 0:
        warn(
            f"a measured mass of {1e3 * measured:g} g is less than the {turning:.5g} g that rotate "
            f"on a pin: the factor is {factor:.2%}"
        )
    return factor


def _change_measured(engine: Engine, options: SchemeOptions) -> Remedy:
    """Fit the difference between the counterweights that a measured mass implies and those of a
    wanted factor: weights to add opposite the pin, or to remove from that side.

    Raises:
        BalcliError: Several factors are given.
    """
    if len(options.factor or ()) > 1:
        raise ArgumentError("{factor}: give one factor with {measured}, such as 55%")
    measured = options.measured or 0.0
    has = find_measured_factor(engine, measured)
    wanted = options._replace(measured=None)
    card = fill_card(engine, choose_factors(engine, wanted)[0])
    masses = np.array([float(w.rotating + w.reciprocating) for w in engine.weighed])
    slots = []
    unbalances = []
    changes = []
    for rows, bobweight in zip(engine.rows_by_pin, card, strict=True):
        pin, z = _locate_pin(engine, rows, masses[rows])
        slots.append(Slot("counterweight", 1, 1, z))
        turning = measured + sum(float(engine.weighed[row].share) for row in rows)
        unbalances.append(-turning * pin - _sum_webs(engine, rows[0]))
        changes.append(_describe_change(bobweight, measured, abs(pin)))
    bare = remove_weights_beside_webs(engine)
    implied = _MEASURED if engine.webs is None else _BESIDE_WEBS
    start = Fitting.start(bare, "factor").add(slots, unbalances, implied).remedy
    base = fit_devices(bare, start)
    remedy = size_by_factor(base, wanted)
    remedy = remedy.add_details(
        measured_g=1e3 * measured,
        measured_factor=has,
        wanted_factor=remedy.details["factor"],
        change=changes,
    )
    return remedy._replace(start=base)


def _sum_webs(engine: Engine, row: int) -> complex:
    """Return the unbalance of the webs of a cylinder's throw at crank angle 0, kg m; 0 if the file
    has none.
    """
    if engine.webs is None:
        return 0j
    return complex(engine.webs.find_unbalance(engine.weighed[row].throw))


def _describe_change(bobweight: Bobweight, measured: float, radius: float) -> Node:
    """Return the unbalance to add opposite a pin (negative: to remove), and what to do.

    Args:
        bobweight: Wanted bobweight of the pin.
        measured: Measured mass, kg.
        radius: Crank radius, m.
    """
    wanted = bobweight.bobweight_g / 1e3
    mass = wanted - measured
    if abs(mass) <= _UNCHANGED * abs(wanted):
        mass = 0.0
    action = "nothing"
    if mass:
        action = "add" if mass > 0 else "remove"
    return {"throw": bobweight.throw, "unbalance_kg_m": mass * radius, "action": action}


def _choose_planes(engine: Engine, options: SchemeOptions) -> tuple[float, ...] | None:
    """Return the given planes (z, m), ascending, each once. By default, return those of the file's
    counterweights if there are at least two, else None (the planes of the pins). A file with webs
    has those of its webs.
    """
    if options.planes is None:
        places = _find_counterweights(engine)[0]
        if engine.webs is not None:
            places = np.array([float(web.z) for web in engine.webs.webs])
        places = np.round(places, 12)  # without rounding errors
        own = np.unique(places)
        return tuple(own.tolist()) if len(own) > 1 and engine.places_known else None
    if not engine.places_known:
        raise ArgumentError("{planes}: {unknown}", unknown=MOMENTS_UNKNOWN)
    return tuple(sorted(set(read_planes(engine, options))))


def describe_factor(engine: Engine, options: SchemeOptions, factor: float) -> Node:
    """Return the factor as a share of all reciprocating mass on the pin and as a share of one
    cylinder's reciprocating mass, and the measured mass if given.
    """
    details: Node = {
        "factor": factor,
        "factor_of_one_cylinder": factor * len(engine.rows_by_pin[0]),
        "definition": DEFINITION,
    }
    if not any(float(weighed.share) for weighed in engine.weighed):
        details["throw"] = NO_THROW
    if options.measured is not None:
        details = {"measured_g": 1e3 * options.measured, **details}
    return details


def name_one_cylinder(engine: Engine) -> str:
    """Return in words the reciprocating mass to which a factor refers: that of any cylinder if all
    are equal, else the mean of all.
    """
    masses = {round(float(weighed.reciprocating), 9) for weighed in engine.weighed}
    if len(masses) > 1:
        return "one cylinder's mean reciprocating mass"
    return "one cylinder's reciprocating mass"


# ------------------------------------------------------------------ what is wanted, what is there
def _fit_factor(
    engine: Engine, factor: float, planes: tuple[float, ...] | None
) -> tuple[Fitting, _Planes]:
    """Fit the missing weight in each plane."""
    fitting = Fitting.start(engine, "factor", 1)
    taken = f"weight for all rotating mass and {factor:.6g} of the reciprocating mass"
    less = ""
    if _find_counterweights(engine)[1].any():
        less = "; less the counterweights of the file"
    fitted = _find_needs(engine, factor, planes)
    slots = [Slot("counterweight", 1, 1, z) for z in fitted.z.tolist()]
    missing = fitted.needs[2].tolist()
    if planes is not None:
        reason = f"In these planes, divided by the lever rule: {taken} of every pin{less}"
        return fitting.add(slots, missing, reason), fitted
    for slot, unbalance, pins in zip(slots, missing, fitted.sets, strict=True):
        numbers = [str(number) for pin in pins for number in pin.cylinders]
        cylinders = "cylinders" if len(numbers) > 1 else "cylinder"
        where = "Opposite the pin" if len(pins) == 1 else "In the plane"
        reason = f"{where} of {cylinders} {', '.join(numbers)}: {taken}{less}"
        fitting = fitting.add([slot], [unbalance], reason)
    return fitting, fitted


def _find_needs(engine: Engine, factor: float, planes: tuple[float, ...] | None) -> _Planes:
    """Return the unbalance that each plane needs, has and lacks. Coupling rods of a locomotive need
    weights, as the pins do. Without given planes, each pin has its own plane; but if the file has
    counterweights or coupling rods, pins at the same position share a plane, because it is not
    known to which of these pins a weight belongs.
    """
    pins = _list_pins(engine, factor)
    places, weights = _find_counterweights(engine)
    rod_places, rods = _find_coupling_rods(engine)
    sets: list[list[_Pin]] = []
    if planes is None:
        shared = weights.any() or rods.any()
        sets = _join_at_same_place(pins) if shared else [[pin] for pin in pins]
        z = np.array([members[0].z for members in sets], float)
    else:
        z = np.array(planes, float)
    if not pins:
        return _Planes(z[:0], np.zeros((3, 0), complex), [])
    if planes is None:
        of_pins = np.zeros((len(z), len(pins)))
        for plane, members in enumerate(sets):
            for k, pin in enumerate(pins):
                of_pins[plane, k] = pin in members
    else:
        of_pins = share_by_lever(np.array([pin.z for pin in pins]), z)
    of_weights = _share_in_any_order(places, weights, z)
    of_rods = _share_in_any_order(rod_places, rods, z)
    unbalances = np.array([pin.unbalance for pin in pins])
    wanted = -(of_pins @ unbalances) - of_rods @ rods
    present = of_weights @ weights
    parts = np.abs(of_pins) @ np.abs(unbalances) + np.abs(of_weights) @ np.abs(weights)
    parts += np.abs(of_rods) @ np.abs(rods)
    needs = np.stack([wanted, present, wanted - present])
    least = np.array([LEFT, LEFT, _WRITTEN])[:, None] * parts
    return _Planes(z, np.where(np.abs(needs) <= least, 0, needs), sets)


def _share_in_any_order(places: Array, unbalances: Complex, z: Array) -> Array:
    """Return the shares of unbalances that planes take by the lever rule, shape (planes,
    unbalances); 0 if no unbalance differs from 0.

    Args:
        places: Positions of the unbalances, m.
        unbalances: Unbalances, kg m.
        z: Positions of the planes in any order, m.
    """
    shares = np.zeros((len(z), len(places)))
    if unbalances.any():
        shares[np.argsort(z)] = share_by_lever(places, np.sort(z))
    return shares


def _join_at_same_place(pins: Iterable[_Pin]) -> list[list[_Pin]]:
    """Return lists of pins at the same z."""
    by_place: dict[float, list[_Pin]] = {}
    for pin in pins:
        by_place.setdefault(pin.z, []).append(pin)
    return list(by_place.values())


def _size_each(engine: Engine, options: SchemeOptions) -> Remedy:
    """Fit counterweights to geared engines, to each on its own crank as if it were alone."""
    if options.measured is not None or len(options.factor or ()) > 1:
        raise ArgumentError(
            "geared engines: give one {factor}, no {measured}, or balance each alone"
        )
    remedy = Remedy("factor", 1)
    cards: list[Bobweight] = []
    needs: list[PlaneNeed] = []
    for crank in map(move_along, engine.cranks):
        own = size_by_factor(crank.engine, options)
        for weight, reason in zip(own.counterweights, own.reasons, strict=True):
            of_crank = weight.model_copy(update={"engine": crank.name})
            remedy = remedy.add_devices([of_crank], f"{crank.name}: {reason}")
        for pin in own.card:
            cylinders = tuple(f"{crank.name}.{number}" for number in pin.cylinders)
            cards.append(pin._replace(cylinders=cylinders))
        needs += own.needs
    details = {key: own.details[key] for key in ("factor", "definition")}
    return remedy._replace(details=details, card=tuple(cards), needs=tuple(needs))


def _find_counterweights(engine: Engine) -> tuple[Array, Complex]:
    """Return positions (z, m) of the file's counterweights and their unbalances at crank angle 0
    (kg m).
    """
    return _place_devices(device for device in engine.devices if device.is_counterweight)


def _find_coupling_rods(engine: Engine) -> tuple[Array, Complex]:
    """Return positions (z, m) of a locomotive's coupling rods and their unbalances at crank angle 0
    (kg m).
    """
    return _place_devices(device for device in engine.devices if device.is_coupling)


def _place_devices(devices: Iterable[Device]) -> tuple[Array, Complex]:
    """Return positions (z, m) of devices on the crank and their unbalances at crank angle 0
    (kg m).
    """
    chosen = list(devices)
    places = np.array([float(device.z) for device in chosen])
    return places, np.array([complex(device.forward) for device in chosen], complex)


def _list_pins(engine: Engine, factor: float) -> list[_Pin]:
    """Return the load of each crank pin; pins without load are omitted."""
    weighed = engine.weighed
    pins = []
    masses = np.array([float(w.rotating + w.share + factor * w.reciprocating) for w in weighed])
    for rows in engine.rows_by_pin:
        if total := float(masses[rows].sum()):
            pin, z = _locate_pin(engine, rows, masses[rows])
            cylinders = tuple(engine.numbers[row] for row in rows)
            pins.append(_Pin(cylinders, total * pin, z))
    return pins


def _locate_pin(engine: Engine, rows: list[int], masses: Array) -> tuple[complex, float]:
    """Return the place of a crank pin at crank angle 0 (x + iy from the crank axis, m), and the
    centre of the masses on it along z, m. The centre is rounded to 1e-12 m if this changes it by no
    more than rounding errors.

    Args:
        engine: Engine.
        rows: Rows of the cylinders on the pin.
        masses: Mass on the pin for each of these cylinders, kg.
    """
    c = engine.cylinders
    places = engine.cylinders.z[rows]
    pin = float(c.radius_of_each[rows[0]]) * unit(engine.first_axis_deg + c.pin_deg[rows[0]])
    z = float(masses @ places) / float(masses.sum())
    rounded = round(z, 12) + 0.0
    rounding = len(places) * EPS * float(np.abs(places).max())
    return complex(pin), rounded if abs(z - rounded) <= rounding else z
