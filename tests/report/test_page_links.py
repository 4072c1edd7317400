"""Links with a whole engine, and what of a page is that of its file alone: in a real browser."""

import base64
import json
import re
import tomllib
import zlib

import pytest
from support.browser import live
from support.engines import GOOD, RADIAL, build_text

from balcli import load_example
from balcli.report.live import explain_still
from balcli.sizing.ladder import find_ladder

WAIT = "new Promise(done => setTimeout(done, {}))"
KEEP = "window.sent = '', Object.defineProperty(navigator, 'clipboard', { value: { writeText: async (text) => { sent = text; } } }), 0"


@pytest.fixture(scope="module")
def page(report):
    """The page of a four."""
    return report(GOOD)


@pytest.fixture(scope="module")
def link(browser, page):
    """The hash of the address that this page copies."""
    browser.open(page)
    return copy_link(browser)


def copy_link(browser):
    """The hash of the address that the page copies."""
    browser.run(KEEP)
    browser.run("document.getElementById('link').click()")
    browser.wait_for("sent")
    address = browser.run("sent")
    assert re.match(r"https://[^#]+/play\.html#toml=", address)
    return "#" + address.partition("#")[2]


# ------------------------------------------------------------------ links
@live
def test_a_link_from_a_file_gives_the_same_engine_on_the_site(browser, page, play):
    browser.open(page)
    browser.run("Live.change('crank.stroke', 80), Page.choose('1')")
    browser.run(WAIT.format(250))
    figures = json.loads(browser.read("figures"))
    address = copy_link(browser)
    assert address.endswith("&crank.stroke=80&step=1")
    packed = re.search(r"toml=([\w-]+)&", address)[1]
    text = zlib.decompress(base64.urlsafe_b64decode(packed + "=" * (-len(packed) % 4))).decode()
    assert tomllib.loads(text) == tomllib.loads(GOOD)
    browser.open(play, address=address)
    browser.run(WAIT.format(250))
    assert browser.complaints == []
    assert json.loads(browser.read("figures")) == figures
    assert browser.run("document.querySelector('h1').textContent") == "in-line four"
    assert browser.run("[...document.querySelectorAll('#changes li')].map(one => one.firstChild.textContent)") == [
        "crank.stroke 90 → 80 mm"
    ]
    assert browser.run("document.querySelector('#steps input:checked').value") == "1"
    assert tomllib.loads(browser.run("Live.writeFile()")) == tomllib.loads(GOOD.replace("stroke = 90", "stroke = 80"))
    assert browser.run("Live.writeAddress()") == address
    assert browser.run("document.body.classList.contains('changed')")  # the sentences are those of the first engine


@live
@pytest.mark.parametrize(
    "damage", [lambda link: link[:-9], lambda link: link[:20], lambda link: "#toml=", lambda link: "#toml=%22x"]
)
def test_a_damaged_link_says_so_and_the_page_shows_its_first_engine(browser, link, play, damage):
    browser.open(play, address=damage(link))
    browser.wait_for("document.getElementById('live-wrong').textContent")
    assert browser.read("live-wrong") == "the link is incomplete"
    assert browser.run("document.querySelector('h1').textContent") == "in-line three"
    assert browser.complaints == []


@live
@pytest.mark.parametrize(("more", "fits"), [(19_000, True), (20_500, False)])
def test_a_long_file_has_to_be_sent_itself(browser, report, more, fits):
    browser.open(report(GOOD + f"# {'x' * (more - len(GOOD))}\n"))
    state = browser.run("[link.disabled, link.textContent]")
    assert state == ([False, "Copy link"] if fits else [True, "Too long for a link: send the file"])


# ------------------------------------------------------------------ steps and schemes
@live
@pytest.mark.parametrize("text", [GOOD, RADIAL])
def test_a_step_that_the_engine_does_not_have_is_an_error(browser, report, text):
    """Also on a page without sliders, whose steps are in its address, too."""
    file = report(text)
    steps = len(find_ladder(build_text(text)).steps)
    browser.open(file, address="#step=9")
    assert browser.read("live-wrong") == f"step: this engine has steps 0 to {steps - 1}"
    browser.open(file, address="#step=0")
    assert browser.read("live-wrong") == ""
    assert browser.run("document.querySelector('#steps input:checked').value") == "0"


SCHEMES = "[...document.querySelectorAll('#steps label')].filter(one => one.textContent.startsWith('scheme')).map(one => [one.textContent, one.firstChild.disabled, one.firstChild.checked])"


@live
def test_a_scheme_is_one_more_choice_and_greyed_after_a_change(browser, report):
    browser.open(report(GOOD, "--scheme", "two-shaft"))
    assert browser.run(SCHEMES) == [["scheme two-shaft", False, True]]
    browser.run("Live.change('rod.length', 170)")
    assert browser.run(SCHEMES) == [["scheme two-shaft", True, False]]
    assert browser.read("live-wrong") == ""
    browser.run("document.getElementById('reset').click()")
    assert browser.run(SCHEMES) == [["scheme two-shaft", False, True]]


# ------------------------------------------------------------------ motion
@live
def test_the_drawing_turns_but_not_for_readers_who_want_no_motion(browser, page):
    where = "document.getElementById('angle').value"
    at = {}
    for still in (True, False):
        browser.open(page, still=still)
        at[still] = [browser.run(f"{WAIT.format(150)}.then(() => {where})") for _ in range(2)]
    peak = browser.run("Page.ofFile.peak.force_deg")
    assert at[True] == [str(round(peak))] * 2
    assert at[False][0] != at[False][1]


# ------------------------------------------------------------------ what the page cannot compute
def test_engines_whose_compensators_depend_on_gas_cannot_be_changed():
    """Given the power in the file, they can."""
    engine = load_example("marine6")
    assert explain_still(engine) == "its compensators depend on the power of its gas"


TRUNK = """\
[crank]
stroke = 700
throws = [0, 120, 240]
spacing = 800
throw_mass = 0.8
[rod]
length = 1500
mass = 0.4
cg = 30
[piston]
bore = 600
mass = 0.3
[layout]
strokes = 2
[operation]
speed = 300
[gas]
cycle = "otto"
compression_ratio = 8
imep = 6
exhaust_opens = 110
"""


@live
def test_a_stroke_that_makes_it_an_engine_with_crosshead_is_refused_where_the_power_is_of_gas(browser, report):
    """Both sides of 0.8 m; with its power in the file, the page computes such an engine."""
    refused = {}
    for text in (TRUNK, TRUNK.replace("speed = 300", "speed = 300\npower = 2000")):
        browser.open(report(text))
        for stroke in (800, 801):
            browser.run(f"Live.change('crank.stroke', {stroke})")
            refused[stroke] = [*refused.get(stroke, []), "with crossheads" in browser.read("live-wrong")]
    assert refused == {800: [False, False], 801: [True, False]}
