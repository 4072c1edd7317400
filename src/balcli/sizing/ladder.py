"""Compute the ladder: devices that balance an engine step by step, and the forces that each step
leaves.

Counterweights in the end planes cancel the part of order 1 that turns with the crank.
Counterweights at every throw cancel it where it arises, so that main bearings do not carry it.
Shafts cancel the part of order 1 that turns against the crank, and order 2. A step is listed if the
part that it cancels, or its reduction of the main bearing load, is not small compared with one
cylinder's first order.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Annotated, NamedTuple

import numpy as np

from ..core.cylinders import DeviceKind
from ..core.peaks import find_largest
from ..core.records import HIDDEN
from ..engine.engine import Engine
from ..errors import BalcliError
from ..forces.crankshaft import find_crank_loads
from ..forces.spectrum import compute_spectra, find_relevant_orders, merge_orders
from ..limits import SMALL, WORTH_A_SHAFT
from .fitting import LEFT, Fitting, Slot, explain_counterweights, explain_shaft, size_unbalances
from .options import check_small
from .planes import find_carriers, find_ends, find_planes, find_unbalance
from .remedy import Remedy, fit_devices
from .residual import (
    FORWARD,
    Residual,
    Scales,
    find_scales,
    find_size,
    is_small,
    list_parts,
)

AS_DRAWN = "as drawn"
WEIGHTS = "counterweights"
WEIGHTS_AT_THROWS = "counterweights at every throw"
SHAFT = "shaft at -1"
SHAFTS = "shafts at +2 and -2"

_AT_THROWS = (
    "Counterweights at every throw cancel the part of order 1 that turns with the crank where it "
    "arises, so main bearings and crankshaft do not carry it"
)


class Scale(NamedTuple):
    """Force and moment of one cylinder, with which the forces and moments of orders are compared.

    Attributes:
        force_N: Largest first-order force of a cylinder alone.
        moment_Nm: This force times the length of the engine; left out where positions are unknown.
    """

    force_N: float
    moment_Nm: float | None = None


@dataclass(frozen=True, kw_only=True)
class Step:
    """The engine with the devices of a step and of earlier steps; counterweights at every throw
    replace those in the end planes.

    Attributes:
        step: Name of the step.
        peak_force_N: Largest free force over a revolution, all orders added up.
        peak_moment_Nm: Largest free moment over a revolution; left out if positions are unknown.
        main_bearing_N: Largest load of a main bearing by inertia; left out if it is not known, or
            if all throws have the same position along the crank.
        inner_moment_Nm: Largest bending moment of the crankshaft by inertia.
        counterweights: Number of new counterweights.
        shafts: Number of new shafts.
        mass_kg: Sum of all new unbalances divided by the crank radius.
        remedy: New devices.
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

    @property
    def title(self) -> str:
        """Name of the step in tables (`name_step`)."""
        return name_step(self.remedy._replace(step=self.step))


def name_step(remedy: Remedy) -> str:
    """Return the name of the step of these devices. If a step needs only one of the two shafts of
    order 2, ": only +2" or ": only -2" is added. Empty if the devices are not those of a step.
    """
    ratios = {shaft.ratio for shaft in remedy.shafts if abs(shaft.ratio) == 2}
    alone = f": only {min(ratios):+d}" if remedy.step == SHAFTS and len(ratios) == 1 else ""
    return f"{remedy.step}{alone}"


class LeftOut(NamedTuple):
    """A step that is not listed because its effect is small.

    Attributes:
        step: Name of the step.
        force_N: Largest rotating force that it would cancel.
        moment_Nm: Largest rotating moment that it would cancel; left out where positions are not
            known.
        main_bearing_N: Reduction of the largest load of a main bearing.
    """

    step: str
    force_N: float
    moment_Nm: float | None = None
    main_bearing_N: float | None = None


