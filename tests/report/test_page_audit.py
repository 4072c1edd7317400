"""What people who use a keyboard or a screen reader, or see contrasts badly, need of the page: in a real browser."""

import pytest
from support.audit import AUDIT
from support.browser import live
from support.commands import ask
from support.paths import write
from support.pictures import without_pictures

from balcli.file import examples

WAIT = "new Promise(done => setTimeout(done, 250))"
SHORTER = "Live.change('crank.stroke', 0.9 * Live.numbers['crank.stroke'])"


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """Pages of engines that have every part together."""
    folder = tmp_path_factory.mktemp("pages")
    made = {}
    with without_pictures():
        for name in ("i6_diesel", "i4_mounts"):
            made[name] = folder / f"{name}.html"
            ask(
                "-q", "report", write(folder / f"{name}.toml", examples.text(name)), "--cylinder", "1", "-o", made[name]
            )
    return made


@live
@pytest.mark.parametrize(("width", "schemes"), [(1280, ["light", "dark"]), (390, ["dark"])])
@pytest.mark.parametrize("name", ["i6_diesel", "i4_mounts"])
def test_nothing_serious_is_found_before_and_after_a_change(browser, pages, name, width, schemes):
    browser.open(pages[name], width=width, dark="light" not in schemes)
    for change in ("0", SHORTER):
        browser.run(change if change == "0" else f"{change}, {WAIT}")
        for scheme in schemes:
            browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
            assert browser.run(AUDIT) == [], f"{scheme} after {change}"


HARMS = {  # each by what is then found
    "no name: button#link": "document.getElementById('link').textContent = ''",
    "contrast": "document.getElementById('facts').style.color = '#999'",
    "a header without scope": "document.querySelector('#orders-table th').removeAttribute('scope')",
    "skips a level": "document.querySelector('h2').outerHTML = '<h4>x</h4>'",
    "no name: svg#end": "document.getElementById('end').removeAttribute('aria-label')",
    "id twice: verdict": "document.getElementById('ladder').id = 'verdict'",
}


@live
def test_the_audit_finds_what_is_wrong(browser, pages):
    """All at once, on a page on which it found nothing."""
    browser.open(pages["i4_mounts"])
    for harm in HARMS.values():
        browser.run(f"{harm}, 0")
    lines = browser.run(AUDIT)
    assert [found for found in HARMS if not any(line.startswith(found) for line in lines)] == []


@live
def test_every_chart_is_saved(browser, pages):
    """As two pictures and a table: bars, paths, curves of every kind and stars."""
    browser.open(pages["i6_diesel"])
    charts = "[...document.querySelectorAll('main figure')].filter(each => each.querySelector('svg[data-title], #stars-charts svg'))"
    assert (
        browser.run(
            f"new Set({charts}.map(each => each.querySelectorAll('.tools button').length)).values().next().value"
        )
        == 3
    )
    names = browser.run(f"{charts}.map(each => each.querySelector('svg').dataset.title || 'star')")
    assert {"Path of the free force", "Torque on the crank", "Pressure", "star"} <= {*names}
    assert len(names) > 10
    heads = "window.heads = [], URL.createObjectURL = (blob) => blob.text().then(text => heads.push(text.split('\\n')[0])), 0"
    browser.run(f"HTMLAnchorElement.prototype.click = function () {{}}; URL.revokeObjectURL = () => {{}}; {heads}")
    browser.run(f"{charts}.forEach(each => each.querySelector('.tools button:last-child').click()), {WAIT}")
    assert '"crank angle, deg","total, N·m","gas, N·m","mean, N·m"' in browser.run("heads")


@live
def test_on_paper_nothing_is_cut(browser, pages):
    """A sheet is narrower than the window from which the layout for phones begins."""
    browser.open(pages["i4_mounts"], width=718)
    browser.call("Emulation.setEmulatedMedia", media="print")
    cut = "['facts', 'key-with', 'bars', 'path'].filter(id => { const at = document.getElementById(id); return at.scrollWidth > at.clientWidth + 1; })"
    assert browser.run(cut) == []
    assert browser.run("getComputedStyle(document.getElementById('facts')).whiteSpace") == "normal"
    assert browser.run(
        "document.getElementById('side').getBoundingClientRect().right < document.getElementById('bars').getBoundingClientRect().left"
    )
    browser.call("Emulation.setEmulatedMedia", media="")


@live
def test_the_first_screen_has_force_and_moment_where_both_matter(browser, tmp_path):
    ask("-q", "report", "twin180", "-o", tmp_path / "page.html")
    browser.open(tmp_path / "page.html", width=1400, height=900)
    assert browser.run("document.querySelectorAll('#bars-charts svg').length") == 2
    assert browser.run("document.getElementById('toc').getBoundingClientRect().bottom") <= 900
    assert browser.run("document.documentElement.scrollWidth <= document.documentElement.clientWidth")


SHIFTS = """
new Promise(async (done) => {
  let total = 0;
  const look = new PerformanceObserver((list) => { for (const { value } of list.getEntries()) total += value; });
  look.observe({ type: "layout-shift", buffered: true });
  for (const name of ["rod.length", "piston.mass", "operation.speed"]) {
    const first = Live.numbers[name];
    for (let k = 1; k <= 3; k++) {
      Live.change(name, first * (1 + 0.12 * k));
      await new Promise((next) => setTimeout(next, 30));
    }
  }
  await new Promise((next) => setTimeout(next, 200));
  done(total);
})
"""


@live
@pytest.mark.parametrize(("width", "height"), [(1400, 900), (1024, 768), (390, 844)])
def test_nothing_jumps_while_the_page_loads_and_a_slider_moves(browser, pages, width, height):
    browser.open(pages["i4_mounts"], width=width, height=height)
    assert browser.run(SHIFTS) < 0.02
    assert browser.run("document.documentElement.scrollWidth <= innerWidth")
