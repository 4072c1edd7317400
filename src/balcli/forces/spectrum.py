"""Compute the forces and moments that inertia and gas cause in an engine, by order.

An order is a number of oscillations per revolution of the crankshaft. The motion of pistons, rods
and devices repeats after each revolution, so its orders are whole. Gas pressure in a four-stroke
engine (and an uneven speed that it causes) repeats after two revolutions and has half orders as
well. So all orders are multiples of 1/2, which floating-point numbers represent exactly.

Inertia: `compute_spectra` sums the series of all mechanisms (`core.loads`); at uneven speed it
convolves them with the coefficients of the speed (`core.speed_ripple`).

Gas presses equally on piston and head: it causes no free force and no free moment, only a torque on
the crank and its reaction on the frame. If t_h are the coefficients of one cylinder's torque over
its cycle, a cylinder that fires at crank angle f adds `t_h e^{i h (theta - f)/2}` at the crank
angle theta, which is of order n = h/2.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import reduce
from operator import add, sub
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core import speed_ripple as ripple
from ..core.cylinders import Device
from ..core.loads import LOADS, Loads, Turning, find_device_forces, find_needed_series
from ..core.mechanisms.closed_form import select_cylinders
from ..core.phases import ANGLE, SUM, Phases, SeparatePhases
from ..core.phasors import EPS, Array, Complex, Phasors, join_orders, join_places, open_axes, unit
from ..engine.engine import Engine, Placed
from ..engine.figures import place_in_plane
from ..errors import NO_GAS, BalcliError, NotComputedError, check_number, list_values, wrong_type
from ..file.fields import shorten
from ..limits import (
    HIGHEST_GAS_ORDER_UNASKED,
    HIGHEST_ORDER,
    HIGHEST_ORDER_UNASKED,
    MOST_LOADS_APART,
)
from .kinds import EVERY_KIND, GAS, GAS_KINDS, KINDS, Kind

if TYPE_CHECKING:
    from ..engine.gas import CylinderGas, EngineGas, GasLaw

# Largest number of orders x cylinders that are computed together, which bounds the memory: about 16
# complex arrays.
_AT_ONCE = 1 << 18


@dataclass(frozen=True, eq=False)
class Spectra:
    """Phasors by order of each kind (`kinds.EVERY_KIND`) that was computed.

    `spectra["moment"]` returns the phasors of a kind, or raises an error that says how to ask for
    them. The kinds that engines have today are attributes, too; an attribute is None if its kind
    was not computed.

    Attributes:
        orders: Orders, ascending, shape (orders,).
        up_deg: Direction that points up, deg from x; None if the file gives none.
        kinds: Phasors of each computed kind, by its name.
    """

    orders: Array
    up_deg: float | None = None
    kinds: Mapping[str, Phasors] = field(default_factory=dict)

    @property
    def force(self) -> Phasors | None:
        """Free force, N; None if it was not computed."""
        return self.kinds.get("force")

    @property
    def moment(self) -> Phasors | None:
        """Free moment, N m; None if it was not computed."""
        return self.kinds.get("moment")

    @property
    def couple(self) -> Phasors | None:
        """Free couple, N m; None if it was not computed."""
        return self.kinds.get("couple")

    @property
    def torque(self) -> Phasors | None:
        """Inertia torque on the crank, N m; None if it was not computed."""
        return self.kinds.get("torque")

    @property
    def roll(self) -> Phasors | None:
        """Roll by inertia, N m; None if it was not computed."""
        return self.kinds.get("roll")

    @property
    def gas(self) -> Phasors | None:
        """Gas torque on the crank, N m; None if it was not computed."""
        return self.kinds.get("gas")

    @property
    def torque_total(self) -> Phasors | None:
        """Torque of gas and inertia on the crank, N m; None if it was not computed."""
        return self.kinds.get("torque_total")

    @property
    def roll_total(self) -> Phasors | None:
        """Roll by gas and inertia, N m; None if it was not computed."""
        return self.kinds.get("roll_total")

    def __getitem__(self, kind: str) -> Phasors:
        """Return the phasors of a kind.

        Args:
            kind: Name of the kind: force, moment, couple, torque, roll, gas, torque_total or
                roll_total.

        Raises:
            NotComputedError: The phasors of this kind were not asked for.
            KeyError: There is no such kind.
        """
        if kind not in EVERY_KIND:
            raise KeyError(f"{kind}; there are {', '.join(EVERY_KIND)}")
        if kind not in self.kinds:
            word = GAS.name if kind in GAS_KINDS else kind
            raise NotComputedError(f'{kind} was not computed; ask for it with only=["{word}"]')
        return self.kinds[kind]

    def items(self) -> list[tuple[Kind, Phasors]]:
        """Return each computed kind with its phasors, in the order of the table of kinds."""
        computed = self.kinds
        return [(kind, computed[name]) for name, kind in EVERY_KIND.items() if name in computed]

    def vectors(self) -> list[tuple[Kind, Phasors]]:
        """Return the `items` that are vectors, such as force and moment."""
        return [(kind, phasors) for kind, phasors in self.items() if kind.vector]

    def scalars(self) -> list[tuple[Kind, Phasors]]:
        """Return the `items` that act about the crank's axis."""
        return [(kind, phasors) for kind, phasors in self.items() if not kind.vector]

    def only(self, kinds: Collection[str]) -> Spectra:
        """Return the spectra of only these kinds, given by their names."""
        found = {name: phasors for name, phasors in self.kinds.items() if name in kinds}
        return replace(self, kinds=found)

    def with_moment_if(self, is_known: bool) -> Spectra:
        """Return the spectra, with nan for the moment if it is not known."""
        if is_known or self.moment is None:
            return self
        p = self.moment
        unknown = Phasors(p.orders, np.full_like(p.vectors, np.nan), p.noise)
        return replace(self, kinds={**self.kinds, "moment": unknown})

    def select_orders(self, orders: ArrayLike) -> Spectra:
        """Return the spectra of only these orders, shape (orders,)."""
        wanted = np.asarray(orders, float)
        found = {name: phasors.select_orders(wanted) for name, phasors in self.kinds.items()}
        return Spectra(wanted, self.up_deg, found)

    def select_place(self, place: int) -> Spectra:
        """Return the spectra at one index of the trailing axis."""
        found = {name: phasors.select_place(place) for name, phasors in self.kinds.items()}
        return replace(self, kinds=found)