class Ladder(NamedTuple):
    """Devices that balance an engine, step by step.

    Attributes:
        scale: Force and moment of one cylinder.
        auto: Step that is fitted by default.
        steps: Steps that are worth listing.
        left_out: Steps that would cancel something but are not listed.
        small: Forces and moments below this share of one cylinder's first order are not balanced.
    """

    scale: Scale
    auto: str
    steps: tuple[Step, ...]
    left_out: tuple[LeftOut, ...]
    small: Annotated[float, HIDDEN] = SMALL

    def fit(self, step: str | int | None = None) -> Remedy:
        """Return the devices of a listed step.

        Args:
            step: Name or number of the step; None: `auto`.

        Raises:
            BalcliError: The step is not listed, or fits nothing.
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
        rows = ", ".join(f"{k} {name}" for k, name in enumerate(names) if k)
        rows = rows or "none, because nothing is worth fitting"
        for out in self.left_out:
            if out.step == name:
                raise BalcliError(f'step "{name}" is left out: {self._explain(out)}')
        raise BalcliError(f'step "{step[:60]}": the choices are {rows}; 0 is the engine as drawn')

    def _explain(self, out: LeftOut) -> str:
        """Return in words the effect of an omitted step and, if an option can list the step, this
        option.
        """
        share, fall = self.measure(out), out.main_bearing_N
        does, hint = "cancel", f"; --small {math.floor(share)}% lists it"
        if fall is not None:
            does = f"{'lower' if fall > 0 else 'raise'} the largest main bearing load by"
            hint = hint if fall > 0 else ""
        return f"it would {does} {abs(share):.2g} % of one cylinder's first order{hint}"

    def measure(self, out: LeftOut) -> float:
        """Return the force or moment that an omitted step would cancel, or its reduction of the
        main bearing load, in % of one cylinder's first order; nan if one cylinder has no force of
        first order.
        """
        sizes = [(out.force_N, self.scale.force_N), (out.moment_Nm or 0.0, self.scale.moment_Nm)]
        if out.main_bearing_N is not None:
            sizes = [(out.main_bearing_N, self.scale.force_N)]
        return max((100 * size / scale for size, scale in sizes if scale), default=math.nan)


# ------------------------------------------------------------------ devices
def add_at_throws(fitting: Fitting) -> Fitting:
    """Return the fitting with a counterweight at every throw. The cylinders of a throw make a
    force of order 1; the counterweight cancels the part of this force that turns with the crank.
    Each counterweight of the file is subtracted at the nearest throw. If a force or moment remains
    (from stagger, or weights of the file), the smallest additional unbalances cancel it.
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


def add_at_ends(fitting: Fitting, first: Residual, sense: int = 1) -> Fitting:
    """Return the fitting with counterweights in the end planes. They cancel the part of order 1
    that turns in the direction `sense` (1: as the first crank, -1: against it), and are on the
    first crank that turns in this direction.
    """
    one = find_carriers(fitting.engine)[sense]
    slots = [Slot.on_crank(one, z) for z in find_ends(one.engine)]
    return fitting.cancel(slots, list_parts(sense), explain_counterweights(first, sense), first)


def add_shafts(fitting: Fitting, residual: Residual, senses: Iterable[int]) -> Fitting:
    """Return the fitting with shafts for the parts of an order that turn in these directions. A
    shaft has one eccentric if that cancels force and moment, else two in the end planes.
    """
    for sense in senses:
        planes = find_planes(fitting.engine, residual, sense)
        slots = [Slot("shaft", residual.order, sense, z) for z in planes]
        parts, reason = list_parts(sense), explain_shaft(residual, sense, len(slots))
        fitting = fitting.cancel(slots, parts, reason, residual)
    return fitting


def ignore_compensators(engine: Engine) -> Engine:
    """Return the engine with the moments of its compensators but without their forces: for each, an
    opposite force is added at the point of reference, where it makes no moment.
    """
    *_, z = engine.reference_m
    opposite = [
        device._replace(forward=-device.forward, backward=-device.backward, z=float(z), spin=0.0)
        for device in engine.every_device
        if device.compensates
    ]
    return replace(engine, devices=(*engine.devices, *opposite)) if opposite else engine


def size_complete(engine: Engine) -> Remedy:
    """Return devices that cancel all forces and moments of orders 1 and 2, even small ones."""
    fitting = Fitting.start(ignore_compensators(engine), "complete")
    first, second = fitting.find_residual(1), fitting.find_residual(2)
    carriers = find_carriers(engine)
    for sense in carriers:
        if any(first.parts[part] for part in list_parts(sense)):
            fitting = add_at_ends(fitting, first, sense)
    fitting = add_shafts(fitting, first, {-1}.difference(carriers))
    return add_shafts(fitting, second, [1, -1]).remedy


