"""What analyze shows only where it is asked for: inner moments, guide-force moments; and strokes of
articulated cylinders.
"""

from __future__ import annotations

import csv
import json
import re
from dataclasses import replace
from io import StringIO
from types import SimpleNamespace

import pytest
from support.cases import cases
from support.commands import ask, ask_json
from support.engines import GOOD, RADIAL, STAGGERED_TWIN, build_text, inline_engine, rotary_engine
from support.paths import ENGINES

from balcli.commands.options import parse_parts
from balcli.core.peaks import Peak
from balcli.errors import BalcliError
from balcli.render import analysis, analysis_document
from balcli.render.devices import device_grid
from balcli.render.formats import Format, render
from balcli.render.sheet import Facts, Grid
from balcli.render.units import SYSTEMS
from balcli.render.view import IN_BRIEF, View
from balcli.results.analysis import QUANTITIES, analyze
from balcli.results.balance import balance

RENDERER = SimpleNamespace(sheet=analysis.sheet, document=analysis_document.document, rows=analysis_document.rows)


def rendered(form, subject, system="si", **options):
    return render([analyze(subject, **options)], RENDERER, form, SYSTEMS[system])


def document(subject, **options):
    return json.loads(rendered(Format.JSON, subject, **options))


def shown(subject, **options):
    return rendered(Format.MARKDOWN, subject, **options)


def test_inner_as_json():
    found = document(inline_engine([0, 180, 180, 0]), only=["inner"], orders=[1, 2])["inner"]
    assert [section["position_mm"] for section in found["sections"]] == pytest.approx([-150, -50, 50, 150])
    assert found["sections"][1]["shear_N"]["orders"][0]["balanced"]
    assert found["largest_bending_Nm"] == max(section["bending_Nm"]["peak"] for section in found["sections"])
    assert [bearing["position_mm"] for bearing in found["bearings"]] == pytest.approx([-200, -100, 0, 100, 200])


def test_without_bearings_bending_ends_with_the_free_moment_about_the_last_place():
    """An engine of two throws in phase has a free force, and so another moment about its middle."""
    about_middle = inline_engine([0, 0])
    about_last = inline_engine([0, 0], more="[frame]\nreference = [0, 0, 50]\n")
    told = shown(about_middle, only=["inner"])
    assert "at the last place is the free moment of all these loads about it" in told
    last = document(about_middle, only=["inner"])["inner"]["sections"][-1]
    assert last["position_mm"] == pytest.approx(50)
    assert last["bending_Nm"]["peak"] == pytest.approx(analyze(about_last).moment.value)
    assert analyze(about_middle).moment.value == pytest.approx(0, abs=1e-6)


def test_guide_as_json():
    found = document(inline_engine([0, 180]), only=["guide"], orders=[1, 2])["guide"]
    assert found["includes"] == "inertia, without gas"
    assert found["height_m"] == pytest.approx([0.16, 0.16])
    assert [entry["order"] for entry in found["orders"]] == [1, 2]
    assert not found["orders"][0]["x_Nm"]["balanced"]
    assert "x_Nm" not in document(inline_engine([0]), only=["guide"], orders=[1])["guide"]["orders"][0]


def test_strokes_as_json():
    found = document(build_text(RADIAL), only=["force"])["travel"]
    assert [entry["cylinder"] for entry in found] == [1, 2, 3, 4, 5, 6, 7]
    assert found[0]["stroke_m"] == pytest.approx(0.12)
    assert found[2]["stroke_m"] > 0.1204
    assert found[2]["top_deg"] == pytest.approx(-found[5]["top_deg"])


def test_nothing_more_where_nothing_was_asked():
    assert not {"inner", "guide", "travel", "why"} & document(inline_engine([0, 180])).keys()


def rows(subject, system="si", **options):
    text = rendered(Format.CSV, subject, system, **options)
    return {
        (r["cylinder"], r["quantity"], r["order"], r["figure"]): (r["value"], r["unit"])
        for r in csv.DictReader(StringIO(text))
    }


