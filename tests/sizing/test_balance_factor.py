"""The shop's factor: what it fits, counts and leaves, against sums written out by hand and a momentum
calculation on a grid.
"""

import math
import re
import tomllib
from functools import cache

import numpy as np
import pytest
from oracle import momentum
from support.cases import cases
from support.commands import ask_json, run_here
from support.engines import build_text, changed, engine_text
from support.paths import write
from support.remedies import SMALL, figures, size_scheme, weigh, write_engine

from balcli.balancing.answer import insert_remedy
from balcli.errors import BalcliError
from balcli.sizing.options import SchemeOptions
from balcli.sizing.remedy import Remedy
from balcli.sizing.residual import find_scales
from balcli.sizing.sizing import size

FORD = 'name = "Ford 302"\n' + engine_text(
    crank="stroke = 76.2\nthrows = [0, 90, 270, 180]\nspacing = 111.25\nthrow_mass = 1.1",
    rod="length = 129.3\nsmall_end = 0.180\nbig_end = 0.400",
    piston="bore = 101.6\npiston = 0.600\npin = 0.130\nrings = 0.041\nlocks = 0.004",
    layout="banks = [45, -45]\nstagger = 22\nnumbering = [[1, 2, 3, 4], [5, 6, 7, 8]]",
    bobweight="rod_bearing = 0.044\noil = 0.005",
    operation="speed = 6000",
)
TWIN = engine_text(
    crank="stroke = 96.8\nthrows = [0]\nthrow_mass = 0.9",
    rod="length = 189\nsmall_end = 0.22\nbig_end = 0.45",
    piston="bore = 88.8\nmass = 0.5\noffset = 3",
    layout="bank_angle = 45\nstagger = 24",
    operation="speed = 4000",
)
UNEQUAL = engine_text(
    crank="stroke = 90\npositions = [-140, -20, 60]\nthrows = [0, 130, 265]\nthrow_mass = 0.8",
    rod="length = 160\nmass = 0.6\ncg = 45",
    piston="mass = 0.5",
    layout="bank_angle = 70\nstagger = 20",
    bobweight="rod_bearing = 0.03",
    operation="speed = 3000",
    **{"cylinder.2": "piston_mass = 0.61"},
)
WEIGHTS = weigh(41000, 170, -190) + weigh(17000, 20, 35)
INLINE = changed(("throws = [0, 180, 180, 0]", "throws = [0, 240, 120]"), ("firing_order = [1, 3, 4, 2]", ""))
FLAT_PLANE = changed(("firing_order = [1, 3, 4, 2]", "bank_angle = 90"))


def fit(text: str, factor: float = 0.5, **options: object) -> Remedy:
    asked = SchemeOptions(factor=(factor,), **options)  # type: ignore[arg-type]
    return size(build_text(text), "factor", asked)


