"""What analyze shows only where it is asked for: inner moments, guide-force moments; and strokes of
articulated cylinders.
"""

import re
from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from support.cases import cases
from support.commands import run_here
from support.engines import GOOD, RADIAL, build_text, inline_engine
from support.paths import ENGINES

from balcli import load
from balcli.analysis import show as analysis
from balcli.analysis.answer import EXTRAS, QUANTITIES, UNASKED, analyze
from balcli.analysis.verdict_words import name_orders
from balcli.file.assumed import Assumed
from balcli.forces.spectrum import compute_spectra
from balcli.shell.options import parse_parts
from balcli.show.sheet import Facts, Grid, View
from balcli.show.units import SYSTEMS


def rows(found, system="si"):
    """The rows of CSV: value and unit by cylinder, quantity, order and figure."""
    return {row[:4]: row[4:] for row in analysis.rows(found, SYSTEMS[system]).lines}


def test_inner_and_guide_as_rows():
    """Every figure of the JSON, places numbered, with their positions."""
    result = analyze(inline_engine([0, 180, 180, 0]), only=["inner", "guide"], orders=[1, 2])
    found = rows(result)
    wanted = result.to_dict()
    section = wanted["inner"]["sections"][1]
    bearing = wanted["inner"]["bearings"][4]
    assert found[0, "shear 2", None, "position"] == (section["position_mm"], "mm")
    assert found[0, "shear 2", None, "peak"] == (section["shear_N"]["peak"], "N")
    assert found[0, "bending 2", 1, "major"] == (section["bending_Nm"]["orders"][0]["major"], "N·m")
    assert found[0, "bearing 5", 2, "x_amplitude"] == (bearing["load_N"]["orders"][1]["x"]["amplitude"], "N")
    assert (0, "shear 5", None, "peak") not in found
    assert found[0, "guide_h", 2, "sin"] == (wanted["guide"]["orders"][1]["h_Nm"]["sin"], "N·m")
    assert found[0, "guide_x", 1, "balanced"] == (True, "")
    single = rows(analyze(inline_engine([0]), only=["guide"], orders=[1]))
    assert not [key for key in single if key[1] == "guide_x"]


def test_without_bearings_bending_ends_with_the_free_moment_about_the_last_place():
    """An engine of two throws in phase has a free force, and so another moment about its middle."""
    found, about_last = (analyze(inline_engine([0, 0], more=f"[frame]\nreference = [0, 0, {z}]\n")) for z in (0, 50))
    asked = analyze(inline_engine([0, 0]), only=["inner"])
    last = asked.to_dict()["inner"]["sections"][-1]
    assert (last["position_mm"], last["bending_Nm"]["peak"]) == pytest.approx((50, about_last.peak.moment.value))
    assert asked.to_dict()["inner"]["largest_bending_Nm"] == last["bending_Nm"]["peak"]
    assert found.peak.moment.value == pytest.approx(0, abs=1e-6)
    told = str(analysis.sheet(asked, SYSTEMS["si"]).parts)
    assert "at the last position is therefore the free moment of all these loads about this position" in told


def test_couples_of_single_cylinders():
    """They are shown where they are named; opposite throws make opposite couples of odd orders."""
    asked = ("analyze", ENGINES / "twin180.toml", "--orders", "1,3", "--by", "cylinder")
    found = [line.split() for line in run_here(*asked, "--only", "couple").out.splitlines()]
    first, third = ([line[1:] for line in found if line[:1] == [order]][-2:] for order in ("1", "3"))
    assert first[0][2] == "90.0"  # H omega^2 D_1 sin theta
    for (size, _, at), (other_size, _, other_at) in (first, third):
        assert size == other_size
        assert abs(float(at) - float(other_at)) == 180
    assert "about the crank" not in run_here(*asked).out


def test_strokes_and_reasons_as_rows():
    result = analyze(build_text(RADIAL), only=["force"], orders=[1], why=True)
    found = rows(result, "imperial")
    assert found[1, "travel", None, "stroke"] == (pytest.approx(0.12 / 0.0254), "in")
    assert found[3, "travel", None, "top_deg"][0] == pytest.approx(-found[6, "travel", None, "top_deg"][0])
    (reason,) = result.to_dict()["why"]["reasons"]
    assert found[0, "force", 1, "why"] == (reason["verdict"], "")
    assert found[0, "force", 1, "why_size"] == (reason["size"], "of one cylinder")


