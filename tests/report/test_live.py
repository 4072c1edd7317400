"""The live page, in a real browser: its figures are those of `balcli analyze`, its address and its
files give the same engine again.
"""

import json
import random
import re
import tomllib
from urllib.parse import quote

import numpy as np
import pytest
from docs_site import make_play_page
from support.browser import live
from support.commands import ask, ask_json
from support.engines import GOOD, RADIAL, build_text, changed, engine_text
from support.paths import write

from balcli import load_example
from balcli.analysis.answer import analyze
from balcli.analysis.show import sheet
from balcli.engine.build import build
from balcli.errors import InputError
from balcli.file import examples
from balcli.file.units import ANGLE, LENGTH, MASS, SPEED, UNBALANCE, convert
from balcli.report.live import describe_engine, explain_still
from balcli.report.page import FOLDER
from balcli.show.units import SI
from balcli.sizing.ladder import WEIGHTS_AT_THROWS, find_ladder

pytestmark = pytest.mark.slow
PRESS = "[...document.querySelectorAll('button')].find(b => b.textContent === '{}').click()"
WAIT = "new Promise(done => setTimeout(done, 100))"
VECTORS, SCALARS = ("force_N", "moment_Nm"), ("couple_Nm", "inertia_torque_Nm", "roll_Nm")
WANTED = ("force", "moment", "couple", "torque", "roll", "peak", "ladder")
WEIGHED = GOOD + "[[counterweight]]\nmass = 2\nradius = 50\nangle = 180\n"
HOSTILE = '</script><img src=x onerror=alert(1)> & "quoted" {{ 7 * 7 }} 发动机'


@pytest.fixture(scope="module")
def play(tmp_path_factory):
    return write(tmp_path_factory.mktemp("site") / "play.html", make_play_page())


@pytest.fixture
def show(browser, tmp_path):
    def opened(text: str = GOOD, address: str = "", *options: str, name: str = "engine.toml", **how):
        file = write(tmp_path / name, text)
        ask("-q", "report", file, *options, "-o", tmp_path / "page.html")
        browser.open(tmp_path / "page.html", **how)
        browser.run(f"change.open = true, {WAIT}")
        if address:
            go(browser, address)
        return browser

    return opened


def go(page, address):
    """Follow an address within the page."""
    listen = "addEventListener('hashchange', () => setTimeout(done, 0), { once: true })"
    page.run(f"new Promise(done => {{ {listen}; location.hash = {json.dumps(address)}; }})")


def figures(page):
    return json.loads(page.read("figures"))


def compute(browser, engines):
    """What the kernel makes of engines: pairs of the page's data and numbers."""
    browser.run(f"window.asked = {json.dumps(engines)}, 0")
    each = (
        "asked.map(([d, n]) => { const e = Kernel.assemble(d, n); return Kernel.describe(e, Kernel.findLadder(e)); })"
    )
    return json.loads(browser.run(f"JSON.stringify({each})"))


def differences(wanted, found):
    """Figures of orders, peaks and ladder that differ by more than 1e-9 of the largest."""
    mine = {entry["order"]: entry for entry in found["orders"]}
    for key in VECTORS + SCALARS:
        parts = ("forward", "backward") if key in VECTORS else ("cos", "sin")
        pairs = [
            (e["order"], part, np.array(e[key][part]), np.array(mine[e["order"]][key][part]))
            for e in wanted["orders"]
            if key in e
            for part in parts
        ]
        for e in wanted["orders"]:
            for word in ("vertical", "horizontal", "yawing", "pitching"):
                size, other = (each.get(key, {}).get(word, {}).get("amplitude") for each in (e, mine[e["order"]]))
                if (size is None) != (other is None) or size is not None:
                    pairs.append((e["order"], word, np.array(size, float), np.array(other, float)))
        largest = max((np.abs(one).max() for *_, one, _ in pairs), default=0)
        yield from (
            (key, order, part, one, other)
            for order, part, one, other in pairs
            if abs(one - other).max() > 1e-9 * largest
        )
    scale = wanted["ladder"]["scale"]
    for key in VECTORS:
        if key in wanted["peak"] and abs(wanted["peak"][key] - found["peak"][key]) > 1e-9 * scale[key]:
            yield key, wanted["peak"], found["peak"]
    steps = {step["step"]: step for step in wanted["ladder"]["steps"]}
    for step in found["ladder"]["steps"]:
        own = steps.get(step["step"], {})
        for key in ("peak_force_N", "peak_moment_Nm"):
            limit = 1e-9 * scale.get(key.removeprefix("peak_"), 1)
            if "counterweights at every throw" not in steps and abs(own.get(key, 0) - step.get(key, 0)) > limit:
                yield step, own


