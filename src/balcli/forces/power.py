"""Compute the power related unbalance: a free moment divided by the power of the engine.

Builders of marine engines judge with it whether a moment compensator is needed. Moment and power
are those at the speed of the file.
"""

import math
from dataclasses import replace
from typing import NamedTuple

from ..engine.engine import Engine

LIKELY = 120.0  # N m/kW; above this limit, a compensator is likely to be needed
# Upper limit of the power related unbalance, N m/kW, and need of a moment compensator up to this
# limit, from the project guides of marine engines (MAN).
_NEEDS = (
    (60.0, "not relevant"),
    (LIKELY, "unlikely"),
    (220.0, "likely"),
    (math.inf, "most likely"),
)


class Power(NamedTuple):
    """Power of an engine at the speed of its file.

    Attributes:
        watts: Power, W.
        kind: "file": brake power in the file; "indicated": power of the gas; "brake": power of the
            gas times the mechanical efficiency.
    """

    watts: float
    kind: str

    def relate(self, moment_Nm: float) -> float:
        """Return a moment at the speed of the file divided by the power, N m/kW."""
        return 1e3 * moment_Nm / self.watts


def at_rated_speed(engine: Engine) -> Engine:
    """Return the engine at the speed of its file."""
    return engine if engine.rated is None else engine.at_speed(engine.rated.speed_rpm)


def find_power(engine: Engine) -> Power | None:
    """Return the power of an engine at the speed of its file; None if the file gives neither power
    nor gas.

    Args:
        engine: One engine, not an array of variants.
    """
    if engine.rated is not None and engine.rated.power_W:
        return Power(engine.rated.power_W, "file")
    if engine.gas is None:
        return None
    indicated = _find_gas_power(engine)
    if indicated <= 0:
        return None
    efficiency = at_rated_speed(engine).mechanical_efficiency
    if efficiency is None:
        return Power(indicated, "indicated")
    return Power(indicated * efficiency, "brake")


def takes_power(engine: Engine) -> bool:
    """Return whether the gas takes power, as that of pumps and compressors does; False without gas.

    Args:
        engine: One engine, not an array of variants.
    """
    return engine.gas is not None and _find_gas_power(engine) < 0


def _find_gas_power(engine: Engine) -> float:
    """Return the power of the gas at the speed of the file, W; negative if the gas takes power."""
    from .curves import find_torque_curves  # engines without gas do not load it

    rated = at_rated_speed(engine)
    return find_torque_curves(replace(rated, ripple=())).gas.mean * float(rated.omega)


def name_need(related: float) -> str | None:
    """Return the need of a compensator in one word of the project guides; None if it is unknown.

    Args:
        related: Power related unbalance, N m/kW; nan if the moment is not known.
    """
    return next((need for most, need in _NEEDS if related <= most), None)


def needs_compensator(related: float) -> bool:
    """Return whether a compensator is likely or most likely to be needed.

    Args:
        related: Power related unbalance, N m/kW.
    """
    return related > LIKELY