WIDE = [0, 72, 144, 216, 288]


BRIEF = View()


def parts(subject, view=BRIEF, **options):
    """Titles of a sheet's parts, and the first cells of its first table."""
    found = analysis.sheet(analyze(subject, only=[*UNASKED, "ladder"], **options), SYSTEMS["si"], view).parts
    first = next(part for part in found if isinstance(part, Grid))
    return [part.title.split(":")[0].split(" (")[0] for part in found], list(first.columns[0].cells)


BRIEF = [
    "",
    "Verdict",
    "Largest by order, and its parts that turn with the crank and against it",
    "Largest over a revolution",
    "What balances it, step by step",
]


def test_in_brief_the_verdict_comes_first_and_only_orders_that_matter():
    assert parts(inline_engine(WIDE)) == (BRIEF, ["1", "2", "4"])
    every = View(every_order=True)
    assert parts(inline_engine(WIDE), every, orders=[4, 6]) == (BRIEF, ["4", "6"])
    assert "10" in parts(inline_engine(WIDE), View(whole=True))[1]


def test_a_mean_turns_neither_way():
    """Under uneven speed a throw pulls longest where it is fastest; that force stands still."""
    ripple = "speed_ripple = [{ order = 1, amplitude = 0.1 }]\n"
    text = GOOD.replace("throws = [0, 180, 180, 0]", "throws = [0]").replace("[1, 3, 4, 2]", "[1]")
    found = analyze(build_text(text + ripple))
    brief = next(p for p in analysis.sheet(found, SYSTEMS["si"]).parts if isinstance(p, Grid))
    assert brief.columns[0].cells[0] == "0"
    assert [column.head for column in brief.columns if column.cells[0] == "–"] == ["with crank", "against"]
    whole = analysis.sheet(found, SYSTEMS["si"], View(whole=True)).parts
    table = next(p for p in whole if p.title.startswith("Free force by order"))
    unknown = [column.head for column in table.columns if column.cells[0] == "–"]
    assert unknown == ["smallest", "axis, deg", "with crank", "against"]


@cases("show/analysis", "only_picks_parts")
def test_only_picks_parts(words, titles):
    chosen, named = parse_parts(words)
    found = analysis.sheet(analyze(inline_engine([0, 180]), only=chosen), SYSTEMS["si"], View(parts=named))
    assert [p.title for p in found.parts if p.title or isinstance(p, Facts)] == titles


def test_orders_without_a_part_of_roll_do_not_make_it_balanced(balcli):
    """The roll of an in-line four has the orders 2, 4, 6 and on."""
    four = ENGINES / "i4.toml"
    odd = balcli("analyze", four, "--orders", "3,7").out
    assert re.search(r"roll moment +balanced in the orders shown\n", odd)
    assert "Verdict\nOrders 3 and 7: force, moment and couple balanced.\n" in odd
    high = balcli("analyze", four, "--orders", "10").out
    assert re.search(r"roll moment +negligible \(0\.0026 N·m\) in the orders shown\n", high)
    assert "order 2: 1355, 4: 65.75" in balcli("analyze", four, "--orders", "2-4").out
    assert "in the orders shown" not in balcli("analyze", ENGINES / "i4.toml").out


def test_the_largest_roll_over_a_revolution_is_that_of_all_orders_together(balcli):
    """Of a V-twin it is neither the largest order nor the sum of all."""
    engine = load(ENGINES / "vtwin45.toml")
    told = " ".join(balcli("analyze", ENGINES / "vtwin45.toml").out.split())
    (value, deg) = re.search(r"roll moment ([\d.]+) N·m at crank angle ([\d.]+) deg", told).groups()
    roll = compute_spectra(engine, range(1, 13), ("roll",)).roll
    angles = np.radians(np.arange(0, 360, 0.01))
    curve = np.abs(sum((2 * c * np.exp(1j * n * angles)).real for n, c in zip(roll.orders, roll.forward, strict=True)))
    assert float(value) == pytest.approx(curve.max(), rel=1e-4)
    assert curve[round(100 * float(deg))] == pytest.approx(curve.max(), rel=1e-4)
    assert max(roll.major) * 1.02 < curve.max() < 0.98 * sum(roll.major)


