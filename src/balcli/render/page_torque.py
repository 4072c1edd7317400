"""What the page needs to run torque and pressure with the crank, in the reader's units."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..core.phasors import Array
from ..torque.pictures import Running
from .units import System

_STEP = 2.0  # deg


def running(found: Running, system: System) -> dict[str, Any]:
    """Curves over one cycle at even crank angles, each with its name and unit."""
    torques = found.torques
    cycle = round(float(torques.crank_deg[-1]))
    angle = np.arange(0.0, cycle + _STEP / 2, _STEP)
    unit = system.moment.fit(float(np.abs(torques.total).max()))

    def of_torque(values: Array) -> list[float]:
        return _rounded(np.interp(angle, torques.crank_deg, values) / unit.size)

    curves = [
        {
            "id": "torque",
            "unit": unit.name,
            "total": of_torque(torques.total),
            "gas": of_torque(torques.gas),
            "mean": float(f"{torques.mean / unit.size:.5g}"),
        }
    ]
    if found.pressures is not None:
        own = np.interp(
            np.remainder(angle - found.fires_deg + cycle / 2, cycle) - cycle / 2,
            found.pressures.cycle_deg,
            found.pressures.pressure,
        )
        unit = system.pressure.fit(float(own.max()))
        curves.append({"id": "pressure", "unit": unit.name, "total": _rounded(own / unit.size)})
    return {"cycle": cycle, "step": _STEP, "curves": curves}


def _rounded(values: Array) -> list[float]:
    return [float(f"{v:.5g}") for v in values.tolist()]
