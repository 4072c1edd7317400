"""Permitted residual unbalance by ISO 21940-11: a grade G is the permitted speed of the centre of
mass, mm/s, so `e = G / angular speed` and `U = mass * e`.
"""

from __future__ import annotations

from ..core.speeds import RPM


def find_permitted_eccentricity(grade: float, speed_rpm: float) -> float:
    """Permitted specific unbalance, mm (or g mm per g), of a grade in mm/s at a service speed."""
    return grade / (speed_rpm * RPM)


def find_permitted_unbalance(grade: float, mass_kg: float, speed_rpm: float) -> float:
    """Permitted residual unbalance of the whole rotor, g mm."""
    return 1e3 * mass_kg * find_permitted_eccentricity(grade, speed_rpm)
