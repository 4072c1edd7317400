"""Compute the torque in journals and crank pins (`analyze --only journals`), the masses of the
cylinders (`--only masses`), and the free moments divided by the power (`--only pru`).

The crankshaft is rigid, turns at the steady mean speed and delivers its torque at the flywheel end.
If T_i is the torque of the cylinders on throw i (1 to n), main journal j (1 to n + 1) carries the
torque of all throws before it, `M_j = sum T_i, i < j`. The pin of throw i carries `M_i + T_i/2`:
the bearing before the throw takes half of the tangential force, and the lever arm of this bearing
load about the pin is the crank radius. Under the torque T, a journal with the outer diameter D and
the bore d has the nominal shear stress `16 T D/(pi (D^4 - d^4))`.

Let l be the length of a rod, m its mass, and a and b the distances of its centre of mass from the
piston pin and the crank pin. The rod is represented by two masses: m b/l at the small end and m a/l
at the big end. About the centre of mass, the two masses have the moment of inertia m a b, and the
rod has the moment of inertia J; the couple constant is the difference H = m a b - J. A rod that
swings about the piston pin has the reduced length (J + m a^2)/(m a), which is l if H = 0.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

import numpy as np

from ..core.cylinder_pressure import crank_torque
from ..core.peaks import CyclePeak, find_swing
from ..core.phasors import Array, Complex
from ..core.piecewise import Extreme, PiecewiseCurve, resolved
from ..engine.build import build
from ..engine.engine import Engine, refuse_geared
from ..engine.gas import EngineGas
from ..engine.load import FiguresOfVariants
from ..engine.rods import CylinderMasses
from ..errors import BalcliError
from ..file.model import EngineFile
from ..forces.crankshaft import find_shear_stress, place_bearings
from ..forces.power import at_rated_speed, find_power, name_need
from ..forces.quantity import TargetQuantity, refuse_stranger
from ..forces.spectrum import compute_spectra, find_relevant_orders
from ..show.engine_facts import name_cylinders
from ..show.sheet import (
    UNKNOWN,
    Column,
    Grid,
    degrees,
    number,
    order_name,
    size_cell,
    size_text,
    unit_cell,
)
from ..show.units import ShownUnit, System
from ..sizing.bobweights import PIN_ALONE
from .parts import list_columns
from .records import (
    Journal,
    JournalTorque,
    Masses,
    PowerRelatedUnbalance,
    RelatedMoment,
    ShearStress,
)

_NONE = JournalTorque(max_Nm=0.0, min_Nm=0.0, range_Nm=0.0, mean_Nm=0.0)
_SPLIT = (
    "Split pins of one throw count as one pin: the torque in the web between them is not computed."
)
_ROUNDING = 1e-12  # a smaller share of the sum of all cylinders' amplitudes is rounding


def find_journals(engine: Engine) -> tuple[Journal, ...]:
    """Return the torque in every main journal and crank pin, from the free end.

    Args:
        engine: One engine, not an array of variants.

    Raises:
        BalcliError: The engine is rotary: its crank is at rest.
    """
    kinds = {"pin": engine.joined_throws_m, "main": place_bearings(engine)}
    torques = CrankTorques.of(engine)
    journals = []
    for (kind, place), weights in weigh_cylinders(engine).items():
        inertia = torques.measure(weights)
        total = torques.measure_total(weights)
        at = kinds[kind] if engine.places_known else None
        journals.append(
            Journal(
                place=f"{kind} {place}",
                position_mm=None if at is None else 1e3 * float(at[place - 1]),
                inertia=inertia,
                total=total,
                stress=_find_stress(engine, total or inertia, kind),
            )
        )
    return tuple(journals)


def weigh_cylinders(engine: Engine) -> dict[tuple[str, int], Array]:
    """Return which share of each cylinder's torque every main journal and crank pin carries, shape
    (cylinders,). The keys run from the free end: ("main", 1), ("pin", 1), ("main", 2), ... Errors
    are those of `find_journals`.

    The bearings that hold a crank pin on both sides share its load equally. Main bearings that the
    file places may have several throws, or none, between them.
    """
    if engine.rotary:
        raise BalcliError("journals: the crank of a rotary engine stands still")
    throws = np.array(engine.joined_throw_of_rows) + 1
    shares = dict[tuple[str, int], Array]()
    pin = 1
    for main, before in enumerate(_count_throws_before_bearings(engine), 1):
        while pin <= before:
            shares["pin", pin] = np.where(throws < pin, 1.0, 0.5 * (throws == pin))
            pin += 1
        shares["main", main] = np.where(throws <= before, 1.0, 0.0)
    for last in range(pin, int(throws.max()) + 1):
        shares["pin", last] = np.where(throws < last, 1.0, 0.5 * (throws == last))
    return shares


def _count_throws_before_bearings(engine: Engine) -> list[int]:
    """Return the number of throws between the free end and each main bearing. Without positions,
    there is a bearing on both sides of every throw.
    """
    places = engine.joined_throws_m
    if engine.bearings is None or engine.bearings.main_positions_m is None:
        return list(range(len(places) + 1))
    return [int((places < bearing).sum()) for bearing in engine.bearings.main_positions_m]


class CrankTorques(NamedTuple):
    """Torque of each cylinder on the crank.

    Attributes:
        orders: Orders of the inertia torque, shape (orders,).
        each: Phasors of each cylinder's inertia torque, N m, shape (orders, cylinders).
        gas: Gas of the cylinders; None: the engine has no gas.
    """

    orders: Array
    each: Complex
    gas: EngineGas | None

    @classmethod
    def of(cls, engine: Engine) -> CrankTorques:
        """Return the torques of an engine at steady speed."""
        steady = replace(engine, ripple=())
        orders = find_relevant_orders(steady)
        orders = orders[orders > 0]
        each = compute_spectra(steady, orders, ("torque",), by_cylinder=True)["torque"].x
        return cls(orders, each, engine.gas)

    def measure(self, weights: Array) -> JournalTorque:
        """Return the extremes of the inertia torque; `weights`: as for `sample`."""
        series = self.each @ weights
        if np.abs(series).sum() <= _ROUNDING * np.abs(self.each).sum():
            return _NONE
        return _write(*find_swing(self.orders, series))

    def measure_total(self, weights: Array) -> JournalTorque | None:
        """Return the extremes of gas plus inertia torque, as `measure` does; None without gas."""
        if self.gas is None:
            return None
        if (gas := self._find_gas(weights)) is None:
            return _NONE
        curve = resolved(lambda angle: gas.at(angle) + self._sum(angle, weights), gas.breaks)
        low, high = curve.extremes()
        return _write(high, low, curve.mean)

    def sample(self, angle: Array, weights: Array) -> Array:
        """Return the sum of the cylinders' torques, N m, at an array of crank angles, rad. Each
        torque is multiplied by its entry of `weights`, shape (cylinders,).
        """
        gas = self._find_gas(weights)
        inertia = self._sum(angle, weights)
        return inertia if gas is None else inertia + gas.at(angle)

    def _sum(self, angle: Array, weights: Array) -> Array:
        """Return the inertia torque of the weighted cylinders; arguments as for `sample`."""
        turned = np.exp(1j * np.multiply.outer(angle, self.orders))
        return np.asarray((turned @ (self.each @ weights)).real)

    def _find_gas(self, weights: Array) -> PiecewiseCurve | None:
        """Return the gas torque of the weighted cylinders over the cycle; None if no gas acts."""
        if self.gas is None or not weights.any():
            return None
        pairs = zip(self.gas.cylinders, weights.tolist(), strict=True)
        shares = [(c.torque, c.fires, c.share * weight) for c, weight in pairs if weight]
        return crank_torque(shares, self.gas.cycle)


def _write(high: CyclePeak | Extreme, low: CyclePeak | Extreme, mean: float = 0.0) -> JournalTorque:
    highest = float(high.value)
    lowest = float(low.value)
    return JournalTorque(
        max_Nm=highest,
        min_Nm=lowest,
        range_Nm=highest - lowest,
        mean_Nm=mean,
        max_deg=math.degrees(float(high.angle)),
        min_deg=math.degrees(float(low.angle)),
    )


def _find_stress(engine: Engine, torque: JournalTorque, kind: str) -> ShearStress | None:
    """Return the stress of a journal of this kind (pin or main); None if its diameter is not
    given.
    """
    bearings = engine.bearings
    if bearings is None:
        return None
    diameters = bearings.pin_m if kind == "pin" else bearings.main_m
    if diameters is None:
        return None
    per_torque = find_shear_stress(*diameters)
    return ShearStress(
        mean_Pa=per_torque * (torque.max_Nm + torque.min_Nm) / 2,
        amplitude_Pa=per_torque * torque.range_Nm / 2,
    )


# ------------------------------------------------------------------ quantities of variants
_KINDS = {"journal": "main", "pin": "pin"}


def list_names(model: EngineFile) -> Iterator[str]:
    """Yield the names of the quantities of main journals and crank pins."""
    if not (model.engine or build(model).rotary):
        for kind in ("journal", "pin"):
            for part in ("range", "max", "min"):
                yield f"{kind}.N.{part}"


def refuse_unknown(model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
    """Raise BalcliError if a quantity names a journal or pin that the crankshaft lacks."""
    refuse_geared(model)
    places = weigh_cylinders(build(model))
    for q in quantities:
        refuse_stranger(q, [str(place) for kind, place in places if kind == _KINDS[q.kind]])


def evaluate_engine(engine: Engine, quantities: Sequence[TargetQuantity]) -> list[float]:
    """Return the value of each quantity of one engine, N m."""
    crank = CrankTorques.of(engine)
    weights = weigh_cylinders(engine)
    torques: dict[tuple[str, int], JournalTorque] = {}
    values = []
    for quantity in quantities:
        place = (_KINDS[quantity.kind], int(quantity.target))
        if place not in torques:
            own = weights[place]
            torques[place] = crank.measure_total(own) or crank.measure(own)
        values.append(float(getattr(torques[place], f"{quantity.part}_Nm")))
    return values


Variants = partial(FiguresOfVariants, evaluate_engine)


# ------------------------------------------------------------------ how it is shown
def lay_out_journals(journals: Sequence[Journal], engine: Engine, system: System) -> Iterator[Grid]:
    """Yield a table of the torques in journals and pins; with gas, also one of inertia only.

    Args:
        journals: Journals, from the free end.
        engine: Their engine.
        system: System of units.
    """
    with_gas = journals[0].total is not None
    title = "Torque along the crankshaft"
    if with_gas:
        totals = [journal.total or _NONE for journal in journals]
        yield _grid(journals, totals, title, system, True)
        title = "Torque along the crankshaft, inertia alone"
    of_inertia = [journal.inertia for journal in journals]
    last = _grid(journals, of_inertia, title, system, not with_gas)
    if len(engine.rows_by_pin) > len(engine.joined_throws):
        last = last._replace(note=f"{last.note} {_SPLIT}".strip())
    yield last


def _grid(
    journals: Sequence[Journal],
    torques: Sequence[JournalTorque],
    title: str,
    system: System,
    with_stress: bool,
) -> Grid:
    unit = system.moment.fit_values(torque.range_Nm for torque in torques)
    length = system.length
    heads = [
        Column("place", words=True),
        Column(f"z, {length.name}"),
        Column(f"largest, {unit.name}"),
        Column("deg"),
        Column("smallest"),
        Column("deg"),
        Column("range"),
        Column("mean"),
    ]
    rows = []
    for journal, torque in zip(journals, torques, strict=True):
        row = [
            journal.place,
            _write_place(journal, length),
            unit_cell(torque.max_Nm, unit),
            _write_angle(torque.max_deg),
            unit_cell(torque.min_Nm, unit),
            _write_angle(torque.min_deg),
            unit_cell(torque.range_Nm, unit),
            unit_cell(torque.mean_Nm, unit),
        ]
        rows.append(row)
    if with_stress and any(journal.stress for journal in journals):
        unit_of_stress = system.stress.fit(1e9)
        heads.append(Column(f"stress, ±{unit_of_stress.name}"))
        for row, journal in zip(rows, journals, strict=True):
            row.append(_write_stress(journal.stress, unit_of_stress))
    ranges = [torque.range_Nm for torque in torques]
    note = ""
    if any(ranges):
        widest = journals[ranges.index(max(ranges))]
        note = f"The range is largest in {widest.place}."
    return Grid.of_rows(title, heads, rows, note)


def _write_place(journal: Journal, unit: ShownUnit) -> str:
    if journal.position_mm is None:
        return UNKNOWN
    return number(unit.of(journal.position_mm / 1e3))


def _write_angle(angle_deg: float | None) -> str:
    if angle_deg is None:
        return ""
    return degrees(angle_deg, 1e9)


def _write_stress(stress: ShearStress | None, unit: ShownUnit) -> str:
    if stress is None:
        return UNKNOWN
    return unit_cell(stress.amplitude_Pa, unit)


# ------------------------------------------------------------------ masses
def list_masses(engine: Engine) -> tuple[Masses, ...]:
    """Return the masses of each set of cylinders with equal parts, sorted by the lowest cylinder
    number.

    Args:
        engine: One engine, not an array of variants.
    """
    c = engine.cylinders
    count = len(engine.numbers)
    radii = np.broadcast_to(np.ravel(c.radius), count).tolist()
    lengths = np.broadcast_to(np.ravel(c.rod_length), count).tolist()
    couples = np.broadcast_to(np.ravel(c.couple), count).tolist()
    alike: dict[tuple[Masses, float], list[int]] = {}
    for row in np.argsort(engine.numbers).tolist():
        masses = _find_masses(engine.weighed[row], lengths[row], couples[row])
        share = engine.find_throw_share(row)
        masses = masses._replace(throw_kg=share.mass, is_whole_throw=share.is_whole)
        alike.setdefault((masses, radii[row]), []).append(int(engine.numbers[row]))
    sets = []
    for (masses, _), numbers in alike.items():
        sets.append(masses._replace(cylinders=tuple(numbers)))
    return tuple(sets)


def _find_masses(weighed: CylinderMasses, length: float, couple: float) -> Masses:
    """Return the masses of a cylinder.

    Args:
        weighed: Masses of piston and rod.
        length: Length of the rod, m; infinite in harmonic motion.
        couple: Couple constant of the rod, kg m^2.
    """
    small = float(weighed.small_end)
    big = float(weighed.big_end)
    masses = Masses(
        cylinders=(),
        piston_kg=float(weighed.piston),
        crosshead_kg=float(weighed.crosshead),
        reciprocating_kg=float(weighed.reciprocating),
        rotating_kg=float(weighed.rotating),
        throw_kg=float(weighed.share),
    )
    mass = small + big
    if mass <= 0:
        return masses
    masses = masses._replace(rod_kg=mass, rod_small_end_kg=small, rod_big_end_kg=big)
    if not math.isfinite(length):
        return masses
    a = length * big / mass
    b = length * small / mass
    inertia = mass * a * b - couple
    return masses._replace(
        rod_inertia_kg_m2=inertia,
        radius_of_gyration_m=math.sqrt(max(inertia, 0.0) / mass),
        couple_constant_kg_m2=couple,
        reduced_length_m=(inertia + mass * a * a) / (mass * a) if a else None,
    )


_LABELS = {
    "piston_kg": "piston",
    "crosshead_kg": "crosshead",
    "rod_kg": "rod",
    "rod_small_end_kg": "rod at the small end",
    "rod_big_end_kg": "rod at the big end",
    "reciprocating_kg": "reciprocating",
    "rotating_kg": "rotating without the throw",
    "throw_kg": "share of the throw",
    "rod_inertia_kg_m2": "inertia of the rod",
    "radius_of_gyration_m": "radius of gyration",
    "couple_constant_kg_m2": "couple constant H",
    "reduced_length_m": "reduced length",
}


def lay_out_masses(masses: Sequence[Masses], system: System) -> Grid:
    """Return a table with a row for each figure and a column for each set of equal cylinders.

    Args:
        masses: Masses of each set of cylinders with equal parts.
        system: System of units.
    """
    labels = _LABELS.copy()
    if not any(alike.crosshead_kg for alike in masses):
        del labels["crosshead_kg"]
    heads = [Column(name_cylinders(alike.cylinders)) for alike in masses]
    figures = list_columns(masses, labels, {}, system)
    rows = [(figure.head, *figure.cells) for figure in figures]
    note = ""
    if not all(alike.is_whole_throw for alike in masses):
        note = PIN_ALONE
    return Grid.of_rows("Masses", [Column("", words=True), *heads], rows, note)


# ------------------------------------------------------------------ power related unbalance
def relate_to_power(engine: Engine) -> PowerRelatedUnbalance:
    """Return the largest free moments of orders 1 and 2 divided by the power, at the speed of the
    file.

    Args:
        engine: One engine, not an array of variants.

    Raises:
        BalcliError: No power is known.
    """
    power = find_power(engine)
    if power is None:
        if engine.gas is not None:
            raise BalcliError("pru: the gas of this machine takes power; give operation.power")
        raise BalcliError("pru needs operation.power, or [gas]")
    moments = compute_spectra(at_rated_speed(engine), [1, 2], ("moment",))["moment"].major.tolist()
    orders = []
    for order, moment in enumerate(moments, 1):
        size = moment if engine.places_known else math.nan
        related = power.relate(size)
        orders.append(RelatedMoment(order, size, related, name_need(related)))
    return PowerRelatedUnbalance(power.watts, power.kind, tuple(orders))


def lay_out_related(related: PowerRelatedUnbalance, system: System) -> Grid:
    """Return a table of the power related unbalance, with the need of a compensator.

    Args:
        related: Power related unbalance.
        system: System of units.
    """
    kind = "" if related.power_kind == "file" else f"{related.power_kind} "
    title = f"Power related unbalance ({kind}power {size_text(related.power_W, system.power)})"
    moments = related.orders
    unit = system.moment.fit_values(moment.moment_Nm for moment in moments)
    heads = [
        Column("order"),
        Column(f"M, {unit.name}"),
        Column("PRU, N·m/kW"),
        Column("compensator", words=True),
    ]
    rows = []
    for moment in moments:
        size = size_cell(moment.moment_Nm, unit)
        need = moment.need or UNKNOWN
        rows.append((order_name(moment.order), size, number(moment.Nm_per_kW), need))
    return Grid.of_rows(title, heads, rows, "Moments and power at the speed of the file.")