def test_inner_and_guide_as_rows():
    """Every figure of the JSON, places numbered, with their positions."""
    subject = inline_engine([0, 180, 180, 0])
    found, wanted = (
        rows(subject, only=["inner", "guide"], orders=[1, 2]),
        document(subject, only=["inner", "guide"], orders=[1, 2]),
    )
    section, bearing = wanted["inner"]["sections"][1], wanted["inner"]["bearings"][4]
    assert found["0", "shear 2", "", "position"] == (str(section["position_mm"]), "mm")
    assert found["0", "shear 2", "", "peak"] == (str(section["shear_N"]["peak"]), "N")
    assert found["0", "bending 2", "1", "major"] == (str(section["bending_Nm"]["orders"][0]["major"]), "N·m")
    assert found["0", "bearing 5", "2", "x_amplitude"] == (str(bearing["load_N"]["orders"][1]["x"]["amplitude"]), "N")
    assert ("0", "shear 5", "", "peak") not in found
    h = wanted["guide"]["orders"][1]["h_Nm"]
    assert found["0", "guide_h", "2", "sin"] == (str(h["sin"]), "N·m")
    assert found["0", "guide_x", "1", "balanced"] == ("true", "")
    assert not [key for key in rows(inline_engine([0]), only=["guide"], orders=[1]) if key[1] == "guide_x"]


def test_strokes_and_reasons_as_rows():
    subject = build_text(RADIAL)
    found = rows(subject, "imperial", only=["force"], orders=[1], reasons=True)
    value, unit = found["1", "travel", "", "stroke"]
    assert (float(value), unit) == (pytest.approx(0.12 / 0.0254), "in")
    assert float(found["3", "travel", "", "top_deg"][0]) == pytest.approx(
        -float(found["6", "travel", "", "top_deg"][0])
    )
    (reason,) = document(subject, only=["force"], orders=[1], reasons=True)["why"]["reasons"]
    assert found["0", "force", "1", "why"] == (reason["verdict"], "")
    assert found["0", "force", "1", "why_size"] == (str(reason["size"]), "of one cylinder")


def test_a_sheet_has_inner_moments_guide_forces_and_strokes():
    text = shown(inline_engine([0, 180, 180, 0]), only=["inner", "guide"])
    for title in (
        "Shear force in the crankshaft behind each load, kN",
        "Bending moment in the crankshaft, N·m",
        "Inertia loads of main bearings half-way between throws, shaft cut in each, kN",
        "largest inner moment",
        "Guide-force moments of inertia alone, without gas, N·m",
    ):
        assert title in text
    assert "divided by L = 160 mm (crankshaft to the middle of the guide" in " ".join(text.split())
    radial = analyze(build_text(RADIAL), only=["force"])
    titles = {
        whole: [p.title for p in analysis.sheet(radial, SYSTEMS["si"], View(whole=whole)).parts]
        for whole in (False, True)
    }
    assert "Strokes and dead centres" not in " ".join(titles[False])
    assert "Strokes and dead centres" in " ".join(titles[True])


WIDE = [0, 72, 144, 216, 288]
SIX = [0, 120, 240, 240, 120, 0]


def parts(subject, view=IN_BRIEF, **options):
    """Titles of a sheet's parts, and the first cells of its first table."""
    found = analysis.sheet(analyze(subject, only=QUANTITIES, **options), SYSTEMS["si"], view).parts
    first = next((part for part in found if isinstance(part, Grid)), None)
    return [part.title.split(":")[0] for part in found], [row[0] for row in (() if first is None else first.rows)]


BRIEF = [
    "",
    "Verdict",
    "Largest by order, and its parts that turn with the crank and against it",
    "Largest over a revolution",
    "Sizing",
]


def test_in_brief_the_verdict_comes_first_and_only_orders_that_matter():
    assert parts(inline_engine(WIDE)) == (BRIEF, ["1", "2", "4"])
    every = View(every_order=True)
    assert parts(inline_engine(WIDE), every, orders=[4, 6]) == (BRIEF, ["4", "6"])
    assert "10" in parts(inline_engine(WIDE), View(whole=True))[1]


