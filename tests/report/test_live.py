"""The live page, in a real browser: its figures are those of `balcli analyze`, its address and its
files give the same engine again.
"""

import json
import random
import tomllib
from functools import cache
from urllib.parse import quote

import pytest
from support.browser import live
from support.cases import slow
from support.commands import ask, ask_json
from support.engines import GOOD, RADIAL, build_text, changed
from support.kernel import WANTED, answer, compute, differences, find_findings
from support.paths import ROOT, write
from support.pictures import without_pictures

from balcli import load_example
from balcli.analysis.answer import analyze
from balcli.balancing.answer import balance
from balcli.engine.build import build
from balcli.errors import MOMENTS_UNKNOWN, InputError
from balcli.file import examples
from balcli.file.model import Counterweight, Shaft
from balcli.file.units import ANGLE, LENGTH, MASS, SPEED, UNBALANCE, convert
from balcli.limits import SMALL
from balcli.report.figures import describe_figures
from balcli.report.live import describe_engine, explain_still
from balcli.report.page import FOLDER, lay_out
from balcli.show.sheet import order_name, sentence, size_text
from balcli.show.units import SI
from balcli.sizing.ladder import find_ladder

PRESS = "[...document.querySelectorAll('button')].find(b => b.textContent === '{}').click()"
WAIT = "new Promise(done => setTimeout(done, 100))"
WEIGHED = GOOD + "[[counterweight]]\nmass = 2\nradius = 50\nangle = 180\n"
HOSTILE = '</script><img src=x onerror=alert(1)> & "quoted" {{ 7 * 7 }} 发动机'


@pytest.fixture
def show(browser, report):
    """Show the page of an engine, which may be shown already: the state of a page is that of its address."""

    def opened(text: str = GOOD, address: str = "", *options: str, name: str = "engine.toml", **how):
        if browser.keep(report(text, *options, name=name), address, **how):
            go(browser, address)
        return browser

    return opened


def go(page, address):
    """Follow an address within the page, which may have it already: another one is put in its place before."""
    listen = "addEventListener('hashchange', () => setTimeout(done, 0), { once: true })"
    follow = f"history.replaceState(null, '', '#another'), location.hash = {json.dumps(address)}"
    page.run(f"new Promise(done => {{ {listen}; {follow}; }})")


def figures(page):
    return json.loads(page.read("figures"))


@cache
def describe(name):
    model = load_example(name).model
    engine = build(model)
    return model, engine, None if explain_still(engine) else describe_engine(model, engine, "")


def values(data):
    return {each["name"]: each["value"] for each in data["numbers"]}


# ------------------------------------------------------------------ the kernel
def list_known(step=1):
    """Every example that the page computes, or every `step`th: name, file, engine and data of the page."""
    known = [(name, *describe(name)) for name in examples.names()[::step]]
    return [each for each in known if each[-1]]


STEPS_OF_EXAMPLES = [8, *slow(1)]


@live
@pytest.mark.parametrize("step", STEPS_OF_EXAMPLES)
def test_the_kernel_agrees_on_examples(browser, play, step):
    browser.keep(play)
    known = list_known(step)
    assert len(known) > 60 / step
    made = compute(browser, [[data, values(data)] for *_, data in known])
    wrong = {
        name: list(differences(answer(engine), found)) for (name, _, engine, _), found in zip(known, made, strict=True)
    }
    assert not {name: each for name, each in wrong.items() if each}


def change_some(seed, count, step=1):
    """Examples (every `step`th) with some of their numbers changed: these numbers, the engine, and the data of the page."""
    dice = random.Random(seed)
    known = [found for _, *found in list_known(step)]
    tried = []
    while len(tried) < count:
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
    return tried


@live
@pytest.mark.stress
def test_the_kernel_agrees_on_random_engines(browser, play):
    browser.keep(play)
    tried = change_some(5, 300)
    made = compute(browser, [[data, values(data) | new] for new, _, data in tried])
    wrong = [(new, each) for (new, engine, _), found in zip(tried, made, strict=True)
             if (each := list(differences(answer(engine), found)))]  # fmt: skip
    assert not wrong


