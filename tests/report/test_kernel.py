"""The kernel of the live page, in a real browser, on engines that differ in one thing: which key of the file holds, both
sides of limits, devices and rods of every form. Figures of the page are those of the analysis.
"""

import pytest
from support.browser import live
from support.engines import GOOD, build_text, changed
from support.kernel import answer, compute, differences, find_findings

from balcli.report.live import describe_engine, explain_still
from balcli.show.sheet import number
from balcli.sizing.ladder import find_ladder


@pytest.fixture
def page(browser, report):
    """A browser with the page of a plain engine."""
    browser.keep(report(GOOD))
    return browser


def describe(engine):
    """Data of the page for an engine, and its numbers."""
    assert explain_still(engine) == ""
    data = describe_engine(engine.model, engine, "")
    return data, {each["name"]: each["value"] for each in data["numbers"]}


def list_steps(found):
    return [step["step"] for step in found["ladder"]["steps"]]


def name_steps(engine):
    """Steps of the command's ladder."""
    return [step.step for step in find_ladder(engine).steps]


def check(page, text):
    """Figures, verdict and steps of the page are those of Python."""
    engine = build_text(text)
    (found,) = compute(page, [describe(engine)])
    wanted = answer(engine)
    assert list(differences(wanted, found)) == []
    scale = wanted["ladder"]["scale"]
    assert found["ladder"]["scale"] == pytest.approx({key: scale[key] for key in ("force_N", "moment_Nm")})
    assert found["verdict"] == find_findings(engine)
    assert list_steps(found) == name_steps(engine)


# ------------------------------------------------------------------ limits
SHIP = """\
[crank]
stroke = {stroke}
throws = [0, 144, 216, 288, 72]
spacing = 1020
throw_mass = 900
[rod]
ratio = 0.4
mass = 900
cg = 300
[piston]
bore = {bore}
mass = 500
[crosshead]
mass = {crosshead}
[layout]
strokes = {strokes}
[operation]
speed = 105
power = 5000
"""


@live
@pytest.mark.parametrize(
    ("stroke", "bore", "crosshead", "strokes", "judged_by_power"),
    [
        *((801, 900, 0, 2, True), (800, 900, 0, 2, False), (753, 300, 0, 2, True), (749, 300, 0, 2, False)),
        *((501, 900, 1, 2, True), (500, 100, 900, 2, False), (1001, 900, 1, 4, False)),
    ],
)
def test_engines_with_crossheads_are_the_same(page, stroke, bore, crosshead, strokes, judged_by_power):
    """Two-stroke engines with a stroke above 0.8 m, 2.5 bores or, with a crosshead, 0.5 m get compensators."""
    text = SHIP.format(stroke=stroke, bore=bore, crosshead=crosshead, strokes=strokes)
    names = [step.step for step in find_ladder(build_text(text)).steps]
    assert ("compensators of order 2" in names) == judged_by_power
    check(page, text)


# ------------------------------------------------------------------ rods, masses, devices
ROD = "mass = 0.6\ncg = 45\n"


@live
@pytest.mark.parametrize(
    "rod",
    [
        *(ROD, f"{ROD}inertia = 1800\n", "mass = 0.9\ncg = 60\n", "small_end = 0.2\nbig_end = 0.5\n"),
        *(f"{ROD}pendulum = {{ period = {period}, pivot = '{end}_end' }}\n"
          for period, end in ((0.75, "small"), (0.7, "small"), (0.65, "big"), (0.68, "big"))),
    ],
)  # fmt: skip
def test_rods_of_every_form(page, rod):
    check(page, changed((ROD, rod)))


@live
@pytest.mark.parametrize(
    "keys",
    ["[piston]\nskirt = 24", "[frame]\ncrankcase = 50\n[piston]", "[frame]\ncrankcase = 500\n[piston]\nskirt = 130"],
)
def test_the_room_around_the_crank(page, keys):
    """Steel of the steps, by skirt, crankcase, or neither; pistons without room leave it out."""
    check(page, changed(("[piston]", keys)))


@live
@pytest.mark.parametrize("places", ["[-200, -100, 0, 100, 200]", "[-190, 0, 210]"])
def test_main_bearings_at_given_places(page, places):
    check(page, GOOD + f"[bearing]\nmain_positions = {places}\n")


VEE = changed(("[0, 180, 180, 0]", "[0, 90]"), ("firing_order = [1, 3, 4, 2]", "banks = [-30, 60]"))


