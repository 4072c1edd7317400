"""The units of textbooks, by hand."""

from __future__ import annotations

import numpy as np
import pytest
from support.engines import engine

from balcli.core.mechanisms import closed_form
from balcli.forces.kinds import FORCE, MOMENT
from balcli.forces.textbook import TextbookUnits, find_textbook_units


def test_textbook_units():
    e = engine(crank={"throws": [0, 240, 120], "positions": [0, 80, 200]}, operation={"speed": 600})
    units = find_textbook_units(e, np.array([1.0, 2.0, 3.0]))
    assert (units.force, units.arm, units.equal) == (
        pytest.approx(0.05 * (20 * np.pi) ** 2),
        pytest.approx(0.1),
        True,
    )
    assert list(units.ratios) == list(closed_form.piston([1, 2, 3], 0.25))
    assert np.isnan(find_textbook_units(engine(), np.array([1.0])).arm)


def test_textbook_units_of_unequal_cylinders_are_cylinder_1s():
    e = engine(
        crank={"throws": [0, 0]}, cylinder={"1": {"piston_mass": 3}}, layout={"numbering": [[2, 1]]}
    )
    units = find_textbook_units(e, np.array([1.0]))
    assert units.force == pytest.approx(3 * 0.05 * (2 * np.pi) ** 2)
    assert not units.equal


def test_moments_are_multiples_of_a_force_times_the_distance_of_throws():
    units = TextbookUnits(force=200.0, arm=0.1, ratios=np.ones(1), equal=True)
    assert (units.size(FORCE), units.name(FORCE)) == (200.0, "F1")
    assert (units.size(MOMENT), units.name(MOMENT)) == (20.0, "F1·a")