def answer(engine):
    return analyze(engine, range(13), WANTED).to_dict()


def describe(name):
    model = load_example(name).model
    engine = build(model)
    return model, engine, None if explain_still(engine) else describe_engine(model, engine, "")


def values(data):
    return {each["name"]: each["value"] for each in data["numbers"]}


# ------------------------------------------------------------------ the kernel
@live
def test_the_kernel_agrees_on_every_example(browser, play):
    browser.open(play)
    known = [(name, *found) for name in examples.names() if (found := describe(name))[2]]
    assert len(known) > 60
    made = compute(browser, [[data, values(data)] for *_, data in known])
    wrong = {
        name: list(differences(answer(engine), found)) for (name, _, engine, _), found in zip(known, made, strict=True)
    }
    assert not {name: each for name, each in wrong.items() if each}


@live
@pytest.mark.stress
def test_the_kernel_agrees_on_random_engines(browser, play):
    """Examples with some of their numbers changed, all at once."""
    browser.open(play)
    dice, known = random.Random(5), [found for name in examples.names() if (found := describe(name))[2]]
    tried = []
    while len(tried) < 300:
        model, _, data = dice.choice(known)
        units = {each["name"]: each["unit"] for each in data["numbers"]}
        new = {}
        for name in dice.sample([*units], dice.randint(1, 5)):
            value = values(data)[name]
            if name.endswith((".ratio", ".order")) and name != "rod.ratio":
                continue
            new[name] = value * dice.uniform(0.8, 1.25) if value else dice.uniform(0, 5 if units[name] == "mm" else 1)
            if units[name] == "deg":
                new[name] = value + dice.uniform(-40, 40)
        try:
            tried.append((new, build(model, new), data))
        except InputError:
            continue
    made = compute(browser, [[data, values(data) | new] for new, _, data in tried])
    wrong = [(new, each) for (new, engine, _), found in zip(tried, made, strict=True)
             if (each := list(differences(answer(engine), found)))]  # fmt: skip
    assert not wrong


def test_the_kernel_is_short_and_needs_nothing():
    text = (FOLDER / "engine.js").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 300
    assert "import" not in text
    assert "require(" not in text


def test_the_site_page_is_small():
    assert len(make_play_page().encode()) <= 600_000


# ------------------------------------------------------------------ the address
@live
def test_a_right_angle_makes_a_circle_of_a_v_twin(browser, play):
    browser.open(play)
    go(browser, "#engine=vtwin45&layout.bank_angle=90")
    first = figures(browser)["orders"][1]["force_N"]
    assert first["backward"] == [0, 0]
    assert first["major"] == first["minor"] > 5e4
    assert browser.complaints == []
    assert [url for url in browser.requests if not url.startswith(("file:", "data:"))] == []


@live
def test_bad_parts_of_an_address_are_named_and_the_rest_applies(show):
    page = show(address="#crank.stroke=80 mm&crank.strok=3&piston.mass=heavy&rod.length=5 furlong&rod.mass=650 g")
    told = page.read("live-wrong")
    assert "crank.strok: there is no such number" in told
    assert 'piston.mass: "heavy" is not a number; give a number in kg' in told
    assert 'rod.length: the unit "furlong" is not known here' in told
    assert page.run("Live.writeAddress()") == "#crank.stroke=80&rod.mass=0.65"
    wanted = answer(build_text(changed(("stroke = 90", "stroke = 80"), ("mass = 0.6", "mass = 0.65"))))
    assert not list(differences(wanted, figures(page)))


