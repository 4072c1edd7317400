"""Stiffness of a throw from its dimensions, by two formulas."""

import math

import pytest
from support.commands import ask, ask_csv, ask_json, ask_torsion, refusal, run_here

from balcli.torsional_vibration.throw_stiffness import ThrowSize

# Every part of Ker Wilson's sum is 1e-6 mm^-3: (60 + 40)/100^4, (53.75 + 40)/(100^4 - 50^4) and 50/(50 * 100^3).
SIZE = ThrowSize(
    radius=0.090,
    journal_length=0.060,
    journal_diameter=0.100,
    journal_bore=0,
    pin_length=0.05375,
    pin_diameter=0.100,
    pin_bore=0.050,
    thickness=0.050,
    width=0.100,
    shear_modulus=80e9,
)
BASE = math.pi * 80e9 / 32 / 1e3  # N m/rad of a flexibility of 1e-6 mm^-3


def test_ker_wilson_by_hand():
    assert SIZE.ker_wilson == pytest.approx(BASE / 3)
    assert SIZE._replace(width=0.200).ker_wilson == pytest.approx(BASE / (2 + 1 / 8))
    assert SIZE._replace(thickness=0.100).ker_wilson == pytest.approx(BASE / (2 + 1 / 2))
    assert SIZE._replace(radius=0.140).ker_wilson == pytest.approx(BASE / (2 + 2))
    assert SIZE._replace(pin_length=0.1475).ker_wilson == pytest.approx(BASE / (2 + 2))
    assert SIZE._replace(journal_bore=0.050).ker_wilson == pytest.approx(BASE / (2 + 1 / 0.9375))
    assert SIZE._replace(shear_modulus=160e9).ker_wilson == pytest.approx(2 * BASE / 3)


def test_carter_by_hand():
    """The parts are (60 + 40)/100^4, 0.75 * 53.75/(100^4 - 50^4) and 1.5 * 90/(50 * 100^3)."""
    assert SIZE.carter == pytest.approx(BASE / (1 + 0.43 + 2.7))
    assert SIZE._replace(width=0.200).carter == pytest.approx(BASE / (1 + 0.43 + 2.7 / 8))
    assert SIZE._replace(thickness=0.100).carter == pytest.approx(BASE / (1.4 + 0.43 + 2.7 / 2))
    assert SIZE._replace(pin_bore=0).carter == pytest.approx(BASE / (1 + 0.43 * 0.9375 + 2.7))


def test_a_throw_of_twice_the_size_is_eight_times_as_stiff():
    lengths = {key: 2 * value for key, value in SIZE._asdict().items() if key != "shear_modulus"}
    twice = SIZE._replace(**lengths)
    assert twice.ker_wilson == pytest.approx(8 * SIZE.ker_wilson)
    assert twice.carter == pytest.approx(8 * SIZE.carter)


@pytest.mark.parametrize(("radius", "holds"), [(0.0401, True), (0.0399, False)])
def test_ker_wilson_needs_a_free_web(radius, holds):
    assert (SIZE._replace(radius=radius).ker_wilson is not None) == holds


def test_the_weakest_section_has_the_larger_stress():
    assert SIZE.weakest_section == (0.100, 0.050)
    assert SIZE._replace(pin_bore=0, pin_diameter=0.101).weakest_section == (0.100, 0)


BEARING = "[bearing]\nmain_diameter = 60\nmain_length = 26\npin_diameter = 50\npin_length = 25\n"
ENGINE = """
crank = { stroke = 86, throws = [0, 180, 180, 0], spacing = 94 }
rod = { length = 146, mass = 0.6, cg = 42 }
piston = { bore = 84, mass = 0.42 }
layout.firing_order = [1, 3, 4, 2]
"""
WEB = "web_thickness = 20\nweb_width = 82\n"
REST = 'throw_inertia = 5200\nloss = 0.02\nrear = [{ name = "flywheel", inertia = 1.35e5, stiffness = 6.4e5 }]\n'


def make(given="", web=WEB, bearing=BEARING, engine=ENGINE):
    stiffness = f"throw_stiffness = {given}\n" if given else ""
    return f"{engine}{bearing}[torsion]\n{stiffness}{web}{REST}"


def test_each_formula_is_the_number_that_it_prints():
    mean = ask_torsion(make())
    throw = mean["throw"]
    both = throw["ker_wilson_Nm_per_rad"], throw["carter_Nm_per_rad"]
    assert throw["used"] == "mean"
    assert throw["used_Nm_per_rad"] == pytest.approx(sum(both) / 2)
    assert throw["spread"] == pytest.approx(abs(both[0] - both[1]) / (sum(both) / 2))
    for word, key, stiffness in zip(("ker-wilson", "carter"), ("ker_wilson", "carter"), both, strict=True):
        by_word = ask_torsion(make(f'"{word}"'))
        by_number = ask_torsion(make(repr(stiffness)))
        assert by_word["throw"]["used"] == word
        assert by_number["throw"]["used"] == "file"
        assert by_number["throw"]["used_Nm_per_rad"] == stiffness
        assert by_word["modes"] == by_number["modes"]
        assert by_word["modes"][0]["frequency_Hz"] == pytest.approx(throw[f"{key}_mode_1_Hz"], rel=1e-12)
    assumed = {each["path"]: each["value"] for each in mean["assumed"]}
    assert assumed["torsion.throw_stiffness"] == pytest.approx(throw["used_Nm_per_rad"], rel=1e-11)
    assert assumed["torsion.shear_modulus"] == 79.3


