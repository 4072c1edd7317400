"""Pictures: every page of every form, the same bytes each time, names that look like markup, and
values where they belong.
"""

import re
import warnings
import xml.etree.ElementTree as ET
from dataclasses import replace
from functools import cache
from threading import Event, Thread
from typing import get_args

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from support.cases import slow
from support.commands import run_python
from support.engines import GOOD, build_text, changed, inline_engine
from support.gas_engines import FOUR as GAS_FOUR, WIEBE
from support.paths import ENGINES, ROOT
from support.pictures import draw_page

from balcli import load_example
from balcli.analysis.answer import QUANTITIES, analyze
from balcli.analysis.plot import draw_vector_bars, set_order_axis, visible_rows
from balcli.balancing.answer import balance
from balcli.core.phasors import Phasors
from balcli.forces.kinds import FORCE
from balcli.report.names import OF_GAS, OF_PARTS, PAGES
from balcli.report.pages import PageSubject, make_page
from balcli.report.study import Study
from balcli.show import plot_style as style
from balcli.show.plane import draw_locus
from balcli.show.units import SI

HOSTILE = '$x_{1}$ </text><script>alert(1)</script> 发动机 №5 & "q" \u0001 _'
ANALYSES = PAGES[:6]
MAGIC = {"svg": b"<?xml", "png": b"\x89PNG", "pdf": b"%PDF"}


@pytest.fixture(scope="module")
def four():
    return analyze(build_text(GOOD), only=QUANTITIES)


@pytest.fixture(scope="module")
def drawn(four):
    """The pages of the four, each drawn once: a function of the page and the form."""
    return cache(lambda what, form: draw_page(PageSubject(Study(four)), what, form))


@pytest.mark.parametrize("what", ["overview", "all", *slow("polar", "orders", "spectrum", "curves")])
def test_every_page_is_drawn(what, drawn):
    assert drawn(what, "svg").startswith(MAGIC["svg"])


@pytest.mark.stress
@pytest.mark.parametrize("what", ANALYSES)
def test_before_and_after(what, four):
    found = balance(four.engine)
    compared = ET.fromstring(draw_page(PageSubject(Study(found.after, found.before)), what, "svg"))
    assert ("before" in " ".join(compared.itertext())) == (what != "orders")


@pytest.mark.stress
@pytest.mark.parametrize("form", get_args(style.Form))
def test_the_same_picture_is_the_same_bytes(form, drawn, four):
    assert drawn("all", form) == draw_page(PageSubject(Study(four)), "all", form)


