"""Rotary engines: the crank stands still, the cylinders turn."""

import numpy as np
import pytest
from support.engines import GNOME, build_text, rotary_engine

from balcli.analysis.answer import analyze
from balcli.balancing.answer import even_knuckles
from balcli.engine import parse as enginefile
from balcli.errors import BalcliError, InputError
from balcli.forces import spectrum
from balcli.report.page import scene
from balcli.show.units import SYSTEMS


@pytest.mark.parametrize("count", [3, 4, 5, 7, 9])
def test_three_or_more_cylinders_have_no_first_order_force(count):
    """Well known: the pistons run round the crank pin almost on a circle. What is left has the order of the cylinders."""
    force = spectrum.compute_spectra(rotary_engine(f"radial = {count}"), np.arange(1.0, 2 * count + 1), ["force"]).force
    assert force is not None
    assert force.balanced[0]
    left = force.orders[~force.balanced]
    assert all(order % count == 0 for order in left)


def test_one_cylinder_has_a_first_order_force_of_its_mean_distance():
    """Forward first order: m omega^2 times the mean distance of the piston pin, here by quadrature (lambda = 6/23)."""
    force = spectrum.compute_spectra(rotary_engine("banks = [0]"), [1.0], ["force"]).force
    assert force is not None
    psi = np.arange(64) * (2 * np.pi / 64)
    distance = (0.06 * np.cos(psi) + np.sqrt(0.23**2 - (0.06 * np.sin(psi)) ** 2)).mean()
    mass = 0.8 + 0.9 * 70 / 230
    assert force.forward[0] == pytest.approx(mass * distance * (1000 * np.pi / 30) ** 2, rel=1e-12)


def test_the_throw_stands_still():
    text = GNOME.format(layout="banks = [0]", offset=0)
    light, heavy = (
        spectrum.compute_spectra(build_text(text.replace("throw_mass = 3", mass)), np.arange(1.0, 4.0))
        for mass in ("throw_mass = 0", "throw_mass = 9")
    )
    for (_, a), (_, b) in zip(light.items(), heavy.items(), strict=True):
        assert np.array_equal(a.forward, b.forward)


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


@pytest.mark.parametrize("value", ["1", '"yes"'])
def test_true_or_false(value):
    with pytest.raises(InputError) as caught:
        enginefile.parse(GNOME.format(layout="radial = 5", offset=0).replace("rotary = true", f"rotary = {value}"))
    told = f"layout.rotary: {value} is not true or false; write it without quotes"
    assert [str(p) for p in caught.value.problems] == [told]


ARTICULATED = (
    "[articulation]\nknuckle_radius = {radius}\nrod = {{ length = {length}, mass = 0.9, cg = {cg}, inertia = 7000 }}\n"
)


def test_articulated_rods_leave_orders_that_equal_rods_do_not():
    found = spectrum.compute_spectra(
        rotary_engine(more=ARTICULATED.format(radius=48, length=184, cg=60)), [1.0, 2, 3], ["force"]
    ).force
    assert found is not None
    assert not found.balanced.any()


def test_an_articulated_rod_that_is_too_short():
    with pytest.raises(InputError) as caught:
        rotary_engine(more=ARTICULATED.format(radius=48, length=60, cg=20))
    assert all("the crank cannot turn: at crank angle" in p.message for p in caught.value.problems)


def test_even_knuckles_are_not_for_rotary_engines():
    file = enginefile.parse(
        GNOME.format(layout="radial = 7", offset=0) + ARTICULATED.format(radius=48, length=184, cg=60)
    )
    with pytest.raises(BalcliError, match="knuckles: needs articulated rods, and a crank that turns"):
        even_knuckles(file)


def test_the_page_has_the_knuckle_pins_of_turning_cylinders():
    """As seen from the cylinder, in the mirror."""
    subject = rotary_engine(more=ARTICULATED.format(radius=48, length=184, cg=60))
    third = next(c for c in scene(analyze(subject), {}, SYSTEMS["si"])["cylinders"] if c["number"] == 3)
    assert third["lead"] == pytest.approx(-720 / 7)
    assert third["knuckle"] == pytest.approx([48 * np.cos(4 * np.pi / 7), -48 * np.sin(4 * np.pi / 7)])
