"""The page of a calculation for a classification society: `torsion --format html`."""

import hashlib
import re
from html import unescape

import numpy as np
import pytest
from support.chains import chain_text
from support.commands import ask_torsion, refusal, run_here

from balcli.torsional_vibration.answer import TorsionQuestion
from balcli.torsional_vibration.class_sheet import make_cases
from balcli.torsional_vibration.load import load_source
from balcli.torsional_vibration.plot import DrawnCase, make_limits, make_torsion

SECTIONS = [
    "inputs",
    "mass-elastic",
    "throw",
    "modes",
    "holzer",
    "excitation",
    "criticals",
    "response",
    "limits",
    "misfire",
    "dampers",
    "conventions",
]
ENGINE = """
name = "three & a <wheel>"
source = "assumed"
crank = { stroke = 90, throws = [0, 240, 120], spacing = 98 }
rod = { length = 150, mass = 0.7, cg = 45 }
piston = { bore = 86, mass = 0.5 }
layout.firing_order = [1, 3, 2]
operation.speed = 2300
gas = { cycle = "wiebe", compression_ratio = 10, heat = 1300 }
[torsion]
throw_stiffness = 3.4e5
throw_inertia = 6200
throw_diameter = 60
loss = 0.03
damping = 0.8
[[torsion.front]]
name = "hub"
inertia = 4000
stiffness = 2e5
damper = { kind = "viscous", inertia = 9000, damping = 4 }
[[torsion.rear]]
name = "flywheel"
inertia = 2e5
stiffness = 4e5
diameter = 60
limit = { rule = "M68", tensile = 500, ck = 0.5 }
[[torsion.rear]]
name = "fan"
inertia = 1e5
stiffness = 3e5
torque_limit = { speed = [2000, 2400], torque = [90, 80] }
"""
CHAIN = chain_text({"a": 1, "b": 2}, {("a", "b"): {"stiffness": 9e4, "loss": 0.03}}, [("a", 2, 300, 60)])
SPEEDS = ("--speeds", "2000:2400:100", "--orders", "0.5-6")


@pytest.fixture(scope="module")
def page():
    return run_here("torsion", "-", *SPEEDS, "--format", "html", stdin=ENGINE).out


@pytest.fixture(scope="module")
def cases(tmp_path_factory):
    path = tmp_path_factory.mktemp("sheet") / "engine.toml"
    path.write_text(ENGINE, encoding="utf-8")
    orders = np.arange(0.5, 6.5, 0.5)
    return make_cases(load_source(str(path), orders), TorsionQuestion(np.array([2000.0, 2200, 2400])))


def read_section(page, key):
    """The text of a section, without tags."""
    section = re.search(rf'<section id="{key}">(.*?)</section>', page, re.S)[1]
    return " ".join(unescape(re.sub("<[^>]*>", " ", section)).split())


def test_the_sections_stand_in_order_and_none_is_empty(page):
    assert re.findall(r'<section id="([^"]*)"', page) == SECTIONS
    assert all(len(read_section(page, key).split()) > 5 for key in SECTIONS)
    assert "<script" not in page
    assert "http" not in page.replace('xmlns="http://www.w3.org/', "").replace("xmlns:xlink", "").replace(
        '="http://www.w3.org/1999/xlink"', ""
    )


def test_inputs_name_the_file_by_its_hash(page):
    inputs = read_section(page, "inputs")
    assert hashlib.sha256(ENGINE.encode()).hexdigest() in inputs
    assert "three & a <wheel>" in inputs
    assert "three & a <wheel>" not in page  # escaped
    assert "assumed layout.strokes = 4" in inputs


def test_the_page_has_the_figures_of_the_command(page):
    firing = ask_torsion(ENGINE, *SPEEDS)
    worst = ask_torsion(ENGINE, *SPEEDS, "--misfire", "worst", "--compressing")
    for section, answer in (("limits", firing), ("misfire", worst)):
        text = read_section(page, section)
        for limit in answer["limits"]:
            if "share" in limit:
                assert f"{limit['share']:.0%} {limit['verdict']}" in text
    misfire = read_section(page, "misfire")
    assert f"cylinder {worst['misfire']['worst']} compresses but does not burn" in misfire
    for mode in firing["modes"]:
        assert f"{mode['frequency_Hz']:.6g}" in read_section(page, "modes")
    driven = sorted({critical["mode"] for critical in firing["criticals"]})[:4]
    holzer = read_section(page, "holzer")
    assert [int(mode) for mode in re.findall(r"table, mode (\d+)", holzer)] == driven


