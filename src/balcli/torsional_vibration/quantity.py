"""Evaluate quantities of an engine's torsional vibration for `sweep`, `search` and `scatter`:
`torsion.1.Hz`, `torsion.misfit`, `shaft.flywheel.torque`, `shaft.flywheel.stress`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from ..core.vibration import Complex, Real
from ..engine.build import build
from ..engine.engine import Engine
from ..engine.load import EngineVariants, Values, choose_speeds, concerns_gas, remember
from ..errors import BalcliError
from ..file.model import EngineFile
from ..file.read import change_figures
from ..forces.quantity import TargetQuantity, refuse_stranger
from .build import build_engine_system, excite_cylinders, excite_engine, require_torsion
from .measured import MeasuredPoints, compare_measured, read_measured
from .modes import find_chain_modes
from .response import find_largest_of_each
from .system import Excitation, TorsionalSystem

MISFIT = "torsion.misfit"
_AT_ONCE = 32  # number of variants whose shafts are searched together; more save nothing


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


class _Variant(NamedTuple):
    """A variant of a file.

    Attributes:
        system: Torsional system.
        speeds: Speeds over which the largest load of a shaft is found, rpm.
        measured: Measured curve with which the system is compared; None: it is not compared.
    """

    system: TorsionalSystem
    speeds: Real
    measured: MeasuredPoints | None


class Variants:
    """Evaluator of quantities for variants of a file. Results that do not change from variant to
    variant are computed once.

    Args:
        model: Engine file with [torsion].
    """

    def __init__(self, model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
        self._model = model
        self._quantities = quantities
        self._engines = EngineVariants(model)
        self._excitations: dict[Values, Excitation] = {}
        self._gas_torques: dict[Values, Complex] = {}
        self._measured: dict[Values, MeasuredPoints | None] = {}
        self._names = {q.name for q in quantities}

    def evaluate(self, values: Mapping[str, float]) -> list[float]:
        """Return the value of each quantity for one variant; `values` are its varied figures by
        path.

        Raises:
            InputError, BalcliError: The variant is impossible.
        """
        return self._evaluate([self._build(values)])[0]

    def joins(self, different: Collection[str], varied: Collection[str]) -> bool:
        """Return whether variants that differ only in some figures are computed together; see
        `studies.quantities.JointVariants`. All figures are such figures.
        """
        return True

    def evaluate_jointly(self, variants: Sequence[Mapping[str, float]]) -> dict[int, list[float]]:
        """Return the value of each quantity for the variants that are possible, by their places in
        `variants`.
        """
        built: dict[int, _Variant] = {}
        for place, values in enumerate(variants):
            with suppress(BalcliError):
                built[place] = self._build(values)
        rows = dict[int, list[float]]()
        places = list(built)
        for start in range(0, len(places), _AT_ONCE):
            some = places[start : start + _AT_ONCE]
            with suppress(BalcliError):  # the variant that is impossible is not known
                of_some = self._evaluate([built[place] for place in some])
                rows |= dict(zip(some, of_some, strict=True))
        return rows

    def _build(self, values: Mapping[str, float]) -> _Variant:
        own = {path: value for path, value in values.items() if not path.startswith("torsion.")}
        engine = self._engines.build(own)
        excitation = remember(
            self._excitations, tuple(own.items()), lambda: self._excite(engine, own)
        )
        varied = change_figures(self._model, values, {"torsion", "bearing"})
        system = build_engine_system(varied, engine, excitation)
        points = None
        if MISFIT in self._names:
            points = remember(
                self._measured, tuple(own.items()), lambda: read_measured(self._model, engine)
            )
        return _Variant(system, choose_speeds(engine, values, choose_torsion_speeds), points)

    def _excite(self, engine: Engine, own: Mapping[str, float]) -> Excitation:
        """Return the torques of the cylinders of a variant; `own` are its varied figures."""
        figures = own.items()
        of_gas = tuple(each for each in figures if concerns_gas(each[0], self._model.gas))
        known = self._gas_torques.get(of_gas)
        excitation = excite_cylinders(self._model, engine, None, known)
        remember(self._gas_torques, of_gas, lambda: excitation.steady)
        return excitation.without_idle_orders()

    def _evaluate(self, variants: Sequence[_Variant]) -> list[list[float]]:
        """Return the value of each quantity for each variant."""
        systems = [variant.system for variant in variants]
        shafts = [q.target for q in self._quantities if q.kind == "shaft"]
        of_shafts: Sequence[dict[str, float]] = [{}] * len(variants)
        if shafts:
            weights = np.isin(systems[0].shafts, shafts).astype(float)
            speeds = [variant.speeds for variant in variants]
            largest = find_largest_of_each(systems, speeds, weights)
            torques = [values for _, values in largest]
            of_shafts = list(map(_name_loads, systems, torques))
        rows = []
        for variant, figures in zip(variants, of_shafts, strict=True):
            known = figures | self._find_figures(variant)
            rows.append([float(known[q.name]) for q in self._quantities])
        return rows

    def _find_figures(self, variant: _Variant) -> dict[str, float]:
        """Return natural frequencies and the misfit of a variant by name, if they are asked for."""
        figures = dict[str, float]()
        if any(q.kind == "torsion" for q in self._quantities):
            hertz = _find_frequencies(variant.system)
            figures |= {f"torsion.{k}.Hz": each for k, each in enumerate(hertz.tolist(), 1)}
        if variant.measured is not None:
            figures[MISFIT] = compare_measured(variant.system, variant.measured).rms_deg
        return figures


def _name_loads(system: TorsionalSystem, torques: Real) -> dict[str, float]:
    """Return torques (N m) and stresses (Pa) of shafts by name."""
    figures = dict[str, float]()
    for shaft, torque, stress in zip(system.shafts, torques, system.stress_by_torque, strict=False):
        figures[f"shaft.{shaft}.torque"] = torque
        figures[f"shaft.{shaft}.stress"] = torque * stress
    return figures


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