# ------------------------------------------------------------------ the tables
TABLES = """JSON.stringify(asked.map(([data, numbers, figures]) => {
  const engine = Kernel.assemble(data, numbers), { limits } = Tables;
  const ofKernel = Kernel.describe(engine, Kernel.findLadder(engine, limits), limits), write = ({ head, rows }) => [head, rows];
  const make = (document) => {
    const last = document.ladder.steps.findIndex(({ step }) => step === document.ladder.auto.at(-1));
    const usual = document.page.extra[0] || document.ladder.steps[Math.max(0, last)];
    return {
      orders: write(Tables.makeOrders(document)), couple: write(Tables.makeAbout(document)), ladder: write(Tables.makeLadder(document)),
      largest: Tables.listLargest(document, data.look.gas), devices: write(Tables.makeDevices(usual)),
    };
  };
  return [make(ofKernel), make(figures), Tables.listFacts(engine, { ...data, speed: numbers["operation.speed"] })];
}))"""
EMPTY = [["order", "couple C", "peak, deg"], []]


def print_tables(engine):
    """Tables and facts of the command, and the figures of the page."""
    result = analyze(engine)
    balanced = balance(engine)
    parts = lay_out(result, balanced, SI)

    def write(grid):
        return [[column.head for column in grid.columns], [list(row) for row in grid.rows]] if grid else EMPTY

    tables = {name: write(getattr(parts, name)) for name in ("orders", "couple", "ladder", "devices")}
    tables["largest"] = [list(pair) for pair in parts.largest.pairs]
    return tables, dict(parts.facts.pairs), describe_figures(result, balanced, SMALL)


def check_tables(browser, states):
    """Every digit of the tables that the page makes, of its own figures and of those of Python, is the command's."""
    printed = [print_tables(engine) for engine, _, _ in states]
    asked = [[data, numbers, figures] for (_, data, numbers), (*_, figures) in zip(states, printed, strict=True)]
    browser.run(f"window.asked = {json.dumps(asked)}, 0")
    found = json.loads(browser.run(TABLES))
    for (tables, facts, figures), (of_kernel, of_python, told) in zip(printed, found, strict=True):
        if not figures["ladder"]["auto"] or figures["page"]["crossheads"]:  # power decides, which the page may not know
            of_kernel["devices"] = of_python["devices"] = tables["devices"]
        assert of_python == tables
        assert of_kernel == tables
        assert {name: facts.get(name) for name, _ in told} == dict(told)


@live
@pytest.mark.parametrize("step", STEPS_OF_EXAMPLES)
def test_the_tables_are_those_of_the_command(browser, play, step):
    browser.keep(play)
    check_tables(browser, [(engine, data, values(data)) for _, _, engine, data in list_known(step)])


@live
@pytest.mark.parametrize(("count", "step"), [(10, 8), pytest.param(200, 1, marks=pytest.mark.slow)])
def test_the_tables_of_random_engines_are_those_of_the_command(browser, play, count, step):
    browser.keep(play)
    check_tables(browser, [(engine, data, values(data) | new) for new, engine, data in change_some(7, count, step)])


def test_the_kernel_needs_nothing():
    text = (FOLDER / "engine.js").read_text(encoding="utf-8")
    assert "import" not in text
    assert "require(" not in text


def test_the_site_page_is_small(play):
    assert play.stat().st_size <= 600_000