def compute_spectra(
    engine: Engine,
    orders: ArrayLike,
    kinds: Collection[str] = tuple(KINDS),
    *,
    by_cylinder: bool = False,
) -> Spectra:
    """Return the free forces and moments of an engine, or of each of its cylinders.

    Args:
        engine: Engine at steady or uneven speed. The phasors have its trailing axes last; with
            `by_cylinder`, it must have none.
        orders: Multiples of 1/2, ascending, not negative, shape (orders,).
        kinds: Names of kinds: any of KINDS, and also of GAS_KINDS if the engine has gas.
        by_cylinder: Whether to return the phasors of each cylinder, as if only that one had masses,
            shape (orders, cylinders), in the order of `engine.numbers`; devices are then ignored.

    Raises:
        BalcliError: One of GAS_KINDS is wanted, and the engine has no gas; or, with `by_cylinder`,
            orders x cylinders exceed MOST_LOADS_APART.
    """
    wanted = np.asarray(orders, float)
    if engine.placed:
        return _add_cranks(engine, wanted, kinds, by_cylinder=by_cylinder)
    if by_cylinder:
        refuse_too_many_loads(engine, len(wanted), engine.cylinders.count)
        engine = replace(engine, devices=())
    parts = {part for name in kinds for part in EVERY_KIND[name].parts}
    phasors = _compute_inertia(engine, wanted, parts - {"gas"}, by_cylinder)
    if "gas" in parts:
        phasors["gas"] = compute_gas_torque(engine, wanted, by_cylinder=by_cylinder)
    sums = {name: add_parts(EVERY_KIND[name], phasors).drop_noise() for name in kinds}
    return Spectra(wanted, engine.up_deg, sums)