@live
def test_units_are_read_as_in_the_file(show):
    spelled = {
        "crank.stroke": (LENGTH, '3.5"', "3½ in.", "0,09 m", "90 MM", "3 1/2 inches"),
        "piston.mass": (MASS, "0.5 Kg", "1.1 LBS", "500 gram", "17 oz"),
        "counterweight.1.unbalance": (UNBALANCE, "9000 g·mm", "9000 gmm", "0.009 kg·m", "12.5 oz*in", "9 kg mm"),
        "counterweight.1.angle": (ANGLE, "30°", "0.5 rad", "1/8 turn"),
        "operation.speed": (SPEED, "5500 1/min", "100 rps", "300 rad/s"),
    }
    page = show()
    for name, (dimension, *texts) in spelled.items():
        for text in texts:
            go(page, f"#{name}={quote(text)}")
            wanted = convert(text, dimension)
            assert page.run(f"Live.numbers['{name}']") == pytest.approx(wanted), text
            assert page.read("live-wrong") == ""


@live
@pytest.mark.parametrize("key", ["mass", "radius"])
def test_a_device_without_size_is_refused_as_in_the_file(show, key):
    page = show(WEIGHED, f"#counterweight.1.{key}=none&rod.mass=0.7")
    told = page.read("live-wrong")
    left = WEIGHED.replace("mass = 2\n" if key == "mass" else "radius = 50\n", "")
    with pytest.raises(InputError) as refused:
        build_text(left)
    assert told == str(refused.value.problems[0])
    assert page.run("Live.writeAddress()") == "#rod.mass=0.7"


@live
def test_an_address_is_followed_while_the_page_writes_its_own(show):
    """The page writes its address a moment after a change, which may be just now."""
    page = show()
    go(page, "#crank.stroke=81")
    listen = "addEventListener('hashchange', () => setTimeout(done, 0), { once: true })"
    both = "location.hash = '#crank.stroke=80'; history.replaceState(null, '', location.pathname)"
    page.run(f"new Promise(done => {{ {listen}; {both}; }})")
    assert page.run("Live.numbers['crank.stroke']") == 80


@live
def test_bad_input_keeps_the_last_good_engine(show):
    page = show()
    before = figures(page)
    field = "document.getElementById('n-rod.length')"
    page.run(f"{field}.value = '20'; {field}.dispatchEvent(new Event('change'))")
    assert "rod.length: the crank cannot turn" in page.read("live-wrong")
    assert figures(page) == before
    assert page.run(f"{field}.value") == "160"
    page.run(f"{field}.value = '6 in'; {field}.dispatchEvent(new Event('change'))")
    assert page.read("live-wrong") == ""
    assert page.run("Live.numbers['rod.length']") == pytest.approx(152.4)


# ------------------------------------------------------------------ controls
@live
def test_keyboard_undo_and_fit(show):
    page = show()
    page.run("document.querySelector('input[type=range][name=\"piston.mass\"]').focus()")
    page.press("ArrowRight", 39)
    assert page.run("Live.numbers['piston.mass']") > 0.5
    assert page.run("document.getElementById('live-redo').disabled")
    page.run(PRESS.format("Undo"))
    assert page.run("Live.numbers['piston.mass']") == 0.5
    page.run(PRESS.format("Fit"))
    assert page.run("Live.numbers['shaft.1.unbalance']") > 0
    assert figures(page)["orders"][2]["force_N"]["major"] == pytest.approx(0, abs=1e-6)
    page.run(PRESS.format("Remove shaft 1"))
    shafts = page.run("Object.keys(Live.numbers).filter(name => name.startsWith('shaft'))")
    assert all(name.startswith("shaft.2") for name in shafts)
    page.run(PRESS.format("Reset"))
    assert page.run("Live.writeAddress()") == ""
    assert page.complaints == []


