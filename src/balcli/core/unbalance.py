"""Compute the depth of a radial hole that removes a given unbalance, or adds it if a slug of
heavier metal fills the hole; and the permitted residual unbalance by ISO 21940-11.
"""

from __future__ import annotations

import math

STEEL = 7850.0  # kg/m3, plain carbon steel
# Density of slugs, kg/m3: heavy alloy of 90 % tungsten (ASTM B777, class 1), also called Mallory
# metal in workshops; and lead
SLUGS = {"tungsten": 17000.0, "mallory": 17000.0, "lead": 11340.0}


def find_drill_depth(unbalance: float, rim: float, drill: float, density: float = STEEL) -> float:
    """Return the depth (m) of a radial hole from the rim inwards that removes this unbalance; nan
    if no depth suffices.

    The unbalance of a hole of depth h and diameter d is `m r = density pi d^2/4 (rim h - h^2/2)`.
    The hole ends at the axis at the latest.

    Args:
        unbalance: Unbalance to remove, kg m.
        rim: Radius of the rim, m.
        drill: Diameter of the drill, m.
        density: Density of the rotor, kg/m3; for a hole with a slug, the density of the slug less
            that of steel.
    """
    # kg m, for a hole of 1 m depth whose centre of mass is at the radius 1 m
    unbalance_per_square = density * math.pi / 4 * drill**2
    share = unbalance / unbalance_per_square / rim**2  # = h/rim - (h/rim)^2 / 2, at most 1/2
    return rim * 2 * share / (1 + math.sqrt(1 - 2 * share)) if share <= 0.5 else math.nan


def find_drilled_unbalance(depth: float, rim: float, drill: float, density: float = STEEL) -> float:
    """Return the unbalance (kg m) that a radial hole from the rim inwards removes, the inverse of
    `find_drill_depth`.

    Args:
        depth: Depth of the hole, m, at most the rim's radius.
        rim: Radius of the rim, m.
        drill: Diameter of the hole, m.
        density: Density of the rotor, kg/m3.
    """
    return density * math.pi / 4 * drill**2 * depth * (rim - depth / 2)


def find_permitted_unbalance(grade: float, mass_kg: float, speed_rpm: float) -> float:
    """Return the permitted residual unbalance of the whole rotor, g mm: `U = mass G / Omega`.

    Args:
        grade: Balance quality grade G: permitted speed of the centre of mass, mm/s.
        mass_kg: Mass of the rotor, kg.
        speed_rpm: Service speed, rpm.
    """
    return 1e3 * mass_kg * grade / (speed_rpm * math.pi / 30)