def _add_cranks(
    engine: Engine, orders: Array, kinds: Collection[str], *, by_cylinder: bool
) -> Spectra:
    """Return the spectra of engines that are geared together; arguments as in `compute_spectra`."""
    if not GAS_KINDS.keys().isdisjoint(kinds) and engine.gas_of_variants is None:
        take_gas(engine)
    every = [place_spectra(one, orders, kinds, by_cylinder=by_cylinder) for one in engine.cranks]
    sums = {}
    for name in kinds:
        parts = [one[name] for one in every]
        sums[name] = (join_places(parts) if by_cylinder else reduce(add, parts)).drop_noise()
    return Spectra(orders, engine.up_deg, sums)


def place_spectra(
    placed: Placed, orders: Array, kinds: Collection[str], *, by_cylinder: bool = False
) -> dict[str, Phasors]:
    """Return the phasors of one of several geared engines, over the crank angle of the first one.

    A crank that turns against the first makes its engine a mirror image (y changes its sign): a
    force becomes its conjugate, and moment and couple also change their signs. Kinetic energies
    add, so a torque keeps its sign, whichever way its crank turns. The load takes part of the
    reaction: the roll of the frame is the couple less the torque, which here counts as positive in
    the direction in which the load turns.

    Args:
        placed: The engine; its moments are about the common point of reference of all engines.
        orders: Orders, shape (orders,).
        kinds: Names of the kinds.
        by_cylinder: Whether to return the phasors of each cylinder, as in `compute_spectra`.
    """
    fires = placed.engine.gas is not None or placed.engine.gas_of_variants is not None
    parts = {part for name in kinds for part in EVERY_KIND[name].parts}
    own = compute_spectra(
        placed.engine, orders, parts if fires else parts - {"gas"}, by_cylinder=by_cylinder
    )
    seen = {kind.name: _see(placed, kind, phasors) for kind, phasors in own.items()}
    if "gas" in parts and not fires:
        shape = (len(orders), *(placed.engine.cylinders.count,) * by_cylinder)
        seen["gas"] = Phasors(orders, np.zeros((2, *shape), complex), np.zeros(shape))
    on_crank = [part for part in seen if EVERY_KIND[part].on_crank]
    on_frame = seen | {part: placed.load_sense * seen[part] for part in on_crank}
    placed_spectra = {}
    for name in kinds:
        kind = EVERY_KIND[name]
        placed_spectra[name] = add_parts(kind, seen if kind.on_crank else on_frame)
    return placed_spectra


def _see(placed: Placed, kind: Kind, own: Phasors) -> Phasors:
    """Return the phasors of a kind in the axes of all engines, from those in an engine's own."""
    n = own.orders.reshape(-1, *(1,) * (own.forward.ndim - 1))
    lead = unit(n * placed.phase_deg)
    forward = lead * own.forward
    backward = np.conj(lead) * own.backward
    noise = own.noise + (SUM + ANGLE * n) * (np.abs(own.forward) + np.abs(own.backward))
    if placed.ratio < 0 and not kind.on_crank:
        sign = 1.0 if kind.dimension == "force" else -1.0
        ahead = sign * forward.conj()
        against = sign * backward.conj()
        mean = n == 0
        forward = np.where(mean, ahead, against)
        backward = np.where(mean, 0, ahead)
    turn = unit(placed.turn_deg) if kind.vector else 1.0
    return Phasors.of(own.orders, turn * forward, turn * backward, noise)


