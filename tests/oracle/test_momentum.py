"""balcli against a momentum calculation on a grid that shares nothing with it (see momentum.py)."""

import numpy as np
import pytest
from oracle import momentum
from support.engines import alone, build_text
from support.paths import ENGINE_FILES

from balcli.forces import spectrum

TOLERANCE = 1e-11  # of the largest first-order amplitude of one cylinder
ORDERS = np.arange(0.0, 11.0)

BASE = """\
[crank]
stroke = 120
throw_mass = 2.0
{crank}
[rod]
length = 240
mass = 1.9
cg = 55
inertia = 21000
[piston]
mass = 1.3
{piston}
[layout]
{layout}
[operation]
speed = 2300
{operation}
{more}
"""
ARTICULATED = """
[articulation]
knuckle_radius = 52
rod = { length = 188, mass = 0.62, cg = 90, inertia = 3500 }
"""
HUNG = "{ length = 188, mass = 0.62, cg = 90, inertia = 3500 }"
WEIGHED = ARTICULATED.replace(HUNG, "{ length = 188, small_end = 0.31, big_end = 0.33 }")
SWUNG = ARTICULATED.replace(
    HUNG, '{ ratio = 0.32, mass = 0.62, cg = 90, pendulum = { pivot = "big_end", period = 0.85 } }'
)
SWUNG_ENDS = ARTICULATED.replace(
    HUNG, '{ length = 188, small_end = 0.3, big_end = 0.33, pendulum = { pivot = "small_end", period = 0.88 } }'
)
RIPPLE = "speed_ripple = [{ order = 1, amplitude = 0.03, angle = 40 }, { order = 3, amplitude = 0.02, angle = -75 }]"
DISPLACED = """
[frame]
reference = [70, -40, 25]
[[counterweight]]
unbalance = 690000
angle = 170
position = 12
[[shaft]]
ratio = -2
unbalance = 9000
angle = 35
at = [-40, 60]
position = -30
[[slider]]
order = 3
unbalance = 2000
direction = 50
angle = 15
at = [12, 9]
"""
BOBWEIGHT = "[bobweight]\nrod_bearing = 0.21\noil = 0.03\n"
CASES = {
    "shells, oil, pistons in parts": {
        "layout": "bank_angle = 70\nstagger = 20",
        "crank": "throws = [0, 130, 265]\nspacing = 110",
        "piston": "piston = 0.8\npin = 0.3\nrings = 0\nlocks = 0.01",
        "more": BOBWEIGHT,
    },
    "shells on the master rods alone": {"layout": "radial = 5", "more": ARTICULATED + BOBWEIGHT},
    "shells on pins that stand still": {"layout": "radial = 5\nrotary = true", "more": BOBWEIGHT},
    "offset": {
        "layout": "banks = [-30, 35]",
        "crank": "throws = [0, 130]\nspacing = 110\nsplay = 12",
        "piston": "offset = 9",
    },
    "displaced reference": {"layout": "bank_angle = 70", "piston": "offset = -7", "more": DISPLACED},
    "uneven speed": {"layout": "bank_angle = 70", "piston": "offset = -7", "operation": RIPPLE, "more": DISPLACED},
    "two unlike cylinders, uneven speed": {
        "layout": "bank_angle = 60",
        "operation": RIPPLE,
        "more": "[cylinder.2]\npiston_mass = 2.5\nrod_length = 200\n",
    },
    "articulated rods weighed at both ends": {"layout": "radial = 7", "more": WEIGHED},
    "articulated rods by ratio, swung": {"layout": "radial = 5", "more": SWUNG},
    "articulated rods weighed and swung, one of its own": {
        "layout": "bank_angle = 60",
        "crank": "throws = [0, 120, 240]\nspacing = 160",
        "more": SWUNG_ENDS + "[cylinder.5]\nrod_mass = 0.7\nrod_cg = 80\nrod_inertia = 4100",
    },
    "rotary with articulated rods weighed and swung": {"layout": "radial = 5\nrotary = true", "more": SWUNG_ENDS},
    "two rows with master rods": {
        "layout": "radial = 5\nstagger = 4",
        "crank": "throws = [0, 180]\nspacing = 160",
        "piston": "offset = 6",
        "operation": RIPPLE,
        "more": ARTICULATED + "[cylinder.4]\nrod_length = 180\npiston_mass = 1.5",
    },
    "vee with articulated rods": {
        "layout": "bank_angle = 60",
        "crank": "throws = [0, 120, 240, 240, 120, 0]\nspacing = 160",
        "more": ARTICULATED.replace("knuckle", "master = 2\nknuckle_angles = [-66.5, 0]\nknuckle"),
    },
    "rotary in two rows, offset": {
        "layout": "radial = 3\nrotary = true\nstagger = 3",
        "piston": "offset = 11",
        "crank": "throws = [0, 175]\nspacing = 160",
        "more": DISPLACED,
    },
    "rotary with master rods in two rows": {
        "layout": "radial = 5\nrotary = true\nstagger = 4",
        "crank": "throws = [0, 180]\nspacing = 160",
        "piston": "offset = 6",
        "operation": RIPPLE,
        "more": ARTICULATED.replace(
            "knuckle_radius", "master = 3\nknuckle_angles = [-140, -70, 0, 75, 141]\nknuckle_radius"
        )
        + DISPLACED
        + "[cylinder.4]\nrod_length = 180\npiston_mass = 1.5",
    },
    "rotary, one cylinder, uneven speed": {
        "layout": "rotary = true",
        "piston": "offset = -5",
        "operation": RIPPLE,
        "more": DISPLACED,
    },
    "articulated, uneven, displaced": {
        "layout": "radial = 5",
        "piston": "offset = 8",
        "operation": RIPPLE,
        "more": ARTICULATED + DISPLACED,
    },
}


def compare(text: str) -> None:
    """Every order of every quantity, in units of what one cylinder does."""
    oracle = momentum.Engine.read(text)
    curves = oracle.curves()
    scales = oracle.scales()
    found = spectrum.compute_spectra(build_text(text), ORDERS)
    for kind, phasors in found.items():
        for row, n in enumerate(ORDERS):
            error = np.abs(phasors.vectors[:, row] - curves.order(kind.name, int(n))).max() / scales[kind.name]
            assert error < TOLERANCE, f"{kind.name} of order {n:g}: off by {error:.2e}"


@pytest.mark.parametrize("name", CASES)
def test_mechanisms(name):
    parts = {"crank": "", "piston": "", "layout": "", "operation": "", "more": ""} | CASES[name]
    text = BASE.format(**parts)
    compare(text.replace("mass = 1.3\n", "") if "piston =" in parts["piston"] else text)


@pytest.mark.parametrize("path", ENGINE_FILES, ids=lambda path: path.stem)
def test_every_engine_that_comes_with_balcli(path):
    compare(path.read_text(encoding="utf-8"))


def test_one_cylinder_of_an_articulated_engine_alone():
    """The share of a master and of an articulated cylinder in what the engine does (`--by cylinder`)."""
    text = BASE.format(crank="", piston="", layout="radial = 5", operation="", more=ARTICULATED)
    oracle = momentum.Engine.read(text)
    whole = build_text(text)
    for number in (1, 3):
        curves = oracle.curves([number])
        force = spectrum.compute_spectra(alone(whole, number), ORDERS, ["force"]).force
        for row, n in enumerate(ORDERS):
            assert abs(force.forward[row] - curves.order("force", int(n))[0]) < TOLERANCE * oracle.scales()["force"]
