"""A six-cylinder Diesel's crankshaft as published: a chain of nine (MWM; Mendes, Meirelles and
Zampieri 2008, doi 10.1243/14644193JMBD126, as set in the examples of openTorsion).
"""

from __future__ import annotations

INERTIAS = (0.017, 0.009, 0.0467, 0.0327, 0.0467, 0.0467, 0.0327, 0.0487, 2.075)  # kg m2
STIFFNESSES = (1.106e6, 1.631e6, 1.253e6, 1.253e6, 1.678e6, 1.253e6, 1.253e6, 1.976e6)
NATURAL_HZ = (
    *(216.5836052, 592.7404802, 984.922964, 1171.017408),
    *(1415.995017, 1660.043912, 1794.38758, 2993.473563),
)
RUNNING_GEAR = 0.006086026  # kg m2 of one cylinder: mean over a turn of m s'^2

ENGINE = """
name = "six"
[crank]
stroke = 137
spacing = 120
[rod]
length = 207
mass = 0
cg = 0
[piston]
mass = 2.521
bore = 105
[layout]
firing_order = [1, 5, 3, 6, 2, 4]
[operation]
speed = 2000
"""


def write_diesel(more: str = "", extra: str = "") -> str:
    """The engine file whose nodes have the published inertias: what the throws lack is the running
    gear's.
    """
    throws = [1e6 * (j - RUNNING_GEAR) for j in INERTIAS[2:8]]
    return f"""{ENGINE}{extra}
[torsion]
throw_inertia = {throws}
throw_stiffness = {list(STIFFNESSES[2:7])}
damping = 2
loss = 0.035
{more}
[[torsion.front]]
name = "gear"
inertia = {INERTIAS[1] * 1e6}
stiffness = {STIFFNESSES[1]}
[[torsion.front]]
name = "pulley"
inertia = {INERTIAS[0] * 1e6}
stiffness = {STIFFNESSES[0]}
[[torsion.rear]]
name = "flywheel"
inertia = {INERTIAS[8] * 1e6}
stiffness = {STIFFNESSES[7]}
diameter = 85
"""
