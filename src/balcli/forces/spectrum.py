"""Engine -> free forces and moments by order, computing only what is asked for.

Which orders there are, and which of them an engine has worth computing or showing.

An order is how often something happens in a revolution of the crankshaft. Pistons, rods and devices
repeat themselves after each revolution, and have whole orders. What happens once in a cycle of four
strokes (gas pressure, and a crank speed that is uneven by it) has halves of whole numbers. All
orders are therefore multiples of 1/2, and exact as floating-point numbers.

Torque of the gas on the crank, by order, of an engine that has gas (`Engine.gas`).

Gas presses on piston and head alike: it makes no free force and no free moment, only torque and its
reaction on the frame. With t_h the coefficients of one cylinder's torque over its cycle, a cylinder
that fires at the crank angle f adds `t_h e^{i h (theta - f)/2}`: order n = h/2.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from operator import add, sub

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core import speed_ripple as ripple
from ..core.cylinders import Device
from ..core.loads import Loads, find_device_force, find_needed_series
from ..core.mechanisms.closed_form import select_cylinders, select_orders
from ..core.phases import ANGLE, SUM, Phases, SeparatePhases
from ..core.phasors import EPS, Array, Complex, Figure, Phasors, join_orders, unit
from ..engine.engine import Engine
from ..engine.figures import place_in_plane
from ..engine.gas import CylinderGas, EngineGas
from ..errors import NO_GAS, BalcliError, wrong_type
from ..file.fields import shorten
from ..limits import (
    HIGHEST_GAS_ORDER_UNASKED,
    HIGHEST_ORDER,
    HIGHEST_ORDER_UNASKED,
    MOST_LOADS_APART,
)
from .kinds import EVERY_KIND, GAS_KINDS, KINDS, Kind

# orders x cylinders that are computed together, which bounds the memory: about 16 complex arrays
_AT_ONCE = 1 << 18


@dataclass(frozen=True, eq=False)
class Spectra:
    """Phasors by order of each kind (`kinds.KINDS`) that was asked for; None: it was not.

    Attributes:
        orders: shape (orders,), ascending.
        force: N.
        moment, couple, torque, roll: N m; the torque is the inertia torque on the crank.
        gas, torque_total, roll_total: N m, of the gas, and with it.
    """

    orders: Array
    force: Phasors | None = None
    moment: Phasors | None = None
    couple: Phasors | None = None
    torque: Phasors | None = None
    roll: Phasors | None = None
    gas: Phasors | None = None
    torque_total: Phasors | None = None
    roll_total: Phasors | None = None

    def __getitem__(self, kind: str) -> Phasors:
        """Phasors of the kind with this name; KeyError if it was not asked for."""
        phasors: Phasors | None = getattr(self, EVERY_KIND[kind].name)
        if phasors is None:
            raise KeyError(kind)
        return phasors

    def items(self) -> list[tuple[Kind, Phasors]]:
        """Each kind that was asked for, with its phasors, as in the table of kinds."""
        found = [(kind, getattr(self, name)) for name, kind in EVERY_KIND.items()]
        return [(kind, phasors) for kind, phasors in found if phasors is not None]

    def vectors(self) -> list[tuple[Kind, Phasors]]:
        """Those of `items` that are vectors: force and moment."""
        return [(kind, phasors) for kind, phasors in self.items() if kind.vector]

    def scalars(self) -> list[tuple[Kind, Phasors]]:
        """Those of `items` that act about the crank's axis."""
        return [(kind, phasors) for kind, phasors in self.items() if not kind.vector]

    def only(self, kinds: Collection[str]) -> Spectra:
        """The same without all other kinds."""
        return Spectra(self.orders, **{k.name: p for k, p in self.items() if k.name in kinds})

    def with_moment_if(self, known: bool) -> Spectra:
        """The same, the moment as nan unless it is known, if it was asked for at all."""
        if known or self.moment is None:
            return self
        p = self.moment
        unknown = Phasors(p.orders, np.full_like(p.vectors, np.nan), p.noise)
        return replace(self, moment=unknown)

    def select_orders(self, orders: ArrayLike) -> Spectra:
        """The same without all other orders."""
        if orders is self.orders:
            return self
        wanted = np.asarray(orders, float)
        rows = np.searchsorted(self.orders, wanted)
        return Spectra(wanted, **{kind.name: p.select_rows(rows) for kind, p in self.items()})

    def select_place(self, place: int) -> Spectra:
        """Those of one place along the trailing axis."""
        return Spectra(
            self.orders, **{kind.name: p.select_place(place) for kind, p in self.items()}
        )


