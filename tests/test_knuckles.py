"""Knuckle angles that make strokes or dead centres even."""
from __future__ import annotations

import numpy as np
import pytest
from test_articulation import RADIAL

from balcli import enginefile
from balcli.errors import BalcliError
from balcli.knuckles import even_knuckles


def test_dead_centres_at_even_intervals():
    found = even_knuckles(enginefile.parse(RADIAL))
    assert np.abs(found.before.top_deg).max() > 3
    assert np.abs(found.after.top_deg).max() < 1e-9
    assert found.angles_deg[0] == 0
    assert found.reasons[0].endswith("top dead centres as even as the master's")


def test_equal_strokes():
    found = even_knuckles(enginefile.parse(RADIAL), "strokes")
    assert np.ptp(found.before.stroke) > 4e-4
    assert np.ptp(found.after.stroke) < 1e-12
    assert len(found.reasons) == 1


def test_mirror_images_get_mirrored_angles():
    angles = np.array(even_knuckles(enginefile.parse(RADIAL)).angles_deg)
    assert np.allclose(angles[1:] + angles[:0:-1], 360, atol=1e-9)


def test_two_rows_are_set_by_the_first():
    text = RADIAL.replace("stroke = 120", "stroke = 120\nthrows = [0, 180]\nspacing = 160")
    found = even_knuckles(enginefile.parse(text))
    assert len(found.angles_deg) == 7
    assert np.abs(found.after.top_deg).max() < 1e-9


def test_where_the_knuckle_pin_goes_for_an_even_dead_centre():
    """On the cylinder's axis when the crank pin is: turned on by the master rod's lean there, arcsin(lambda sin Delta)."""
    angles = even_knuckles(enginefile.parse(RADIAL)).angles_deg
    for bank in range(1, 7):
        apart = 2 * np.pi * bank / 7
        assert angles[bank] == pytest.approx(np.degrees(apart + np.arcsin(60 / 240 * np.sin(apart))), abs=1e-9)


def test_a_bank_that_no_angle_makes_even():
    """Opposite the master, turning the knuckle pin hardly changes the stroke, and this offset has added too much to it."""
    text = RADIAL.replace("radial = 7", "banks = [0, 180]") + "[cylinder.2]\npiston_offset = 60\n"
    found = even_knuckles(enginefile.parse(text), "strokes")
    assert found.reasons[1:] == ("no angle makes bank 2 even: the knuckle pin stays where it is",)
    assert found.angles_deg == (0, 180)


def test_an_engine_without_articulated_rods():
    with pytest.raises(BalcliError) as caught:
        even_knuckles(enginefile.parse(RADIAL[:RADIAL.index("[articulation]")]))
    assert str(caught.value) == "knuckles: this engine has no articulated rods; an engine file says so with [articulation]"