# ------------------------------------------------------------------ the address
@live
def test_a_right_angle_makes_a_circle_of_a_v_twin(browser, play):
    browser.open(play)
    go(browser, "#engine=vtwin45&layout.bank_angle=90")
    first = next(entry["force_N"] for entry in figures(browser)["orders"] if entry["order"] == 1)
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
    wanted = answer(build_text(changed(("stroke = 90", "stroke = 80"), ("mass = 0.6", "mass = 0.65"))), None)
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
    most = max(len(texts) for _, *texts in spelled.values())
    for k in range(most):  # an address has one text for each number
        chosen = {name: texts[k % len(texts)] for name, (_, *texts) in spelled.items()}
        go(page, "#" + "&".join(f"{name}={quote(text)}" for name, text in chosen.items()))
        assert page.read("live-wrong") == ""
        for name, text in chosen.items():
            wanted = convert(text, spelled[name][0])
            assert page.run(f"Live.numbers['{name}']") == pytest.approx(wanted), text


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
    assert page.run("document.getElementById('redo').disabled")
    page.run(PRESS.format("Undo"))
    assert page.run("Live.numbers['piston.mass']") == 0.5
    page.run("document.querySelector('#steps label:last-child input').click(), document.getElementById('fit').click()")
    assert page.run("Live.numbers['shaft.1.unbalance']") > 0
    second = next(entry["force_N"] for entry in figures(page)["orders"] if entry["order"] == 2)
    assert second["major"] == pytest.approx(0, abs=1e-6)
    page.run(PRESS.format("Remove shaft 1"))
    shafts = page.run("Object.keys(Live.numbers).filter(name => name.startsWith('shaft'))")
    assert all(name.startswith("shaft.2") for name in shafts)
    page.run(PRESS.format("Reset"))
    assert page.run("Live.writeAddress()") == ""
    assert page.complaints == []


@live
def test_devices_of_steps_that_are_no_row_are_fitted(show):
    """Shafts of order 2 are worth fitting here, the one of order 1 is not."""
    page = show(
        changed(("throws = [0, 180, 180, 0]", "throws = [0, 188, 180, 0]"), ("firing_order = [1, 3, 4, 2]", ""))
    )
    usual = figures(page)["page"]["extra"][0]
    assert usual["step"] == "default: steps 2 and 4"
    page.run("document.getElementById('fit').click()")
    sizes = page.run(
        "Object.entries(Live.numbers).filter(([name]) => name.endsWith('.unbalance')).map(([, value]) => value)"
    )
    assert sizes == pytest.approx([1e6 * device["unbalance_kg_m"] for device in usual["devices"]])
    left = figures(page)["peak"]["force_N"]
    assert left == pytest.approx(usual["peak_force_N"], rel=1e-6)


@live
@pytest.mark.parametrize("width", [360, 1280, *slow(800, 1600)])
def test_the_page_fits_its_window(show, width):
    page = show(width=width, dark=width == 360)
    assert page.run("document.documentElement.scrollWidth <= window.innerWidth")
    labelled = "[...document.querySelectorAll('#live-numbers input')].every(i => i.labels.length || i.ariaLabel)"
    assert page.run(labelled)


STEPS = "[...document.querySelectorAll('#ladder-table tbody th')].map(cell => cell.textContent)"


@live
@pytest.mark.parametrize("step", STEPS_OF_EXAMPLES)
def test_steps_have_the_names_of_the_command(browser, play, step):
    browser.keep(play)
    for name, _, engine, _ in list_known(step):
        go(browser, f"#engine={name}")
        listed = [f"{row} {each.step}" for row, each in enumerate(find_ladder(engine).steps)]
        assert browser.run(STEPS) == listed, name


@live
def test_the_command_takes_the_names_of_steps(browser, play, tmp_path):
    browser.keep(play)
    file = write(tmp_path / "i3.toml", examples.text("i3"))
    go(browser, "#engine=i3")
    for step in browser.run(STEPS)[1:]:
        number, name = step.split(" ", 1)
        assert ask_json("-q", "balance", file, "--step", number)["step"] == name


