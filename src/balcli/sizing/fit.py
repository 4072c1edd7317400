"""Devices that an engine file leaves open (`unbalance = "fit"`): their unbalances, together, by
least squares over the quantities to cancel.

Each order is solved by itself: a device is linear in its complex unbalance, and shakes at one order
alone. Residuals count in shares of one cylinder's first order, so that force, moment and roll can
stand next to each other.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..core import least_squares
from ..core.phasors import Array
from ..engine.devices import build_device
from ..engine.engine import Engine
from ..errors import MOMENTS_UNKNOWN, NO_GAS, BalcliError
from ..file.fields import join_words
from ..file.model import EngineFile
from ..forces.kinds import ROLL_TOTAL
from ..forces.spectrum import compute_spectra
from .fitting import find_effect
from .planes import TABLES, DeviceTable, find_order, measure_direction
from .remedy import Remedy
from .residual import (
    BACKWARD_FORCE,
    BACKWARD_MOMENT,
    FORWARD_FORCE,
    FORWARD_MOMENT,
    ROLL,
    Scales,
    find_residual,
    find_scales,
    hold_steady,
)
from .schemes import FIT

# Quantities that can be targets, and their parts; roll_total includes the gas.
TARGETS = {
    "force": (FORWARD_FORCE, BACKWARD_FORCE),
    "moment": (FORWARD_MOMENT, BACKWARD_MOMENT),
    "roll": (ROLL,),
    ROLL_TOTAL.name: (ROLL,),
}
_LOST = 1e-10  # of the largest singular value of an order: less determines nothing
_NOTHING = 1e-12  # of the largest unbalance of an order: less is rounding
_REASON = "Placed as in the file; smallest sum of squares of the remaining {} at its order"


class _Unknown(NamedTuple):
    """A device to fit: its name in messages, its table, and the columns of its real unknowns."""

    name: str
    table: DeviceTable
    held: bool
    columns: Array


def list_to_fit(model: EngineFile) -> list[tuple[str, DeviceTable]]:
    """Return the devices whose unbalance is "fit", with their names (`shaft.2`), in the order of
    the file.
    """
    return [
        (f"{key}.{number}", table)
        for key in TABLES
        for number, table in enumerate(getattr(model, key), 1)
        if table.to_fit
    ]


def remove_to_fit(model: EngineFile) -> EngineFile:
    """Return the file without the devices whose unbalance is "fit"."""
    rest = {
        key: tuple(table for table in getattr(model, key) if not table.to_fit) for key in TABLES
    }
    return model.model_copy(update=rest)


def size_fit(engine: Engine, model: EngineFile, targets: Sequence[str] | None = None) -> Remedy:
    """Find the unbalances of all devices of a file that are to be fitted.

    An angle that the file gives is held. Where the targets do not determine the unbalances, the
    smallest are taken.

    Args:
        engine: The engine without these devices.
        model: The file with them.
        targets: Quantities to cancel, of `TARGETS`; default: force and moment, as far as known.

    Raises:
        BalcliError: an unknown target, or one that the file does not determine.
    """
    chosen = _check_targets(engine, targets)
    scales, notes = find_scales(engine), []
    by_order: dict[int, list[tuple[str, DeviceTable]]] = {}
    for name, table in list_to_fit(model):
        by_order.setdefault(find_order(table), []).append((name, table))
    found: dict[str, DeviceTable] = {}
    unknowns = rank = 0
    for order, tables in by_order.items():
        matrix, target, devices = _set_up(engine, order, tables, chosen, scales)
        solution = least_squares.solve(matrix, target, lost=_LOST)
        unknowns, rank = unknowns + matrix.shape[1], rank + solution.rank
        x = np.where(np.abs(solution.x) < _NOTHING * np.abs(solution.x).max(), 0, solution.x)
        largest, at = np.abs(matrix).max(), 0
        for device in devices:
            values = x[at : at + device.columns.shape[1]]
            at += len(values)
            found[device.name] = _fill(device, values)
            if np.abs(device.columns).max() <= _LOST * largest:
                notes.append(f"{device.name} has no effect on these targets: its unbalance is 0.")
            elif device.held and values[0] < 0:
                notes.append(
                    f"{device.name} has to stand opposite: its angle is turned by 180 deg."
                )
    if undetermined := unknowns - rank:
        notes.insert(
            0,
            f"{undetermined} unknown{'s are' if undetermined > 1 else ' is'} not determined by "
            "these targets; the smallest weights are given.",
        )
    details = {"target": list(chosen), "unknowns": unknowns, "undetermined": undetermined}
    remedy = Remedy(FIT, note=" ".join(notes), details=details)
    fitted = [found[name] for name, _ in list_to_fit(model)]
    return remedy.add_devices(fitted, _REASON.format(join_words(chosen)))


def _check_targets(engine: Engine, targets: Sequence[str] | None) -> tuple[str, ...]:
    """Return the quantities to cancel, each once."""
    if targets is None:
        return ("force", "moment") if engine.places_known else ("force",)
    for target in targets:
        if target not in TARGETS:
            raise BalcliError(f'--target "{target:.60}": choose from {", ".join(TARGETS)}')
    if "moment" in targets and not engine.places_known:
        raise BalcliError(f"--target moment: {MOMENTS_UNKNOWN}")
    if ROLL_TOTAL.name in targets and engine.gas is None:
        raise BalcliError(f"--target {ROLL_TOTAL.name}: {NO_GAS}")
    return tuple(dict.fromkeys(targets))


def _set_up(
    engine: Engine,
    order: int,
    tables: Sequence[tuple[str, DeviceTable]],
    targets: Sequence[str],
    scales: Scales,
) -> tuple[Array, Array, list[_Unknown]]:
    """Return matrix and target of an order, in shares of one cylinder, and its devices."""
    residual, parts, there, weights = find_residual(engine, order), [], [], []
    for target in targets:
        scale = scales.roll if ROLL in TARGETS[target] else getattr(scales, target)
        for part in TARGETS[target]:
            value = residual.parts[part]
            if target == ROLL_TOTAL.name:
                phasors = compute_spectra(hold_steady(engine), [order], (target,))[target]
                value = 2 * complex(phasors.forward[0]) / residual.newtons_per_kg_m
            parts.append(part)
            there.append(value)
            weights.append(residual.newtons_per_kg_m / scale)
    devices = []
    for name, table in tables:
        held = "angle" in table.model_fields_set
        angles = (table.angle,) if held else (0.0, 90.0)
        columns = [
            np.array(weights)
            * find_effect(
                build_device(
                    table.model_copy(update={"unbalance": 1e6, "angle": angle}),
                    engine.first_axis_deg,
                ),
                parts,
                residual.reference,
            )
            for angle in angles
        ]
        devices.append(_Unknown(name, table, held, np.array(columns).view(float).T))
    matrix = np.concatenate([device.columns for device in devices], axis=1)
    return matrix, -(np.array(weights) * np.array(there, complex)).view(float), devices


def _fill(device: _Unknown, values: Array) -> DeviceTable:
    """Return the table with the unbalance found; values: kg m, one of a held angle, else two."""
    if device.held:
        turned = measure_direction(complex(np.exp(1j * np.radians(device.table.angle + 180))))
        angle = turned if values[0] < 0 else device.table.angle
    else:
        angle = measure_direction(complex(*values)) if values.any() else 0.0
    size = 1e6 * float(np.hypot(*values) if len(values) > 1 else abs(values[0]))
    return device.table.model_copy(update={"unbalance": size, "angle": angle})