def refuse_too_many_loads(engine: Engine, orders: int, loads: int) -> None:
    """Raise BalcliError if the forces of single cylinders and counterweights would fill the memory.

    Args:
        engine: Engine.
        orders: Number of orders.
        loads: Number of cylinders and counterweights.
    """
    most = MOST_LOADS_APART // 2 if engine.ripple else MOST_LOADS_APART
    if orders * loads > most:
        raise BalcliError(
            f"{orders} orders of {loads} single cylinders and counterweights are "
            f"{orders * loads} forces, and at most {most} are kept: an engine with longer "
            "rods has fewer orders"
        )


def count_engine_samples(engine: Engine) -> int:
    """Return the approximate number of samples of a revolution that the mechanisms of an engine (or
    of variants) need.
    """
    if engine.placed:
        return sum(count_engine_samples(one.engine) for one in engine.cranks)
    c = engine.cylinders
    sampled = c.linkage is not None or np.count_nonzero(c.eps)
    return c.count_all_samples()[1] if sampled else 0


def compute_forces_of_devices(engine: Engine, devices: Sequence[Device], orders: Array) -> Phasors:
    """Return the force of each device by order, N, shape (orders, devices).

    Args:
        engine: One engine, not an array of variants.
        devices: Devices.
        orders: Orders, shape (orders,).
    """
    speed, dense = _mix_orders(engine, orders)
    forces = find_device_forces(devices, dense, engine.omega**2).drop_noise()
    if not engine.ripple:
        return forces
    return ripple.apply_speed(forces, speed).select_orders(orders).drop_noise()


def add_parts(kind: Kind, parts: Mapping[str, Phasors]) -> Phasors:
    """Return the phasors of a kind as the sum of its parts (`Kind.parts`).

    Args:
        kind: Kind of force or moment.
        parts: Phasors of the parts by name.
    """
    plus = reduce(add, (parts[name] for name in kind.plus or (kind.name,)))
    return reduce(sub, (parts[name] for name in kind.minus), plus)


