"""The page: whole without a network, whatever an engine is called; and alive in a real browser."""

import json
import re
import xml.etree.ElementTree as ET
from contextlib import nullcontext
from functools import cache
from html.parser import HTMLParser

import numpy as np
import pytest
from support.browser import live
from support.cases import slow
from support.commands import ask, run_python
from support.engines import GOOD, RADIAL, build_text, changed
from support.paths import ENGINES, write
from support.pictures import without_pictures

from balcli import load_example
from balcli.analysis.answer import analyze
from balcli.balancing.answer import balance
from balcli.forces.kinds import KINDS
from balcli.report.page import Answers, mark_code, page
from balcli.show.sheet import number
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


def test_a_page_without_torsion_needs_no_library_of_pictures(tmp_path):
    file = write(tmp_path / "engine.toml", GOOD)
    code = (
        "import sys; from balcli.cli import main; sys.argv = ['balcli', 'report', sys.argv[1], sys.argv[2]]\n"
        "try: main()\nexcept SystemExit: pass\nassert 'matplotlib' not in sys.modules"
    )
    done = run_python("-c", code, str(file), str(tmp_path / "page.html"))
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "page.html").stat().st_size <= 220_000


@pytest.mark.slow
def test_the_largest_page_of_the_examples_is_small():
    """With gas, a moving piston and pictures of torsion."""
    assert len(ask("report", ENGINES / "i6_diesel.toml", "--cylinder", "1", "-o", "-").encode()) <= 220_000


def test_what_stands_between_backticks_is_code():
    assert mark_code("fits `a<b` & c") == "fits <code>a&lt;b</code> &amp; c"
    assert "<code>balcli balance</code> fits step" in report(GOOD)


@pytest.mark.parametrize("pictures", [False, *slow(True)])
def test_a_hostile_name_stays_text(pictures):
    with nullcontext() if pictures else without_pictures():
        tame, wild = (make_report(text) for text in (GOOD, changed(('"in-line four"', json.dumps(HOSTILE)))))
    assert Outline(wild).tags == Outline(tame).tags
    assert "{{ 7 * 7 }}" in wild


def test_imperial_units_reach_everything():
    with without_pictures():
        text = report(GOOD, system=IMPERIAL)
    data = json.loads(re.search(r'id="page">(.*?)</script>', text, re.S)[1])
    assert data["units"]["force"] == {"name": "lbf", "size": pytest.approx(4.4482216152605)}
    assert "force, lbf" in text
    assert "N·m" not in re.sub("<script.*?</script>", "", text, flags=re.S)


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
    """Arrow keys on the slider; the dot on the path is the force as drawn, x up and y to the right."""
    page = show()
    page.run("document.querySelector('#steps input').click(), angle.value = 0, angle.focus()")
    for _ in range(3):
        page.press("ArrowRight", 39)
    assert page.run("angle.value") == "3"
    curve = analyze(build_text(GOOD)).spectra.force
    forces = [float(curve.values(np.radians(theta)).real) for theta in (0, 3)]
    heights = []
    for theta in (3, 0):
        turn(page, theta)
        x, y = numbers(page, "#path-force .shake", "cx", "cy")
        assert x == pytest.approx(150)
        heights.insert(0, 150 - y)
    assert heights[0] / heights[1] == pytest.approx(forces[0] / forces[1], rel=1e-4)


@live
@pytest.mark.parametrize(
    "text", [GOOD, pytest.param(RADIAL, marks=pytest.mark.stress), pytest.param(ROTARY, marks=pytest.mark.stress)]
)
def test_the_rods_keep_their_length_and_pistons_are_where_the_engine_has_them(show, text):
    page = show(text)
    c = build_text(text).cylinders
    for theta in (0, 77, 250):
        turn(page, theta)
        ends = page.run(
            "[...document.querySelectorAll('#end .rod')]"
            ".map((rod) => ['x1', 'y1', 'x2', 'y2'].map((k) => Number(rod.getAttribute(k))))"
        )
        psi = np.radians(theta + np.ravel(c.angle_deg))
        if c.linkage is None:
            lam = float(c.lam.flat[0])
            eps = float(c.eps.flat[0])
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
def test_the_fitted_engine_shakes_less(show):
    """The devices of the chosen step are drawn, and the key figures are those of its row."""
    page = show()
    ladder = balance(build_text(GOOD)).ladder
    page.run("document.querySelectorAll('#steps input')[2].click()")
    step = ladder.steps[2]
    unit = SI.force.fit(ladder.steps[0].peak_force_N)
    assert number(unit.of(ladder.steps[0].peak_force_N)) in page.read("key-large")
    assert number(unit.of(step.peak_force_N)) in page.read("key-large")
    assert page.run("document.querySelectorAll('#end .weight').length") == len(step.remedy.devices)
    assert "with step 2" in page.read("key-with")


@live
def test_what_is_written_of_the_file_is_what_the_page_writes(show):
    """Drawn anew after a change that was taken back, the tables are those that Python wrote."""
    page = show(GOOD)
    tables = "['ladder-table', 'largest-list'].map(id => document.getElementById(id).outerHTML.replace(/\\n/g, ''))"
    before = page.run(tables)
    page.run("Page.show(Page.ofFile, { scene: null, changed: true })")
    page.run("new Promise(done => setTimeout(done, 300))")
    assert [re.sub(' class="sel"| class=""', "", text) for text in page.run(tables)] == [
        re.sub(' class="sel"| class=""', "", text) for text in before
    ]


