"""Single figures of the torsional vibration of an engine, for variants: `torsion.1.Hz`,
`shaft.flywheel.torque`, `shaft.flywheel.stress`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ..core.vibration import Real
from ..engine.build import Engine, build
from ..engine.variants import EngineVariants, Values, remember
from ..enginefile.model import EngineFile
from ..enginefile.read import change_figures
from ..errors import BalcliError
from ..forces.target_quantity import Subject, TargetQuantity, parse_target_quantity, refuse_stranger
from .build_engine import build_engine_system, excite_engine
from .largest import find_largest_torques
from .modes import find_natural_modes
from .motion import stress_by_torque
from .system import Excitation, TorsionalSystem

SLOWEST, FASTEST, SPEEDS = 0.5, 1.5, 101  # range of speeds, over the file's own, and how many
_SUBJECTS = {
    "torsion": Subject("1", {"Hz": "Hz"}),
    "shaft": Subject("flywheel", {"torque": "N·m", "stress": "Pa"}),
}


def parse_quantity(text: str) -> TargetQuantity:
    """`torsion.1.Hz` and its like; torque and stress of a shaft are the largest half of peak to
    peak over a range of speeds.

    Raises:
        BalcliError: anything else, with what there is.
    """
    found = parse_target_quantity(text, _SUBJECTS)
    number = found.target
    if found.kind == "torsion" and not (number.isascii() and number.isdigit() and int(number)):
        raise BalcliError(
            f"{text} is no quantity: after torsion comes the number of a mode, from 1"
        )
    return found


def list_names(model: EngineFile) -> Iterator[str]:
    """Those that a file has."""
    system = _build(model, build(model), None)
    yield from (f"torsion.{mode.number}.Hz" for mode in find_natural_modes(system))
    for shaft, section in zip(system.shafts, system.sections, strict=True):
        yield f"shaft.{shaft}.torque"
        if section is not None:
            yield f"shaft.{shaft}.stress"


def refuse_unknown(model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
    """Nothing, unless one of these is of a mode or shaft that the file does not have, or a stress
    of a shaft without diameter.

    Raises:
        BalcliError: the quantity, and what there is.
        InputError: what does not fit together in [torsion].
    """
    if model.torsion is None:
        raise BalcliError(
            f"{quantities[0].name}: the file has no [torsion]; balcli torsion --help says what it "
            "needs"
        )
    system = _build(model, build(model), None)
    modes = len(find_natural_modes(system))
    for q in quantities:
        if q.kind == "torsion" and int(q.target) > modes:
            raise BalcliError(f"{q.name}: there are {modes} modes")
        if q.kind == "shaft":
            refuse_stranger(q, system.shafts)
        if q.part == "stress" and system.sections[system.shafts.index(q.target)] is None:
            raise BalcliError(f"{q.name}: this shaft has no diameter, so its stress is not known")


class Variants:
    """Evaluates quantities of variants of a file one by one; what does not vary is computed once.

    Args:
        model: with [torsion].
    """

    def __init__(self, model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
        self._model, self._quantities = model, quantities
        self._engines = EngineVariants(model)
        self._excitations: dict[Values, Excitation] = {}

    def evaluate(self, values: Mapping[str, float]) -> list[float]:
        """The value of each quantity for one variant, by the figures that vary.

        Raises:
            InputError, BalcliError: it cannot be.
        """
        own = {path: value for path, value in values.items() if not path.startswith("torsion.")}
        engine = self._engines.build(own)
        key = tuple(own.items())
        excitation = remember(
            self._excitations, key, lambda: excite_engine(self._model, engine, None)
        )
        varied = change_figures(self._model, values, {"torsion"})
        system = _build(varied, engine, excitation)
        found: dict[TargetQuantity, float] = {}
        if of_modes := [q for q in self._quantities if q.kind == "torsion"]:
            modes = find_natural_modes(system)
            found |= {q: modes[int(q.target) - 1].frequency_hz for q in of_modes}
        if of_shafts := [q for q in self._quantities if q.kind == "shaft"]:
            found |= _find_largest(system, choose_torsion_speeds(engine), of_shafts)
        return [found[q] for q in self._quantities]


def _find_largest(
    system: TorsionalSystem, speeds: Real, quantities: list[TargetQuantity]
) -> dict[TargetQuantity, float]:
    """Torque and stress of shafts."""
    places = {q: system.shafts.index(q.target) for q in quantities}
    shafts = sorted(set(places.values()))
    _, torques = find_largest_torques(system, speeds, shafts)
    largest = dict(zip(shafts, map(float, torques), strict=True))
    by_torque = {"torque": np.ones(len(system.shafts)), "stress": stress_by_torque(system)}
    return {q: largest[shaft] * float(by_torque[q.part][shaft]) for q, shaft in places.items()}


def choose_torsion_speeds(engine: Engine) -> Real:
    """(speeds,) rpm, over which torque and stress of a shaft are largest: half to one and a half
    times the engine's own.
    """
    return np.asarray(np.linspace(SLOWEST, FASTEST, SPEEDS) * float(engine.speed_rpm))


def _build(model: EngineFile, engine: Engine, excitation: Excitation | None) -> TorsionalSystem:
    if excitation is None:
        excitation = excite_engine(model, engine, None)
    return build_engine_system(model, engine, excitation)
