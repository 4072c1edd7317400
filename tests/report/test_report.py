"""The page: whole without a network, whatever an engine is called; and alive in a real browser."""

import json
import re
from contextlib import nullcontext
from functools import cache
from html.parser import HTMLParser

import numpy as np
import pytest
from support.browser import live
from support.cases import slow
from support.commands import ask
from support.engines import GOOD, RADIAL, build_text, changed
from support.paths import ENGINES, write
from support.pictures import without_pictures

from balcli.analysis.answer import analyze
from balcli.balancing.answer import balance
from balcli.forces.kinds import KINDS
from balcli.report.page import Answers, page
from balcli.show.units import IMPERIAL, SI

HOSTILE = "</script><script>alert('name')</script><img src=x onerror=alert(1)> & \"quoted\" {{ 7 * 7 }} 发动机"
ROTARY = RADIAL.partition("[articulation]")[0].replace("radial = 7", "radial = 7\nrotary = true")


def make_report(text: str, system=SI) -> str:
    """The page of an engine file."""
    engine = build_text(text)
    return page(Answers(analyze(engine, None, {*KINDS, "peak"}), balance(engine)), system)


report = cache(make_report)  # many tests look at one page


class Outline(HTMLParser):
    """Tags of a page, and whatever it would load."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.loads: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        found = [value for key, value in attrs if key in ("src", "href", "xlink:href")]
        self.loads += [value for value in found if not value.startswith(("#", "data:"))]


@pytest.mark.stress
def test_it_loads_nothing():
    outline = Outline(text := report(GOOD))
    assert outline.loads == []
    assert "@import" not in text
    named = re.findall(r"https?://[^\"'\s<)]+", text)
    assert {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xlink"} >= {*named}


@cache
def printed_report(name: str) -> str:
    """What the command makes of an engine that comes with balcli."""
    with without_pictures():
        return ask("report", ENGINES / f"{name}.toml", "-o", "-")


def test_a_moving_curve_has_no_second_picture():
    """The locus turns with the crank, of the engine as it is and with its devices; the picture stands still where no
    script runs.
    """
    balanced = balance(engine := build_text(GOOD), "two-shaft")
    text = page(Answers(analyze(engine), balanced), SI)
    moving = re.sub("<noscript>.*?</noscript>", "", text, flags=re.S)
    for after in ("", "-after"):
        assert f'id="spectrum-force{after}-figure_1"' in text
        assert f'id="polar-force{after}-figure_1"' not in moving
    assert 'id="polar-force-figure_1"' in text
    assert 'id="curves-force-figure_1"' in text
    assert 'id="stars-' in text


@pytest.mark.parametrize("pictures", [False, *slow(True)])
def test_a_hostile_name_stays_text(pictures):
    with nullcontext() if pictures else without_pictures():
        tame, wild = (make_report(text) for text in (GOOD, changed(('"in-line four"', json.dumps(HOSTILE)))))
    assert Outline(wild).tags == Outline(tame).tags
    assert "{{ 7 * 7 }}" in wild


def test_imperial_units_reach_everything():
    with without_pictures():
        text = report(GOOD, system=IMPERIAL)
    scene = json.loads(re.search(r'id="scene">(.*?)</script>', text, re.S)[1])
    unit = scene["units"]["force"]
    assert (unit["name"], unit["thousand"]) == ("lbf", "")
    second = next(row for row in scene["variants"][0]["force"] if row[0] == 2)
    force = analyze(build_text(GOOD)).spectra.force.select_orders([2])
    assert second[1] == pytest.approx(float(force.forward[0].real) / 4.4482216152605, rel=1e-12)


@pytest.mark.stress
@pytest.mark.parametrize(
    "text",
    [RADIAL, ROTARY, changed(("bore = 86\n", "")), changed(("mass = 0.5", "mass = 0"), ("mass = 0.6", "mass = 0"))],
)
def test_unusual_engines_have_a_page(text):
    scene = json.loads(re.search(r'id="scene">(.*?)</script>', report(text), re.S)[1])
    assert scene["bore"] > 0


# ------------------------------------------------------------------ in a browser
@pytest.fixture
def show(browser, tmp_path):
    def opened(text: str = GOOD, **how):
        file = write(tmp_path / "page.html", report(text))
        browser.open(file, **how)
        return browser

    return opened


def turn(browser, theta: float) -> None:
    browser.run(f"angle.value = {theta}; angle.dispatchEvent(new Event('input'))")


def numbers(browser, selector: str, *attributes: str) -> list[float]:
    return [float(browser.run(f"document.querySelector('{selector}').getAttribute('{name}')")) for name in attributes]


@live
def test_the_keyboard_moves_the_vector(show):
    """Arrow keys on the slider; the vector's tip is the force, x up and y to the right."""
    page = show()
    page.run("angle.focus()")
    for _ in range(3):
        page.press("ArrowRight", 39)
    assert page.run("angle.value") == "3"
    curve = analyze(build_text(GOOD)).spectra.force
    y, x = numbers(page, "#force-vector", "x2", "y2")
    forces = [float(abs(curve.values(np.radians(t)))) for t in (0, 3)]
    assert abs(y) < 1e-6
    turn(page, 0)
    assert numbers(page, "#force-vector", "y2")[0] / x == pytest.approx(forces[0] / forces[1], rel=1e-4)
    assert float(page.read("force-now").split()[0]) == pytest.approx(forces[0], rel=1e-3)


