"""Single figures of an engine on its mounts, for variants: `mode.3.Hz`, `mode.roll.share`,
`mount.left.force`, `point.lever.motion`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..core.cycle_peaks import find_longest
from ..core.rigid_body import move_points, respond_body
from ..core.singular_values import Real
from ..core.vibration import frequencies
from ..engine.build import Engine, build
from ..enginefile.fields import nearest, shorten
from ..enginefile.model import EngineFile, Table, label_table
from ..enginefile.mounting_tables import Body, find_tensor_faults
from ..errors import BalcliError, InputError, Problem
from .build import MountedBody, build_mounted_body
from .modes import BodyModes, find_mounted_modes
from .report import choose_speeds
from .response import Loads, find_loads, refuse_resonance

BEGINNINGS = ("mode", "mount", "point")
_OF_MODES = {"Hz": "Hz", "share": "%", "damping": "%"}
_OF_MOUNTS = {"force": "N", "static": "N"}
_OF_POINTS = {"motion": "m"}
_PARTS = {"mode": _OF_MODES, "mount": _OF_MOUNTS, "point": _OF_POINTS}
_MOTIONS = {"x": 0, "y": 1, "z": 2, "rx": 3, "ry": 4, "rz": 5, "roll": 5}
_RUNS = {"mount.force", "point.motion"}  # what needs an engine


@dataclass(frozen=True)
class MountQuantity:
    """One figure.

    Attributes:
        kind: one of BEGINNINGS.
        target: number of the mode (`3`), or of which motion it has the largest share (`roll`);
            name of the mount or point.
        part: what of it.
    """

    kind: str
    target: str
    part: str

    @property
    def name(self) -> str:
        """As a user writes it."""
        return f"{self.kind}.{self.target}.{self.part}"

    @property
    def unit(self) -> str:
        """Of its values: SI, or percent."""
        return _PARTS[self.kind][self.part]

    @property
    def of_running_engine(self) -> bool:
        """Whether it takes an engine that runs."""
        return f"{self.kind}.{self.part}" in _RUNS


def parse_mount_quantity(text: str) -> MountQuantity:
    """`mode.3.Hz` and its like.

    Raises:
        BalcliError: anything else, with what there is.
    """
    kind, _, rest = text.partition(".")
    target, _, part = rest.rpartition(".")
    parts = _PARTS[kind]
    if part not in parts or not target:
        example = {"mode": "3", "mount": "left", "point": "lever"}[kind]
        there = " or ".join(f"{kind}.{example}.{each}" for each in parts)
        raise BalcliError(f"{text} is no quantity: give {there}")
    if kind == "mode" and target not in _MOTIONS and target not in tuple("123456"):
        raise BalcliError(
            f"{text} is no quantity: after mode comes its number from 1 to 6, or its motion: "
            f"{', '.join(_MOTIONS)}"
        )
    return MountQuantity(kind, target, part)


def refuse_unknown_targets(model: EngineFile, quantities: Sequence[MountQuantity]) -> None:
    """Nothing, unless one of these is of a mount or point that the file does not have.

    Raises:
        BalcliError: the quantity, and the nearest name.
    """
    names = {
        "mount": [label_table(table, k) for k, table in enumerate(model.mount, 1)],
        "point": [label_table(table, k) for k, table in enumerate(model.point, 1)],
    }
    for q in quantities:
        there = names.get(q.kind)
        if there is not None and q.target not in there:
            near = nearest(q.target, there)
            hint = f"did you mean {near}?" if near else f"there are {', '.join(there[:8])}"
            raise BalcliError(f"{q.name}: the file has no {q.kind} {shorten(q.target)}; {hint}")


def vary_mounting(model: EngineFile, values: Mapping[str, float]) -> EngineFile:
    """The file with other figures of body, mounts and points, by dotted name
    (`mount.left.stiffness.2`, `body.mass`); all others are left alone.

    Raises:
        InputError: an inertia tensor that no body has.
    """
    tables = dict(model.tables())
    changed: dict[str, Table] = {}
    for path, value in values.items():
        start = next((s for s in tables if path.startswith(f"{s}.")), "")
        if start.partition(".")[0] in ("body", "mount", "point"):
            table = changed.get(start, tables[start])
            changed[start] = _change(table, path[len(start) + 1 :], value)
    body = changed.get("body", model.body)
    if isinstance(body, Body) and (faults := list(find_tensor_faults(body.inertia))):
        raise InputError([Problem("body", fault) for fault in faults])
    rows = {
        key: tuple(
            changed.get(f"{key}.{label_table(table, k)}", table)
            for k, table in enumerate(getattr(model, key), 1)
        )
        for key in ("mount", "point")
    }
    return model.model_copy(update={"body": body, **rows})


def _change(table: Table, key: str, value: float) -> Table:
    """With another figure: `mass`, or one of a list (`stiffness.2`)."""
    name, _, number = key.partition(".")
    if not number:
        return table.model_copy(update={name: value})
    figures = list(getattr(table, name))
    figures[int(number) - 1] = value
    return table.model_copy(update={name: tuple(figures)})


class MountedVariants:
    """Evaluates quantities of variants of a file one by one; what does not vary is computed once.

    Args:
        model: with [body] and [[mount]].
    """

    def __init__(self, model: EngineFile, quantities: Sequence[MountQuantity]) -> None:
        self._model, self._quantities = model, quantities
        self._runs = any(q.of_running_engine for q in quantities)
        self._engines: dict[tuple[tuple[str, float], ...], Engine] = {}

    def evaluate(self, values: Mapping[str, float]) -> list[float]:
        """The value of each quantity for one variant, by the figures that vary.

        Raises:
            InputError, BalcliError: it cannot be.
        """
        model = vary_mounting(self._model, values)
        mounted = build_mounted_body(model)
        modes = find_mounted_modes(mounted)
        forces: Real = np.zeros(0)
        motions: Real = np.zeros(0)
        if self._runs:
            engine = self._build_engine(values)
            loads = find_loads(engine, mounted.body.centre)
            modes = find_mounted_modes(mounted, loads.mean)
            forces, motions = _find_peaks(mounted, modes, loads, choose_speeds(engine))
        labels = {
            "mount": [label_table(table, k) for k, table in enumerate(model.mount, 1)],
            "point": [label_table(table, k) for k, table in enumerate(model.point, 1)],
        }
        found = []
        for q in self._quantities:
            if q.kind == "mode":
                found.append(_read_mode(modes, q))
                continue
            k = labels[q.kind].index(q.target)
            if q.part == "static":
                found.append(float(np.linalg.norm(modes.settled.forces[k])))
            else:
                found.append(float((forces if q.kind == "mount" else motions)[k]))
        return found

    def _build_engine(self, values: Mapping[str, float]) -> Engine:
        own = {
            path: value
            for path, value in values.items()
            if path.partition(".")[0] not in ("body", "mount", "point")
        }
        if own and self._model.gas is not None:
            raise BalcliError(
                "with [gas], forces of mounts are told only while figures of body, mounts and "
                f"points vary, not {next(iter(own))}"
            )
        key = tuple(own.items())
        if key not in self._engines:
            self._engines = {key: build(self._model, own or None)}
        return self._engines[key]


def _read_mode(modes: BodyModes, q: MountQuantity) -> float:
    if q.target in _MOTIONS:
        motion = _MOTIONS[q.target]
        mode = max(modes.six, key=lambda one: one.shares[motion])
    else:
        mode = modes.six[int(q.target) - 1]
        motion = int(np.argmax(mode.shares))
    if q.part == "Hz":
        return mode.hertz
    return float(100 * mode.shares[motion] if q.part == "share" else 50 * mode.loss)


def _find_peaks(
    mounted: MountedBody, modes: BodyModes, loads: Loads, speeds_rpm: Real
) -> tuple[Real, Real]:
    """Largest force of each mount and motion of each point over a range of speeds."""
    omega = speeds_rpm * (np.pi / 30)
    refuse_resonance(modes, loads, omega)
    w = frequencies(loads.orders, omega)
    found = respond_body(mounted.body, mounted.dynamic, w, loads.at(omega))
    moved = move_points(mounted.points, mounted.body.centre, found.motion)
    forces = find_longest(loads.orders, found.forces).value.max(axis=0)
    motions = find_longest(loads.orders, moved).value.max(axis=0, initial=0.0)
    return forces, motions
