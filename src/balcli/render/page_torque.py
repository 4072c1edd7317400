"""What the page needs to run torque and pressure with the crank, in the reader's units."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ..core.phasors import Array
from ..engine.build import Engine
from ..forces.gas import take_gas
from ..torque.course import find_torque_curves
from .units import System

_STEP = 2.0  # deg


def running(engine: Engine, system: System) -> dict[str, Any]:
    """Return curves over one cycle at even crank angles, each with its name and unit."""
    gas, curves = take_gas(engine), find_torque_curves(replace(engine, ripple=()))
    at = np.radians(np.arange(0.0, gas.cycle_deg + _STEP / 2, _STEP))
    total = curves.total.at(at)
    unit = system.moment.fit(float(np.abs(total).max()))
    shown: list[dict[str, Any]] = [
        {
            "id": "torque",
            "unit": unit.name,
            "total": _rounded(total / unit.size),
            "gas": _rounded(curves.gas.at(at) / unit.size),
            "mean": float(f"{curves.total.mean / unit.size:.5g}"),
        }
    ]
    first = gas.cylinders[engine.numbers.index(1)]
    if first.torque.pressure is not None:
        own = first.find_pressure(at - first.fires)
        unit = system.pressure.fit(float(own.max()))
        shown.append({"id": "pressure", "unit": unit.name, "total": _rounded(own / unit.size)})
    return {"cycle": gas.cycle_deg, "step": _STEP, "curves": shown}


def _rounded(values: Array) -> list[float]:
    return [float(f"{v:.5g}") for v in values.tolist()]