@pytest.mark.parametrize("command", [("analyze",), ("analyze", "--only", "gas")])
def test_the_mean_roll_is_minus_the_mean_torque(balcli, command):
    """C - T, and no couple has a mean."""
    shown = balcli(*command, ENGINES / "i4_wiebe.toml", "--orders", "0,2").out
    table = shown.partition("About the crank axis with gas")[2]
    figures = re.findall(r"-?[\d.]+", re.search(r"^0 +(.+)$", table, re.MULTILINE)[1])
    torque, roll = (float(figure) for figure in figures[-2:])
    assert roll == -torque < 0


@pytest.mark.parametrize("more", [(), ("--all",)])
def test_orders_that_are_asked_for_are_shown_balanced_or_not(balcli, more):
    given = ("--only", "textbook", "--orders", "1-6", *more)
    table = balcli("analyze", ENGINES / "i5.toml", *given).out.partition("Free moment in")[2]
    assert re.findall(r"^(\d) +", table, re.MULTILINE) == list("123456")
    assert "Free moment by order" not in table


OPEN = """
crank.stroke = 80
rod.length = 140
rod.mass = 0.5
rod.cg = 45
piston.bore = 80
piston.mass = 0.4
"""
UNEVEN = "operation.speed_ripple = [{ order = 2, amplitude = 0.05 }]\n"
WITH_GAS = 'gas.cycle = "otto"\ngas.compression_ratio = 10\ngas.imep = 9\n'
LEFT_OUT = [
    "crank.spacing = 100",
    "layout.stagger = 20",
    "crank.throw_mass = 0.8",
    "crank.inertia = 9e4",
    "rod.inertia = 1900",
    "piston.offset = 2",
    "layout.strokes = 2",
    "gas.compression_index = 1.4",
]


def name_paths(assumed: Iterable[Assumed] | None) -> set[str]:
    return {value.path for value in assumed or ()}


@pytest.mark.parametrize("word", [*QUANTITIES, *EXTRAS, "gas", "xy", "textbook"])
@pytest.mark.parametrize(
    "more",
    [
        "crank.throws = [0, 120]\nlayout.bank_angle = 90\n",
        "crank.spacing = 100\nlayout.firing_order = [1, 2, 3]\n" + WITH_GAS,
        "crank.throws = [0]\nlayout.banks = [-5, 5]\nframe.reference = [9, 9, 9]\n" + UNEVEN,
        "crank.spacing = 100\nlayout.banks = [-5, 5]\nlayout.firing_order = [1, 2]\n" + UNEVEN + WITH_GAS,
    ],
)
def test_a_table_names_the_defaults_that_would_change_it(word: str, more: str) -> None:
    quantities, words = parse_parts(word)

    def ask(line: str = "") -> tuple[list[Any], set[str]]:
        found = analyze(build_text(OPEN + more + line), only=quantities)
        parts = analysis.sheet(found, SYSTEMS["si"], View(parts=words)).parts
        return [part for part in parts if "assumed" not in str(part)], name_paths(found.assumed)

    if (word in ("gas", "pru") and "gas" not in more) or (word == "inner" and "spacing" not in more):
        pytest.skip("the command refuses it")
    before, listed = ask()
    every = name_paths(build_text(OPEN + more).list_assumed("gas"))
    keys = {line: line.partition(" ")[0] for line in LEFT_OUT}
    unnamed = (line for line, key in keys.items() if key in every and key not in listed)
    assert [line for line in unnamed if ask(line)[0] != before] == []


@pytest.mark.parametrize(
    ("orders", "told"),
    [
        ([2, 4], "orders 2 and 4"),
        ([1, 2, 3, 4, 5, 6], "orders 1 to 6"),
        ([1, 2, 3, 4, 5, 7], "6 orders, the highest 7"),
    ],
)
def test_many_orders_are_named_by_their_range_or_number(orders, told):
    assert name_orders(orders) == told