def test_limits_dampers_and_conventions_in_words(page):
    shafts = read_section(page, "mass-elastic")
    assert "bore, mm loss" in shafts
    assert "M68: tensile strength 500 N/mm², c_K 0.5, rated 2300 rpm" in shafts
    assert "90, 80 N·m at 2000, 2400 rpm" in shafts
    assert "hub: viscous damper, ring 0.009 kg·m², damping 4 N·m·s/rad." in read_section(page, "dampers")
    assert "IACS UR M68, revisions 2 and 3" in read_section(page, "conventions")


def test_dimensions_from_which_stiffnesses_follow_are_listed():
    """Of a throw, and of a plain shaft; a page without them has no column of lengths."""
    bearing = "bearing = { pin_diameter = 50, pin_bore = 18, pin_length = 32, main_diameter = 60, main_length = 34 }\n"
    text = ENGINE.replace("[torsion]\n", f"{bearing}[torsion]\nweb_thickness = 21\nweb_width = 88\n")
    text = text.replace("throw_stiffness = 3.4e5\n", "").replace("stiffness = 3e5", "diameter = 48\nlength = 410")
    page = run_here("torsion", "-", *SPEEDS, "--format", "html", stdin=text).out
    throw = read_section(page, "throw")
    assert "crank radius 45 mm main journal diameter 60 mm, 34 mm long crank pin diameter 50 mm, bore 18 mm," in throw
    assert "web 21 mm thick, 88 mm wide shear modulus 79.3 GPa" in throw
    shafts = read_section(page, "mass-elastic")
    assert "bore, mm length, mm loss" in shafts
    assert re.search(r"fan \S+ 48 0 410 0.03", shafts)


def test_the_amplitude_of_each_order_is_that_of_one_cylinder(cases):
    """At rated speed, order 3 of three equal cylinders is in phase: its sum is that of the throws' angles."""
    from balcli.torsional_vibration.modes import sum_phases

    system = cases.firing.system
    modes = cases.firing.modes
    sums = sum_phases(system.excitation, modes, 2300 * np.pi / 30)
    third = list(system.excitation.orders).index(3)
    of_throws = [abs(mode.shape[system.excitation.nodes].sum()) for mode in modes]
    assert sums[:, third] == pytest.approx(of_throws, rel=1e-9)


def test_pictures_have_curves_of_both_cases_and_limits(cases):
    drawn = [DrawnCase("firing", cases.firing), DrawnCase("misfire", cases.misfire)]
    (figure,) = make_limits(drawn)
    rule, table = figure.axes
    assert [len(ax.lines) for ax in (rule, table)] == [4, 3]  # M68 has a transient limit
    named = [[text.get_text() for text in ax.get_legend().get_texts()] for ax in (rule, table)]
    assert named == [["firing", "misfire", "limit", "transient limit"], ["firing", "misfire", "limit"]]
    continuous, transient = rule.lines[2:]
    factor = cases.firing.system.limits[0].limit.transient
    assert transient.get_ydata() == pytest.approx(factor * continuous.get_ydata())
    assert table.lines[2].get_ydata()[[0, -1]] == pytest.approx([90, 80])
    worst = cases.firing.response.shafts[3].worst
    assert max(rule.lines[0].get_ydata()) == pytest.approx(worst.stress_Pa / 1e6, rel=1e-9)


def test_the_picture_of_the_response_has_the_limit_of_each_shaft(cases):
    stresses = make_torsion(cases.firing, "response").axes[0].lines
    shafts = [shaft for shaft in cases.firing.response.shafts if shaft.stress_Pa is not None]
    assert len(stresses) == len(shafts) + 2  # the limits of the flywheel
    assert cases.firing.system.limits[0].limit.at(np.array([2000.0]))[0] / 1e6 == pytest.approx(
        stresses[-2].get_ydata()[0]
    )


def test_a_chain_has_no_misfire_and_no_throw():
    page = run_here("torsion", "-", "--speeds", "500:900:100", "-f", "html", stdin=CHAIN).out
    assert "there is no misfire" in read_section(page, "misfire")
    assert "no dimensions of a throw" in read_section(page, "throw")
    assert "no limit" in read_section(page, "limits")
    assert "no dampers" in read_section(page, "dampers")


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ([], "--format html: give the range of speeds"),
        ([*SPEEDS, "--misfire", "1"], "--format html: leave --misfire out"),
        ([*SPEEDS, "--damper", "viscous"], "--format html: leave --damper out"),
        ([*SPEEDS, "-o", "sheet.csv"], ".csv is csv, but --format is html"),
    ],
)
def test_options_that_do_not_suit(options, told):
    assert told in refusal("torsion", "-", "--format", "html", *options, stdin=ENGINE)


def test_the_ending_of_a_file_makes_a_page(tmp_path):
    target = tmp_path / "sheet.html"
    assert run_here("torsion", "-", "--speeds", "500:900:100", "-o", target, stdin=CHAIN).status == 0
    assert target.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