def compute_spectra(
    engine: Engine, orders: ArrayLike, kinds: Collection[str] = tuple(KINDS)
) -> Spectra:
    """Free forces and moments of an engine.

    Args:
        engine: the engine; trailing axes of its arrays become those of the phasors.
        orders: shape (orders,), ascending, not negative.
        kinds: names of KINDS, and of GAS_KINDS for an engine with gas.

    Raises:
        BalcliError: a kind of gas is asked of an engine without.
    """
    return _compute(engine, orders, kinds, apart=False)


def compute_each_cylinder(
    engine: Engine, orders: ArrayLike, kinds: Collection[str] = tuple(KINDS)
) -> Spectra:
    """What each cylinder does by itself, as if no other had a mass; the devices are left out.

    Args:
        engine: without trailing axes.
        orders, kinds: as in `compute_spectra`.

    Returns:
        Phasors of shape (orders, cylinders), the cylinders in the order of `engine.numbers`.

    Raises:
        BalcliError: more than MOST_LOADS_APART of them.
    """
    refuse_too_many_loads(engine, np.size(orders), engine.cylinders.count)
    return _compute(replace(engine, devices=()), orders, kinds, apart=True)


def refuse_too_many_loads(engine: Engine, orders: int, loads: int) -> None:
    """Nothing, unless so many orders of so many cylinders and counterweights, kept one by one,
    would fill the memory.

    Raises:
        BalcliError: they would.
    """
    most = MOST_LOADS_APART // 2 if engine.ripple else MOST_LOADS_APART
    if orders * loads > most:
        raise BalcliError(
            f"{orders} orders of {loads} cylinders and counterweights one by one are "
            f"{orders * loads} forces, and at most {most} are kept: an engine farther from its "
            "lock has fewer orders"
        )


def count_engine_samples(engine: Engine) -> int:
    """About how many samples of revolutions the mechanisms of an engine, or of variants, take."""
    c = engine.cylinders
    sampled = c.linkage is not None or np.count_nonzero(c.eps)
    return c.count_all_samples()[1] if sampled else 0


def compute_device_force(engine: Engine, device: Device, orders: Array) -> Phasors:
    """Force of one device of an engine without trailing axes, N, for these orders."""
    if not engine.ripple:
        return find_device_force(device, orders, engine.omega**2).drop_noise()
    w, dense = _mix_orders(engine, orders)
    steady = find_device_force(device, dense, engine.omega**2).drop_noise()
    return ripple.apply_to_force(steady, w).select_orders(orders).drop_noise()


def _compute(engine: Engine, orders: ArrayLike, kinds: Collection[str], *, apart: bool) -> Spectra:
    wanted = np.asarray(orders, float)
    parts = {part for name in kinds for part in EVERY_KIND[name].parts}
    inertia = parts - {"gas"}
    if engine.ripple:
        found = _compute_uneven(engine, wanted, inertia, apart)
    else:
        found, _ = _compute_steady(engine, wanted, inertia, apart)
    if "gas" in parts:
        found["gas"] = _compute_gas(engine, wanted, apart=apart)
    every = {name: add_parts(EVERY_KIND[name], found).drop_noise() for name in kinds}
    return Spectra(wanted, **every)


def _compute_gas(engine: Engine, orders: Array, *, apart: bool) -> Phasors:

    compute = compute_gas_torque_of_each if apart else compute_gas_torque
    return compute(engine, orders)