# ------------------------------------------------------------------ the verdict, as data
@live
@pytest.mark.parametrize("small", [0, SMALL, *slow(0.01, 0.2)])
@pytest.mark.parametrize("step", STEPS_OF_EXAMPLES)
def test_the_page_finds_what_the_command_finds(browser, play, small, step):
    """On examples, and with a further shaft and counterweight."""
    browser.keep(play)
    more = {"shaft.9.ratio": -1, "shaft.9.unbalance": 20000, "shaft.9.angle": 30, "shaft.9.position": 40}
    more |= {"counterweight.9.unbalance": 7000, "counterweight.9.angle": 170, "counterweight.9.position": -20}
    known = list_known(step)
    asked = [[data, values(data) | added] for *_, data in known for added in ({}, more)]
    found = [each["verdict"] for each in compute(browser, asked, small)]
    wanted = [find_findings(one, small) for _, model, engine, _ in known for one in (engine, with_more(model))]
    wrong = {known[k // 2][0]: (one, two) for k, (one, two) in enumerate(zip(wanted, found, strict=True)) if one != two}
    assert not wrong
    cures = [cure for finding in found for one in finding["matter"] for cure in one.get("cures", ())]
    assert sum(cure["further"] for cure in cures) > 50 / step
    assert any("takes_back" in cure for cure in cures)


def with_more(model):
    """The engine with a further shaft and counterweight."""
    shaft = Shaft(ratio=-1, unbalance=20000, angle=30, position=40)
    weight = Counterweight(unbalance=7000, angle=170, position=-20)
    changed = {"shaft": (*model.shaft, shaft), "counterweight": (*model.counterweight, weight)}
    return build(model.model_copy(update=changed))


@live
@pytest.mark.stress
def test_the_page_finds_what_the_command_finds_on_random_engines(browser, play):
    browser.keep(play)
    tried = change_some(6, 200)
    made = compute(browser, [[data, values(data) | new] for new, _, data in tried])
    wanted = [find_findings(engine) for _, engine, _ in tried]
    assert [each["verdict"] for each in made] == wanted


ORDERS = "[...document.querySelectorAll('#orders-table tbody tr')].map(row => [row.firstChild.textContent, row.lastChild.textContent])"


@live
def test_the_table_of_orders_names_what_would_cancel_them(show):
    text = GOOD + "[[shaft]]\nratio = 2\nunbalance = 9\n[cylinder.1]\npiston_mass = 0.8\n"
    page = show(text, "", "--small", "0.1%")
    cures = dict(page.run(ORDERS))
    assert cures["1"] == "counterweights, shaft at -1"
    assert cures["2"] == "further shaft at +2, shaft at -2"
    assert cures["4"] == "usually left"
    assert figures(page)["verdict"]["matter"] == find_findings(build_text(text), 0.001)["matter"]


@live
@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        (examples.text("locomotive4"), {"1": "counterweights", "2": "no device is named"}),
        (GOOD + "[[operation.speed_ripple]]\norder = 1\namplitude = 0.1\n", {"1": "no device is named"}),
        (examples.text("marine6"), {"2": "compensators"}),
    ],
)
def test_the_table_of_orders_names_only_devices_that_the_verdict_names(show, text, wanted):
    cures = dict(show(text).run(ORDERS))
    assert {order: cures[order] for order in wanted} == wanted


@live
def test_no_order_is_found_that_the_command_does_not_list(show):
    """With `--small 0` nothing is small, but orders of rounding size are no orders."""
    text = examples.text("ford_ecoboost_1_0")
    document = ask_json("-q", "analyze", "-", "--small", "0", stdin=text)
    page = show(text, "", "--small", "0")
    assert figures(page)["verdict"]["matter"] == document["verdict"]["matter"]
    listed = [f"{entry['order']:g}" for entry in document["orders"] if entry["order"] <= 12]
    assert {order for order, _ in page.run(ORDERS)} <= set(listed)


# ------------------------------------------------------------------ what holds only for the file
OF_FILE = "[...document.querySelectorAll('[data-of-file]')]"
LINES = "[...document.querySelectorAll('.why')].map(line => line.checkVisibility())"
SENTENCES = "[...document.querySelectorAll('.words-of-file > p:not(.why)')].map(line => line.checkVisibility())"
CHANGES = "[...document.querySelectorAll('#changes li')].map(line => line.firstChild.textContent)"