def test_at_uneven_speed_no_order_has_a_cure_of_its_own():
    """Of a crank whose throw is all that shakes, order 2 is what order 1 of the speed makes of it:
    its counterweight takes that as well, and no shaft at twice the speed is wanted.
    """
    throw_alone = """
[crank]
stroke = 80
throw_mass = 1
[rod]
length = 140
[piston]
mass = 1e-9
[operation]
speed = 3000
"""
    ripple = "speed_ripple = [{ order = 1, amplitude = 0.1 }]\n"
    weight = "[[counterweight]]\nunbalance = 40000\nangle = 180\n"
    uneven, balanced = (build_text(throw_alone + ripple + more) for more in ("", weight))
    second, left = (analyze(engine, orders=[2]).spectra.force.major[0] for engine in (uneven, balanced))
    assert left < 1e-6 * second
    told, steady = (
        " ".join(shown(engine, only=["force", "moment", "sizing"]).split())
        for engine in (uneven, build_text(throw_alone))
    )
    assert "Second order: force of" in told
    assert "nothing on the crankshaft" not in told
    assert "what cancels an order at steady speed" in told
    assert "no free force or moment of orders 1 and 2 at steady speed" in told
    assert "counterweights cancel" in steady
    assert "steady" not in steady
    whole = analysis.sheet(analyze(uneven), SYSTEMS["si"], View(whole=True)).parts
    book = next(part for part in whole if part.title == "Free force in textbook units")
    assert [row[1] for row in book.rows][:3] == ["balanced", "1", "1"]
    assert book.note.endswith("without devices, at steady speed.")


@pytest.mark.parametrize("gas", ["", '[gas]\ncycle = "otto"\ncompression_ratio = 9\nimep = 8\n'])
@pytest.mark.parametrize("view", [IN_BRIEF, View(whole=True)])
def test_couple_and_roll_are_told_to_be_about_the_point_of_reference(gas, view):
    """A force on the crank axis has a lever about a point beside it; about one along it none."""
    told = [
        analysis.sheet(analyze(build_text(f"{GOOD}{gas}[frame]\nreference = {point}\n")), SYSTEMS["si"], view)
        for point in ([0, 0, 300], [0, 50, 300])
    ]
    on_axis, beside = ([p.title for p in s.parts if p.title.startswith("About")] for s in told)
    assert bool(on_axis) == bool(gas or view is not IN_BRIEF)
    assert [title.replace("the crank axis", "the point of reference") for title in on_axis] == beside
    assert all("the crank axis" in title for title in on_axis)


def test_a_mean_turns_neither_way():
    """Under uneven speed a throw pulls longest where it is fastest; that force stands still."""
    ripple = "speed_ripple = [{ order = 1, amplitude = 0.1 }]\n"
    text = GOOD.replace("throws = [0, 180, 180, 0]", "throws = [0]").replace("[1, 3, 4, 2]", "[1]")
    found = analyze(build_text(text + ripple))
    assert found.spectra.force.forward[0] != 0
    brief = next(p for p in analysis.sheet(found, SYSTEMS["si"]).parts if isinstance(p, Grid))
    assert brief.rows[0][0] == "0"
    assert brief.rows[0][2:4] == ("–", "–")
    whole = analysis.sheet(found, SYSTEMS["si"], View(whole=True)).parts
    table = next(p for p in whole if p.title.startswith("Free force by order"))
    assert table.rows[0][2:] == ("–",) * 4


def test_what_is_left_out_is_named_in_one_line():
    """A straight six has nothing below order 6, where ellipses are as small as the series."""
    found = analysis.sheet(analyze(inline_engine(SIX)), SYSTEMS["si"])
    grid = next(part for part in found.parts if isinstance(part, Grid))
    assert [row[:4] for row in grid.rows] == [(n, "balanced", "", "") for n in "12"]
    assert re.fullmatch(r"Negligible: orders 6, 12 \(at most force [\d.e-]+ N\)\. All: --all\.", grid.note)


