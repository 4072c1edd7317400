"""Single figures of the torsional vibration of an engine, for variants: `torsion.1.Hz`,
`shaft.flywheel.torque`, `shaft.flywheel.stress`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.singular_values import Real
from ..engine.build import Engine, build
from ..enginefile.fields import nearest, shorten
from ..enginefile.model import EngineFile, Table
from ..errors import BalcliError
from .build_engine import build_engine_system, excite_engine
from .modes import find_natural_modes
from .response import Response, find_response
from .system import Excitation, TorsionalSystem

BEGINNINGS = ("torsion", "shaft")
SLOWEST, FASTEST, SPEEDS = 0.5, 1.5, 101  # range of speeds, over the file's own, and how many
_UNITS = {"Hz": "Hz", "torque": "N·m", "stress": "Pa"}
_EXAMPLES = "torsion.1.Hz, shaft.flywheel.torque or shaft.flywheel.stress"


@dataclass(frozen=True)
class TorsionQuantity:
    """One figure.

    Attributes:
        target: number of the mode, or name of the shaft.
        part: Hz; or torque or stress, the largest half of peak to peak over a range of speeds.
    """

    target: str
    part: str

    @property
    def name(self) -> str:
        """As a user writes it."""
        return f"{'torsion' if self.part == 'Hz' else 'shaft'}.{self.target}.{self.part}"

    @property
    def unit(self) -> str:
        """SI."""
        return _UNITS[self.part]


def parse_torsion_quantity(text: str) -> TorsionQuantity:
    """`torsion.1.Hz` and its like.

    Raises:
        BalcliError: anything else, with what there is.
    """
    kind, _, rest = text.partition(".")
    target, _, part = rest.rpartition(".")
    parts = {"torsion": ("Hz",), "shaft": ("torque", "stress")}[kind]
    counted = kind == "shaft" or (target.isascii() and target.isdigit() and int(target) > 0)
    if part not in parts or not target or not counted:
        raise BalcliError(f"{text} is no quantity: give {_EXAMPLES}")
    return TorsionQuantity(target, part)


def refuse_unknown_shafts(model: EngineFile, quantities: Sequence[TorsionQuantity]) -> None:
    """Nothing, unless one of these is of a mode or shaft that the file does not have, or a stress
    of a shaft without diameter.

    Raises:
        BalcliError: the quantity, and what there is.
        InputError: what does not fit together in [torsion].
    """
    system = _build(model, build(model), None)
    modes = len(find_natural_modes(system))
    for q in quantities:
        if q.part == "Hz":
            if int(q.target) > modes:
                raise BalcliError(f"{q.name}: there are {modes} modes")
            continue
        if q.target not in system.shafts:
            near = nearest(q.target, system.shafts)
            hint = f"did you mean {near}?" if near else f"there are {', '.join(system.shafts[:8])}"
            raise BalcliError(f"{q.name}: there is no shaft {shorten(q.target)}; {hint}")
        if q.part == "stress" and system.sections[system.shafts.index(q.target)] is None:
            raise BalcliError(f"{q.name}: this shaft has no diameter, so its stress is not known")


def vary_torsion(model: EngineFile, values: Mapping[str, float]) -> EngineFile:
    """The file with other figures of [torsion], by dotted name (`torsion.rear.1.stiffness`); all
    others are left alone.
    """
    torsion: Any = model.torsion
    for path, value in values.items():
        first, *rest = path.split(".")
        if first == "torsion":
            torsion = _change(torsion, rest, value)
    return model.model_copy(update={"torsion": torsion})


def _change(whole: Any, keys: Sequence[str], value: float) -> Any:
    """A table or list with another figure in it."""
    if not keys:
        return value
    first, *rest = keys
    if isinstance(whole, Table):
        return whole.model_copy(update={first: _change(getattr(whole, first), rest, value)})
    members = list(whole)
    members[int(first) - 1] = _change(members[int(first) - 1], rest, value)
    return tuple(members)


class TorsionVariants:
    """Evaluates quantities of variants of a file one by one; what does not vary is computed once.

    Args:
        model: with [torsion].
    """

    def __init__(self, model: EngineFile, quantities: Sequence[TorsionQuantity]) -> None:
        self._model, self._quantities = model, quantities
        self._runs = any(q.part != "Hz" for q in quantities)
        self._known: dict[tuple[tuple[str, float], ...], tuple[Engine, Excitation]] = {}

    def evaluate(self, values: Mapping[str, float]) -> list[float]:
        """The value of each quantity for one variant, by the figures that vary.

        Raises:
            InputError, BalcliError: it cannot be.
        """
        engine, excitation = self._build_engine(values)
        model = vary_torsion(self._model, values)
        system = _build(model, engine, excitation)
        modes = find_natural_modes(system)
        response = None
        if self._runs:
            response = find_response(system, excitation, choose_speeds(engine))
        return [
            _read(system, [mode.frequency_hz for mode in modes], response, q)
            for q in self._quantities
        ]

    def _build_engine(self, values: Mapping[str, float]) -> tuple[Engine, Excitation]:
        own = {k: value for k, value in values.items() if not k.startswith("torsion.")}
        if own and self._runs and self._model.gas is not None:
            raise BalcliError(
                "with [gas], torque of shafts is told only while figures of [torsion] vary, not "
                f"{next(iter(own))}"
            )
        key = tuple(own.items())
        if key not in self._known:
            engine = build(self._model, own or None)
            self._known = {key: (engine, excite_engine(self._model, engine, None))}
        return self._known[key]


def choose_speeds(engine: Engine) -> Real:
    """(speeds,) rpm, over which torque and stress of a shaft are largest: half to one and a half
    times the engine's own.
    """
    return np.asarray(np.linspace(SLOWEST, FASTEST, SPEEDS) * float(engine.speed_rpm))


def _build(model: EngineFile, engine: Engine, excitation: Excitation | None) -> TorsionalSystem:
    if model.torsion is None:
        raise BalcliError("has no [torsion]; balcli torsion --help says what it needs")
    if excitation is None:
        excitation = excite_engine(model, engine, None)
    return build_engine_system(model, engine, excitation)


def _read(
    system: TorsionalSystem, hertz: Sequence[float], response: Response | None, q: TorsionQuantity
) -> float:
    if q.part == "Hz" or response is None:
        return hertz[int(q.target) - 1]
    found = response.torque if q.part == "torque" else response.stress
    return float(found[:, system.shafts.index(q.target)].max())
