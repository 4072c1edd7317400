"""Banks and throws -> numbered cylinders."""

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
from support.cases import cases
from support.engines import engine, refused

from balcli.engine.layout import plan_cylinders
from balcli.file.model import Crank, Layout


def planned(throws=None, **layout):
    crank = Crank(stroke=100, throws=throws)
    return plan_cylinders(SimpleNamespace(crank=crank, layout=Layout(**layout), cylinder={}, gas=None))


def where(found):
    """number -> (bank, throw)"""
    return {cell.number: (cell.bank, cell.throw) for cell in found.cells}


# ------------------------------------------------------------------ numbering
def test_cylinders_are_counted_through_bank_after_bank_from_the_free_end():
    places = product((0, 1), (0, 1, 2, 3))  # bank, throw
    assert where(planned([0, 90, 270, 180], bank_angle=90)) == dict(enumerate(places, 1))
    numbered = planned([0, 180], bank_angle=90, numbering=[[1, 3], [2, 4]])
    assert where(numbered) == {1: (0, 0), 3: (0, 1), 2: (1, 0), 4: (1, 1)}


def test_alternating_rods_take_the_banks_in_turn():
    found = planned([0, 180, 0, 180], banks=[-90, 90], rods="alternating")
    assert where(found) == {1: (0, 0), 2: (0, 2), 3: (1, 1), 4: (1, 3)}
    assert found.rods_on_throw == 1
    three = planned([0] * 7, banks=[0, 10, 20], rods="alternating")
    assert where(three) == {1: (0, 0), 2: (0, 3), 3: (0, 6), 4: (1, 1), 5: (1, 4), 6: (2, 2), 7: (2, 5)}


def test_as_many_throws_as_the_firing_order_needs():
    assert planned(firing_order=[1, 3, 4, 2]).throws == 4
    assert planned(firing_order=[1, 2, 3, 4, 5, 6], bank_angle=60).throws == 3
    assert planned(firing_order=[1, 5, 3, 6, 2, 4], banks=[-7, 7], rods="alternating").throws == 6
    assert planned(firing_order=[1, 3, 5, 2, 4], radial=5).throws == 1
    assert planned(radial=5).throws == planned().throws == 1


# ------------------------------------------------------------------ places along the crank
def test_rods_side_by_side_the_first_bank_towards_the_free_end():
    e = engine(crank={"throws": [0, 180], "positions": [-30, 70]}, layout={"banks": [0, 60, 90], "stagger": 20})
    assert e.numbers == (1, 2, 3, 4, 5, 6)
    assert np.ravel(e.cylinders.z) * 1e3 == pytest.approx([-50, 50, -30, 70, -10, 90])
    assert list(e.throws_m) == pytest.approx([-0.03, 0.07])
    assert e.reference_m == pytest.approx((0, 0, 0.02))


def test_alternating_rods_have_a_throw_to_themselves_so_there_is_no_stagger():
    boxer = {"banks": [-90, 90], "rods": "alternating", "stagger": 20}
    e = engine(crank={"throws": [0, 180], "spacing": 40}, layout=boxer)
    assert np.ravel(e.cylinders.z) * 1e3 == pytest.approx([-20, 20])


# ------------------------------------------------------------------ what cannot be
@cases("engine/layout", "one_mistake")
def test_one_mistake(parts, message):
    assert refused(**parts) == f"engine: {message}"
