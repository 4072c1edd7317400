"""Engine -> free forces and moments by order, computing only what is asked for."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import reduce
from operator import add, sub

import numpy as np
from numpy.typing import ArrayLike

from ..core import speed_ripple as ripple
from ..core.cylinders import Device
from ..core.loads import Loads, find_device_force, find_needed_series
from ..core.mechanisms.fourier import select_cylinders, select_orders
from ..core.phases import Phases, SeparatePhases
from ..core.phasors import Array, Complex, Phasors, join_orders
from ..engine.arrays import place_in_plane
from ..engine.build import Engine
from ..errors import BalcliError
from ..limits import MOST_LOADS_APART
from .kinds import EVERY_KIND, KINDS, Kind

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
    from . import gas  # engines without gas do not pay for it

    compute = gas.compute_gas_torque_of_each if apart else gas.compute_gas_torque
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
    for name, phasors in found.items():
        if name == "torque":
            uneven = ripple.apply_to_torque(phasors, w, loads.mean_inertia)
        else:
            mean = loads.mean_momentum if name == "couple" else 0.0
            uneven = ripple.apply_to_force(phasors, w, mean)
        found[name] = uneven.select_orders(orders)
    return found


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