@live
def test_a_chart_is_saved_with_its_colours_and_figures(show):
    """As SVG with colours written out, as a picture, and as a table with units."""
    page = show()
    written = ET.fromstring(page.run("Charts.writeSvg(document.getElementById('bars-force'))"))
    bars = [each for each in written.iter() if each.tag.endswith("rect") and each.get("height") == "10"]
    assert {each.get("fill").split("(")[0] for each in bars} == {"rgb", "url"}
    assert not any(each.get("class") for each in written.iter())
    page.run("HTMLAnchorElement.prototype.click = function () {}")
    assert page.run("Charts.savePng(document.getElementById('bars-force'), 'x.png')") > 2000
    page.run("window.kept = [], URL.createObjectURL = (blob) => { kept.push(blob); return 'blob:x'; }")
    page.run("[...document.querySelectorAll('#path button')].find(each => each.textContent === 'CSV').click()")
    head, *rows = page.run("kept[0].text()").splitlines()
    assert head.startswith('"crank angle, deg","as drawn: force along x, force, N"')
    force = analyze(build_text(GOOD)).spectra.force
    assert float(rows[30].split(",")[1]) == pytest.approx(float(force.values(np.radians(30)).real))


@live
def test_play_and_pause_by_keyboard(show):
    page = show()
    page.run("play.focus()")
    page.press(" ", 32, " ")
    page.run("new Promise((done) => setTimeout(done, 400))")
    page.press(" ", 32, " ")
    reached = float(page.run("angle.value"))
    page.run("new Promise((done) => setTimeout(done, 200))")
    assert reached != 0
    assert float(page.run("angle.value")) == reached


@live
def test_charts_have_their_usual_width_on_paper(show):
    """Their width in the window is another one; what they say is cut if it is narrow."""
    page = show()
    width = "document.querySelector('#bars svg').viewBox.baseVal.width"
    in_window = page.run(width)
    assert in_window != 520
    page.run("dispatchEvent(new Event('beforeprint'))")
    assert page.run(width) == 520
    page.run("dispatchEvent(new Event('afterprint'))")
    assert page.run(width) == in_window


@live
def test_light_and_dark_and_in_print(show):
    paper = "getComputedStyle(document.body).backgroundColor"
    white = "rgb(255, 255, 255)"
    page = show()
    assert page.run(paper) == white
    page.run("theme.click()")
    changed = page.run(paper)
    page = show(dark=True)
    dark = page.run(paper)
    assert dark == changed != white
    page.call("Emulation.setEmulatedMedia", media="print", features=[{"name": "prefers-color-scheme", "value": "dark"}])
    assert page.run("getComputedStyle(document.querySelector('.acts')).display") == "none"
    assert page.run(paper) == white
    page.call("Emulation.setEmulatedMedia", media="")


@pytest.mark.parametrize(
    ("name", "signs"),
    [
        ("i4_wiebe", ('id="torque-curve"', "Gas torque")),
        ("i6_diesel", ('id="torsion"',)),
        ("i4_mounts", ('id="rocking"', "On its mounts")),
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


def test_the_page_has_the_steps_of_the_ladder():
    """With their devices; another scheme is one more choice."""
    engine = build_text(GOOD)
    ladder = balance(build_text(GOOD)).ladder
    assert "What balances it, step by step" in report(GOOD)
    for scheme, more in (("auto", []), ("two-shaft", ["scheme two-shaft"])):
        text = page(Answers(analyze(engine), balance(engine, scheme)), SI)
        figures = json.loads(re.search(r'id="figures">(.*?)</script>', text, re.S)[1])
        steps = figures["ladder"]["steps"]
        assert [step["step"] for step in steps] == [step.step for step in ladder.steps]
        assert [len(step["devices"]) for step in steps] == [len(step.remedy.devices) for step in ladder.steps]
        extra = [step["step"] for step in figures["page"]["extra"]]
        assert [name for name in extra if name.startswith("scheme")] == more
        (second,) = (change for change in steps[2]["changes"] if change["order"] == 2)
        assert np.abs(second["force"]).max() < 1e-6


def test_a_page_of_several_cranks_names_their_point_of_reference_and_has_no_stars():
    """As the command does; each counterweight is on the crank of an engine."""
    cranks = load_example("napier_deltic")
    fitted = balance(cranks, "counterweights")
    text = page(Answers(analyze(cranks, None, {*KINDS, "peak"}), fitted), SI)
    assert "<h2>About the point of reference, <small>" in text
    assert '<section id="stars" class="needs-script" hidden>' in text
    assert 'href="#stars"' not in text
    figures = json.loads(re.search(r'id="figures">(.*?)</script>', text, re.S)[1])
    devices = [device for choice in figures["page"]["extra"] for device in choice["devices"]]
    assert {device["crank"] for device in devices} == {device.engine for device in fitted.remedy.devices}
    assert "<h2>About the crank axis, <small>" in report(GOOD)
    assert '<section id="stars" class="needs-script">' in report(GOOD)