@live
@pytest.mark.parametrize("width", [360, 800, 1280, 1600])
def test_the_page_fits_its_window(show, width):
    page = show(width=width, dark=width == 360)
    assert page.run("document.documentElement.scrollWidth <= window.innerWidth")
    labelled = "[...document.querySelectorAll('#live-numbers input')].every(i => i.labels.length || i.ariaLabel)"
    assert page.run(labelled)


STEPS = "[...document.querySelectorAll('#live-ladder tbody th')].map(cell => cell.textContent)"


@live
def test_steps_have_the_names_that_the_command_takes(browser, play, tmp_path):
    """The command lists one step more, so that its numbers differ from those of a row here."""
    browser.open(play)
    for name in examples.names():
        engine = build(load_example(name).model)
        if not explain_still(engine):
            go(browser, f"#engine={name}")
            listed = [one.step for one in find_ladder(engine).steps if one.step != WEIGHTS_AT_THROWS]
            assert browser.run(STEPS) == listed, name
    file = write(tmp_path / "i3.toml", examples.text("i3"))
    go(browser, "#engine=i3")
    for step in browser.run(STEPS)[1:]:
        assert ask_json("-q", "balance", file, "--step", step)["step"] == step


@live
def test_the_verdict_is_that_of_the_command(browser, play):
    """Except for what gas does."""
    browser.open(play)
    for name in examples.names():
        engine = build(load_example(name).model)
        if explain_still(engine):
            continue
        go(browser, f"#engine={name}")
        wanted = next(each.paragraphs for each in sheet(analyze(engine), SI).parts if each.title == "Verdict")
        told = " ".join(_cut_causes(one) for one in wanted if "rocks the engine" not in one)
        assert browser.read("live-verdict") == told, name


@live
@pytest.mark.parametrize("small", ["0%", "1%", "20%"])
@pytest.mark.parametrize("name", ["i4_shafts", "ford_ecoboost_1_0", "v8_flatplane", "wartsila_6rtflex96c", "flat12"])
def test_the_verdict_heeds_devices_and_what_is_small(show, name, small):
    text = examples.text(name) + "[[shaft]]\nratio = -1\nunbalance = 20000\nposition = 40\n"
    page = show(text, "", "--small", small)
    told = ask("-q", "analyze", "-", "--small", small, stdin=text).partition("Verdict")[2]
    assert page.read("live-verdict") == _cut_causes(" ".join(told.partition("Largest by order")[0].split()))


@live
def test_the_verdict_names_the_direction_of_a_force_of_nearly_constant_size(show):
    """A 90-degree twin with one piston 5 g heavier: the part against the crank is 0.2 % of the other."""
    text = engine_text(
        piston="mass = 0.5", crank="stroke = 90\nthrows = [0]\nthrow_mass = 0.8", layout="bank_angle = 90"
    )
    text += "[cylinder.2]\npiston_mass = 0.505\n"
    told = " ".join(ask("-q", "analyze", "-", stdin=text).partition("Verdict")[2].split())
    assert "turning with the crank; counterweights cancel" in told
    assert show(text).read("live-verdict") in told


def _cut_causes(verdict: str) -> str:
    """The verdict without the causes of the couple, which the page does not know."""
    return re.sub(r"(Transverse couple: .*?\))[^.]*\.", r"\1.", verdict)


@live
def test_roll_with_gas_is_headed_as_of_inertia(browser, play):
    browser.open(play)
    head = "document.querySelector('#live-orders thead th:last-child').textContent"
    go(browser, "#engine=i4_wiebe")
    assert browser.run(head) == "roll of inertia, N·m"
    go(browser, "#engine=vtwin45")
    assert browser.run(head) == "roll, N·m"


def copy_command(page):
    page.run(f"{PRESS.format('Copy command')}, {WAIT}")
    return page.read("live-done")


