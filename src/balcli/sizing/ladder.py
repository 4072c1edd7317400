"""The ladder: devices that balance an engine step by step, and the forces left with each step.

Counterweights in the end planes cancel the part of order 1 that turns with the crank;
counterweights at every throw cancel it where it arises, so that main bearings do not carry it;
shafts cancel the part that turns against the crank, and order 2. A step is listed if the part that
it cancels is not small compared with one cylinder.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import reduce
from operator import add
from typing import Annotated, NamedTuple

import numpy as np

from ..core.cylinders import DeviceKind
from ..core.peaks import find_largest
from ..core.phasors import Array, Phasors
from ..core.records import HIDDEN
from ..engine.devices import build_device
from ..engine.engine import Engine
from ..errors import BalcliError
from ..forces.crankshaft import (
    compute_bearing_forces,
    compute_bending,
    compute_loads,
    is_counterweight,
    join_loads,
    place_bearings,
)
from ..forces.spectrum import (
    compute_device_force,
    compute_spectra,
    find_relevant_orders,
    merge_orders,
)
from ..limits import SMALL, WORTH_A_SHAFT
from .fitting import LEFT, Fitting, Slot, explain_counterweights, explain_shaft, size_unbalances
from .options import check_small
from .planes import find_ends, find_planes, find_unbalance
from .remedy import Remedy
from .residual import (
    BACKWARD,
    FORWARD,
    Residual,
    ResidualPart,
    Scales,
    find_scales,
    find_size,
    is_small,
)

AS_DRAWN = "as drawn"
WEIGHTS = "counterweights"
WEIGHTS_AT_THROWS = "counterweights at every throw"
SHAFT = "shaft at -1"
SHAFTS = "shafts at +2 and -2"
STEPS = (AS_DRAWN, WEIGHTS, WEIGHTS_AT_THROWS, SHAFT, SHAFTS)

_AT_THROWS = (
    "At every throw, against the part of order 1 that turns with the crank, so that main bearings "
    "and crankshaft do not carry it"
)


@dataclass(frozen=True, kw_only=True)
class Scale:
    """Force and moment of one cylinder, against which a part is small or large.

    Attributes:
        force_N: Largest first-order force of a cylinder alone.
        moment_Nm: This force at the length of the engine; left out where positions are not known.
    """

    force_N: float
    moment_Nm: float | None = None


@dataclass(frozen=True, kw_only=True)
class Step:
    """The engine with the devices of a step and of those before it.

    Attributes:
        step: Name of the step.
        peak_force_N: Largest free force over a revolution, of all orders.
        peak_moment_Nm: Largest free moment over a revolution; left out for unknown positions.
        main_bearing_N: Largest load of a main bearing by inertia; left out where all throws stand
            in one plane.
        inner_moment_Nm: Largest bending moment of the crankshaft by inertia.
        counterweights: Number of new counterweights.
        shafts: Number of new shafts.
        mass_kg: Sum of all new unbalances, over the crank radius of cylinder 1.
        remedy: The devices.
    """

    step: str
    peak_force_N: float
    peak_moment_Nm: float | None = None
    main_bearing_N: float | None = None
    inner_moment_Nm: float | None = None
    counterweights: int
    shafts: int
    mass_kg: float
    remedy: Annotated[Remedy, HIDDEN]


@dataclass(frozen=True, kw_only=True)
class LeftOut:
    """A step that would cancel a part that is too small to be listed.

    Attributes:
        step: Name of the step.
        force_N: Largest force that it would cancel, turning in one sense.
        moment_Nm: Largest moment that it would cancel; left out where positions are not known.
        main_bearing_N: Reduction of the largest load of a main bearing.
    """

    step: str
    force_N: float
    moment_Nm: float | None = None
    main_bearing_N: float | None = None


@dataclass(frozen=True, kw_only=True)
class Ladder:
    """Devices that balance an engine, step by step.

    Attributes:
        scale: Force and moment of one cylinder.
        auto: Step that is fitted unless another one is asked for.
        steps: Steps that are worth listing.
        left_out: Steps that are not listed and would cancel something.
        small: Share of one cylinder below which a part is left.
    """

    scale: Scale
    auto: str
    steps: tuple[Step, ...]
    left_out: tuple[LeftOut, ...]
    small: Annotated[float, HIDDEN] = SMALL

    def fit(self, step: str | int | None = None) -> Remedy:
        """Return the devices of a listed step.

        Args:
            step: Its name or number; None: `auto`.

        Raises:
            BalcliError: Nothing is fitted in this step, or it is not listed.
        """
        name = self.auto if step is None else self._find_name(str(step))
        remedy = next(one.remedy for one in self.steps if one.step == name)
        return remedy._replace(scheme="auto" if step is None else "step", step=name)

    def _find_name(self, step: str) -> str:
        names = [one.step for one in self.steps]
        at = int(step) if step.isdecimal() and len(step) < 4 else -1
        plain = step.strip().lower().replace("−", "-")
        name = names[at] if 0 <= at < len(names) else plain
        if name in names[1:]:
            return name
        rows = ", ".join(f"{k} {name}" for k, name in enumerate(names))
        for out in self.left_out:
            if out.step == name:
                raise BalcliError(f'step "{name}" is left out: {self._explain(out)}')
        why = "nothing is fitted as drawn" if name == AS_DRAWN else "there is no such step"
        if name == WEIGHTS and WEIGHTS_AT_THROWS in names:
            why = f'"{WEIGHTS_AT_THROWS}" replaces it; --scheme {WEIGHTS} fits it'
        raise BalcliError(f'step "{step[:60]}": {why}; this engine has {rows}')

    def _explain(self, out: LeftOut) -> str:
        """Return the effect of an omitted step, and the option that lists it, if there is one."""
        share, fall = self.measure(out), out.main_bearing_N
        moment = "" if out.moment_Nm is None else f" and {out.moment_Nm:.4g} N·m"
        does = f"it would take {out.force_N:.4g} N{moment}"
        if fall is not None:
            change = f"{'lower' if fall > 0 else 'raise'} the largest main bearing load"
            does = f"it would {change} by {abs(fall):.4g} N"
        hint = f"; --small {math.floor(share)}% lists it" if fall is None or fall > 0 else ""
        return f"{does}, {abs(share):.2g} % of one cylinder{hint}"

    def measure(self, out: LeftOut) -> float:
        """Return the size of the part that a step would cancel, or by how much it would lower a
        main bearing load, in % of one cylinder's first order; nan where this is 0.
        """
        sizes = [(out.force_N, self.scale.force_N), (out.moment_Nm or 0.0, self.scale.moment_Nm)]
        if out.main_bearing_N is not None:
            sizes = [(out.main_bearing_N, self.scale.force_N)]
        return max((100 * size / scale for size, scale in sizes if scale), default=math.nan)


# ------------------------------------------------------------------ devices
def add_at_throws(fitting: Fitting) -> Fitting:
    """Return the fitting with a weight at every throw, against the forward force of order 1 of its
    cylinders and of the counterweights of the file that are nearest to it. If a force or moment
    remains (stagger, weights of the file), the smallest addition cancels it.
    """
    engine, throws = fitting.engine, fitting.engine.joined_throws_m
    forward = compute_spectra(engine, [1], ("force",), each=True)["force"].forward[0]
    unbalances = np.zeros(len(throws), complex)
    np.add.at(unbalances, engine.joined_throw_of_rows, -forward / float(engine.omega) ** 2)
    for device in engine.devices:
        if device.kind is DeviceKind.COUNTERWEIGHT:
            unbalances[np.abs(throws - device.z).argmin()] -= device.forward
    slots = [Slot("counterweight", 1, 1, float(z)) for z in throws]
    left = fitting.add(slots, unbalances, "").find_residual(1)
    parts = FORWARD if engine.places_known else FORWARD[:1]
    if any(left.parts[part] for part in parts):
        unbalances = unbalances + size_unbalances(slots, left, parts).unbalances
    return fitting.add(slots, unbalances.tolist(), _AT_THROWS)


def add_at_ends(fitting: Fitting, first: Residual) -> Fitting:
    """Return the fitting with weights in the end planes for the part that turns with the crank."""
    slots = [Slot("counterweight", 1, 1, z) for z in find_ends(fitting.engine)]
    return fitting.cancel(slots, FORWARD, explain_counterweights(first), first)


def add_shafts(fitting: Fitting, residual: Residual, senses: Iterable[int]) -> Fitting:
    """Return the fitting with shafts for the parts of an order in these senses: one eccentric where
    one cancels force and moment, else two in the end planes.
    """
    for sense in senses:
        planes = find_planes(fitting.engine, residual, sense)
        slots = [Slot("shaft", residual.order, sense, z) for z in planes]
        parts, reason = _parts(sense), explain_shaft(residual, sense, len(slots))
        fitting = fitting.cancel(slots, parts, reason, residual)
    return fitting


def _parts(sense: int) -> tuple[ResidualPart, ResidualPart]:
    return FORWARD if sense > 0 else BACKWARD


def size_complete(engine: Engine) -> Remedy:
    """Return devices that leave nothing of orders 1 and 2, however small."""
    fitting = Fitting.start(engine, "complete")
    first, second = fitting.find_residual(1), fitting.find_residual(2)
    if any(first.parts[part] for part in FORWARD):
        fitting = add_at_ends(fitting, first)
    return add_shafts(add_shafts(fitting, first, [-1]), second, [1, -1]).remedy


# ------------------------------------------------------------------ steps
def find_ladder(engine: Engine, small: float = SMALL) -> Ladder:
    """Return the ladder of an engine.

    Args:
        engine: Engine without trailing axes.
        small: Share of one cylinder below which a part is left.

    Raises:
        BalcliError: `small` is not a share from 0 to 50 %.
    """
    check_small(small)
    drawn, scales = Fitting.start(engine, ""), find_scales(engine)
    first, second = drawn.find_residual(1), drawn.find_residual(2)
    meter = _Meter.start(engine)
    listed, left_out, fitting = _list_weights(drawn, first, meter, scales, small)
    auto, shafts = listed[-1].step, {}
    for name, residual, senses in ((SHAFT, first, (-1,)), (SHAFTS, second, (1, -1))):
        sizes = {sense: find_size(residual, sense, scales) for sense in senses}
        if due := [sense for sense, size in sizes.items() if not is_small(size, small)]:
            fitting = add_shafts(fitting, residual, due)
            shafts[name] = fitting.remedy
            auto = name if max(sizes.values()) >= WORTH_A_SHAFT else auto
        elif any(sizes.values()):
            left_out.append(_leave_out(name, engine, residual, senses))
    steps = (*listed, *meter.measure(shafts, within=listed[-1]).values())
    moment = scales.moment if engine.places_known else None
    scale = Scale(force_N=scales.force, moment_Nm=moment)
    return Ladder(scale=scale, auto=auto, steps=steps, left_out=tuple(left_out), small=small)


def _list_weights(
    drawn: Fitting, first: Residual, meter: _Meter, scales: Scales, small: float
) -> tuple[list[Step], list[LeftOut], Fitting]:
    """Return the listed steps as drawn and with counterweights, those that are left out, and the
    fitting of the last one listed.

    Args:
        drawn: Nothing fitted.
        first: Residual of order 1.
        meter: Measures steps.
        scales: Force, moment and roll of one cylinder.
        small: Share of one cylinder below which a part is left.
    """
    engine = drawn.engine
    turning = find_size(first, 1, scales)
    fitted = {AS_DRAWN: drawn}
    if turning:
        fitted[WEIGHTS] = add_at_ends(drawn, first)
    if meter.loads is not None and len(set(engine.joined_throws_m.tolist())) > 2:
        fitted[WEIGHTS_AT_THROWS] = add_at_throws(drawn)
    found = meter.measure({name: fitting.remedy for name, fitting in fitted.items()})
    names, left_out = [AS_DRAWN], []
    if not is_small(turning, small):
        names.append(WEIGHTS)
    if step := found.get(WEIGHTS_AT_THROWS):
        load = found[names[-1]].main_bearing_N or 0.0
        fall = load - (step.main_bearing_N or 0.0)
        if fall > LEFT * load and not is_small(fall, small * scales.force):
            names.append(WEIGHTS_AT_THROWS)
        elif step.counterweights:
            left_out.append(_leave_out(WEIGHTS_AT_THROWS, engine, first, [1], fall))
    if turning and names == [AS_DRAWN]:
        left_out.insert(0, _leave_out(WEIGHTS, engine, first, [1]))
    return [found[name] for name in names], left_out, fitted[names[-1]]


def _leave_out(
    step: str,
    engine: Engine,
    residual: Residual,
    senses: Iterable[int],
    main_bearing: float | None = None,
) -> LeftOut:
    """Return a step that is left out, with the largest parts that it would cancel."""
    forces, moments = zip(*(map(residual.size, _parts(sense)) for sense in senses), strict=True)
    return LeftOut(
        step=step,
        force_N=max(forces),
        moment_Nm=max(moments) if engine.places_known else None,
        main_bearing_N=main_bearing,
    )


_FREE = ("peak_force_N", "peak_moment_Nm")
_WITHIN = ("main_bearing_N", "inner_moment_Nm")


class _Meter(NamedTuple):
    """Figures of an engine as drawn, to which those of devices are added: each is linear in them.

    Attributes:
        engine: Engine as drawn.
        free: Free force and moment (of unknown positions: force), shape (orders,).
        loads, z: Forces of cylinders and counterweights, and their positions, m; None where they
            are not known, or too many.
        bearings_m: Positions of the main bearings; None where all throws stand in one plane.
    """

    engine: Engine
    free: list[Phasors]
    loads: Phasors | None
    z: Array
    bearings_m: Array | None

    @classmethod
    def start(cls, engine: Engine) -> _Meter:
        """Return the figures of an engine."""
        orders = merge_orders(find_relevant_orders(engine), [1, 2])
        kinds = ("force", "moment") if engine.places_known else ("force",)
        free = [phasors for _, phasors in compute_spectra(engine, orders, kinds).items()]
        loads, z = None, np.zeros(0)
        if engine.places_known and not engine.rotary:
            with suppress(BalcliError):  # too many to keep apart
                loads, z = compute_loads(engine, orders)
        return cls(engine, free, loads, z, place_bearings(engine.joined_throws_m))

    def measure(
        self, remedies: Mapping[str, Remedy], *, within: Step | None = None
    ) -> dict[str, Step]:
        """Return the steps with these devices, by name.

        Args:
            remedies: Devices by the name of the step.
            within: Step whose loads within the crankshaft are those of all.
        """
        if not remedies:
            return {}
        curves = [self._add(remedy, within is None) for remedy in remedies.values()]
        apart = [one.vectors for step in curves for one in step.values()]
        together = Phasors(self.free[0].orders, np.concatenate(apart, axis=2), np.zeros((1, 1)))
        ends = np.cumsum([one.shape[2] for one in apart])
        largest = iter(map(np.max, np.split(find_largest(together), ends[:-1])))
        found = {}
        for (name, remedy), step in zip(remedies.items(), curves, strict=True):
            figures = {key: float(next(largest)) for key in step}
            if within:
                figures |= {key: getattr(within, key) for key in _WITHIN}
            found[name] = self._make_step(name, remedy, figures)
        return found

    def _add(self, remedy: Remedy, with_loads: bool) -> dict[str, Phasors]:
        """Return curves, shape (orders, curves), by the figures that they are the peaks of."""
        new = [build_device(table, self.engine.first_axis_deg) for table in remedy.devices]
        forces = [compute_device_force(self.engine, d, self.free[0].orders) for d in new]
        arms = [1j * float(device.z - self.engine.reference_m[2]) for device in new]
        moments = [arm * force for arm, force in zip(arms, forces, strict=True)]
        found = {}
        for key, as_drawn, more in zip(_FREE, self.free, (forces, moments), strict=False):
            one = reduce(add, more, as_drawn).drop_noise()
            found[key] = Phasors(one.orders, one.vectors[..., None], one.noise[..., None])
        if self.loads is None or not with_loads:
            return found
        on_crank = [k for k, device in enumerate(new) if is_counterweight(device)]
        loads = join_loads([self.loads, *(forces[k] for k in on_crank)])
        z = np.array([*self.z, *(float(new[k].z) for k in on_crank)])
        if self.bearings_m is not None:
            found["main_bearing_N"] = compute_bearing_forces(loads, z, self.bearings_m)
        return found | {"inner_moment_Nm": compute_bending(loads, z)}

    def _make_step(self, name: str, remedy: Remedy, figures: Mapping[str, float]) -> Step:
        unbalance = sum(map(find_unbalance, remedy.devices))
        shafts = {(shaft.ratio, shaft.at) for shaft in remedy.shafts}
        radius = self.engine.cylinders.radius
        return Step(
            step=name,
            counterweights=len(remedy.counterweights),
            shafts=len(shafts),
            mass_kg=unbalance / float(radius),
            remedy=remedy,
            **figures,
        )
