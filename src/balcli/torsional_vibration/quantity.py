"""Evaluate quantities of an engine's torsional vibration for `sweep`, `search` and `scatter`:
`torsion.1.Hz`, `torsion.misfit`, `shaft.flywheel.torque`, `shaft.flywheel.stress`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ..core.vibration import Real
from ..engine.build import build
from ..engine.engine import Engine
from ..engine.load import EngineVariants, Values, choose_speeds, remember
from ..errors import BalcliError
from ..file.model import EngineFile
from ..file.read import change_figures
from ..forces.quantity import TargetQuantity, refuse_stranger
from .build import build_engine_system, excite_engine, require_torsion
from .measured import MeasuredPoints, compare_measured, read_measured
from .modes import find_chain_modes
from .response import find_largest
from .system import Excitation, TorsionalSystem

MISFIT = "torsion.misfit"


def list_names(model: EngineFile) -> Iterator[str]:
    """Yield the names of the quantities that a file has."""
    system = _build(model)
    yield from (f"torsion.{number}.Hz" for number, _ in enumerate(_find_frequencies(system), 1))
    if model.torsion is not None and model.torsion.measured is not None:
        yield MISFIT
    for shaft, stress in zip(system.shafts, system.stress_by_torque, strict=True):
        yield f"shaft.{shaft}.torque"
        if stress:
            yield f"shaft.{shaft}.stress"


def refuse_unknown(model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
    """Check that the file has the mode or shaft of each quantity, and a diameter for each stress.

    Raises:
        BalcliError: The quantity does not exist; the error lists those that do.
        InputError: [torsion] contradicts itself.
    """
    require_torsion(model, quantities[0].name)
    system = _build(model)
    modes = [str(number) for number, _ in enumerate(_find_frequencies(system), 1)]
    for q in quantities:
        if q.name == MISFIT:
            _require_measured(model)
        elif q.kind == "torsion" and q.target not in modes:
            raise BalcliError(f"{q.name}: the file has {len(modes)} modes")
        if q.kind == "shaft":
            refuse_stranger(q, system.shafts)
        if q.part == "stress" and not system.stress_by_torque[system.shafts.index(q.target)]:
            raise BalcliError(f"{q.name}: this shaft has no diameter, so its stress is not known")


def _require_measured(model: EngineFile) -> None:
    if model.torsion is None or model.torsion.measured is None:
        raise BalcliError(
            f"{MISFIT}: the file has no measured curve; name its file in torsion.measured"
        )


class Variants:
    """Evaluator of quantities, one variant of a file after the other. Results that do not change
    from variant to variant are computed once.

    Args:
        model: Engine file with [torsion].
    """

    def __init__(self, model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
        self._model = model
        self._quantities = quantities
        self._engines = EngineVariants(model)
        self._excitations: dict[Values, Excitation] = {}
        self._measured: dict[Values, MeasuredPoints | None] = {}
        self._names = {q.name for q in quantities}

    def evaluate(self, values: Mapping[str, float]) -> list[float]:
        """Return the value of each quantity for one variant; `values` are its varied figures by
        path.

        Raises:
            InputError, BalcliError: The variant is impossible.
        """
        own = {path: value for path, value in values.items() if not path.startswith("torsion.")}
        engine = self._engines.build(own)
        excitation = remember(
            self._excitations, tuple(own.items()), lambda: excite_engine(self._model, engine, None)
        )
        varied = change_figures(self._model, values, {"torsion", "bearing"})
        system = build_engine_system(varied, engine, excitation)
        figures = dict[str, float]()
        if any(q.kind == "torsion" for q in self._quantities):
            hertz = _find_frequencies(system)
            figures |= {f"torsion.{k}.Hz": each for k, each in enumerate(hertz.tolist(), 1)}
        if MISFIT in self._names:
            points = remember(
                self._measured, tuple(own.items()), lambda: read_measured(self._model, engine)
            )
            if points is not None:
                figures[MISFIT] = compare_measured(system, points).rms_deg
        looked_at = [q.target for q in self._quantities if q.kind == "shaft"]
        if looked_at:
            speeds = choose_speeds(engine, values, choose_torsion_speeds)
            weights = np.isin(system.shafts, looked_at).astype(float)
            _, torques = find_largest(system, speeds, weights)
            of_shafts = zip(system.shafts, torques, system.stress_by_torque, strict=False)
            for shaft, torque, stress in of_shafts:
                figures |= {
                    f"shaft.{shaft}.torque": torque,
                    f"shaft.{shaft}.stress": torque * stress,
                }
        return [float(figures[q.name]) for q in self._quantities]


def _find_frequencies(system: TorsionalSystem) -> Real:
    """Return the natural frequencies of the modes in which shafts twist, Hz, lowest first."""
    modes = find_chain_modes(system.chain)
    return np.asarray(modes.omega[modes.rigid :] / (2 * np.pi))


def choose_torsion_speeds(engine: Engine) -> Real:
    """Return the speeds (speeds,), rpm, over which the largest torque and stress of a shaft are
    found: 0.5 to 1.5 times the engine's speed.
    """
    return np.asarray(np.linspace(0.5, 1.5, 101) * float(engine.speed_rpm))


def _build(model: EngineFile) -> TorsionalSystem:
    engine = build(model)
    return build_engine_system(model, engine, excite_engine(model, engine, None))
