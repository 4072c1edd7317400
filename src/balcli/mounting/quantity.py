"""Single figures of an engine on its mounts, for variants: `mode.3.Hz`, `mode.roll.share`,
`mount.left.force`, `point.lever.motion`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ..core.speeds import RPM
from ..engine.arrays import find_first_largest
from ..engine.variants import EngineVariants
from ..enginefile.model import EngineFile, label_table
from ..enginefile.read import change_figures
from ..errors import BalcliError
from ..forces.target_quantity import Subject, TargetQuantity, parse_target_quantity, refuse_stranger
from .build import build_mounted_body
from .modes import BodyModes, find_mounted_modes
from .motions import AXES, ROLL
from .report import choose_mount_speeds
from .response import LargestAmplitude, find_largest_amplitudes, find_loads

_SUBJECTS = {
    "mode": Subject("3", {"Hz": "Hz", "share": "%", "damping": "%"}),
    "mount": Subject("left", {"force": "N", "static": "N"}),
    "point": Subject("lever", {"motion": "m"}),
}
_MOTIONS = {axis: k for k, axis in enumerate(AXES)} | {"roll": ROLL}
_NUMBERS = tuple("123456")
_TABLES = ("body", "mount", "point")  # of the file, which no engine has
_RUNS = ("force", "motion")  # what takes an engine that runs


def parse_quantity(text: str) -> TargetQuantity:
    """`mode.3.Hz` and its like; of a mode, its number, or the motion of which it has the largest
    share.

    Raises:
        BalcliError: anything else, with what there is.
    """
    found = parse_target_quantity(text, _SUBJECTS)
    if found.kind == "mode" and found.target not in (*_MOTIONS, *_NUMBERS):
        raise BalcliError(
            f"{text} is no quantity: after mode comes its number from 1 to 6, or its motion: "
            f"{', '.join(_MOTIONS)}"
        )
    return found


def list_names(model: EngineFile) -> Iterator[str]:
    """Those that a file has."""
    named = _name_targets(model) | {"mode": [*_NUMBERS, *_MOTIONS]}
    for kind, subject in _SUBJECTS.items():
        yield from (f"{kind}.{target}.{part}" for target in named[kind] for part in subject.units)


def _name_targets(model: EngineFile) -> dict[str, list[str]]:
    return {
        "mount": [label_table(table, k) for k, table in enumerate(model.mount, 1)],
        "point": [label_table(table, k) for k, table in enumerate(model.point, 1)],
    }


def refuse_unknown(model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
    """Nothing, unless one of these is of a mount or point that the file does not have, or it has no
    body on mounts.

    Raises:
        BalcliError: the quantity, and the nearest name.
    """
    if model.body is None or not model.mount:
        raise BalcliError(
            f"{quantities[0].name}: the file has no [body] on a [[mount]]; balcli mounts --help "
            "says what it needs"
        )
    names = _name_targets(model)
    for q in quantities:
        if q.kind in names:
            refuse_stranger(q, names[q.kind])


class Variants:
    """Evaluates quantities of variants of a file one by one; what does not vary is computed once.

    Args:
        model: with [body] and [[mount]].
    """

    def __init__(self, model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
        self._model, self._quantities = model, quantities
        self._runs = any(q.part in _RUNS for q in quantities)
        # The mean torque of the gas, less friction, leans on the mounts at rest.
        self._leans = model.gas is not None and any(q.part == "static" for q in quantities)
        self._engines, self._targets = EngineVariants(model), _name_targets(model)

    def evaluate(self, values: Mapping[str, float]) -> list[float]:
        """The value of each quantity for one variant, by the figures that vary.

        Raises:
            InputError, BalcliError: it cannot be.
        """
        mounted = build_mounted_body(change_figures(self._model, values, _TABLES))
        if not (self._runs or self._leans):
            modes = find_mounted_modes(mounted)
            return [self._read(q, modes, {}) for q in self._quantities]
        own = {
            path: value for path, value in values.items() if path.partition(".")[0] not in _TABLES
        }
        engine = self._engines.build(own)
        loads = find_loads(engine, mounted.body.centre)
        modes = find_mounted_modes(mounted, loads.mean)
        largest: Mapping[int, LargestAmplitude] = {}
        if self._runs:
            omega = choose_mount_speeds(engine) * RPM
            curves = sorted({self._number(q) for q in self._quantities if q.part in _RUNS})
            found = find_largest_amplitudes(mounted, modes, loads, omega, curves)
            largest = dict(zip(curves, found, strict=True))
        return [self._read(q, modes, largest) for q in self._quantities]

    def _read(
        self, q: TargetQuantity, modes: BodyModes, largest: Mapping[int, LargestAmplitude]
    ) -> float:
        """Return the value of a quantity; `largest` holds the curves by `_number`."""
        if q.kind == "mode":
            return _read_mode(modes, q)
        if q.part == "static":
            return float(np.linalg.norm(modes.settled.forces[self._number(q)]))
        return largest[self._number(q)].value

    def _number(self, q: TargetQuantity) -> int:
        """Return the number of a mount, or of a point after all mounts."""
        first = 0 if q.kind == "mount" else len(self._targets["mount"])
        return first + self._targets[q.kind].index(q.target)


def _read_mode(modes: BodyModes, q: TargetQuantity) -> float:
    if q.target in _MOTIONS:
        motion = _MOTIONS[q.target]
        mode = max(modes.six, key=lambda one: one.shares[motion])
    else:
        mode = modes.six[int(q.target) - 1]
        motion = int(find_first_largest(mode.shares))
    if q.part == "Hz":
        return mode.hertz
    return float(100 * mode.shares[motion] if q.part == "share" else 50 * mode.loss)