@cases("render/analysis", "only_picks_parts")
def test_only_picks_parts(words, titles):
    chosen, named = parse_parts(words)
    found = analysis.sheet(analyze(inline_engine([0, 180]), only=chosen), SYSTEMS["si"], View(parts=named))
    assert [p.title for p in found.parts if p.title or isinstance(p, Facts)] == titles


def test_a_rotary_engine_from_end_to_end():
    subject = rotary_engine("radial = 9")
    assert document(subject, reasons=True)["orders"][0]["force_N"]["balanced"]
    assert "balanced exactly: 9 evenly spaced phasors sum to nothing" in shown(subject, reasons=True)


def test_an_unknown_quantity_is_refused_with_those_there_are():
    with pytest.raises(BalcliError) as caught:
        analyze(inline_engine([0]), only=["bending"])
    assert str(caught.value) == (
        "there is no quantity bending: choose from force, moment, couple, torque, roll, peak, sizing, gas, inner, guide"
    )


# ------------------------------------------------------------------ one throw, pins split, rods apart
def find_facts(text, wanted):
    found = analysis.sheet(analyze(build_text(text)), SYSTEMS["si"])
    facts = next(part for part in found.parts if isinstance(part, Facts))
    return [value for name, value in facts.pairs if name == wanted]


def find_throws(text):
    return find_facts(text, "throws")


def test_throws_that_do_not_begin_with_cylinder_1_say_from_where_they_count():
    """The crank angle is 0 where cylinder 1's pin is at 0, which need not be on the first throw."""
    boxer = GOOD.replace("firing_order = [1, 3, 4, 2]", "banks = [-90, 90]\n{}")
    first = "numbering = [[1, 2, 3, 4], [5, 6, 7, 8]]"
    last = "numbering = [[4, 3, 2, 1], [5, 6, 7, 8]]"
    boxer = boxer.replace("throws = [0, 180, 180, 0]", "throws = [0, 180, 90, 270]")
    assert find_throws(boxer.format(first)) == ["0, 180, 90, 270 deg"]
    assert find_throws(boxer.format(last)) == ["90, 270, 180, 0 deg from cylinder 1's pin"]


def test_a_speed_that_the_file_does_not_give_is_said_to_be_assumed():
    assert find_facts(GOOD, "speed") == ["3000 rpm"]
    silent = GOOD.replace("speed = 3000", "")
    assert find_facts(silent, "speed") == ["1000 rpm, assumed: the file gives none"]
    faster = analyze(replace(build_text(silent), speed_rpm=2000.0))
    assert "assumed" not in render([faster], RENDERER, Format.TABLE, SYSTEMS["si"])


def test_split_pins_of_one_throw_stand_in_the_header():
    assert find_throws(STAGGERED_TWIN) == ["0 deg, split pins: the next bank's at -30 deg"]
    assert not find_throws(STAGGERED_TWIN.replace("splay = -30", ""))


def test_one_throw_has_a_length_beside_which_moments_are_small():
    """Rods 20 mm apart; without stagger, the stroke."""
    twin = build_text(STAGGERED_TWIN)
    of_one = analyze(twin).of_one_cylinder
    assert of_one["moment"] == pytest.approx(0.020 * of_one["force"], rel=1e-12)
    of_one = analyze(build_text(STAGGERED_TWIN.replace("stagger = 20", ""))).of_one_cylinder
    assert of_one["moment"] == pytest.approx(0.067 * of_one["force"], rel=1e-12)
    assert parts(twin)[1] == ["1", "2", "4"]


def test_the_sizing_in_brief_says_where_its_planes_are():
    twin = analyze(build_text(STAGGERED_TWIN), only=QUANTITIES)
    lines = analysis.sheet(twin, SYSTEMS["si"]).parts[-1].paragraphs
    assert lines[0].endswith("; all at z = -10, 10 mm.")


