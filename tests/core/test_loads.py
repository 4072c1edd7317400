"""Bounds of rounding that every result carries, and angles of cylinders by bank."""

from dataclasses import replace

import numpy as np
import pytest
from support.engines import alone, build_text, engine, engine_text

from balcli.core.loads import Loads, share_by_lever, sum_by_lever, sum_weighted
from balcli.core.mechanisms.closed_form import SERIES, Series, select_cylinders
from balcli.core.phases import Phases
from balcli.core.phasors import EPS, Phasors
from balcli.engine.build import build
from balcli.engine.parse import parse
from balcli.forces.spectrum import compute_spectra
from balcli.studies.parameters import parse_parameter as parameter
from balcli.studies.sweep import Sweep

QUANTITIES = ("force", "moment", "couple", "torque", "roll")
ENGINES = {
    "plain": {"rod": {"mass": 0.5, "cg": 60, "inertia": 3000}},
    "offset": {"rod": {"mass": 0.5, "cg": 60, "inertia": 3000}, "piston": {"offset": 7}},
    "articulated": {
        "layout": {"radial": 5},
        "articulation": {"knuckle_radius": 30, "rod": {"length": 150, "mass": 0.3, "cg": 50}},
    },
    "rotary": {"layout": {"radial": 5, "rotary": True}, "piston": {"offset": 3}},
}


@pytest.mark.parametrize("name", ENGINES)
@pytest.mark.parametrize("along", [0, 100, -1e6])
def test_every_order_has_a_bound_of_its_rounding(name, along):
    """Real, and not below the rounding of what is there; about a far point that of the arms too."""
    crank = {"stroke": 100, "throws": [0], "positions": [100]}
    built = engine(**ENGINES[name], crank=crank, frame={"reference": [20, 30, along]})
    found = compute_spectra(built, np.arange(0.0, 9.0), QUANTITIES)
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
    crank = {"stroke": 100, "throws": [0, 240, 120, 120, 240, 0], "spacing": 100}
    for reference in ([0, 0, 1e6], [3e5, -2e5, 250], [0, 0, -250]):
        six = engine(crank=crank, frame={"reference": reference})
        found = compute_spectra(six, np.arange(1.0, 6.0), ("force", "moment"))
        assert found.force.balanced.all()
        assert found.moment.balanced.all()


def test_each_cylinder_has_its_own_crank_angle():
    """Cylinder 1's pin lies on its axis, at 50 degrees; the others' lie at -60, 40 and -50; also
    for variants side by side.
    """
    text = engine_text(
        crank="stroke = 100\nthrows = [0, 100]\nsplay = 10", layout="banks = [-20, 50]\nnumbering = [[4, 2], [3, 1]]"
    )
    built = build_text(text)
    assert dict(zip(built.numbers, built.cylinders.angle_deg, strict=True)) == pytest.approx(
        {4: -60 + 20, 2: 40 + 20, 3: -50 - 50, 1: 0}
    )
    turned = replace(
        built.cylinders,
        axis_deg=built.cylinders.axis_deg[:, None] + [0, 30, -9],
        pin_deg=built.cylinders.pin_deg[:, None],
    )
    assert turned.angle_deg == pytest.approx(np.tile(built.cylinders.angle_deg[:, None], 3))


# ------------------------------------------------------------------ several side by side
LOW = np.arange(0.0, 5.0)
VEE = engine_text(
    crank="stroke = 100\nthrows = [0, 130, 250]\nspacing = 90",
    layout="bank_angle = 70\nstagger = 20",
    rod="ratio = 0.25\nmass = 0.5\ncg = 60\ninertia = 3000",
    piston="mass = 1\noffset = 0",
    frame="reference = [0, 0, 0]",
    operation="speed = 1000",
)