@live
@pytest.mark.parametrize(
    "keys",
    [
        *("[crosshead]\nmass = 0.3\n", "[cylinder.2]\ncrosshead_mass = 0.7\n"),
        "[crosshead]\nmass = 0.3\n[cylinder.2]\ncrosshead_mass = 0.7\n",
        *(
            "[cylinder.2]\npiston_mass = 0.9\n",
            "[cylinder.2]\npiston_offset = -3\n",
            "[cylinder.2]\nrod_length = 180\n",
        ),
        "[cylinder.2]\nrod_mass = 0.8\nrod_cg = 50\n",
        "[bobweight]\nrod_bearing = 0.05\noil = 0.02\n",
    ],
)
@pytest.mark.parametrize("offset", [0, 5])
def test_a_key_of_a_cylinder_holds_before_that_of_all(page, keys, offset):
    """Two rods on each throw share its mass; the offset of all pistons holds where a cylinder has none of its own."""
    check(page, VEE.replace("mass = 0.5", f"mass = 0.5\noffset = {offset}") + keys)


@live
@pytest.mark.parametrize(
    "device",
    [
        *("[[counterweight]]\nmass = 2\nradius = 50\nangle = 150\nposition = 30\n",
          "[[counterweight]]\nunbalance = 100000\nangle = 150\nposition = -30\n"),
        *(f"[[shaft]]\nratio = {ratio}\nunbalance = 20000\nangle = 40\nposition = 30\nat = [70, -20]\n" for ratio in (1, -1, 2, -2)),
        "[[shaft]]\nratio = -2\nmass = 0.5\nradius = 40\nangle = 40\n",
        *(f"[[slider]]\norder = {order}\nunbalance = 20000\ndirection = {direction}\nangle = 70\n" for order, direction in ((1, 30), (2, 100))),
    ],
)  # fmt: skip
def test_devices_of_every_form(page, device):
    """Angles of counterweights count from cylinder 1's crank pin, which is at -30 deg; those of others from x."""
    check(page, VEE + device)


@live
@pytest.mark.parametrize("throws", ["[0]", "[0, 180]", "[0, 240, 120]", "[0, 180, 180, 0]"])
@pytest.mark.parametrize("spacing", ["spacing = 100\n", "spacing = 60\n"])
def test_ladders_of_forces_and_moments(page, throws, spacing):
    """The scale of moments is the length of the engine, at least a stroke of 90 mm. A three has moments alone."""
    check(
        page, changed(("[0, 180, 180, 0]", throws), ("firing_order = [1, 3, 4, 2]\n", ""), ("spacing = 100\n", spacing))
    )


@live
@pytest.mark.parametrize("throws", ["[0, 180]", "[0, 240, 120]", "[0, 180, 180, 0]"])
def test_moments_that_are_not_known_count_for_nothing(page, throws):
    pairs = (("[0, 180, 180, 0]", throws), ("firing_order = [1, 3, 4, 2]\n", ""), ("spacing = 100\n", ""))
    engine = build_text(changed(*pairs))
    (found,) = compute(page, [describe(engine)])
    assert found["verdict"] == find_findings(engine)
    assert list_steps(found) == name_steps(engine)


# ------------------------------------------------------------------ what the page cannot compute
@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ([], ""),
        ([("throw_mass = 0.8", "throw_mass = [0.8, 0.8, 0.8, 0.9]")], "its throws differ"),
        ([("stroke = 90", "stroke = [90, 90, 90, 80]")], "its throws differ"),
        ([("length = 160\nmass = 0.6\ncg = 45", "motion = 'harmonic'")], "its pistons have harmonic motion"),
        ([("speed = 3000", "speed = 3000\nspeed_ripple = [{ order = 2, amplitude = 0.01, angle = 0 }]")], "its speed is uneven"),
    ],
)  # fmt: skip
def test_why_an_engine_cannot_be_changed(changes, reason):
    assert explain_still(build_text(changed(*changes))) == reason


# ------------------------------------------------------------------ input and figures
WRONG = "document.getElementById('live-wrong').textContent"


def follow(page, address):
    listen = "addEventListener('hashchange', () => setTimeout(done, 0), { once: true })"
    page.run(f"new Promise(done => {{ {listen}; location.hash = '{address}'; }})")


@live
@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        *(("crank.stroke", 0, "is not above 0"), ("crank.stroke", 1e-3, "")),
        *(("piston.mass", 0, ""), ("piston.mass", -1e-9, "is below 0")),
        *(("shaft.1.ratio", 1000, ""), ("shaft.1.ratio", 1001, "is above 1000"), ("shaft.1.ratio", -1000, "")),
        *(("shaft.1.ratio", -1001, "is below -1000"), ("counterweight.1.unbalance", 0, "")),
        ("counterweight.1.unbalance", -1, "is below 0"),
    ],
)
def test_numbers_reach_to_their_limits(page, name, value, told):
    follow(page, f"#{name}={value:.9f}")
    wrong = page.run(WRONG)
    assert (wrong == "") == (told == "")
    assert told in wrong


@live
@pytest.mark.parametrize("force", [9.9e-5, 1.01e-4, 0.5, 9999.4, 10_001, 99_999, 123_456, 999_999, 1_000_001, 1.5e7])
def test_figures_are_written_as_the_command_writes_them(page, force):
    assert page.run(f"Tables.number({force})") == number(force)
