"""Rotary engines: the crank stands still, the cylinders turn."""

import numpy as np
import pytest
from support.engines import GNOME, rotary_engine

from balcli.balancing.answer import balance_knuckles
from balcli.engine import parse as enginefile
from balcli.errors import BalcliError, InputError
from balcli.forces.spectrum import compute_spectra
from balcli.report.page import scene


def test_one_cylinder_has_a_first_order_force_of_its_mean_distance():
    """m omega^2 times the mean distance of the piston pin, here by quadrature; from three on, only multiples of their
    number are left, because the pistons run round the crank pin almost on a circle.
    """
    psi = np.arange(64) * (2 * np.pi / 64)
    distance = (0.06 * np.cos(psi) + np.sqrt(0.23**2 - (0.06 * np.sin(psi)) ** 2)).mean()
    force = compute_spectra(rotary_engine("banks = [0]"), [1.0], ["force"]).force
    mass = 0.8 + 0.9 * 70 / 230
    assert force.forward[0] == pytest.approx(mass * distance * (1000 * np.pi / 30) ** 2, rel=1e-12)
    for count in (3, 4, 5, 7, 9):
        force = compute_spectra(rotary_engine(f"radial = {count}"), np.arange(1.0, 2 * count + 1), ["force"]).force
        assert not (force.orders[~force.balanced] % count).any(), count


def test_every_second_cylinder_fires_as_they_come_round():
    """Cylinder 5 of 5 stands 72 degrees behind cylinder 1 and comes to the top after it."""
    rotary_engine("radial = 5", more="firing_order = [1, 4, 2, 5, 3]\n")
    with pytest.raises(InputError, match=r"layout.numbering = \[\[1\], \[5\], \[4\], \[3\], \[2\]\]"):
        rotary_engine("radial = 5", more="firing_order = [1, 3, 5, 2, 4]\n")


def test_the_throws_of_two_rows_follow_from_the_firing_order():
    """Cylinder 6 stands at 240 degrees and is to fire 60 degrees after cylinder 1: its pin stands still at 300."""
    found = rotary_engine("radial = 3", more="firing_order = [1, 6, 5, 4, 3, 2]\nstrokes = 2\n")
    assert found.cylinders.axis_deg == pytest.approx([0, 300])
    assert found.numbers == (1, 3, 5, 2, 4, 6)


ARTICULATED = "[articulation]\nknuckle_radius = 48\nrod = { length = 184, mass = 0.9, cg = 60, inertia = 7000 }\n"


def test_an_articulated_rod_that_is_too_short():
    with pytest.raises(InputError) as caught:
        rotary_engine(more=ARTICULATED.replace("184", "60").replace("cg = 60", "cg = 20"))
    assert all("the crank cannot turn: at crank angle" in p.message for p in caught.value.problems)


def test_knuckles_are_not_for_rotary_engines():
    file = enginefile.parse(GNOME.format(layout="radial = 7", offset=0) + ARTICULATED)
    with pytest.raises(BalcliError, match="knuckles needs articulated rods, and a crank that turns"):
        balance_knuckles(file)


def test_the_page_has_the_knuckle_pins_of_turning_cylinders():
    """As seen from the cylinder, in the mirror."""
    drawn = scene(rotary_engine(more=ARTICULATED))["cylinders"]
    third = next(c for c in drawn if c["number"] == 3)
    assert third["lead"] == pytest.approx(-720 / 7)
    assert third["knuckle"] == pytest.approx([48 * np.cos(4 * np.pi / 7), -48 * np.sin(4 * np.pi / 7)])