@pytest.mark.parametrize(
    "vary",
    [
        ("crank.throws.2=100,130",),
        ("crank.throws.3=0,130,250,300",),
        ("crank.splay=0,10,25",),
        ("layout.bank_angle=60,70,90",),
        ("piston.mass=1,2,3",),
        ("piston.offset=1,3,5",),
        ("crank.throws.2=0,90,130", "crank.throws.3=0,250"),
        ("crank.throws.2=0,90,130", "rod.ratio=0.2,0.3"),
    ],
)
def test_variants_side_by_side_are_what_each_is_alone(vary):
    """All quantities of several orders at once, with their bounds."""
    file = parse(VEE)
    sweep = Sweep(file, tuple(parameter(v, file) for v in vary), ())
    together = compute_spectra(sweep.engine(), LOW, QUANTITIES)
    shape = [len(p.values) for p in sweep.parameters]
    for place in np.ndindex(*shape):
        values = {p.path: float(p.values[k]) for p, k in zip(sweep.parameters, place, strict=True)}
        for quantity, single in compute_spectra(build(file, values), LOW, QUANTITIES).items():
            found = together[quantity.name]
            for name in ("forward", "backward", "noise"):
                whole = np.broadcast_to(getattr(found, name), (len(LOW), *shape))[(slice(None), *place)]
                most = 0.01 * single.noise if name == "noise" else single.noise
                assert np.all(np.abs(whole - getattr(single, name)) <= most), (quantity, name, place)


@pytest.mark.parametrize("ripple", ["", "speed_ripple = [{ order = 1, amplitude = 0.03, angle = 40 }]"])
def test_an_engine_does_what_its_cylinders_do(ripple):
    """Unlike cylinders: the sum of what each does alone, with a bound no smaller than that of any of them."""
    text = VEE + ripple + "\n[cylinder.2]\npiston_mass = 3\nrod_length = 170\n[cylinder.5]\npiston_offset = 9\n"
    built = build_text(text)
    parts = [compute_spectra(alone(built, number), LOW, QUANTITIES) for number in built.numbers]
    for quantity, whole in compute_spectra(built, LOW, QUANTITIES).items():
        each = [part[quantity.name] for part in parts]
        assert np.all(np.abs(sum(p.vectors for p in each) - whole.vectors) <= whole.noise), quantity
        assert np.all(max(p.noise.max() for p in each) <= whole.noise.max()), quantity


@pytest.mark.parametrize("name", ["articulated", "rotary"])
@pytest.mark.parametrize("size", [0.0, 1e-6])
def test_errors_of_a_curve_stay_within_the_bounds_of_the_forces(name, size):
    """Both components off by their own bounds; a bound for the rounding of the sum even if they are exact."""
    built = engine(**ENGINES[name])
    c = built.cylinders
    few, which = c.linkage.find_distinct_harmonics(LOW, c.lam, c.eps, SERIES)
    exact = select_cylinders(few, which)
    exact["piston"] = Series(0 * exact["piston"].c)
    along = exact["along"].c
    across = exact["across"].c
    curve = {"along": Series(along, size * np.ones(1)), "across": Series(across, 3 * size)}
    for turn in (1, -1, 1j, -1j):
        off = {"along": Series(along + size), "across": Series(across + 3 * turn * size)}
        here, there = (Loads(c, (), 0j, 0.0, Phases(c, LOW), exact | it, 1.0).force for it in (curve, off))
        assert np.all(here.noise >= EPS * here.major)
        assert np.all(np.abs(there.vectors - here.vectors) <= here.noise)


@pytest.mark.parametrize(
    "planes", [[0.0], [-0.2, 0.2], [-0.3, -0.1, 0.0, 0.4], [0.9, 1.0, 2.0]], ids=["one", "two", "four", "beyond"]
)
def test_planes_carry_loads_by_the_lever_rule(planes):
    """Planes that carry nothing, several loads at a place, a load in a plane; forces and moments stay the same."""
    places = np.array([0.1, -0.25, 0.1, 0.0, 0.35, -0.6])
    vectors = np.random.default_rng(3).normal(size=(2, 4, 6, 2)) @ [1, 1j]
    loads = Phasors(np.arange(1.0, 5.0), vectors, np.abs(vectors).sum(axis=0) * EPS)
    carried = sum_by_lever(loads, places, np.array(planes))
    dense = sum_weighted(loads, share_by_lever(places, np.array(planes)))
    assert carried.vectors == pytest.approx(dense.vectors, abs=1e-12)
    assert carried.noise == pytest.approx(dense.noise, rel=1e-13)
    assert carried.vectors.sum(axis=-1) == pytest.approx(vectors.sum(axis=-1), abs=1e-12)
    if len(planes) > 1:
        assert carried.vectors @ planes == pytest.approx(vectors @ places, abs=1e-12)