def test_equal_peaks_are_told_by_the_first_and_how_far_they_are_apart():
    four = ask("analyze", ENGINES / "i4.toml", "--only", "force,peak")
    assert "kN at crank angle 90.0 deg and every 180 deg" in four
    three = ask("analyze", ENGINES / "i3.toml", "--only", "moment,peak")
    assert re.search(r"moment +[0-9.]+ N·m at crank angle [0-9.]+ deg\n", three)


def test_orders_without_a_part_of_roll_do_not_make_it_balanced(balcli):
    """The roll of an in-line four has the orders 2, 4, 6 and on."""
    four = ENGINES / "i4.toml"
    odd = balcli("analyze", four, "--orders", "3,7").out
    assert re.search(r"roll C − T +balanced in the orders shown\n", odd)
    assert "Verdict\nThe orders shown: free of force and moment.\n" in odd
    high = balcli("analyze", four, "--orders", "10").out
    assert re.search(r"roll C − T +negligible \(0\.0026 N·m\) in the orders shown\n", high)
    assert "order 2: 1355, 4: 65.75" in balcli("analyze", four, "--orders", "2-4").out
    assert "in the orders shown" not in balcli("analyze", ENGINES / "i4.toml").out


def test_a_force_that_only_turns_is_as_large_at_every_crank_angle():
    star = analyze(rotary_engine("radial = 9"), only=["force", "peak"])
    turning = replace(star, force=Peak(7.0, 0.0, 0.0))
    facts = analysis.sheet(turning, SYSTEMS["si"], View(parts=frozenset({"force", "peak"})))
    told = [pair for part in facts.parts if isinstance(part, Facts) for pair in part.pairs]
    assert ("force", "7 N at every crank angle") in told


def test_roll_beside_that_with_gas_is_told_to_be_of_inertia_alone(balcli):
    diesel, petrol = ENGINES / "i6_diesel.toml", ENGINES / "i6.toml"
    told = "About the crank axis of inertia alone, N·m"
    assert told in balcli("analyze", diesel, "--only", "roll,guide").out
    assert told not in balcli("analyze", petrol, "--only", "roll,guide").out
    assert "roll C − T, inertia alone" in balcli("analyze", diesel).out


@pytest.mark.parametrize("command", [("analyze",), ("analyze", "--only", "gas")])
def test_the_mean_roll_is_minus_the_mean_torque(balcli, command):
    """C - T, and no couple has a mean."""
    shown = balcli(*command, ENGINES / "i4_wiebe.toml", "--orders", "0,2").out
    table = shown.partition("About the crank axis with gas")[2]
    figures = re.findall(r"-?[\d.]+", re.search(r"^0 +(.+)$", table, re.MULTILINE)[1])
    torque, roll = (float(figure) for figure in figures[-2:])
    assert roll == -torque < 0


def test_all_has_the_guide_moments_and_json_has_not(balcli):
    assert "Guide-force moments" in balcli("analyze", ENGINES / "i3.toml", "--all").out
    assert "guide" not in ask_json("analyze", ENGINES / "i3.toml", "--all")


@pytest.mark.parametrize("more", [(), ("--all",)])
def test_orders_that_are_asked_for_are_shown_balanced_or_not(balcli, more):
    given = ("--only", "textbook", "--orders", "1-6", *more)
    table = balcli("analyze", ENGINES / "i5.toml", *given).out.partition("Free moment in")[2]
    assert re.findall(r"^(\d) +", table, re.MULTILINE) == list("123456")
    assert "Free moment by order" not in table


def test_weights_of_ships_are_told_in_kg_m():
    """As `analyze` has them; a bare number of an engine file is g mm."""
    for mass, unit in (("0.5", "g·mm"), ("500", "kg·m")):
        ship = build_text(GOOD.replace("mass = 0.5", f"mass = {mass}"))
        devices = device_grid(balance(ship).remedy, SYSTEMS["si"])
        assert devices.columns[2] == unit
        size = float(devices.rows[0][2]) / {"g·mm": 1e6, "kg·m": 1}[unit]
        assert size == pytest.approx(balance(ship).remedy.devices[0].unbalance / 1e6, rel=1e-4)