@live
@pytest.mark.parametrize(
    "text", [GOOD, pytest.param(RADIAL, marks=pytest.mark.stress), pytest.param(ROTARY, marks=pytest.mark.stress)]
)
def test_the_rods_keep_their_length_and_pistons_are_where_the_engine_has_them(show, text):
    page, c = show(text), build_text(text).cylinders
    for theta in (0, 77, 250):
        turn(page, theta)
        ends = page.run(
            "[...document.querySelectorAll('#end .rod')]"
            ".map((rod) => ['x1', 'y1', 'x2', 'y2'].map((k) => Number(rod.getAttribute(k))))"
        )
        psi = np.radians(theta + np.ravel(c.angle_deg))
        if c.linkage is None:
            lam, eps = float(c.lam.flat[0]), float(c.eps.flat[0])
            places = np.cos(psi) + np.sqrt(1 - (lam * np.sin(psi) - eps) ** 2) / lam
        else:
            last = len(c.linkage.mass) - 1
            moved = (c.linkage.motion(psi[[k]], c.lam, c.eps).place[min(k, last), 0] for k in range(c.count))
            places = np.array(list(moved))
        lengths = np.broadcast_to(np.ravel(c.radius / c.lam) * 1e3, c.count)
        drawn = np.array(ends)
        rods = np.hypot(drawn[:, 2] - drawn[:, 0], drawn[:, 3] - drawn[:, 1])
        assert np.sort(rods) == pytest.approx(np.sort(lengths), rel=1e-9)
        assert np.sort(-drawn[:, 3]) == pytest.approx(np.sort(places * float(c.radius[0]) * 1e3), rel=1e-9)


@live
def test_orders_are_switched(show):
    page = show()
    before = numbers(page, "#force-vector", "y2")
    page.run("for (const box of document.querySelectorAll('[name=order]')) if (box.value !== '4') box.click()")
    fourth = page.read("force-now")
    page.run("document.querySelector('[name=order][value=\"4\"]').click()")
    assert before != [0]
    force = analyze(build_text(GOOD)).spectra.force.select_orders([4])
    assert float(fourth.split()[0]) == pytest.approx(float(force.major[0]), rel=1e-3)
    assert page.read("force-now") == "balanced"


@live
def test_the_fitted_engine_shakes_less(show):
    page = show()
    page.run("document.querySelectorAll('[name=variant]')[2].click()")
    after = balance(build_text(GOOD)).after
    force = float(abs(after.spectra.force.values(0.0)))
    assert float(page.read("force-now").split()[0]) == pytest.approx(force, rel=1e-3)
    assert page.run("document.querySelectorAll('#end .weight').length") == len(after.engine.devices)


@live
def test_play_and_pause_by_keyboard(show):
    page = show()
    page.run("play.focus()")
    page.press(" ", 32, " ")
    page.run("new Promise((done) => setTimeout(done, 400))")
    page.press(" ", 32, " ")
    reached = float(page.run("angle.value"))
    page.run("new Promise((done) => setTimeout(done, 200))")
    assert 5 < reached < 90
    assert float(page.run("angle.value")) == reached


@live
def test_light_and_dark_and_in_print(show):
    paper, white = "getComputedStyle(document.body).backgroundColor", "rgb(255, 255, 255)"
    page = show()
    assert page.run(paper) == white
    page.run("theme.click()")
    changed = page.run(paper)
    page = show(dark=True)
    dark = page.run(paper)
    assert dark == changed != white
    page.call("Emulation.setEmulatedMedia", media="print", features=[{"name": "prefers-color-scheme", "value": "dark"}])
    assert page.run("getComputedStyle(document.querySelector('.controls')).display") == "none"
    assert page.run(paper) == white
    page.call("Emulation.setEmulatedMedia", media="")


@pytest.mark.parametrize(
    ("name", "signs"),
    [
        ("i4_wiebe", ('id="torque-curve"', "Gas torque")),
        ("i6_diesel", ('id="torsion"',)),
        ("i4_mounts", ("rocking", "On its mounts")),
    ],
)
def test_a_chapter_is_in_the_page_of_an_engine_that_has_it(name, signs):
    for sign in signs:
        assert sign in printed_report(name)
        assert sign not in printed_report("i5")


def test_torque_and_pressure_run_with_the_crank():
    """Of an engine with gas, over its cycle."""
    data = re.search(r'id="running">(.*?)</script>', printed_report("i4_wiebe"), re.DOTALL)
    running = json.loads(data[1])
    assert running["cycle"] == 720
    torque, pressure = running["curves"]
    assert len(torque["total"]) == len(pressure["total"]) == 361
    assert max(pressure["total"]) == pytest.approx(61.3, abs=0.2)
    assert torque["mean"] == pytest.approx(206.7, abs=0.1)
    assert torque["total"][0] == pytest.approx(torque["total"][-1], abs=1e-3)


def test_the_page_switches_between_the_steps_of_the_ladder():
    """And shows their table; with another scheme also the engine with its devices."""
    engine, ladder = build_text(GOOD), balance(build_text(GOOD)).ladder
    names = [f"{k} {step.step}" for k, step in enumerate(ladder.steps)]
    assert "What balances it, step by step" in report(GOOD)
    for scheme, more in (("auto", []), ("two-shaft", ["scheme two-shaft"])):
        balanced = balance(engine, scheme)
        with without_pictures():
            text = page(Answers(analyze(engine), balanced), SI)
        variants = json.loads(re.search(r'id="scene">(.*?)</script>', text, re.S)[1])["variants"]
        assert [variant["label"] for variant in variants] == names + more
        for variant, step in zip(variants, ladder.steps, strict=False):
            assert len(variant["devices"]) == len(step.remedy.devices)
        second = [next(row for row in variant["force"] if row[0] == 2)[1] for variant in variants]
        assert second[0] == second[1] > 100 > 1e-6 > abs(second[2])
