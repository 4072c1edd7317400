"""Dummy pistons (cylinders that the firing order leaves out), true strokes, vanishing rod couples."""

import pytest
from support.engines import engine, refused

from balcli import torque
from balcli.file.assumed import Assumed
from balcli.forces.spectrum import compute_spectra

GUIDE = {
    "crank": {"stroke": 75.6, "throws": [0, 180, 0], "positions": [-50, 0, 50]},
    "rod": {"length": 135, "small_end": 0.12, "big_end": 0.25},
    "piston": {"bore": 82, "mass": 0.35},
    "layout": {"firing_order": [1, 3]},
    "operation": {"speed": 8000},
    "cylinder": {"2": {"bank": 180, "gas": 0, "piston_mass": 0.82, "rod_big_end": 0.3, "rod_small_end": 0.12}},
}
WIEBE = {"cycle": "wiebe", "compression_ratio": 10.5, "imep": 10}


def test_a_dummy_has_inertia_but_no_displacement():
    made = engine(**GUIDE)
    assert float(made.displacement_m3) == pytest.approx(798.49e-6, rel=1e-5)
    assert abs(compute_spectra(made, [1]).force.major[0]) == pytest.approx(5305.9, rel=1e-5)


@pytest.mark.parametrize(("order", "dummy"), [([1, 3], "2"), ([2, 3], "1")])
def test_a_dummy_does_not_count_in_the_mean_pressure(order, dummy):
    """Two cylinders of the given mean pressure have it together, wherever the dummy stands."""
    crank = GUIDE["crank"] | {"throws": [0, 0, 0]}
    own = {dummy: GUIDE["cylinder"]["2"]}
    made = engine(**GUIDE | {"crank": crank, "cylinder": own, "gas": WIEBE, "layout": {"firing_order": order}})
    assert torque(made).imep_Pa == pytest.approx(1e6, rel=1e-9)


def test_a_cylinder_left_out_that_has_gas_is_refused():
    parts = {**GUIDE, "cylinder": {"2": {"bank": 180}}}
    assert "write [cylinder.2] gas = 0 if cylinder 2 is a dummy piston" in str(refused(**parts))


def test_displacement_of_an_offset_crank_is_that_of_its_torque():
    made = engine(crank={"stroke": 90}, rod={"length": 150}, piston={"bore": 90, "mass": 0.5, "offset": 10}, gas=WIEBE)
    swept = made.gas.cylinders[0].piston.swept
    assert (float(made.displacement_m3), 573.96e-6) == (pytest.approx(swept, rel=1e-14), pytest.approx(swept, rel=1e-5))


@pytest.mark.parametrize(("share", "balanced"), [(1, True), (1.01, False), (1 + 1e-12, False)])
@pytest.mark.parametrize(("mass", "cg", "length"), [(1.2, 60, 240), (0.3, 33.3, 111.1)])
def test_a_rod_of_just_that_inertia_has_no_couple(share, balanced, mass, cg, length):
    rod = {"mass": mass, "cg": cg, "length": length, "inertia": mass * cg * (length - cg) * share}
    made = engine(crank={"stroke": 60}, rod=rod, piston={"mass": 1.2})
    assert compute_spectra(made, [1]).couple.balanced[0] == balanced


def test_the_crankshaft_counts_in_the_couple_at_uneven_speed():
    parts = {
        "crank": {"stroke": 120, "throw_mass": 1.1, "inertia": 450000},
        "rod": {"length": 240, "mass": 1.4, "cg": 70, "inertia": 9000},
        "piston": {"mass": 1.2},
        "operation": {"speed": 1500, "speed_ripple": [{"order": 2, "amplitude": 0.05, "angle": 0}]},
    }
    made = engine(**parts)
    spectra = compute_spectra(made, [2, 4])
    assert list(spectra.couple.major) == pytest.approx([1119.1, 27.98], rel=1e-4)
    assert "crank.inertia" not in [doubt.path for doubt in made.doubts]
    without = engine(**{**parts, "crank": {"stroke": 120, "throw_mass": 1.1}})
    assert Assumed("crank.inertia", 0.0, "kg mm^2") in without.inferred
    alike = compute_spectra(without, [2, 4]).roll.major
    assert list(spectra.roll.major) == pytest.approx(list(alike), rel=1e-12), "the crank only passes it on"