@live
def test_the_command_for_a_changed_engine_names_the_changed_file(show):
    page = show()
    assert copy_command(page) == "Copied: balcli analyze engine.toml"
    go(page, "#crank.stroke=80")
    assert copy_command(page).startswith("Copied: balcli analyze engine_changed.toml. Download TOML")
    page.run("window.saved = '', HTMLAnchorElement.prototype.click = function () { saved = this.download; }")
    page.run(PRESS.format("Download TOML"))
    assert page.run("saved") == "engine_changed.toml"
    page.run(PRESS.format("Reset"))
    assert copy_command(page) == "Copied: balcli analyze engine.toml"
    assert copy_command(show(GOOD, "", "--small", "2%")) == "Copied: balcli analyze engine.toml --small 2%"


@live
def test_the_command_quotes_the_name_of_the_file_and_says_where_there_is_none(show, browser, play):
    assert copy_command(show(name="my $HOME engine.toml")) == "Copied: balcli analyze 'my $HOME engine.toml'"
    browser.open(play)
    assert copy_command(browser).startswith("Copied: balcli analyze vtwin45.toml. Download TOML")


@live
def test_a_hostile_name_stays_text(show):
    page = show(changed(('"in-line four"', json.dumps(HOSTILE))), "#crank.stroke=<img src=x onerror=alert(1)>")
    assert page.complaints == []
    assert [url for url in page.requests if not url.startswith(("file:", "data:"))] == []
    assert page.run("document.querySelectorAll('img, h1 *').length") == 0
    assert page.run("document.querySelector('h1').textContent") == HOSTILE


# ------------------------------------------------------------------ files
FREE = GOOD.replace("firing_order = [1, 3, 4, 2]\n", "")
INLINE = "crank = { stroke = 90, throws = [0, 180, 180, 0], spacing = 100, throw_mass = 0.8 }\n" + FREE.partition(
    "[rod]"
)[2].replace("length", "rod.length").replace("mass = 0.6", "rod.mass = 0.6").replace("cg", "rod.cg")
FILES = {
    "throws in a list": ("#crank.throws.2=170&crank.throws.3=190&rod.inertia=2000", GOOD.replace("cg = 45", "cg = 45\ninertia = 1800")),
    "a list over several lines": ("#crank.throws.2=170", GOOD.replace("[0, 180, 180, 0]", "[\n 0,\n 180, 180,\n 0 ]")),
    "tables in braces": ("#crank.stroke=80", INLINE),
    "a key that the file leaves out": ("#piston.offset=2&crank.splay=0", GOOD),
    "a table that it leaves out": ("#operation.speed=4000", FREE.partition("[operation]")[0]),
    "a new device": ("#counterweight.1.unbalance=5000&counterweight.1.angle=90", GOOD),
    "a place of a new shaft": ("#shaft.1.at.1=5", GOOD),
    "a device less": ("#shaft.1=none", GOOD + "[[shaft]]\nratio = 2\nunbalance = 100\n# the other\n[[shaft]]\nratio = -2\nunbalance = 300\n"),
    "an unbalance in place of mass and radius": ("#counterweight.1.unbalance=5000", WEIGHED),
    "a device in place of another": ("#counterweight.1=none&counterweight.2.unbalance=700", WEIGHED),
    "units": ("#crank.stroke=80&piston.mass=0.7", GOOD.replace("stroke = 90", 'stroke = "3.5 in"  # long').replace("mass = 0.5", 'mass = "500 g"')),
    "other line ends": ("#crank.stroke=80", GOOD.replace("\n", "\r\n")),
    "a pendulum test": ("#rod.mass=0.7", GOOD.replace("cg = 45", "cg = 45\npendulum = { period = 0.75, pivot = 'small_end' }")),
    "a rod beyond its end": ("#rod.cg=-6", GOOD.replace("cg = 45", "cg = -5\ninertia = 1800")),
}  # fmt: skip