def test_different_stiffnesses_of_the_file_have_no_single_value():
    throw = ask_torsion(make("[5e5, 6e5, 5e5]"))["throw"]
    assert throw["used"] == "file"
    assert "used_Nm_per_rad" not in throw


def test_a_file_without_dimensions_has_no_throw():
    assert "throw" not in ask_torsion(make("5e5", web=""))


def test_diameter_and_bore_follow_from_the_dimensions():
    """The pin has the larger stress: 50/(50^4 - 20^4) against 60/60^4."""
    speeds = ("--speeds", "3000,3100", "--orders", "1-4")
    hollow = BEARING + "pin_bore = 20\n"
    own = ask_torsion(make(bearing=hollow, web=f"{WEB}throw_diameter = 50\nthrow_bore = 20\n"), *speeds)
    assert ask_torsion(make(bearing=hollow), *speeds)["response"] == own["response"]
    assert "stress_Pa" in own["response"]["shafts"][0]


def test_the_thickness_may_be_that_of_equal_webs():
    web = "[[web]]\nthickness = 20\nhub = 90\nboss = 70\ndensity = 7.8\n"
    with_webs = ask_torsion(make(web="web_width = 82\n") + web)
    alone = ask_torsion(make())
    assert with_webs["throw"]["carter_Nm_per_rad"] == alone["throw"]["carter_Nm_per_rad"]
    assert {"path": "torsion.web_thickness", "value": 20, "unit": "mm"} in with_webs["assumed"]
    unequal = web.replace("hub", "webs = [1, 2, 3]\nhub") + web.replace("thickness = 20", "thickness = 22")
    refused = refusal("torsion", "-", stdin=make(web="web_width = 82\n") + unequal)
    assert "torsion.web_thickness is missing" in refused


def test_the_table_names_what_is_used_and_csv_has_it():
    table = ask("torsion", "-", stdin=make('"carter"'))
    assert "Carter, used" in table
    assert "The formulas differ by" in table
    csv = {row["figure"]: row["value"] for row in ask_csv("torsion", "-", stdin=make()) if row["part"] == "throw"}
    assert csv["used"] == "mean"


def test_formulas_that_differ_much_are_a_doubt():
    """Soft webs: at 10 mm both formulas differ by more than 15 %, at 14 mm by less."""
    differs = "torsion.throw_stiffness: follows from dimensions, but the formulas differ by"
    soft = make(web="web_thickness = 20\nweb_width = 60\n")
    stiff = make(web=WEB)
    assert differs in run_here("torsion", "-", stdin=soft).err
    assert differs not in run_here("torsion", "-", stdin=stiff).err


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (make(web="web_thickness = 20\n"), "is missing; give the stiffness between the 4 throws"),
        (make(web="web_thickness = 20\n"), "of which torsion.web_width is missing"),
        (make('"carter"', web="", bearing=""), 'is "carter", but bearing.main_diameter, bearing.main_length'),
        (make('"bicera"'), '"bicera" is no known word; give a figure, a list, or "ker-wilson" or "carter"'),
        (make(bearing=BEARING + "pin_bore = 50\n"), "bearing: pin_bore = 50 mm: has to be below"),
        (make(engine=ENGINE.replace("86", "40")), "overlap of journal and pin"),
        (make(engine=ENGINE.replace("stroke = 86", "stroke = [86, 84, 84, 86]")), "the strokes differ (84 and 86 mm)"),
        (make(bearing=BEARING.replace("main_diameter = 60\n", "")), "has main_length without main_diameter"),
        (make(bearing=BEARING.replace("main_length = 26\n", "")), "has main_diameter without main_width"),
    ],
)
def test_mistakes(text, told):
    assert told in run_here("torsion", "-", stdin=text).err


def test_carter_holds_for_journals_and_pins_that_overlap():
    throw = ask_json("torsion", "-", stdin=make('"carter"', engine=ENGINE.replace("86", "42").replace("146", "80")))[
        "throw"
    ]
    assert set(throw) == {"carter_Nm_per_rad", "used_Nm_per_rad", "used", "carter_mode_1_Hz"}


def test_dimensions_vary_in_a_sweep():
    rows = ask_csv(
        "sweep",
        "-",
        "--vary",
        "torsion.web_width=80,82",
        "--vary",
        "bearing.pin_diameter=48,50",
        "-q",
        "torsion.1.Hz",
        stdin=make(),
    )
    swept = {(row["torsion.web_width"], row["bearing.pin_diameter"]): float(row["torsion.1.Hz"]) for row in rows}
    for (width, pin), hertz in swept.items():
        own = make(bearing=BEARING.replace("50", pin), web=WEB.replace("82", width))
        assert hertz == pytest.approx(ask_torsion(own)["modes"][0]["frequency_Hz"], rel=1e-12)
    assert len(set(swept.values())) == 4


@pytest.mark.parametrize(("own", "formula"), [("1%", True), ("20%", False)])
def test_throws_scatter_by_half_the_spread(own, formula):
    options = ("-q", "torsion.1.Hz", "--samples", "2", "--seed", "1", "--stiffness-scatter", own)
    out = " ".join(run_here("scatter", "-", *options, stdin=make()).out.split())
    spread = ask_torsion(make())["throw"]["spread"]
    assert (f"stiffness ±{50 * spread:.4g} %" in out) == formula
    assert ("half of the difference of the two formulas" in out) == formula