# ------------------------------------------------------------------ steps
def find_ladder(engine: Engine, small: float = SMALL) -> Ladder:
    """Return the ladder of an engine.

    Args:
        engine: One engine, not an array of variants.
        small: Forces and moments below this share of one cylinder's first order are not balanced.

    Raises:
        BalcliError: `small` is not a share from 0 to 50 %.
    """
    check_small(small)
    drawn, scales = Fitting.start(ignore_compensators(engine), ""), find_scales(engine)
    first, second = drawn.find_residual(1), drawn.find_residual(2)
    steps, left_out, fitting = _list_weights(engine, drawn, first, scales, small)
    auto = steps[-1].step
    others = {-1}.difference(find_carriers(engine))
    for name, residual, senses in ((SHAFT, first, others), (SHAFTS, second, (1, -1))):
        sizes = {sense: find_size(residual, list_parts(sense), scales) for sense in senses}
        if due := [sense for sense, size in sizes.items() if not is_small(size, small)]:
            fitting = add_shafts(fitting, residual, due)
            steps.append(_make_step(name, engine, fitting))
            auto = name if max(sizes.values()) >= WORTH_A_SHAFT else auto
        elif any(sizes.values()):
            left_out.append(_leave_out(name, engine, residual, senses))
    moment = scales.moment if engine.places_known else None
    scale = Scale(force_N=scales.force, moment_Nm=moment)
    return Ladder(scale=scale, auto=auto, steps=tuple(steps), left_out=tuple(left_out), small=small)


def _list_weights(
    engine: Engine, drawn: Fitting, first: Residual, scales: Scales, small: float
) -> tuple[list[Step], list[LeftOut], Fitting]:
    """Return the step "as drawn" and the steps with counterweights, the omitted steps, and the
    fitting of the last listed step.

    Args:
        engine: Engine as drawn.
        drawn: Fitting without devices.
        first: Residual of order 1.
        scales: Force, moment and roll of one cylinder.
        small: Forces and moments below this share of one cylinder's first order are not balanced.
    """
    senses = find_carriers(engine)
    turning = {sense: find_size(first, list_parts(sense), scales) for sense in senses}
    fitting, steps, left_out = drawn, [_make_step(AS_DRAWN, engine, drawn)], []
    if due := [sense for sense, size in turning.items() if not is_small(size, small)]:
        for sense in due:
            fitting = add_at_ends(fitting, first, sense)
        steps.append(_make_step(WEIGHTS, engine, fitting))
    inside = steps[0].inner_moment_Nm is not None
    if inside and len(set(engine.joined_throws_m.tolist())) > 2:
        at_throws = add_at_throws(drawn)
        step = _make_step(WEIGHTS_AT_THROWS, engine, at_throws)
        load = steps[-1].main_bearing_N or 0.0
        fall = load - (step.main_bearing_N or 0.0)
        if fall > LEFT * load and not is_small(fall, small * scales.force):
            fitting = at_throws
            steps.append(step)
        elif step.counterweights:
            left_out.append(_leave_out(WEIGHTS_AT_THROWS, engine, first, [1], fall))
    if any(turning.values()) and len(steps) == 1:
        left_out.insert(0, _leave_out(WEIGHTS, engine, first, turning))
    return steps, left_out, fitting


def _leave_out(
    step: str,
    engine: Engine,
    residual: Residual,
    senses: Iterable[int],
    main_bearing: float | None = None,
) -> LeftOut:
    """Return an omitted step with the largest force and moment that it would cancel."""
    forces, moments = zip(*(map(residual.size, list_parts(sense)) for sense in senses), strict=True)
    return LeftOut(
        step=step,
        force_N=max(forces),
        moment_Nm=max(moments) if engine.places_known else None,
        main_bearing_N=main_bearing,
    )


def _make_step(name: str, engine: Engine, fitting: Fitting) -> Step:
    """Return the figures of the engine with the devices of a fitting."""
    remedy = fitting.remedy
    fitted = fit_devices(engine, remedy)
    kinds = ("force", "moment") if engine.places_known else ("force",)
    orders = merge_orders(find_relevant_orders(fitted), [1, 2])
    peaks = {
        f"peak_{kind.key}": float(find_largest(phasors))
        for kind, phasors in compute_spectra(fitted, orders, kinds).items()
    }
    loads = find_crank_loads(fitted)
    return Step(
        step=name,
        **peaks,
        main_bearing_N=None if loads is None else loads.main_N,
        inner_moment_Nm=None if loads is None else loads.inner_moment_Nm,
        counterweights=len(remedy.counterweights),
        shafts=len({(shaft.ratio, shaft.at) for shaft in remedy.shafts}),
        mass_kg=sum(
            find_unbalance(d) / engine.find_radius(d.position / 1e3) for d in remedy.devices
        ),
        remedy=remedy,
    )