# ------------------------------------------------------------------ what it leaves
@cache
def pull_of_pins(text: str, factor: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Force and moment (N, N m) over the crank angle of what the factor balances: every rod's
    rotating mass, its share of the throw and a share of what goes to and fro, as a point that
    turns with its pin; and the sum of their sizes.
    """
    data = tomllib.loads(text)
    oracle = momentum.Engine.read(text)
    omega = data["operation"]["speed"] * math.pi / 30
    force = np.zeros(momentum.POINTS, complex)
    moment = np.zeros(momentum.POINTS, complex)
    sizes = 0.0
    for cell in oracle.cells:
        piston, rod = oracle._parts(cell)
        small = rod["mass"] * rod["cg"] / rod["length"]
        mass = rod["mass"] - small + cell["share"] + oracle.shells
        mass += factor * (piston["mass"] + small)
        angle = momentum.THETA + math.radians(oracle.first["axis"] + cell["pin"])
        pull = mass * cell["radius"] * omega**2 * np.exp(1j * angle)
        force += pull
        moment += 1j * (cell["z"] - oracle.z) * pull
        sizes += abs(pull[0])
    return force, moment, sizes


@cache
def find_curves(text: str | bytes) -> momentum.Curves:
    """What the parts of a file do over the crank angle, by their momentum."""
    return momentum.Engine.read(text).curves()


@pytest.mark.parametrize("planes", [None, "ends", "throws", (-0.21, 0.33), (-0.3, -0.05, 0.01, 0.2), (0.02,)])
@pytest.mark.parametrize("weights", ["", WEIGHTS])
@pytest.mark.parametrize("name", ["ford", "twin", "unequal", "inline"])
def test_what_is_left_is_the_engine_without_what_the_factor_takes(name, weights, planes):
    """Whatever the file has already, and wherever the rest is put: on a grid, by the momentum of all
    parts of the file as it is written.
    """
    text = {"ford": FORD, "twin": TWIN, "unequal": UNEQUAL, "inline": INLINE}[name]
    remedy = fit(text + weights, 0.53, planes=planes)
    written = insert_remedy((text + weights).encode(), remedy)
    left, bare = (find_curves(t) for t in (written, text))
    force, moment, scale = pull_of_pins(text, 0.53)
    assert find_orders(left.force) == pytest.approx(find_orders(bare.force - force), abs=1e-11 * scale)
    one_throw = name == "twin" and weights and planes == "throws"
    if planes != (0.02,) and not one_throw:
        assert find_orders(left.moment) == pytest.approx(find_orders(bare.moment - moment), abs=1e-11 * scale)
    else:
        assert remedy.note.startswith("one plane, or planes at the same z")


def find_orders(curve: np.ndarray) -> np.ndarray:
    """Its vectors of orders -8 to 8, without the rounding of higher ones."""
    return np.roll(np.fft.fft(curve, norm="forward"), 8)[:17]


# ------------------------------------------------------------------ what is there already
def test_what_the_file_has_is_counted_plane_by_plane():
    """Weights at -200 and 25: the second half-way between the planes at -200 and 250."""
    remedy = fit(FORD + weigh(30000, 90, -200) + weigh(8000, -90, 25), 0.51, planes=(-0.2, 0.25))
    bare = fit(FORD, 0.51, planes=(-0.2, 0.25))
    front, rear = remedy.needs
    assert (front.position_mm, rear.position_mm) == (-200, 250)
    assert front.present == pytest.approx(26e-3j, rel=1e-12)
    assert rear.present == pytest.approx(-4e-3j, rel=1e-12)
    for need, whole, left in zip(remedy.needs, bare.counterweights, remedy.counterweights, strict=True):
        assert abs(need.wanted) * 1e6 == pytest.approx(whole.unbalance, rel=1e-12)
        assert need.missing == pytest.approx(need.wanted - need.present, rel=1e-12)
        assert abs(need.missing) * 1e6 == pytest.approx(left.unbalance, rel=1e-12)
        assert math.degrees(np.angle(need.missing)) == pytest.approx(left.angle, abs=1e-9)
    assert "less the counterweights of the file" in remedy.reasons[0]
    assert not bare.needs
    assert "less the counterweights" not in bare.reasons[0]


def test_what_is_missing_is_told_where_the_counterweights_of_the_file_stand():
    """At its ends, not at the four throws between them; whatever decimals say a place twice."""
    ends = weigh(40000, -162, '"-9 in"') + weigh(40000, -160, -228.6) + weigh(40000, 18, 228.6)
    chosen = fit(FORD + ends)
    asked = fit(FORD + ends, planes=(-0.2286, 0.2286))
    assert chosen.devices == asked.devices
    assert [need.position_mm for need in chosen.needs] == [-228.6, 228.6]
    assert chosen.note == (
        "the weights are in the planes of the file's counterweights; planes throws computes "
        "weights for every throw instead"
    )
    assert asked.note == ""
    assert len(fit(FORD + ends, planes="throws").devices) == 4
    one_place = fit(FORD + weigh(40000, 9))
    assert (len(one_place.devices), one_place.note) == (4, "")


@pytest.mark.parametrize("planes", [None, "ends", (-0.25, 0.3)])
def test_nothing_is_missing_once_it_is_there(planes):
    """What was written is all there is to do; no dust of a device is left."""
    text = insert_remedy(FORD.encode(), fit(FORD, 0.51, planes=planes))
    again = fit(text, 0.51, planes=planes)
    assert not again.devices
    assert again.note == "nothing is missing: the counterweights of the file balance this factor"
    assert {need.missing for need in again.needs} == {0}


def test_what_is_there_counts_in_sum_where_moments_are_not_known():
    """Three pins that balance each other: their own weights are not asked for a second time."""
    three = SMALL["three"].replace("spacing = 100\n", "")
    first = fit(three)
    assert len(first.devices) == 3
    again = fit(insert_remedy(three.encode(), first))
    assert not again.devices
    assert again.note.startswith("nothing is missing")


@pytest.mark.parametrize("form", ["table", "card"])
def test_pins_that_balance_each_other_are_not_called_a_balanced_engine(form, tmp_path):
    """A flat-plane crank needs no weight in two planes, whatever its engine's second order."""
    told = "nothing is missing: the masses on the pins balance each other in these planes"
    assert fit(FLAT_PLANE, planes="ends").note == told
    assert len(fit(FLAT_PLANE).devices) == 4
    (path := tmp_path / "flat.toml").write_text(FLAT_PLANE)
    out = run_here("balance", path, "--factor", "50%", "--planes", "ends", "-f", form).out
    assert told[1:] in " ".join(out.split())
    assert "Orders 1 and 2 are balanced" not in out
    assert "\n.\n" not in out


def test_a_weight_in_a_plane_counts_in_that_plane_alone():
    """Also where its place is another decimal of the same number."""
    for place, plane in (("-220.1", -0.2201), ('"-8.7 in"', -0.22098), ('"1/3 m"', 1 / 3)):
        for slip in (-1, 0, 1):
            here = plane * (1 + slip * 2e-16)
            needs = fit(FORD + weigh(30000, 77, place), 0.5, planes=(here, 0.05)).needs
            at = {abs(need.position_mm / 1e3 - plane) < 1e-9: abs(need.present) for need in needs}
            assert at == {True: pytest.approx(0.03, rel=1e-12), False: 0}


@pytest.mark.parametrize(
    ("beside", "planes", "lost"), [(60, None, True), (60, "throws", True), (0, None, False), (0, (0.0,), False)]
)
def test_one_plane_does_not_take_the_moment_of_a_weight_beside_it(beside, planes, lost):
    """A force that a factor leaves has a lever about a point of reference beside it, no moment of
    the crank's own: nothing is said of that.
    """
    text = f"{TWIN}[frame]\nreference = [0, 0, 80]\n{weigh(40000, 180, beside)}"
    remedy = size_scheme(build_text(text), "factor", factor=(0.3,), planes=planes)
    assert remedy.note.startswith("one plane, or planes at the same z") == lost


def test_shafts_of_the_file_are_no_counterweights():
    shaft = "[[shaft]]\nratio = 1\nunbalance = 9000\n"
    assert fit(TWIN + shaft).counterweights == fit(TWIN).counterweights
    assert not fit(TWIN + shaft).needs


# ------------------------------------------------------------------ the card
def test_the_card_of_a_ford_302():
    """Weighed part by part and summed by hand: 2 x (400 + 44 + 5) = 898 turn, 2 x (600 + 130 + 41 +
    4 + 180) = 1910 go to and fro, and 898 + 0.51 x 1910 = 1872.1 g hang on each pin.
    """
    remedy = fit(FORD, 0.51)
    parts = {"big end": 800, "rod bearing": 88, "oil": 10}
    parts |= {"piston": 1200, "pin": 260, "rings": 82, "locks": 8, "small end": 360}
    for one in remedy.card:
        assert {line.part: line.sum_g for line in one.lines} == pytest.approx(parts)
        sums = one.rotating_g, one.reciprocating_g, one.bobweight_g, one.throw_g
        assert sums == pytest.approx((898, 1910, 1872.1, 1100))
    weights = [w.unbalance for w in remedy.counterweights]
    assert weights == pytest.approx([(1872.1 + 1100) * 38.1] * 4, rel=1e-12)


# ------------------------------------------------------------------ both definitions, and the inverse
def test_the_same_weight_by_both_definitions():
    """65 % of one cylinder's reciprocating mass are 32.5 % of all on the pin of a twin."""
    told = figures(fit(TWIN, 0.325))
    assert (told["factor"], told["factor of one cylinder"]) == (0.325, 0.65)
    assert figures(fit(INLINE, 0.4))["factor of one cylinder"] == 0.4


def test_what_was_measured_is_the_factor_it_stands_for():
    """Rotating 2 x 450 g, reciprocating 2 x 720 g: 1375 g on the pin take 475/1440 of it."""
    remedy = size_scheme(build_text(TWIN), "factor", measured=1.375)
    assert figures(remedy)["factor"] == pytest.approx(475 / 1440, rel=1e-12)
    assert figures(remedy)["factor of one cylinder"] == pytest.approx(950 / 1440, rel=1e-12)
    assert figures(remedy)["measured"] == 1.375
    assert remedy.card[0].bobweight_g == pytest.approx(1375)
    assert remedy.counterweights[0].unbalance == pytest.approx((1375 + 900) * 48.4, rel=1e-12)


# ------------------------------------------------------------------ refusals
@cases("sizing/balance_factor", "what_a_factor_cannot_be", FORD=FORD, TWIN=TWIN)
def test_what_a_factor_cannot_be(text, options, told):
    with pytest.raises(BalcliError, match=f"^{re.escape(told)}"):
        size_scheme(build_text(text), "factor", **options)


# ------------------------------------------------------------------ as it is typed, and read
@pytest.fixture
def ford(tmp_path):
    return write(tmp_path / "ford.toml", FORD)


def test_a_factor_alone_chooses_its_scheme(ford):
    in_full = run_here("balance", ford, "--scheme", "factor", "--factor", "0.51").out
    assert "bobweight (rotating + share)" in run_here("balance", ford, "--measured", "1872.1 g").out
    assert [run_here("balance", ford, "--factor", share).out for share in ("51%", "51 %")] == [in_full] * 2
    assert "Ford 302: counterweights at every throw (auto)\n" in run_here("balance", ford).out


def test_a_throw_that_counts_as_0_is_told_once(tmp_path):
    """Below the bobweight, in the table and on the card; in JSON as a sentence of its own."""
    file = write(tmp_path / "e.toml", engine_text(crank="stroke = 80\nthrows = [0]"))
    for form in ("table", "card"):
        told = " ".join(run_here("balance", file, "--factor", "50%", "-f", form).out.split())
        assert told.count("counts as 0, because crank.throw_mass is 0 or not given") == 1
    assert "counts as 0" in ask_json("balance", file, "--factor", "50%")["details"]["throw"]


# ------------------------------------------------------------------ the card for the wall
def test_the_card_as_a_page(ford):
    """Grams as summed by hand; ounces of 28.3495 g."""
    asked = "balance --factor 51% --planes=-220mm,230mm --radius 2.5in --drill 1in --max-depth 40mm --width 400mm"
    page = run_here(*asked.split(), "--grade", "G16", "--mass", "46 kg", "--format", "card", ford).out
    lines = [" ".join(line.split()) for line in page.splitlines()]
    wanted = """
Bobweight card: Ford 302
balance factor 51 % of all reciprocating mass on the pin = 102 % of one
Bobweight of pins 1+5, 2+6, 3+7, 4+8
quantity × each g oz
big end 2 × 400 800 28.219
rod bearing 2 × 44 88 3.1041
oil 2 × 5 10 0.35274
rotating sum 898 31.676
piston 2 × 600 1200 42.329
pin 2 × 130 260 9.1712
rings 2 × 41 82 2.8925
locks 2 × 4 8 0.28219
small end 2 × 180 360 12.699
reciprocating sum 1910 67.373
balanced share 1910 × 51 % 974.1 34.36
bobweight (rotating + share) 1872.1 66.036
throw itself, at the crank radius 1100 38.801
counterweight opposite 2972.1 104.84
counterweight 1 88527 -161.6 from pin 1 crank axis -220
counterweight 1 88527 18.4 from pin 1 crank axis 230
1 counterweight 18.4 13 38.84
2 counterweight -161.6 13 38.84
1 88527 585.7 ±0.66%
""".strip().splitlines()
    assert [line for line in wanted if line not in lines] == []
    assert max(map(len, page.splitlines())) == 80


def test_a_piston_a_little_heavier_does_not_decide_which_factor_is_best():
    """Pins of a crank of three at 120 degrees balance each other: a factor changes its moment, of
    which 50 % leaves least in a vee at 90 degrees, and the force by 10 g alone. On one pin it
    changes the force.
    """
    vee = write_engine(0, 240, 120, layout="bank_angle = 90") + "[cylinder.2]\npiston_mass = 1.01\n"
    factors = (0.4, 0.5, 0.6)
    found = size_scheme(build_text(vee), "factor", factor=factors, planes="ends")
    forces, moments = ([getattr(peaks, name) for peaks in found.sweep] for name in ("peak_force_N", "peak_moment_Nm"))
    assert max(forces) - min(forces) < 0.03 * find_scales(build_text(vee)).force
    assert moments[1] < 0.9 * min(moments[0], moments[2])
    assert figures(found)["factor"] == 0.5
    one = size_scheme(build_text(SMALL["one"]), "factor", factor=factors)
    best = min(one.sweep, key=lambda peaks: peaks.peak_force_N)
    assert figures(one)["factor"] == best.factor