def add_parts(kind: Kind, parts: Mapping[str, Phasors]) -> Phasors:
    """Phasors of a kind by those of its parts (`Kind.parts`), which are given by name."""
    plus = reduce(add, (parts[name] for name in kind.plus or (kind.name,)))
    return reduce(sub, (parts[name] for name in kind.minus), plus)


def with_only(engine: Engine, moving: ArrayLike) -> Engine:
    """The engine with the masses of some cylinders alone, and without devices.

    Args:
        moving: which cylinders, shape (cylinders,), in the order of `engine.numbers`.
    """
    c = engine.cylinders
    here = np.asarray(moving, bool).reshape(-1, *(1,) * (c.pin_deg.ndim - 1)).astype(float)
    cylinders = replace(
        c,
        reciprocating=here * c.reciprocating,
        rotating=here * c.rotating,
        couple=here * c.couple,
        linkage=c.linkage and replace(c.linkage, mass=here * c.linkage.mass),
    )
    return replace(engine, cylinders=cylinders, devices=())


def _compute_steady(
    engine: Engine, orders: Array, parts: Collection[str], apart: bool
) -> tuple[dict[str, Phasors], Loads]:
    """Phasors of some parts by name at a steady speed, and the loads of the lowest orders."""
    c, (x, y, z) = engine.cylinders, engine.reference_m
    names = [name for name in KINDS if name in parts]
    series = find_needed_series(c, parts, uneven=bool(engine.ripple))
    few, which = c.find_distinct_harmonics(orders, series)
    most = max(_AT_ONCE // c.count, 1)

    def make_loads(block: slice) -> Loads:
        own = few if len(orders) <= most else select_orders(few, block)
        own = select_cylinders(own, which)
        phases = (SeparatePhases if apart else Phases)(c, orders[block])
        return Loads(c, engine.devices, place_in_plane(x, y), z, phases, own, engine.omega**2)

    lowest, blocks = make_loads(slice(most)), []
    for start in range(0, max(len(orders), 1), most):
        loads = make_loads(slice(start, start + most)) if start else lowest
        blocks.append([getattr(loads, name) for name in names])
    return {
        name: _join(own) for name, own in zip(names, zip(*blocks, strict=True), strict=False)
    }, lowest


def _join(blocks: Sequence[Phasors]) -> Phasors:
    return blocks[0] if len(blocks) == 1 else join_orders(blocks)


def _compute_uneven(
    engine: Engine, orders: Array, parts: Collection[str], apart: bool
) -> dict[str, Phasors]:
    """Phasors of some parts by name at an uneven speed."""
    w, dense = _mix_orders(engine, orders)
    steady, loads = _compute_steady(engine, dense, parts, apart)
    found = {name: phasors.drop_noise() for name, phasors in steady.items()}
    crank = _find_crankshaft(engine) / (engine.cylinders.count if apart else 1)
    for name, phasors in found.items():
        if name == "torque":
            uneven = ripple.apply_to_torque(phasors, w, loads.mean_inertia + crank)
        else:
            mean = loads.mean_momentum + crank if name == "couple" else 0.0
            uneven = ripple.apply_to_force(phasors, w, mean)
        found[name] = uneven.select_orders(orders)
    return found


def _find_crankshaft(engine: Engine) -> Figure:
    """Return what `crank.inertia` has beyond the unbalanced masses of the throws, which turn with
    the pins, times the square of the speed, N m; 0 where the file does not give it.
    """
    if engine.crank_inertia is None or engine.rotary:
        return 0.0
    throws = sum(weighed.share for weighed in engine.weighed) * engine.cylinders.radius**2
    return (engine.crank_inertia - throws) * engine.omega**2


def _mix_orders(engine: Engine, orders: Array) -> tuple[Complex, Array]:
    """Coefficients of the speed (`ripple.find_speed`), and the dense orders it mixes into these."""
    mixed = [line.order for line in engine.ripple]
    dense = dense_orders(orders.max(initial=0) + 2 * max(mixed), [*mixed, *orders])
    return ripple.find_speed(engine.ripple, float(dense[1])), dense


def dense_orders(highest: float, mixed: Iterable[float]) -> Array:
    """The orders 0, 1, 2 .. up to the highest, shape (orders,); 0, 1/2, 1 .. where some that are
    mixed are halves.
    """
    step = ripple.find_step(mixed)
    return np.arange(round(highest / step) + 1.0) * step


SHOWN = 1e-6  # share of a quantity's largest order below which an order is not worth showing


def is_order(number: float) -> bool:
    """Whether it is an order that may be asked for: a multiple of 1/2, 0 to HIGHEST_ORDER."""
    return 0 <= number <= HIGHEST_ORDER and number % 0.5 == 0


def check_orders(orders: Iterable[float], engines: Collection[Engine] = ()) -> Array:
    """Orders that were asked for, ascending, each once.

    Args:
        orders: as asked for.
        engines: whose they are: one at least has to have half orders if some are asked for.

    Raises:
        BalcliError: there are none, some are no orders, or half orders that no engine has.
        TypeError: they are no numbers.
    """
    asked = sorted(set(_list_numbers(orders)))
    if not asked or not all(map(is_order, asked)):
        named = ", ".join(shorten(n) for n in asked[:8]) or "none"
        raise BalcliError(f"orders must be multiples of 1/2 from 0 to {HIGHEST_ORDER}, not {named}")
    halves = ", ".join(f"{n:g}" for n in asked if n % 1)
    if halves and engines and all(engine.cycle_revolutions == 1 for engine in engines):
        give = "" if any(engine.gas for engine in engines) else "give [gas], or "
        raise BalcliError(
            f"orders {halves}: half orders are those of gas pressure in four strokes; {give}ask "
            "for whole orders"
        )
    return np.array(asked, float)


def _list_numbers(orders: object) -> list[float]:
    strange: object = orders
    is_number = isinstance(orders, np.ndarray) and orders.ndim == 0
    if isinstance(orders, Iterable) and not (is_number or isinstance(orders, (str, bytes))):
        given = list(orders)
        strangers = [one for one in given if not isinstance(one, (int, float, np.number))]
        if not strangers:
            return given
        strange = strangers[0]
    raise wrong_type("orders", strange, "give numbers, such as [1, 2, 4]")


def parse_order(text: str) -> float | None:
    """The order that a text names, such as `2` or `1.5`; None if it names none."""
    short = len(text) <= len(f"{HIGHEST_ORDER}.5") + 1
    if not short or not re.fullmatch(r"[0-9]+(\.[05])?", text, re.ASCII):
        return None
    number = float(text) if "." in text else int(text)
    return number if is_order(number) else None


def split_order(text: str) -> tuple[float | None, str]:
    """`1.5.amplitude` as the order 1.5 and what comes after it; None where there is no order."""
    match = re.fullmatch(r"([^.]*(?:\.[05](?=\.|$))?)(?:\.(.*))?", text, re.DOTALL)
    if match is None:
        return None, text
    return parse_order(match[1]), match[2] or ""


def find_relevant_orders(engine: Engine) -> Array:
    """The orders 1 .. n beyond which nothing exceeds rounding errors, shape (orders,); 0 .. n at
    uneven speed, with halves where its lines have some.
    """
    of_devices = [device.order for device in engine.devices]
    highest = max([engine.cylinders.find_highest_order(), *of_devices])
    if not engine.ripple:
        return np.arange(1.0, highest + 1)
    lines = [line.order for line in engine.ripple]
    return dense_orders(highest + 2 * max(lines), lines)


def list_gas_orders(engine: Engine) -> Array:
    """Orders of gas torque that are worth showing unless others are asked for: multiples of 1/2 (of
    1 in two-stroke engines) up to HIGHEST_GAS_ORDER_UNASKED, shape (orders,). Of so many cylinders
    that all of these may cancel, also the order of their firing, and its double.
    """
    step = 2 / engine.strokes
    firing = step * len(engine.fires_deg or engine.numbers)
    higher = [firing, 2 * firing] if firing > HIGHEST_GAS_ORDER_UNASKED else []
    return np.array([*np.arange(step, HIGHEST_GAS_ORDER_UNASKED + step, step), *higher])


def mark_considerable(phasors: Phasors) -> NDArray[np.bool_]:
    """Orders in which something exceeds SHOWN of its own largest order, shape (orders,); none above
    HIGHEST_ORDER_UNASKED.
    """
    sizes = phasors.major.reshape(len(phasors.orders), -1).max(axis=1, initial=0)
    large = sizes > SHOWN * sizes.max(initial=0)
    return np.asarray(large & (phasors.orders <= HIGHEST_ORDER_UNASKED))


def choose_orders(found: Spectra, *engines: Engine) -> Array:
    """The orders worth showing: 1 and 2 (and 0), and all in which some kind is considerable, of gas
    those that are listed for one of the engines.
    """
    due = (found.orders <= 2) & (found.orders % 1 == 0)
    listed = set(merge_orders(*map(list_gas_orders, engines)).tolist())
    for kind, phasors in found.items():
        worth = mark_considerable(phasors)
        if kind.name in GAS_KINDS:
            worth &= [order in listed for order in found.orders.tolist()]
        due |= worth
    return found.orders[due]


def merge_orders(*several: Iterable[float]) -> Array:
    """All orders of several, ascending, each once."""
    # np.union1d would import masked arrays, which takes longer than all the rest
    return np.array(sorted({float(order) for orders in several for order in orders}))


_LEAST = 24  # harmonics that are computed at least, so that the largest is among them
_QUADRATURE = 8 * EPS  # error of a coefficient, of the largest


def take_gas(engine: Engine) -> EngineGas:
    """Return the gas of an engine.

    Raises:
        BalcliError: The engine has none.
    """
    if engine.gas is None:
        raise BalcliError(f"{engine.name or 'the engine'}: {NO_GAS}")
    return engine.gas


def compute_gas_torque(engine: Engine, orders: Array) -> Phasors:
    """Return the torque of all cylinders' gas on the crank, N m, noise included.

    Args:
        engine: without trailing axes, or variants whose gas may be asked for.
        orders: multiples of 1/2, shape (orders,).

    Raises:
        BalcliError: the engine has no gas.
    """
    if engine.gas_of_variants is not None:
        return engine.gas_of_variants(orders)
    each = compute_gas_torque_of_each(engine, orders)
    count = len(take_gas(engine).cylinders)
    rounding = SUM * count + ANGLE * orders
    noise = each.noise.sum(axis=1) + rounding * np.abs(each.forward).sum(axis=1)
    return Phasors(orders, each.vectors.sum(axis=2), noise)


def compute_gas_torque_of_each(engine: Engine, orders: Array) -> Phasors:
    """Return the torque of each cylinder's gas on the crank, N m, shape (orders, cylinders), the
    cylinders in the order of `engine.numbers`; arguments and errors as of `compute_gas_torque`.
    """
    gas = take_gas(engine)
    courses, errors = find_courses(gas, orders)
    fires = np.stack([_turn(cylinder, orders) for cylinder in gas.cylinders], axis=1)
    return Phasors.from_scalar(orders, courses * fires, errors)


def find_courses(gas: EngineGas, orders: Array) -> tuple[Complex, Array]:
    """Return the torque of each cylinder's gas by its own cycle angle, N m, shape (orders,
    cylinders): `Re sum c_n e^{i n theta}`; and its error, likewise.
    """
    halves = np.rint(2 * orders).astype(np.intp)
    courses = np.empty((len(orders), len(gas.cylinders)), complex)
    errors = np.empty(courses.shape)
    for torque, rows in gas.group_equal():
        lowest = np.abs(torque.harmonics(np.arange(1, _LEAST + 1)))
        courses[:, rows] = torque.harmonics(halves)[:, None]
        errors[:, rows] = _QUADRATURE * float(lowest.max())
    courses *= gas.shares
    return courses, gas.shares * errors


def _turn(cylinder: CylinderGas, orders: Array) -> Complex:
    """e^{-i n f}: the nominal angle turns exactly, so that cylinders that fire evenly cancel."""
    return np.exp(-1j * orders * cylinder.piston.top) * unit(-orders * cylinder.nominal_deg)
