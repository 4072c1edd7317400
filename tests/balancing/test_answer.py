"""`balcli balance`: what it prints, what it refuses, and the workshop's figures."""

import math
import re
from pathlib import Path

import pytest
from support.cases import cases
from support.commands import ask_csv, ask_json, refusal, run_here
from support.engines import GOOD, SINGLE, build_text, changed
from support.paths import ENGINES, write

from balcli.balancing.answer import balance
from balcli.core.unbalance import STEEL, find_drill_depth
from balcli.errors import BalcliError
from balcli.file.model import Counterweight
from balcli.sizing.options import SCHEMES, SchemeOptions
from balcli.sizing.remedy import Remedy
from balcli.sizing.workshop import Practical, Tools, find_practical


@pytest.fixture
def file(tmp_path) -> Path:
    return write(tmp_path / "engine.toml", GOOD)


def test_json_has_devices_reasons_and_both_analyses(file):
    doc = ask_json("balance", file, "--scheme", "two-shaft", "--at=-40,60", "--order", "2")
    keys = "format version scheme order counterweights shafts sliders reasons practical details assumed before after"
    assert list(doc) == [*keys.split(), "ladder"]
    assert [s["ratio"] for s in doc["shafts"]] == [-2, 2]
    assert doc["shafts"][0]["at_mm"] == [-40, 60]
    assert doc["shafts"][1]["at_mm"] == pytest.approx([-40, -60])
    for state in ("before", "after"):
        (second,) = (entry["force_N"] for entry in doc[state]["orders"] if entry["order"] == 2)
        assert second["balanced"] is (state == "after")


def test_csv_has_one_figure_a_line(file):
    rows = ask_csv("balance", file)
    devices = {(r["part"], r["figure"]): r["value"] for r in rows if r["part"].startswith("shaft")}
    assert devices["shaft 1", "ratio"] == "2"
    weights = {f"counterweight {k}" for k in (1, 2, 3, 4)}
    assert {r["part"] for r in rows} == weights | {"shaft 1", "shaft 2", "step", "ladder", "before", "after"}
    ladder = {(r["quantity"], r["figure"]): r["value"] for r in rows if r["part"] == "ladder"}
    assert ladder["as drawn", "counterweights"] == "0"
    after = {r["figure"]: r["value"] for r in rows if r["quantity"] == "bearings" and r["part"] == "after"}
    steps = [r["value"] for r in rows if r["part"] == "step"]
    assert steps == ["counterweights at every throw", "shafts at +2 and -2"]
    assert after["main_N"] == ladder[steps[-1], "main_bearing"]
    assert (ladder["roll", "of"], float(ladder["roll", "order"])) == ("inertia", 2)
    assert devices["shaft 2", "speed_rpm"] == "6000.0"


@pytest.mark.parametrize(("place", "named"), [("0,0", True), ("0,80", False)])
def test_a_couple_that_the_devices_do_not_change_is_named(place, named):
    """A shaft beside the crank axis has a couple of its own; one on the axis has none."""
    printed = run_here("balance", ENGINES / "vtwin45.toml", "--scheme", "single-shaft", "--at", place).out
    note = " ".join(printed.split())
    assert ("Transverse couple: up to 103.9 N·m (order 1), from the rods" in note) is named
    assert ("No scheme changes the couple." in note) is named


@pytest.mark.slow
@pytest.mark.parametrize("scheme", SCHEMES)
def test_imperial_units_reach_reasons_and_notes(file, scheme):
    for form in ("table", "markdown"):
        for text in (GOOD, SINGLE, changed(("throws = [0, 180, 180, 0]", "throws = [0, 0, 0, 0]"))):
            options = ("--scheme", scheme, "--units", "imperial", "--format", form)
            told = run_here("balance", "-", *options, stdin=text.partition("firing_order")[0]).out
            computed = re.sub(r"(?m)^(- )?assumed.*(\n {2,}\S.*)*", "", told)  # assumed values have units of the file
            assert not re.search(r"\d (N|kN|N·m|kN·m|kg|g|mm|kg·m|g·mm)\b", computed)


@pytest.mark.parametrize(
    ("asked", "line"),
    [
        (["--speed", 4500], "speed = 4500.0    # as balanced by balcli\n"),
        (["--speed", 3000], "speed = 3000\n"),
        ([], "speed = 3000\n"),
    ],
)
def test_what_is_written_runs_at_the_speed_that_was_asked_for(file, tmp_path, asked, line):
    """So that it reads back to exactly `after`."""
    out = tmp_path / "out.toml"
    after = ask_json("balance", file, "--write", out, *asked)["after"]
    assert f"[operation]\n{line}" in out.read_text()
    assert ask_json("balance", out, "--scheme", "factor", "--factor", "0")["before"]["peak"] == after["peak"]


@cases("analysis/balance", "refusals")
def test_refusals(file, options, told):
    assert told in refusal("balance", file, *options)


def test_a_rotary_engine_has_no_factor():
    text = changed(("throws = [0, 180, 180, 0]\n", ""), ("firing_order = [1, 3, 4, 2]", "radial = 5\nrotary = true"))
    told = "a rotary engine's pin stands still"
    assert told in refusal("balance", "-", "--scheme", "factor", stdin=text)


# ------------------------------------------------------------------ the workshop
def engine():
    return build_text(SINGLE)