@live
def test_what_holds_only_for_the_file_says_so_while_a_number_differs(show):
    page = show(examples.text("i4_mounts"))
    assert page.run(f"{OF_FILE}.length") == page.run(f"{LINES}.length") >= 4
    heads = page.run(f"{OF_FILE}.map(part => part.closest('section').id)")
    assert {"verdict", "ladder", "orders", "devices", "mounts"} <= set(heads)
    states = []
    for change in ("0", "Live.change('crank.stroke', 80)", PRESS.format("Reset")):
        page.run(f"{change}, {WAIT}")
        for media in ("screen", "print"):
            page.call("Emulation.setEmulatedMedia", media=media)
            states.append((set(page.run(LINES)), set(page.run(SENTENCES))))
    page.call("Emulation.setEmulatedMedia", media="")
    as_written = ({False}, {True})
    changed = ({True}, {False})
    assert states == [as_written, as_written, changed, changed, as_written, as_written]


@live
def test_the_page_ends_with_a_command_that_prints_its_figures(show):
    page = show(GOOD)
    end = "document.querySelector('footer').innerText"
    assert page.run(end).endswith("balcli analyze engine.toml prints the same figures")
    page.run("Live.change('crank.stroke', 80), 0")
    assert page.run(end).endswith("balcli analyze of the downloaded file prints the same figures")


@live
def test_steps_that_are_fitted_by_default_are_marked(show):
    """At every stroke: those that the command names."""
    page = show(GOOD)
    marked = "[...document.querySelectorAll('#ladder-table tbody tr')].map(row => row.classList.contains('auto'))"
    for change in ("0", "Live.change('piston.mass', 0.05)"):
        page.run(f"{change}, {WAIT}")
        ladder = figures(page)["ladder"]
        assert page.run(marked) == [step["step"] in ladder["auto"] for step in ladder["steps"]]
        assert ladder["auto"]


@live
def test_facts_that_do_not_follow_other_throws_are_gray(show):
    page = show(GOOD)
    page.run(f"Live.change('crank.throws.2', 170), {WAIT}")
    gray = page.run("[...document.querySelectorAll('#facts .stale')].map(each => each.firstChild.textContent)")
    assert set(gray) == {"firing", "assumed"}
    assert "170" in page.read("facts")


@live
def test_the_speed_of_the_command_line_is_that_of_the_whole_page(show):
    """So nothing is out of date at first, but it is at the speed of the file."""
    page = show(GOOD, "", "--speed", "6000")
    assert (set(page.run(LINES)), page.run(CHANGES)) == ({False}, ["operation.speed 3000 → 6000 rpm"])
    page.run(PRESS.format("Reset"))
    assert (set(page.run(LINES)), page.run(CHANGES)) == ({True}, ["as in "])


@live
@pytest.mark.parametrize(
    ("address", "changes"),
    [
        ("#rod.length=150.5&piston.mass=0.25", ["piston.mass 0.5 → 0.25 kg", "rod.length 160 → 150.5 mm"]),
        ("#counterweight.1=none", ["counterweight.1 removed"]),
        (
            "#shaft.1.ratio=-2",
            ["shaft.1 added: ratio -2, unbalance 10000 g mm, angle 0 deg, position 0 mm, at.1 0 mm, at.2 0 mm"],
        ),
        (
            "#counterweight.1.unbalance=5000",
            [
                "counterweight.1.mass 2 → none",
                "counterweight.1.radius 50 → none",
                "counterweight.1.unbalance none → 5000 g mm",
            ],
        ),
    ],
)
def test_changed_numbers_stand_beside_the_title(show, address, changes):
    page = show(WEIGHED, address)
    found = page.run(CHANGES)
    assert sorted(found) == sorted(changes)


LARGEST = "document.getElementById('live-largest').textContent"


@live
@pytest.mark.parametrize("piston", [0.5, 0.8])
def test_the_largest_force_and_moment_are_spoken(show, piston):
    """A moment after the last change; a table that changes is not."""
    page = show(GOOD + f"[cylinder.1]\npiston_mass = {piston}\n", "#crank.stroke=80")
    peak = figures(page)["peak"]
    moment = size_text(peak["moment_Nm"], SI.moment) if piston > 0.5 else "balanced"
    told = f"Largest over a revolution: force {size_text(peak['force_N'], SI.force)}, moment {moment}."
    page.wait_for(f"{LARGEST} === {json.dumps(told)}")
    assert page.read("live-largest") == told
    loud = "[...document.querySelectorAll('[aria-live], [role=alert], [role=status]')].map(part => part.id)"
    assert page.run(loud) == ["live-wrong", "live-largest", "live-done"]


