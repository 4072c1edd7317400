"""Fit all unbalances that an engine file leaves open (`unbalance = "fit"`) together, by least
squares of the quantities to cancel.

The effect of a device is linear in its complex unbalance and has a single order, so each order is
solved separately. Force, moment and roll are weighted as shares of one cylinder's first order.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from ..core import least_squares
from ..core.phasors import Array, unit
from ..engine.devices import refuse_drifting
from ..engine.engine import Engine, refuse_geared
from ..engine.placed import build_fitted
from ..errors import MOMENTS_UNKNOWN, NO_GAS, ArgumentError, BalcliError, InputError
from ..file.fields import join_words
from ..file.model import EngineFile, Shaft
from ..forces.kinds import ROLL_TOTAL
from ..forces.spectrum import compute_spectra
from .fitting import find_effects
from .options import FIT
from .planes import TABLES, DeviceTable, find_order, measure_direction
from .remedy import Remedy
from .residual import (
    FORCE,
    MOMENT,
    ROLL,
    find_residual,
    find_scales,
    hold_steady,
)

# Possible targets, and the parts of a residual that each contains; roll_total includes the gas.
TARGETS = {
    "force": FORCE,
    "moment": MOMENT,
    "roll": (ROLL,),
    ROLL_TOTAL.name: (ROLL,),
}
_LOST = 1e-10  # singular values below this share of the largest count as 0
_ROUNDING = 1e-12  # unbalances below this share of the largest unbalance of their order count as 0
_REASON = "Place from the file; leaves the least sum of squares of {} at the device's order"


def list_to_fit(model: EngineFile) -> list[tuple[str, DeviceTable]]:
    """Return the names (`shaft.2`) and tables of devices whose unbalance is "fit", in the order of
    the file.
    """
    to_fit = []
    for key in TABLES:
        for number, table in enumerate(getattr(model, key), 1):
            if table.to_fit:
                to_fit.append((f"{key}.{number}", table))
    return to_fit


def list_open_webs(model: EngineFile) -> list[str]:
    """Return the names of the dimensions of webs that are "fit" (`web.1.opening`)."""
    return [f"web.{n}.{table.to_fit}" for n, table in enumerate(model.web, 1) if table.to_fit]


def remove_to_fit(model: EngineFile) -> EngineFile:
    """Return the file without the devices whose unbalance is "fit". Webs with a dimension "fit"
    have no counterweight; if this is their thickness, they have no thickness either.
    """
    rest: dict[str, tuple[object, ...]] = {}
    for key in TABLES:
        rest[key] = tuple(table for table in getattr(model, key) if not table.to_fit)
    if list_open_webs(model):
        rest["web"] = tuple(table.take_open_away() for table in model.web)
    return model.model_copy(update=rest)


def size_fit(engine: Engine, model: EngineFile, targets: Sequence[str] | None = None) -> Remedy:
    """Fit all unbalances that a file gives as "fit".

    An angle that the file gives is kept. If the targets do not determine the unbalances, the
    smallest unbalances are used that cancel the targets best.

    Args:
        engine: Engine without these devices.
        model: Engine file with these devices.
        targets: Quantities to cancel (keys of `TARGETS`); default: force and, if known, moment.

    Raises:
        BalcliError: A target does not exist, or the file lacks data for it.
    """
    refuse_geared(engine)
    chosen = _check_targets(engine, targets)
    named = list_to_fit(model)
    drifting = []
    for name, table in named:
        if isinstance(table, Shaft) and table.drifts:
            drifting.append(refuse_drifting(name, table, 'unbalance = "fit"'))
    if drifting:
        raise InputError(drifting)
    fitted: dict[str, DeviceTable] = {}
    notes: list[str] = []
    unknowns = rank = 0
    for order in dict.fromkeys(find_order(table) for _, table in named):
        tables = {name: table for name, table in named if find_order(table) == order}
        effects, target = _set_up(engine, order, tables.values(), chosen)
        solution = least_squares.solve(np.concatenate(effects, axis=1), target, lost=_LOST)
        unknowns = unknowns + len(solution.x)
        rank = rank + solution.rank
        x = np.where(np.abs(solution.x) < _ROUNDING * np.abs(solution.x).max(), 0, solution.x)
        largest = max(np.abs(effect).max() for effect in effects)
        for (name, table), effect in zip(tables.items(), effects, strict=True):
            values, x = np.split(x, [effect.shape[1]])
            fitted[name] = _fill(table, values)
            if np.abs(effect).max() <= _LOST * largest:
                notes.append(f"{name} has no effect on these targets: its unbalance is 0.")
            elif len(values) == 1 and values[0] < 0:
                notes.append(f"{name} is on the opposite side: its angle is turned by 180 deg.")
    if undetermined := unknowns - rank:
        are = "unknowns are" if undetermined > 1 else "unknown is"
        notes.insert(
            0,
            f"{undetermined} {are} not determined by these targets; the smallest unbalances are "
            "used.",
        )
    details = {"target": list(chosen), "unknowns": unknowns, "undetermined": undetermined}
    remedy = Remedy(FIT, note=" ".join(notes), details=details)
    in_order = [fitted[name] for name, _ in named]
    return remedy.add_devices(in_order, _REASON.format(join_words(chosen)))


def _check_targets(engine: Engine, targets: Sequence[str] | None) -> tuple[str, ...]:
    """Return the quantities to cancel, each once."""
    if targets is None:
        return ("force", "moment") if engine.places_known else ("force",)
    for target in targets:
        if target not in TARGETS:
            raise ArgumentError(
                '{target} "{name:.60}": choose from {known}', name=target, known=", ".join(TARGETS)
            )
    if "moment" in targets and not engine.places_known:
        raise ArgumentError("{target} moment: {unknown}", unknown=MOMENTS_UNKNOWN)
    if ROLL_TOTAL.name in targets and engine.gas is None:
        raise ArgumentError(
            "{target} {name}: the engine file {lacks}", name=ROLL_TOTAL.name, lacks=NO_GAS
        )
    return tuple(dict.fromkeys(targets))


def _set_up(
    engine: Engine, order: float, tables: Iterable[DeviceTable], targets: Sequence[str]
) -> tuple[list[Array], Array]:
    """Return the effect of each device of an order, shape (values, unknowns), and the values to
    cancel, shape (values,). Values are real and imaginary parts of the targets as shares of one
    cylinder's first order. A device has one unknown (its unbalance) if its angle is given, else
    two (real and imaginary part of the unbalance).
    """
    residual = find_residual(engine, order)
    scales = find_scales(engine)
    if not scales.force:
        raise BalcliError('"fit" needs reciprocating masses, because forces are compared with them')
    parts = []
    present = []
    weights = []
    for target in targets:
        scale = scales.roll if ROLL in TARGETS[target] else getattr(scales, target)
        for part in TARGETS[target]:
            value = residual.parts[part]
            if target == ROLL_TOTAL.name:
                phasors = compute_spectra(hold_steady(engine), [order], (target,))[target]
                value = 2 * complex(phasors.forward[0]) / residual.newtons_per_kg_m
            parts.append(part)
            present.append(value)
            weights += 2 * [residual.newtons_per_kg_m / scale]
    effects = []
    for table in tables:
        angles = (table.angle,) if "angle" in table.model_fields_set else (0.0, 90.0)
        devices = []
        for angle in angles:
            of_one_kg_m = table.model_copy(update={"unbalance": 1e6, "angle": angle})
            devices.append(build_fitted(of_one_kg_m, engine))
        of_device = find_effects(devices, parts, residual.reference)
        effects.append(np.array(weights)[:, None] * of_device)
    return effects, -np.array(weights) * np.array(present, complex).view(float)


def _fill(table: DeviceTable, values: Array) -> DeviceTable:
    """Return the table with a fitted unbalance (kg m). `values`: the unbalance if its angle is
    given, else its real and imaginary part.
    """
    if len(values) > 1:
        angle = measure_direction(complex(*values)) if values.any() else 0.0
        unbalance = float(np.hypot(*values))
    else:
        opposite = complex(unit(table.angle + 180))
        angle = measure_direction(opposite) if values[0] < 0 else table.angle
        unbalance = float(abs(values[0]))
    return table.model_copy(update={"unbalance": 1e6 * unbalance, "angle": angle})