def test_practical_figures_follow_from_their_definitions():
    result = balance(engine(), "single-shaft", SchemeOptions(), tools=Tools(radius=0.06, disc=0.05))
    *weights, shaft = result.practical
    weight = weights[0]
    assert [one.unbalance_kg_m for one in weights] == pytest.approx([weight.unbalance_kg_m] * 2)
    assert weight.mass_kg == pytest.approx(weight.unbalance_kg_m / 0.06)
    for device in (weight, shaft):
        assert device.force_N == pytest.approx(device.unbalance_kg_m * engine().omega ** 2)
    assert weight.speed_rpm == shaft.speed_rpm == engine().speed_rpm
    mass = STEEL * math.pi * 0.05**2 / 2 * weight.disc_thickness_mm / 1e3  # half disc, centroid at 4R/(3 pi)
    assert mass * 4 * 0.05 / (3 * math.pi) == pytest.approx(weight.unbalance_kg_m)


def test_drill_depth_removes_the_unbalance():
    """Radial hole from the rim: the integral of density times area times radius over its depth."""
    depth = find_drill_depth(1e-3, 0.08, 0.012)
    area = math.pi / 4 * 0.012**2
    assert STEEL * area * (0.08**2 - (0.08 - depth) ** 2) / 2 == pytest.approx(1e-3, rel=1e-13)
    assert math.isnan(find_drill_depth(1.0, 0.08, 0.012))
    assert find_drill_depth(0.0, 0.08, 0.012) == 0


@pytest.mark.parametrize("name", ["radius", "thickness", "disc", "drill"])
def test_lengths_of_tools_are_positive(name):
    for length in (0.0, -1e-3, math.inf, math.nan):
        with pytest.raises(BalcliError, match=rf"^{name}: .* mm; give figures above 0$"):
            find_practical(engine(), Remedy(""), Tools(**{name: length}))


# ------------------------------------------------------------------ holes
def plan_holes(grams_mm: float, **tools: float) -> Practical:
    weight = Remedy("", devices=(Counterweight(unbalance=grams_mm, angle=150, position=0),))
    (figures,) = find_practical(engine(), weight, Tools(radius=0.08, **tools))
    assert figures.holes is not None
    return figures


def removed(holes: Practical, drill: float, density: float) -> float:
    """g mm of all holes, each in thin slices, summed from the rim inwards."""
    slices = 20_000
    step = holes.drill_depth_mm / 1e3 / slices
    radii = [0.08 - (k + 0.5) * step for k in range(slices)]
    return holes.holes * density * math.pi / 4 * drill**2 * step * sum(radii) * 1e6


def test_a_hole_stands_opposite_to_the_weight_and_removes_it():
    holes = plan_holes(6000, drill=0.02)
    assert (holes.holes, holes.hole_angle_deg) == (1, -30)
    assert removed(holes, 0.02, STEEL) == pytest.approx(6000, rel=1e-9)


def test_as_many_holes_as_the_depth_asks_for():
    holes = plan_holes(20_000, drill=0.02, max_depth=0.05)
    assert holes.holes == 3
    assert removed(holes, 0.02, STEEL) == pytest.approx(20_000, rel=1e-9)
    assert holes.drill_depth_mm <= 50
    assert removed(holes._replace(holes=2, drill_depth_mm=50), 0.02, STEEL) < 20_000


@pytest.mark.parametrize("count", [1, 2, 3, 50])
def test_holes_to_the_last_digit_of_their_depth(count):
    """So much as these holes remove at full depth asks for no further one."""
    most = STEEL * math.pi / 4 * 0.02**2 * (0.08**2 - 0.05**2) / 2 * 1e6
    for slip in (-1e-14, 0, 1e-14):
        holes = plan_holes(count * most * (1 + slip), drill=0.02, max_depth=0.03, width=1.0)
        assert holes.holes == count
        assert holes.drill_depth_mm == pytest.approx(30, rel=1e-9)


def test_a_slug_adds_what_it_is_heavier_than_steel_on_its_own_side():
    holes = plan_holes(20_000, drill=0.02, slug=17_000.0)
    assert holes.hole_angle_deg == 150
    assert removed(holes, 0.02, 17_000 - STEEL) == pytest.approx(20_000, rel=1e-9)


def test_holes_that_do_not_fit_on_the_crank_are_an_error(tmp_path):
    """Side by side along the stroke of a single, or along --width. The answer without holes is
    printed first; nothing is written.
    """
    for drill in (1e-4, 1e-170):
        with pytest.raises(BalcliError, match="do not fit"):
            plan_holes(20_000, drill=drill)
    written = tmp_path / "new.toml"
    done = run_here("balance", "-", "--drill", "2", "--write", written, stdin=SINGLE)
    message = done.err
    assert (done.status, written.exists()) == (2, False)
    assert done.out == run_here("balance", "-", stdin=SINGLE).out
    assert all(part in message for part in ("--drill 2 mm", "g mm", "holes side by side", "--width", "--slug"))
    assert plan_holes(20_000, drill=0.02, max_depth=0.05, width=0.06).holes == 3
    with pytest.raises(BalcliError, match="2 holes side by side"):
        plan_holes(20_000, drill=0.02, max_depth=0.05, width=0.059)


@cases("analysis/balance", "what_holes_cannot_be")
def test_what_holes_cannot_be(file, options, told):
    assert refusal("balance", file, *options) == told