@live
def test_moments_that_are_not_known_are_said_to_be_unknown(show):
    page = show(GOOD.replace("spacing = 100\n", ""))
    page.wait_for(LARGEST)
    assert "moment" not in page.read("live-largest").partition(".")[0]
    assert page.read("live-largest").endswith(sentence(MOMENTS_UNKNOWN))


@live
def test_roll_with_gas_is_headed_as_of_inertia(browser, play):
    browser.keep(play)
    head = "document.querySelector('#largest-list dt').textContent"
    go(browser, "#engine=i4_wiebe")
    assert browser.run(head) == "roll moment, inertia alone"
    go(browser, "#engine=vtwin45")
    assert browser.run(head) == "roll moment"


KEY_ROLL = """(([...document.querySelectorAll('#key-small div')].map((each) => each.textContent).find(
    (text) => text.startsWith('Roll'))))"""


@live
def test_the_key_figure_of_the_roll_is_that_with_gas(show):
    """The page does not compute gas: of a changed engine it says that the roll is that of inertia alone."""
    text = (ROOT / "engines" / "i4_wiebe.toml").read_text()
    page = show(text)
    roll = find_ladder(build_text(text)).roll
    assert roll.of == "total"
    key = page.run(KEY_ROLL)
    assert key == f"Roll with gas{size_text(roll.amplitude_Nm, SI.moment)} order {order_name(roll.order)}"
    page.run("Live.change('rod.length', 150)")
    page.wait_for("document.body.classList.contains('changed')")
    assert page.run(KEY_ROLL).startswith("Roll, inertia alone")


def copy_command(page):
    done = "document.getElementById('live-done').textContent"
    page.run(f"{done} = '', {PRESS.format('Copy command')}")
    page.wait_for(done)
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
    assert copy_command(browser).startswith("Copied: balcli analyze i3.toml. Download TOML")


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


QUICK = ["throws in a list", "a table that it leaves out", "a new device", "a device less", "units", "other line ends"]
OTHERS = [case for case in FILES if case not in QUICK]


@live
@pytest.mark.parametrize("case", [*QUICK, *slow(*OTHERS)])
def test_the_downloaded_file_gives_the_figures_of_the_page(show, tmp_path, case):
    address, text = FILES[case]
    page = show(text, address)
    assert page.read("live-wrong") == ""
    written = page.run("Live.writeFile()")
    kept = ("# long", "# the other", "\r\n")
    file = tmp_path / "new.toml"
    file.write_text(written, newline="")
    assert tomllib.loads(written) != tomllib.loads(text)
    assert [part in written for part in kept] == [part in text for part in kept]
    assert not list(differences(analyze_file(file), figures(page)))


def analyze_file(path):
    return ask_json("-q", "analyze", path, "--only", ",".join(WANTED))


@live
@pytest.mark.parametrize(
    "name", ["vtwin45", "v6_60", "twin180", *slow("v4_90", "flat12", "v10_common", "tsinghua_12v135q")]
)
def test_another_bank_angle_or_throw_makes_a_file_that_is_read(browser, play, tmp_path, name):
    """A firing order that fits the former throws alone is left out; the numbering stays."""
    browser.keep(play)
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
    assert not list(differences(answer(build_text(text), None), found))


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
    with without_pictures():
        text = ask("report", "-", "-o", "-", stdin=RADIAL)
    assert "cannot be changed on the page: it has articulated rods" in text
    assert 'id="live"' not in text


@live
def test_explore_shows_the_page_in_a_frame(browser, tmp_path):
    with without_pictures():
        frame = load_example("vtwin45").explore()._repr_html_()
    browser.open(write(tmp_path / "notebook.html", f"<!doctype html><body>{frame}"))
    inside = "document.querySelector('iframe').contentDocument"
    shown = f"{inside}.getElementById('figures').textContent"
    browser.wait_for(f"{inside}.getElementById('figures') && {shown}")
    assert browser.complaints == []
    assert '"force_N"' in browser.run(shown)