@pytest.mark.parametrize("form", ["svg", "png", *slow("pdf")])
def test_a_hostile_name_stays_text_and_warns_of_nothing(form, four):
    subject = PageSubject(Study(analyze(replace(four.engine, name=HOSTILE), only=QUANTITIES)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        data = draw_page(subject, "polar", form)
    assert data.startswith(MAGIC[form])
    if form == "svg":
        root = ET.fromstring(data)
        assert not [e for e in root.iter() if e.tag.endswith("script")]
        told = " ".join(e.text or "" for e in root.iter() if e.tag.endswith("text"))
        assert f"{style.fit_name(HOSTILE)},3000rpm".replace(" ", "") in told.replace(" ", "")


def texts_of(svg: bytes) -> list[str]:
    return [e.text or "" for e in ET.fromstring(svg).iter() if e.tag.endswith("text")]


def test_what_is_negligible_beside_one_cylinder_is_said_and_not_drawn():
    """A five has a free force of 1e-6 of one cylinder's, and a moment, of which orders 1 and 2 count."""
    five = PageSubject(Study(analyze(inline_engine([0, 144, 216, 288, 72]))))
    polar, orders = (texts_of(draw_page(five, what, "svg")) for what in ("polar", "orders"))
    for texts in (polar, orders):
        assert [text for text in texts if text.startswith("Free force: negligible (")]
    assert "moment about x, N·m" in polar
    assert "force along x, N" not in polar
    found = [text for text in orders if ", order" in text]
    assert found == ["moment, order 1, at crank angle 36°", "moment, order 2, at crank angle 18°"]


def test_what_is_nothing_is_said_and_not_drawn():
    """A six is balanced in force and moment; about the crank it is not."""
    six = analyze(inline_engine([0, 240, 120, 120, 240, 0]), only=QUANTITIES)
    for what in ANALYSES:
        found = texts_of(draw_page(PageSubject(Study(six)), what, "svg"))
        assert [text for text in found if re.match("Free force: .*; Free moment: balanced$", text)]
        assert "force, N" not in found


def list_texts(subject, what):
    """Texts in the pictures of a page."""
    return re.findall(r">([^<>]*)</text>", draw_page(subject, what, "svg").decode())


def test_about_the_crank_the_gas_is_drawn_by_order_and_curves_are_of_inertia():
    """Bars of half orders are those of the gas, whose quantities they show; a curve of some of its
    orders would be no torque.
    """
    fired = analyze(build_text(GAS_FOUR + WIEBE + "[cylinder.2]\ngas = 0.5\n"))
    bars = list_texts(PageSubject(Study(fired)), "spectrum")
    assert {"inertia torque T", "gas torque", "total roll", "½"} <= set(bars)
    assert "About the crank, with gas" in bars
    curves = list_texts(PageSubject(Study(fired)), "curves")
    assert {"About the crank, of inertia only", "couple C", "roll moment", "360"} <= set(curves)
    assert "720" not in curves


def test_crank_angles_do_not_lie_on_one_another(ax):
    """Along a straight line that is run to and fro, two places of the tip are the same."""
    ones = np.array([1.0 + 0j])
    draw_locus(ax, Phasors.of(np.array([1.0]), ones, ones, np.zeros(1)), FORCE.name_components(None), SI.force)
    places = np.array([text.get_position() for text in ax.texts if "°" in text.get_text()])
    assert len(places) > 2
    apart = np.abs(places[:, None] - places[None])
    near = (apart[..., 0] < 0.1) & (apart[..., 1] < 0.05)
    assert near.sum() == len(places)


def test_threads_that_draw_leave_matplotlib_as_it_was():
    """The second begins before the first has ended, and ends after it."""
    import matplotlib

    before = dict(matplotlib.rcParams)
    second_is_in = Event()
    first_is_out = Event()

    def draw_second():
        with style.open_figure(2, 2):
            second_is_in.set()
            first_is_out.wait()

    second = Thread(target=draw_second)
    with style.open_figure(2, 2):
        second.start()
        second_is_in.wait(0.2)
    first_is_out.set()
    second.join()
    assert dict(matplotlib.rcParams) == before


@pytest.mark.slow
def test_matplotlib_is_imported_for_pictures_only():
    code = (
        "import sys\nimport balcli.report.pages\nfrom balcli.show import plot_style as "
        "style\nassert 'matplotlib' not in sys.modules\n"
        "with style.open_figure(2, 2) as f: f.subplots(); style.save_figure(f, 'png')\nassert "
        "'matplotlib.pyplot' not in sys.modules"
    )
    assert run_python("-c", code).returncode == 0


# ------------------------------------------------------------------ what is drawn
@pytest.fixture
def ax():
    with style.open_figure(3, 3) as figure:
        yield figure.subplots()


def test_locus_has_x_upwards(ax):
    """One cylinder's rotating mass: m r omega^2 along the crank pin, up at crank angle 0, to the
    right at 90 degrees.
    """
    masses = (("mass = 0.5", "mass = 0"), ("mass = 0.6\ncg = 45\n", ""), ("spacing = 100\n", ""))
    one = analyze(
        build_text(changed(("throws = [0, 180, 180, 0]", "throws = [0]"), ("firing_order = [1, 3, 4, 2]", ""), *masses))
    )
    draw_locus(ax, one.spectra.force, FORCE.name_components(None), SI.force)
    right, up = next(line for line in ax.lines if len(line.get_xdata()) > 100).get_data()
    force = 0.8 * 0.045 * (3000 * np.pi / 30) ** 2
    assert (right[0], up[0]) == pytest.approx((0, force))
    assert (right[90], up[90]) == pytest.approx((force, 0), abs=1e-9 * force)


@pytest.mark.parametrize(("share", "marked"), [(0.5, True), (0.1, False), (0.01, False)])
def test_a_small_locus_has_a_picture_of_its_own_instead_of_crank_angles(ax, share, marked):
    """Marks would lie on one another; the picture in the corner has a scale that shows the locus."""
    before = Phasors.of(np.array([1.0]), np.array([100 + 0j]), np.zeros(1, complex), np.zeros(1))
    after = replace(before, vectors=share * before.vectors)
    draw_locus(ax, after, FORCE.name_components(None), SI.force, before)
    texts = [text.get_text() for text in ax.texts]
    assert ("60°" in texts) == marked
    assert len(ax.child_axes) == 1 - marked
    for inset in ax.child_axes:
        assert inset.get_xlim()[1] == pytest.approx(1.25 * 100 * share)
    widths = [max(x) - min(x) for x in (line.get_xdata() for line in ax.lines) if len(x) > 20]
    drawn = any(width == pytest.approx(200 * share) for width in widths)
    assert drawn


def test_bars_are_both_vectors_and_add_up_to_the_largest_value(ax, four):
    force = four.spectra.force
    draw_vector_bars(ax, force, FORCE.name_components(None), SI.force)
    rows = visible_rows(force)
    heights = np.array([bar.get_height() for bar in ax.patches[: 2 * len(rows)]]).reshape(2, -1)
    unit = 1e3 if force.major.max() >= 5000 else 1
    assert heights.sum(axis=0) * unit == pytest.approx(force.major[rows])
    assert heights[0] * unit == pytest.approx(np.abs(force.forward[rows]))


def test_in_a_page_colours_follow_it_and_ids_are_its_own(drawn):
    text = style.inline_svg(drawn("polar", "svg"), "here")
    assert text.startswith("<svg")
    assert "var(--ink)" in text
    assert not any(colour in text for colour in style.NAMES)
    assert 'id="here-' in text
    ET.fromstring(text)


def test_in_a_page_a_name_in_a_picture_stays_as_it_is():
    name = '#1a1a1a id="a url(#b href="#c'
    text = style.inline_svg(f'<svg><g id="a" fill="#1a1a1a"/><text>{name}</text></svg>'.encode(), "here")
    assert text == f'<svg><g id="here-a" fill="var(--ink)"/><text>{name}</text></svg>'


WITH_WEBS = (ENGINES / "i4_webs.toml").read_text(encoding="utf-8")
LONG = ["main", "piston", "stars"]  # more than a second each
SHORT = [what for what in (*OF_GAS, *OF_PARTS) if what not in LONG]


def lay_out(page) -> FigureCanvasAgg:
    """The canvas of a page on which everything has found its place, as when the page is saved."""
    canvas = FigureCanvasAgg(page)
    with style.in_our_style():
        canvas.draw()
    return canvas


@pytest.mark.parametrize("what", [*SHORT, *slow(*LONG)])
def test_no_label_is_cut_off_by_the_edge_of_a_page(what):
    text = WITH_WEBS if what == "webs" else GAS_FOUR + WIEBE
    page = make_page(PageSubject(Study(analyze(build_text(text)))), what)
    canvas = lay_out(page)
    labels = [ax.xaxis.label for ax in page.axes] + [ax.yaxis.label for ax in page.axes]
    labels += [ax.get_legend() for ax in page.axes if ax.get_legend()]
    labels += [text for ax in page.axes for text in (ax.title, ax._left_title, *ax.texts)]
    for label in labels:
        box = label.get_window_extent(canvas.get_renderer())
        inside = box.x0 >= 0 and box.y0 >= 0 and box.x1 <= page.bbox.x1 and box.y1 <= page.bbox.y1
        assert inside or (hasattr(label, "get_text") and not label.get_text()), label


@pytest.mark.parametrize(
    ("frame", "names"),
    [("", {"force along x", "force along y"}), ("[frame]\nup = 0\n", {"vertical force", "horizontal force"})],
)
def test_pictures_name_components_by_up(frame, names):
    subject = PageSubject(Study(analyze(build_text(GOOD + frame))))
    shown = list_texts(subject, "curves")
    assert names <= set(shown), shown


def test_angles_are_written_where_they_touch_nothing():
    """At most eight on a curve, away from the curve and from each other, in inches as drawn."""
    fired = build_text(GAS_FOUR + WIEBE)
    page = make_page(PageSubject(Study(analyze(fired))), "pin")
    canvas = lay_out(page)
    for ax in page.axes:
        texts = [text for text in ax.texts if "°" in text.get_text()]
        assert 4 <= len(texts) <= 8
        boxes = [text.get_window_extent(canvas.get_renderer()) for text in texts]
        assert not any(one.overlaps(other) for k, one in enumerate(boxes) for other in boxes[:k])
        path = ax.transData.transform(max((line.get_xydata() for line in ax.lines), key=len))
        assert not any(box.contains(*point) for box in boxes for point in path)


@pytest.mark.parametrize(
    ("name", "loci"),
    [
        ("i3", ["moment"]),
        ("i4", ["force"]),
        ("v8_crossplane", ["moment"]),
        ("twin180", ["moment", "force"]),
        ("i6", []),
    ],
)
def test_the_overview_has_the_locus_of_what_matters(name, loci):
    page = make_page(PageSubject(Study(analyze(load_example(name)))), "overview")
    titles = [ax.get_title("left") for ax in page.axes]
    assert titles[: len(loci)] == [f"Free {quantity}" for quantity in loci]
    spectra = page.axes[len(loci) :]
    assert len({ax.get_xlim() for ax in spectra}) == 1
    assert [tick.get_text() for tick in spectra[0].get_xticklabels()][:3] == ["1", "2", "3"]


@pytest.mark.parametrize(
    ("orders", "ticks"),
    [
        ([1, 2, 4], ["1", "2", "3", "4"]),
        ([1, 2, 2.5, 5, 7.5, 10], ["1", "2", "2½", "3", "4", "5", "6", "7", "7½", "8", "9", "10"]),
        ([1, 2, 4.5, 24], ["1", "2", "4½", "6", "8", "10", "12", "14", "16", "18", "20", "22", "24"]),
    ],
)
def test_every_bar_has_its_order_on_the_axis(orders, ticks):
    """Other orders stand beside them at even steps, if there is room."""
    ax = Figure().subplots()
    set_order_axis([ax], np.array(orders, float))
    assert [tick.get_text() for tick in ax.get_xticklabels()] == ticks


def test_a_colour_has_one_meaning_in_the_report_and_in_pictures():
    css = (ROOT / "src" / "balcli" / "report" / "assets" / "report.css").read_text()
    for colour, name in style.NAMES.items():
        if name not in ("ink", "soft", "faint", "paper"):
            assert f"--{name}: light-dark({colour}, " in css