def with_only(engine: Engine, moving: ArrayLike) -> Engine:
    """Return the engine with masses in some cylinders only, and without devices.

    Args:
        engine: Engine.
        moving: Whether each cylinder keeps its masses, shape (cylinders,), in the order of
            `engine.numbers`.
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


def _compute_inertia(
    engine: Engine, orders: Array, parts: Collection[str], by_cylinder: bool
) -> dict[str, Phasors]:
    """Return the phasors of some kinds of inertia by name; arguments as in `compute_spectra`."""
    c = engine.cylinders
    x, y, z = engine.reference_m
    uneven = bool(engine.ripple)
    names = [name for name in KINDS if name in parts]
    if not names:
        return {}
    speed, dense = _mix_orders(engine, orders)
    few, which = c.find_distinct_harmonics(dense, find_needed_series(c, parts, uneven=uneven))
    most = max(_AT_ONCE // c.count, 1)

    def make_loads(start: int) -> Loads:
        block = slice(start, start + most)
        series = select_cylinders(few, which, block)
        phases = (SeparatePhases if by_cylinder else Phases)(c, dense[block])
        return Loads(c, engine.devices, place_in_plane(x, y), z, phases, series, engine.omega**2)

    starts = range(0, max(len(dense), 1), most)
    blocks = [[getattr(loads, name) for name in names] for loads in map(make_loads, starts)]
    steady = {name: join_orders(pieces) for name, *pieces in zip(names, *blocks, strict=True)}
    if not uneven:
        return steady
    scale = engine.omega**2 / (c.count if by_cylinder else 1)
    inertia = engine.find_turning_inertia(beyond_pins=True)
    turning = Turning(*(scale * value for value in inertia))
    mixed_spectra = {}
    lowest = make_loads(0)
    for name, phasors in steady.items():
        form = LOADS[name]
        mean = form.find_mean(lowest, turning)
        mixed = ripple.apply_speed(phasors.drop_noise(), speed, mean, rate_last=form.of_energy)
        mixed_spectra[name] = mixed.select_orders(orders)
    return mixed_spectra


def _mix_orders(engine: Engine, orders: Array) -> tuple[Complex, Array]:
    """Return the coefficients of the speed (`ripple.find_speed`), and the orders that have to be
    computed to get the given ones. At uneven speed, these are all orders up to the highest that
    contributes.
    """
    if not engine.ripple:
        return np.ones(1, complex), orders
    mixed = [line.order for line in engine.ripple]
    dense = dense_orders(orders.max(initial=0) + 2 * max(mixed), [*mixed, *orders])
    return ripple.find_speed(engine.ripple, float(dense[1])), dense


def dense_orders(highest: float, mixed: Iterable[float]) -> Array:
    """Return the orders 0, 1, 2 .. up to the highest, shape (orders,); 0, 1/2, 1 .. if any of
    `mixed` is a half order.

    Args:
        highest: Highest order.
        mixed: Orders of the uneven speed and of the engine.
    """
    step = 0.5 if any(order % 1 for order in mixed) else 1.0
    return np.arange(round(highest / step) + 1.0) * step


SHOWN = 1e-6  # smallest amplitude worth showing, as a share of the largest among all orders


def is_order(number: float) -> bool:
    """Return whether a number is an order: a multiple of 1/2 from 0 to HIGHEST_ORDER."""
    return 0 <= number <= HIGHEST_ORDER and number % 0.5 == 0


def check_orders(orders: Iterable[float], engines: Collection[Engine] = ()) -> Array:
    """Return the orders in an argument, ascending, each once.

    Args:
        orders: Numbers.
        engines: Engines, one of which must have half orders if `orders` has some.

    Raises:
        BalcliError: There are no orders, some numbers are no orders, or no engine has half orders.
        TypeError: The argument has other values than numbers.
    """
    wanted = "give numbers, such as [1, 2, 4]"
    if isinstance(orders, bytes) or not np.iterable(orders):
        raise wrong_type("orders", orders, wanted)
    asked = sorted({check_number("orders", n, wanted) for n in list_values("orders", orders)})
    if not asked or not all(map(is_order, asked)):
        named = ", ".join(shorten(n) for n in asked[:8]) or "none"
        raise BalcliError(f"orders must be multiples of 1/2 from 0 to {HIGHEST_ORDER}, not {named}")
    halves = ", ".join(f"{n:g}" for n in asked if n % 1)
    if halves and engines and all(engine.cycle_revolutions == 1 for engine in engines):
        message = "half orders need [gas] and four strokes, or a shaft at a half order"
        raise BalcliError(f"orders {halves}: {message}")
    return np.array(asked, float)


def parse_order(text: str) -> float | None:
    """Return the order that a text names, such as `2` or `1.5`; None if it names none."""
    written = re.fullmatch(r"[0-9]+(\.[05])?", text)
    return float(text) if written and is_order(float(text)) else None


def split_order(text: str) -> tuple[float | None, str]:
    """Return the order at the beginning of a text and the rest: 1.5 and `amplitude` for
    `1.5.amplitude`; None if there is no order.
    """
    match = re.fullmatch(r"([^.]*(?:\.[05](?=\.|$))?)(?:\.(.*))?", text, re.DOTALL)
    if match is None:
        return None, text
    return parse_order(match[1]), match[2] or ""


def find_relevant_orders(engine: Engine) -> Array:
    """Return the orders 1 .. n, shape (orders,); above n, all amplitudes are below rounding errors.
    Half orders are those of shafts. At uneven speed, return 0 .. n, with all half orders if the
    speed or a shaft has some.
    """
    if engine.placed:
        return merge_orders(*(find_relevant_orders(one.engine) for one in engine.cranks))
    of_devices = [device.order for device in engine.devices]
    highest = max([engine.cylinders.find_highest_order(), *of_devices])
    if not engine.ripple:
        halves = [order for order in of_devices if order % 1]
        return merge_orders(np.arange(1.0, highest + 1), halves)
    lines = [line.order for line in engine.ripple]
    return dense_orders(highest + 2 * max(lines), [*lines, *of_devices])


def list_gas_orders(engine: Engine, highest: float = HIGHEST_GAS_ORDER_UNASKED) -> Array:
    """Return orders of gas torque, shape (orders,): multiples of 1/2 (of 1 in two-stroke engines).
    If the engine fires more than `highest` times a revolution, two orders are added, because all
    lower orders may cancel: the number of firings per revolution and twice this number.

    Args:
        engine: Engine with gas.
        highest: Highest order, except for the two that may be added.
    """
    if engine.placed:
        fired = (one.engine for one in engine.cranks if one.engine.gas is not None)
        return merge_orders(*(list_gas_orders(own, highest) for own in fired))
    step = 2 / engine.strokes
    firing = step * len(engine.fires_deg or engine.numbers)
    higher = [firing, 2 * firing] if firing > highest else []
    return np.array([*np.arange(step, highest + step / 2, step), *higher])


def mark_considerable(phasors: Phasors) -> NDArray[np.bool_]:
    """Return whether the amplitude of each order exceeds the share SHOWN of the largest amplitude,
    shape (orders,); False above HIGHEST_ORDER_UNASKED.
    """
    sizes = phasors.major.reshape(len(phasors.orders), -1).max(axis=1, initial=0)
    large = sizes > SHOWN * sizes.max(initial=0)
    return np.asarray(large & (phasors.orders <= HIGHEST_ORDER_UNASKED))


def choose_orders(spectra: Spectra, listed: Iterable[float]) -> Array:
    """Return the orders worth showing, shape (orders,): 0, 1 and 2 if computed, and each order in
    which some kind is worth showing (`mark_considerable`).

    Args:
        spectra: Computed phasors of every kind.
        listed: Orders of gas that may be shown.
    """
    due = (spectra.orders <= 2) & (spectra.orders % 1 == 0)
    of_gas = np.isin(spectra.orders, merge_orders(listed))
    for kind, phasors in spectra.items():
        due |= mark_considerable(phasors) & (of_gas | (kind.name not in GAS_KINDS))
    return spectra.orders[due]


def merge_orders(*several: Iterable[float]) -> Array:
    """Return all orders of several lists, ascending, each once."""
    # np.union1d would import masked arrays, which takes too long
    return np.array(sorted({float(order) for orders in several for order in orders}))


_LEAST = 24  # the largest harmonic of a gas torque is among this many first harmonics
_QUADRATURE = 8 * EPS  # error of a coefficient, relative to the largest one


def take_gas(engine: Engine) -> EngineGas:
    """Return the gas of an engine.

    Raises:
        BalcliError: The engine has none.
    """
    if engine.gas is None:
        raise BalcliError(f"{engine.name or 'the engine'}: {NO_GAS}")
    return engine.gas


class GasAtSpeeds(NamedTuple):
    """Gas of an engine at any speeds.

    Attributes:
        torque: Function that returns torques by order, N m, shape (orders, *speeds, ...), at
            speeds, rpm.
        imep: Function that returns the indicated mean effective pressure, Pa, at speeds, rpm.
        law: Law by which the gas depends on the speed; None: it does not depend on it.
    """

    torque: Callable[[ArrayLike], Complex]
    imep: Callable[[ArrayLike], Array]
    law: GasLaw | None

    def select_orders(self, rows: NDArray[np.bool_]) -> GasAtSpeeds:
        """Return the gas with the torques of only some orders."""
        return self._replace(torque=lambda speeds_rpm: self.torque(speeds_rpm)[rows])

    def replace_cylinder(self, row: int, other: Callable[[ArrayLike], Complex]) -> GasAtSpeeds:
        """Return the gas in which one cylinder has another torque; torques are by cylinder.

        Args:
            row: Row of the cylinder.
            other: Function that returns its torques by order, N m, shape (orders, *speeds), at
                speeds, rpm.
        """

        def find_torque(speeds_rpm: ArrayLike) -> Complex:
            torque = np.array(self.torque(speeds_rpm))
            torque[..., row] = other(speeds_rpm)
            return torque

        return self._replace(torque=find_torque)

    def spread_orders(self, rows: NDArray[np.intp], count: int) -> GasAtSpeeds:
        """Return the gas with its orders at these rows of `count` orders; it has no torque of the
        others.
        """

        def find_torque(speeds_rpm: ArrayLike) -> Complex:
            own = self.torque(speeds_rpm)
            torque = np.zeros((count, *own.shape[1:]), complex)
            torque[rows] = own
            return torque

        return self._replace(torque=find_torque)


def follow_gas(engine: Engine, find: Callable[[Engine], Complex]) -> GasAtSpeeds:
    """Return the gas of an engine at any speeds.

    Args:
        engine: One engine with gas, not an array of variants.
        find: Function that returns gas torques by order, shape (orders, ...), for the engine with
            the gas of one speed.

    Raises:
        BalcliError: The engine has no gas.
    """
    gas = take_gas(engine)
    by_speed = gas.follow(lambda own: find(replace(engine, gas=own)))

    def find_torque(speeds_rpm: ArrayLike) -> Complex:
        return np.moveaxis(np.asarray(by_speed(speeds_rpm), complex), np.ndim(speeds_rpm), 0)

    return GasAtSpeeds(find_torque, follow_imep(engine), gas.law)


def follow_imep(engine: Engine) -> Callable[[ArrayLike], Array]:
    """Return a function that returns the indicated mean effective pressure of an engine, Pa, at
    speeds, rpm.

    Raises:
        BalcliError: The engine has no gas.
    """
    volume = float(engine.displacement_m3)
    return take_gas(engine).follow(lambda own: own.work / volume)


def compute_gas_torque(engine: Engine, orders: Array, *, by_cylinder: bool = False) -> Phasors:
    """Return the torque of the gas on the crank, N m, with the trailing axes of the gas; rounding
    errors are not yet set to 0.

    Args:
        engine: Engine with gas, or an array of variants with `gas_of_variants`.
        orders: Multiples of 1/2, shape (orders,).
        by_cylinder: Whether to return the torque of each cylinder instead of the sum, shape
            (orders, cylinders, *trailing), in the order of `engine.numbers`.

    Raises:
        BalcliError: The engine has no gas.
    """
    if engine.gas_of_variants is not None and not by_cylinder:
        return engine.gas_of_variants(orders)
    gas = take_gas(engine)
    halves = np.rint(2 * orders).astype(np.intp)
    torques = np.empty((len(orders), len(gas.cylinders), *gas.variants), complex)
    errors = np.empty(torques.shape)
    for torque, rows in gas.group_equal():
        lowest = np.abs(torque.harmonics(np.arange(1, _LEAST + 1)))
        torques[:, rows] = torque.harmonics(halves)[:, None]
        errors[:, rows] = _QUADRATURE * lowest.max(axis=0)
    shares = open_axes(gas.shares, gas.variants)
    turns = np.stack([_turn(one, orders) for one in gas.cylinders], axis=1)
    torques *= shares * open_axes(turns, gas.variants)
    torque_phasors = Phasors.from_scalar(orders, torques, shares * errors)
    if by_cylinder:
        return torque_phasors
    rounding = open_axes(SUM * len(gas.cylinders) + ANGLE * orders, gas.variants)
    noise = torque_phasors.noise.sum(axis=1) + rounding * np.abs(torque_phasors.forward).sum(axis=1)
    return Phasors(orders, torque_phasors.vectors.sum(axis=2), noise)


def _turn(cylinder: CylinderGas, orders: Array) -> Complex:
    """Return e^{-i n f} by order n, f being the crank angle of firing. The turn by the nominal
    angle is exact, so that evenly firing cylinders cancel exactly.
    """
    return np.exp(-1j * orders * cylinder.piston.top) * unit(-orders * cylinder.nominal_deg)
