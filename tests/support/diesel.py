"""A six-cylinder Diesel's crankshaft as published: a chain of nine (MWM; Mendes, Meirelles and
Zampieri 2008, doi 10.1243/14644193JMBD126, as set in the examples of openTorsion).
"""

INERTIAS = (0.017, 0.009, 0.0467, 0.0327, 0.0467, 0.0467, 0.0327, 0.0487, 2.075)  # kg m2
STIFFNESSES = (1.106e6, 1.631e6, 1.253e6, 1.253e6, 1.678e6, 1.253e6, 1.253e6, 1.976e6)
NATURAL_HZ = (
    *(216.5836052, 592.7404802, 984.922964, 1171.017408),
    *(1415.995017, 1660.043912, 1794.38758, 2993.473563),
)
RUNNING_GEAR = 0.006086026  # kg m2 of one cylinder: mean over a turn of m s'^2

# fmt: off
DIAGRAM = [  # of the cylinder pressure: angle in 25/41 deg, pressure in 2/517 MPa: the digitiser's steps
    (0, 69), (46, 69), (83, 73), (117, 69), (155, 69), (184, 69), (223, 73), (263, 73),
    (295, 73), (342, 81), (384, 93), (407, 105), (431, 129), (454, 165), (479, 237), (494, 333),
    (507, 405), (516, 497), (522, 593), (529, 737), (534, 877), (539, 1017), (545, 1165), (552, 1397),
    (554, 1621), (559, 1801), (564, 2101), (567, 2365), (571, 2633), (575, 2837), (586, 3169), (589, 3397),
    (592, 3561), (595, 3697), (598, 3821), (603, 3929), (609, 3789), (613, 3665), (615, 3553), (618, 3389),
    (621, 3261), (623, 3109), (628, 2937), (631, 2773), (634, 2637), (637, 2361), (640, 2245), (642, 2133),
    (646, 2001), (649, 1849), (652, 1673), (657, 1569), (661, 1425), (670, 1293), (673, 1117), (682, 965),
    (690, 809), (702, 705), (718, 553), (740, 453), (764, 365), (790, 301), (823, 257), (860, 221),
    (891, 181), (915, 137), (955, 105), (989, 85), (1043, 77), (1098, 69), (1145, 65),
]
# fmt: on

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
    """The engine file whose nodes have the published inertias: what the throws lack is the running gear's."""
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
