"""Bounds of rounding that every result carries, and angles of cylinders by bank."""
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from kit import engine, engine_text

from balcli.core.phasors import EPS
from balcli.engine import build
from balcli.enginefile import parse
from balcli.spectrum import spectra

QUANTITIES = ("force", "moment", "couple", "torque", "roll")
ENGINES = {
    "plain": {"rod": {"mass": 0.5, "cg": 60, "inertia": 3000}},
    "offset": {"rod": {"mass": 0.5, "cg": 60, "inertia": 3000}, "piston": {"offset": 7}},
    "articulated": {"layout": {"radial": 5}, "articulation": {"knuckle_radius": 30, "rod": {"length": 150, "mass": 0.3, "cg": 50}}},
    "rotary": {"layout": {"radial": 5, "rotary": True}, "piston": {"offset": 3}},
}


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("along", [0, 100, -1e6])
def test_every_order_has_a_bound_of_its_rounding(name, along):
    """Real, and not below the rounding of what is there; about a far point that of the arms too."""
    parts = ENGINES[name]
    built = engine(**parts, crank={"stroke": 100, "throws": [0], "positions": [100]}, frame={"reference": [20, 30, along]})
    found = spectra(built, np.arange(0.0, 9.0), QUANTITIES)
    for quantity in QUANTITIES:
        phasors = getattr(found, quantity)
        noise = np.broadcast_to(phasors.noise, phasors.forward.shape)
        assert np.isrealobj(noise)
        assert np.all(noise >= 0)
        assert np.all(noise >= EPS * phasors.major)
    arms = max(abs(along - 100), 100) / 1e3
    assert found.moment.noise[1] >= arms * EPS * found.force.major[1]


def test_what_balances_does_so_about_any_point():
    """An in-line six has neither force nor moment of orders 1 and 2, a kilometre away or at its own cylinders."""
    for reference in ([0, 0, 1e6], [3e5, -2e5, 250], [0, 0, -250]):
        six = engine(crank={"stroke": 100, "throws": [0, 240, 120, 120, 240, 0], "spacing": 100}, frame={"reference": reference})
        found = spectra(six, np.arange(1.0, 6.0), ("force", "moment"))
        assert found.force.balanced.all()
        assert found.moment.balanced.all()


def test_each_cylinder_has_its_own_crank_angle():
    """Cylinder 1's pin lies on its axis, at 50 degrees; the others' lie at -60, 40 and -50; also for variants side by side."""
    text = engine_text(crank="stroke = 100\nthrows = [0, 100]\nsplay = 10", layout="banks = [-20, 50]\nnumbering = [[4, 2], [3, 1]]")
    built = build(parse(text))
    assert dict(zip(built.numbers, built.cylinders.angle_deg, strict=True)) == pytest.approx({4: -60 + 20, 2: 40 + 20, 3: -50 - 50, 1: 0})
    turned = replace(built.cylinders, axis_deg=built.cylinders.axis_deg[:, None] + [0, 30, -9], pin_deg=built.cylinders.pin_deg[:, None])
    assert turned.angle_deg == pytest.approx(np.tile(built.cylinders.angle_deg[:, None], 3))
