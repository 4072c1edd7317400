"""Evaluate quantities of an engine on its mounts for `sweep`, `search` and `scatter`:
`mode.3.Hz`, `mode.roll.share`, `mount.left.force`, `point.lever.motion`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ..core.phases import RPM
from ..engine.load import EngineVariants, choose_speeds
from ..errors import BalcliError
from ..file.model import EngineFile
from ..file.read import change_figures
from ..file.table import label_table
from ..forces.quantity import TargetQuantity, refuse_stranger
from .answer import choose_mount_speeds
from .build import BodyMode, build_mounted_body, find_mounted_modes, settle
from .loads import find_loads
from .response import RunningBody, find_worst
from .rigid_body import AXES

_PARTS = {"mode": ("Hz", "share", "damping"), "mount": ("force", "static"), "point": ("motion",)}
_MOTIONS = (*AXES, "roll")
_MODES = (*"123456", *_MOTIONS)
_TABLES = ("body", "mount", "point")  # tables of the file that do not change the engine


def list_names(model: EngineFile) -> Iterator[str]:
    """Yield the names of all quantities that a file has."""
    for kind, targets in _name_targets(model).items():
        yield from (f"{kind}.{target}.{part}" for target in targets for part in _PARTS[kind])


def _name_targets(model: EngineFile) -> dict[str, list[str]]:
    return {
        "mode": [*_MODES],
        "mount": [label_table(table, k) for k, table in enumerate(model.mount, 1)],
        "point": [label_table(table, k) for k, table in enumerate(model.point, 1)],
    }


def refuse_unknown(model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
    """Raise BalcliError if a quantity names a mount or point that the file does not have, or if the
    file has no body on mounts.
    """
    if model.body is None or not model.mount:
        lacking = "the file has no [body] on a [[mount]]; give both"
        raise BalcliError(f"{quantities[0].name}: {lacking}")
    for q in quantities:
        refuse_stranger(q, _name_targets(model)[q.kind])


class Variants:
    """Evaluator of quantities for variants of a file, one after the other. Results that are the
    same for all variants are computed once.

    Args:
        model: File with [body] and [[mount]].
        quantities: Quantities to evaluate.
    """

    def __init__(self, model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
        self._model = model
        self._quantities = quantities
        targets = _name_targets(model)
        places = [(kind, name) for kind in ("mount", "point") for name in targets[kind]]
        self._place = {q: places.index((q.kind, q.target)) for q in quantities if q.kind != "mode"}
        self._curves = sorted({self._place[q] for q in quantities if q.part in ("force", "motion")})
        # Whether forces at rest are requested, which depend on the mean torque of the gas.
        self._leans = model.has_gas and any(q.part == "static" for q in quantities)
        self._engines = EngineVariants(model)

    def evaluate(self, values: Mapping[str, float]) -> list[float]:
        """Return the value of each quantity for one variant; `values` are its varied figures by
        path.

        Raises:
            InputError, BalcliError: No engine can have these figures.
        """
        mounted = build_mounted_body(change_figures(self._model, values, _TABLES))
        modes = find_mounted_modes(mounted)
        mean = 0.0
        largest = np.zeros(len(mounted.names) + len(mounted.points))  # N, mm
        if self._curves or self._leans:
            own = {k: v for k, v in values.items() if k.partition(".")[0] not in _TABLES}
            engine = self._engines.build(own)
        if self._curves:
            omega = choose_speeds(engine, values, choose_mount_speeds) * RPM
            running = RunningBody.choose(mounted, modes, engine, omega)
            running.refuse_resonance(omega)
            mean = running.loads.mean
            running = running._replace(couplings=running.couplings[self._curves])
            _, largest[self._curves] = find_worst(running, omega, running.find_peaks(omega))
            largest[len(mounted.names) :] *= 1e3
        elif self._leans:
            mean = find_loads(engine, mounted.body.centre).mean
        rest = np.linalg.norm(settle(mounted, mean)[0], axis=-1)
        values_found = []
        for quantity in self._quantities:
            if quantity.kind == "mode":
                values_found.append(_read_mode(modes.each, quantity))
            elif quantity.part == "static":
                values_found.append(float(rest[self._place[quantity]]))
            else:
                values_found.append(float(largest[self._place[quantity]]))
        return values_found


def _read_mode(modes: Sequence[BodyMode], q: TargetQuantity) -> float:
    if q.target in _MOTIONS:
        axis = "rz" if q.target == "roll" else q.target
        mode = max(modes, key=lambda mode: mode.energy_percent[axis])
        share = mode.energy_percent[axis]
    else:
        mode = modes[int(q.target) - 1]
        share = max(mode.energy_percent.values())
    return {"Hz": mode.frequency_Hz, "share": share, "damping": 50 * mode.loss_factor}[q.part]