@live
@pytest.mark.parametrize("case", FILES)
def test_the_downloaded_file_gives_the_figures_of_the_page(show, tmp_path, case):
    address, text = FILES[case]
    page = show(text, address)
    assert page.read("live-wrong") == ""
    written, kept = page.run("Live.writeFile()"), ("# long", "# the other", "\r\n")
    file = tmp_path / "new.toml"
    file.write_text(written, newline="")
    assert tomllib.loads(written) != tomllib.loads(text)
    assert [part in written for part in kept] == [part in text for part in kept]
    assert not list(differences(analyze_file(file), figures(page)))


def analyze_file(path):
    return ask_json("-q", "analyze", path, "--orders", "0-12", "--only", ",".join(WANTED))


@live
@pytest.mark.parametrize("name", ["vtwin45", "v4_90", "flat12", "v6_60", "twin180", "v10_common", "tsinghua_12v135q"])
def test_another_bank_angle_or_throw_makes_a_file_that_is_read(browser, play, tmp_path, name):
    """A firing order that fits the former throws alone is left out; the numbering stays."""
    browser.open(play)
    known = values(describe(name)[2])
    changed = "layout.bank_angle" if "layout.bank_angle" in known else "crank.throws.2"
    go(browser, f"#engine={name}&{changed}={known[changed] + 7}")
    file = write(tmp_path / "new.toml", browser.run("Live.writeFile()"))
    assert not list(differences(analyze_file(file), figures(browser)))


@live
def test_a_speed_of_the_command_line_is_a_change(show):
    page = show(GOOD, "", "--speed", "6000")
    assert "speed = 6000" in page.run("Live.writeFile()")
    assert page.run("Live.writeAddress()") == "#operation.speed=6000"


@live
def test_a_quick_shaft_is_not_sampled(show):
    text = GOOD + "[[shaft]]\nratio = 128\nunbalance = 1000\nat = [10, 20]\n"
    found = figures(show(text))
    assert not list(differences(answer(build_text(text)), found))


@live
@pytest.mark.parametrize(
    ("address", "message"),
    [
        ("#counterweight.1.constructor=5", "counterweight.1.constructor: there is no such number"),
        ("#__proto__.x=5", "there is no such number"),
        ("#piston.mass=1 toString", 'the unit "toString" is not known'),
        ("#piston.mass=1,000", "can mean two numbers"),
        ("#crank.stroke=-5", "crank.stroke: -5 is not above 0"),
        ("#operation.speed=0", "operation.speed: 0 is not above 0"),
        ("#shaft.1.ratio=1.5", "give a whole number"),
        ("#counterweight.9=none", "counterweight.9: is not there"),
        ("#piston.mass=none", "piston.mass: cannot be left out"),
        ("#operation.speed=none", "operation.speed: cannot be left out"),
    ],
)
def test_bad_parts_leave_the_engine_and_the_rest(show, address, message):
    page = show(address=f"{address}&rod.mass=0.7")
    assert message in page.read("live-wrong")
    left = page.run("Object.entries(Live.numbers).filter(([n]) => n === 'rod.mass' || n.includes('weight'))")
    assert left == [["rod.mass", 0.7]]
    assert page.complaints == []


# ------------------------------------------------------------------ what has no live page; notebooks
def test_engines_that_the_page_cannot_compute_say_so():
    text = ask("report", "-", "-o", "-", stdin=RADIAL)
    assert "cannot be changed on the page: it has articulated rods" in text
    assert 'id="live"' not in text


@live
def test_explore_shows_the_page_in_a_frame(browser, tmp_path):
    frame = load_example("vtwin45").explore()._repr_html_()
    browser.open(write(tmp_path / "notebook.html", f"<!doctype html><body>{frame}"))
    inside = "document.querySelector('iframe').contentDocument"
    browser.run(f"{inside}.getElementById('change').open = true; new Promise(done => setTimeout(done, 200))")
    assert browser.complaints == []
    assert '"force_N"' in browser.run(f"{inside}.getElementById('figures').textContent")
