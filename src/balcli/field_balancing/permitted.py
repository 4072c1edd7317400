"""Permitted residual unbalance by ISO 21940-11."""

from __future__ import annotations

from ..core.speeds import RPM


def find_permitted_unbalance(grade: float, mass_kg: float, speed_rpm: float) -> float:
    """Return the permitted residual unbalance of the whole rotor, g mm: `U = mass G / Omega`.

    Args:
        grade: Balance quality grade G: permitted speed of the center of mass, mm/s.
        mass_kg: Mass of the rotor, kg.
        speed_rpm: Service speed, rpm.
    """
    return 1e3 * mass_kg * grade / (speed_rpm * RPM)
