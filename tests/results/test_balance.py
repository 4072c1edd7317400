"""`balcli balance`: what it prints, what it refuses, and the workshop's figures."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import pytest
from support.cases import cases
from support.commands import ask_csv, refusal, run_here
from support.engines import GOOD, SINGLE, build_text, changed
from support.paths import ENGINES, write

from balcli.core.drilled_hole import STEEL, find_drill_depth
from balcli.engine.load import load
from balcli.enginefile.model import Counterweight, Slider
from balcli.errors import BalcliError
from balcli.results.balance import balance
from balcli.sizing.options import SchemeOptions
from balcli.sizing.remedy import Remedy
from balcli.sizing.schemes import SCHEMES
from balcli.sizing.workshop import Holes, Tools, find_practical


@pytest.fixture
def file(tmp_path) -> Path:
    return write(tmp_path / "engine.toml", GOOD)


def run(*arguments: object, text: str | None = None):
    return run_here("balance", *arguments, stdin=text or "")


def document(*arguments: object, text: str | None = None) -> dict:
    result = run(*arguments, "--format", "json", text=text)
    assert result.status == 0, result.err
    return json.loads(result.out)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.stress
def test_every_scheme_and_format(scheme):
    for form in ("table", "csv", "markdown", "json"):
        result = run("-", "--scheme", scheme, "--format", form, text=SINGLE)
        assert result.status == 0, result.err
        assert result.out.strip()


def test_tables_fit_eighty_columns(monkeypatch):
    for scheme in SCHEMES:
        result = run("-", "--scheme", scheme, "--drill", "10", text=SINGLE)
        tables = [line for line in result.out.splitlines() if set(line) == {"─"}]
        assert tables
        assert max(map(len, tables)) <= 80


def test_json_has_devices_reasons_and_both_analyses(file):
    doc = document(file, "--scheme", "two-shaft", "--at=-40,60", "--order", "2")
    assert list(doc) == [
        "format",
        "version",
        "scheme",
        "order",
        "counterweights",
        "shafts",
        "sliders",
        "reasons",
        "practical",
        "details",
        "before",
        "after",
    ]
    assert [s["ratio"] for s in doc["shafts"]] == [-2, 2]
    assert doc["shafts"][0]["at_mm"] == [-40, 60]
    assert doc["shafts"][1]["at_mm"] == pytest.approx([-40, -60])
    second = {
        state: next(o for o in doc[state]["orders"] if o["order"] == 2)["force_N"] for state in ("before", "after")
    }
    assert second["before"]["balanced"] is False
    assert second["after"]["balanced"] is True


def test_before_and_after_show_the_same_orders():
    doc = document("-", "--scheme", "eccentric-slider", text=SINGLE)
    assert [o["order"] for o in doc["before"]["orders"]] == [o["order"] for o in doc["after"]["orders"]]
    assert 3 in [o["order"] for o in doc["after"]["orders"]]


def test_what_has_one_size_all_round_is_largest_at_any_angle():
    """Two weights on a shaft, 1 kg m each: 2 cos 15 times 3948 N together, and 1974 N m by the one
    half a metre off, which a plane at 0 leaves.
    """
    text = """
        crank = { stroke = 400 }
        rod = { length = 1000 }
        piston = { mass = 0 }
        operation = { speed = 600 }
        counterweight = [{ unbalance = 1e6, angle = 30 }, { unbalance = 1e6, position = 500 }]
        """
    out = run_here("balance", "-", "--scheme", "counterweights", "--planes", "0", stdin=text).out
    assert re.search(r"^force, kN +7\.6266 +any +balanced$", out, re.MULTILINE)
    assert re.search(r"^moment, N·m +1973\.9 +any +1973\.9 +any$", out, re.MULTILINE)


def test_csv_has_one_figure_a_line(file):
    rows = ask_csv("balance", file)
    devices = {(r["part"], r["figure"]): r["value"] for r in rows if r["part"].startswith("shaft")}
    assert devices["shaft 1", "ratio"] == "2"
    assert {r["part"] for r in rows} == {"shaft 1", "shaft 2", "before", "after"}
    assert devices["shaft 2", "speed_rpm"] == "6000.0"


def test_csv_has_what_json_calls_practical_and_details(file):
    options = ("--scheme", "factor", "--factor", "0.5")
    rows = ask_csv("balance", file, *options)
    found = {(r["part"], r["figure"]): r["value"] for r in rows if not r["quantity"]}
    wanted = document(file, *options)
    for k, shop in enumerate(wanted["practical"], 1):
        assert {key: found[f"counterweight {k}", key] for key in shop} == {
            key: str(value) for key, value in shop.items()
        }
    assert found["details", "card.2.bobweight_g"] == str(wanted["details"]["card"][1]["bobweight_g"])
    assert found["details", "card.2.cylinders.1"] == "2"


@pytest.mark.parametrize(("units", "size", "length"), [("si", 1.0, 1.0), ("imperial", 28.349523125 * 25.4, 25.4)])
def test_csv_has_devices_in_the_units_asked_for(file, units, size, length):
    options = ("--scheme", "two-shaft", "--at=-60 mm,80 mm", "--position", "12 mm")
    rows = ask_csv("balance", file, *options, "--units", units)
    found = {r["figure"]: (float(r["value"]), r["unit"]) for r in rows if r["part"] == "shaft 1" and r["unit"]}
    shaft = document(file, *options)["shafts"][0]
    names = {"si": ("g·mm", "mm"), "imperial": ("oz·in", "in")}[units]
    assert found["unbalance"] == (pytest.approx(shaft["unbalance_kg_m"] * 1e6 / size), names[0])
    assert [found["at_x"], found["at_y"], found["position"]] == [
        (pytest.approx(v / length), names[1]) for v in (-60, 80, 12)
    ]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_imperial_units_reach_reasons_and_notes(file, scheme):
    """Grams stand on the bobweight card in either system, as on the scales of a shop."""
    for form in ("table", "markdown"):
        for text in (GOOD, SINGLE, changed(("throws = [0, 180, 180, 0]", "throws = [0, 0, 0, 0]"))):
            options = ("--scheme", scheme, "--units", "imperial", "--format", form)
            told = run("-", *options, text=text.partition("firing_order")[0]).out
            assert not re.search(r"\d (N|kN|N·m|kN·m|kg|mm|kg·m|g·mm)\b", told)


def test_imperial_units(file):
    assert "oz·in" in run(file, "--units", "imperial").out


def test_uneven_speed_is_said(file):
    file.write_text(GOOD + "speed_ripple = [{ order = 2, amplitude = 0.01 }]\n")
    assert "steady mean speed" in document(file)["details"]["speed"]
    assert "steady mean speed" in run(file).out


def test_what_is_balanced_is_so_at_steady_speed(tmp_path, file):
    """Uneven speed makes order 2 of what orders 4 and 6 are."""
    six = changed(
        ("throws = [0, 180, 180, 0]", "throws = [0, 120, 240, 240, 120, 0]"),
        ("firing_order = [1, 3, 4, 2]", "strokes = 4"),
    )
    path = write(tmp_path / "six.toml", six)
    assert "Orders 1 and 2 are balanced.\n" in run(path).out
    path.write_text(six + "speed_ripple = [{ order = 4, amplitude = 0.1 }]\n")
    assert "Orders 1 and 2 are balanced at steady speed.\n" in run(path).out


def test_written_file_reads_back(file, tmp_path):
    doc = document(file, "--scheme", "auto", "--write", tmp_path / "out.toml")
    result = run_here("analyze", tmp_path / "out.toml", "--format", "json")
    again = json.loads(result.out)
    same = {o["order"]: o for o in again["orders"]}
    assert again["peak"] == doc["after"]["peak"]
    assert all(same[o["order"]] == o for o in doc["after"]["orders"] if o["order"] in same)


@pytest.mark.parametrize(
    ("scheme", "speed", "line"),
    [
        ("auto", 4500, "speed = 4500.0    # as balanced by balcli\n"),
        ("auto", 3000, "speed = 3000\n"),
        ("auto", None, "speed = 3000\n"),
    ],
)
def test_what_is_written_runs_at_the_speed_that_was_asked_for(file, tmp_path, scheme, speed, line):
    """So that it reads back to exactly `after`."""
    out = tmp_path / "out.toml"
    asked = [] if speed is None else ["--speed", speed]
    after = document(file, "--scheme", scheme, "--write", out, *asked)["after"]
    assert f"[operation]\n{line}" in out.read_text()
    assert document(out, "--scheme", "factor", "--factor", "0")["before"]["peak"] == after["peak"]


def test_standard_input_can_be_written(tmp_path):
    document("-", "--write", tmp_path / "out.toml", text=GOOD)
    assert (tmp_path / "out.toml").read_text().startswith(GOOD)


@cases("results/balance", "refusals")
def test_refusals(file, options, told):
    assert told in refusal("balance", file, *options)


def test_a_rotary_engine_has_no_factor(tmp_path):
    file = write(
        tmp_path / "rotary.toml",
        GOOD.replace("throws = [0, 180, 180, 0]\n", "").replace(
            "firing_order = [1, 3, 4, 2]", "radial = 5\nrotary = true"
        ),
    )
    assert "the cylinders turn and the crank pins stand still" in refusal("balance", file, "--scheme", "factor")


def test_weights_of_a_rotary_engine_stand_on_its_cylinders(tmp_path, file):
    path = write(
        tmp_path / "rotary.toml",
        SINGLE.replace("strokes = 4", "radial = 5\nrotary = true") + "[cylinder.2]\npiston_mass = 0.6\n",
    )
    told = "Counterweights stand on the cylinders, which turn, at angles from cylinder 1's axis"
    assert told in run(path).out
    assert "Counterweights stand" not in run(file).out


def test_the_engine_file_itself_is_never_written(file):
    assert "choose another name" in refusal("balance", file, "--write", file)
    assert file.read_text() == GOOD


def test_a_folder_that_is_not_there(file, tmp_path):
    assert "not_there" in refusal("balance", file, "--write", tmp_path / "not_there" / "x.toml")


# ------------------------------------------------------------------ the workshop
def engine():
    return build_text(SINGLE)


def test_practical_figures_follow_from_their_definitions():
    result = balance(engine(), "single-shaft", SchemeOptions(), tools=Tools(radius=0.06, disc=0.05))
    weight, shaft = result.practical
    omega = engine().omega
    assert weight.mass == pytest.approx(weight.unbalance / 0.06)
    assert shaft.force == pytest.approx(shaft.unbalance * omega**2)
    assert (weight.force, weight.speed_rpm) == (pytest.approx(weight.unbalance * omega**2), engine().speed_rpm)
    assert shaft.speed_rpm == engine().speed_rpm
    # half disc: mass pi R^2/2 t density, centroid at 4R/(3 pi)
    assert STEEL * math.pi * 0.05**2 / 2 * weight.disc_thickness * 4 * 0.05 / (3 * math.pi) == pytest.approx(
        weight.unbalance
    )


def test_shafts_turn_at_their_ratio():
    found = balance(engine(), "four-shaft").practical
    assert sorted(p.speed_rpm for p in found) == [3000, 3000, 6000, 6000]


def test_a_slow_engine_has_the_speeds_of_its_shafts_with_their_fractions():
    out = run("-", "--scheme", "four-shaft", "--speed", "61.25", text=SINGLE).out
    assert re.findall(r"^\d shaft +(\S+)", out, re.M) == ["61.25", "61.25", "122.5", "122.5"]


def test_given_thickness_sets_the_radius():
    remedy = balance(engine()).remedy
    for p in find_practical(engine(), remedy, Tools(thickness=0.03)):
        assert p.disc_thickness == 0.03
        assert STEEL * 0.03 * 2 / 3 * p.disc_radius**3 == pytest.approx(p.unbalance)
    assert find_practical(engine(), Remedy("auto"), Tools()) == ()


def test_drill_depth_removes_the_unbalance():
    """Radial hole from the rim: the integral of density times area times radius over its depth."""
    depth = find_drill_depth(1e-3, 0.08, 0.012)
    area = math.pi / 4 * 0.012**2
    assert STEEL * area * (0.08**2 - (0.08 - depth) ** 2) / 2 == pytest.approx(1e-3, rel=1e-13)
    assert math.isnan(find_drill_depth(1.0, 0.08, 0.012))
    assert find_drill_depth(0.0, 0.08, 0.012) == 0


def test_a_first_guess_of_a_device_in_steel():
    """A half disc 20 mm thick (if nothing else is said) of 50 mm radius, 7850 kg/m3: its unbalance
    `t 2/3 R^3` times that.
    """
    weight = Remedy(
        "", counterweights=(Counterweight(unbalance=7850 * 0.02 * 2 / 3 * 0.05**3 * 1e6, angle=0, position=0),)
    )
    (figures,) = find_practical(engine(), weight, Tools())
    assert (figures.disc_radius, figures.disc_thickness) == pytest.approx((0.05, 0.02), rel=1e-14)
    assert (figures.radius, figures.mass) == (0.045, pytest.approx(figures.unbalance / 0.045))
    assert figures.holes is None


@pytest.mark.parametrize("name", ["radius", "thickness", "disc", "drill"])
@pytest.mark.parametrize("length", [0.0, -1e-3, math.inf, math.nan])
def test_lengths_of_tools_are_positive(name, length):
    with pytest.raises(BalcliError, match=rf"^--{name}: .* mm; give figures above 0$"):
        find_practical(engine(), Remedy(""), Tools(**{name: length}))


@pytest.mark.parametrize(
    ("tools", "told"),
    [
        # the crank radius of 45 mm; mm where m are wanted
        (Tools(drill=0.0901), "--drill: a hole of 90.1 mm is wider than its rim of radius 45 mm"),
        (Tools(drill=12, radius=0.08), "--drill: a hole of 12000 mm is wider than its rim of "),
    ],
)
def test_a_hole_is_narrower_than_its_rim(tools, told):
    with pytest.raises(BalcliError, match=f"^{re.escape(told)}"):
        find_practical(engine(), Remedy(""), tools)


def test_a_hole_ends_at_the_axis():
    """Drilled from the rim to the axis, `rim^2/2` times area and density is removed: that much, and
    no more.
    """
    most = STEEL * math.pi / 4 * 0.01**2 * 0.05**2 / 2
    assert find_drill_depth(most * (1 - 1e-14), 0.05, 0.01) == pytest.approx(0.05, rel=1e-6)
    assert math.isnan(find_drill_depth(most * (1 + 1e-14), 0.05, 0.01))


def test_a_slider_is_no_disc(file):
    told = run(file, "--scheme", "slider", "--order", "2").out
    (row,) = [line.split() for line in told.splitlines() if line.startswith("1 slider")]
    assert row[-2:] == ["–", "–"]
    assert "mass at an amplitude of 45 mm." in told
    assert "centrifugal" not in told
    assert "Of sliders: the phase at crank angle 0, along a path that counts from x." in told
    assert "Of sliders" not in run(file).out


def test_sliders_move_at_their_order():
    """n times the crank's speed, n^2 times the force."""
    remedy = Remedy("", sliders=(Slider(order=3, unbalance=1e6, direction=0, angle=0),))
    (figures,) = find_practical(engine(), remedy, Tools(radius=0.5, drill=1.0))
    assert (figures.mass, figures.speed_rpm) == (2, 9000)
    assert figures.force == pytest.approx((9000 * math.pi / 30) ** 2, rel=1e-14)
    assert figures.holes is None  # it does not turn: no side of it is heavy


# ------------------------------------------------------------------ holes
def plan_holes(grams_mm: float, **tools: float) -> Holes:
    weight = Remedy("", counterweights=(Counterweight(unbalance=grams_mm, angle=150, position=0),))
    (figures,) = find_practical(engine(), weight, Tools(radius=0.08, **tools))
    assert figures.holes is not None
    return figures.holes


def removed(holes: Holes, drill: float, density: float) -> float:
    """g mm of all holes, each in thin slices, summed from the rim inwards."""
    slices = 20_000
    step = holes.depth / slices
    radii = [0.08 - (k + 0.5) * step for k in range(slices)]
    return holes.number * density * math.pi / 4 * drill**2 * step * sum(radii) * 1e6


def test_a_hole_stands_opposite_to_the_weight_and_removes_it():
    holes = plan_holes(6000, drill=0.02)
    assert (holes.number, holes.angle_deg, holes.reason) == (1, -30, "")
    assert removed(holes, 0.02, STEEL) == pytest.approx(6000, rel=1e-9)


def test_as_many_holes_as_the_depth_asks_for():
    holes = plan_holes(20_000, drill=0.02, max_depth=0.05)
    assert (holes.number, holes.reason) == (3, "one hole would be deeper than --max-depth")
    assert removed(holes, 0.02, STEEL) == pytest.approx(20_000, rel=1e-9)
    assert holes.depth <= 0.05
    assert removed(holes._replace(number=2, depth=0.05), 0.02, STEEL) < 20_000


@pytest.mark.parametrize("count", [1, 2, 3, 50])
def test_holes_to_the_last_digit_of_their_depth(count):
    """So much as these holes remove at full depth asks for no further one."""
    most = STEEL * math.pi / 4 * 0.02**2 * (0.08**2 - 0.05**2) / 2 * 1e6
    for slip in (-1e-14, 0, 1e-14):
        holes = plan_holes(count * most * (1 + slip), drill=0.02, max_depth=0.03)
        assert holes.number == count
        assert holes.depth == pytest.approx(0.03, rel=1e-9)


def test_one_hole_deeper_than_the_radius_becomes_several():
    """To the axis a hole removes rim^2/2; a tenth more needs two."""
    holes = plan_holes(STEEL * math.pi / 4 * 0.02**2 * 0.08**2 / 2 * 1.1 * 1e6, drill=0.02)
    assert (holes.number, holes.reason) == (2, "one hole would be deeper than the radius")


def test_a_slug_adds_what_it_is_heavier_than_steel_on_its_own_side():
    holes = plan_holes(20_000, drill=0.02, slug=17_000.0)
    assert holes.angle_deg == 150
    assert removed(holes, 0.02, 17_000 - STEEL) == pytest.approx(20_000, rel=1e-9)


def test_more_holes_than_any_counterweight_has_room_for():
    for drill in (1e-4, 1e-170):
        holes = plan_holes(20_000, drill=drill)
        assert holes.number > 50
        assert math.isnan(holes.depth)
    out = run("-", "--drill", "0.1", text=SINGLE).out
    assert "more than 50" in out
    assert "One hole would be deeper than the radius." in out


@cases("results/balance", "what_holes_cannot_be")
def test_what_holes_cannot_be(file, options, told):
    assert refusal("balance", file, *options) == told


def test_holes_as_the_shop_reads_them(file):
    options = ("--drill", "1 in", "--radius", "60 mm", "--scheme", "counterweights")
    told = run("-", *options, text=SINGLE).out.partition("Holes to drill, 25.4 mm")[2]
    weight = document("-", *options, text=SINGLE)
    entry = weight["practical"][0]
    assert entry["hole_angle_deg"] == 0 == weight["counterweights"][0]["angle_deg"] - 180
    assert told.splitlines()[3].split() == [
        "1",
        "counterweight",
        "0.0",
        str(entry["holes"]),
        f"{entry['drill_depth_mm']:.2f}",
    ]
    assert "opposite to the weight to add; radial, from a rim at 60 mm (--radius) inwards" in told
    slugs = run("-", *options, "--slug", "tungsten", text=SINGLE).out
    assert "Holes for slugs of 17 g/cm³, 25.4 mm" in slugs
    assert "1 counterweight           180.0" in slugs


def list_orders(*options: object) -> list[str]:
    """The table of orders, without its heads: rows, and a note if there is one."""
    out = run_here("balance", ENGINES / "i3.toml", "--scheme", "counterweights", *options).out
    table = out.partition("Largest value by order, before and after\n")[2].partition("\n\n")[0]
    return table.splitlines()[2:]


def test_orders_that_are_negligible_before_and_after_are_told_in_one_line() -> None:
    """A thousandth of one cylinder's, whose torque at the crank radius is the smallest of these;
    orders that are asked for have a row.
    """
    *rows, note = list_orders()
    assert [row.split()[0] for row in rows] == ["1", "2", "3", "4", "6"]
    found = balance(load(ENGINES / "i3.toml"), "counterweights", orders=[8, 9, 12])
    roll, moment = (
        max(float(one.spectra[kind].major.max()) for one in (found.before, found.after)) for kind in ("roll", "moment")
    )
    assert max(roll, moment) < 1e-3 * found.before.of_one_cylinder["roll"]
    assert note.startswith("Negligible: orders 8, 9, 12 (at most force ")
    assert note.endswith(f", moment {moment:.4g} N·m, roll {roll:.4g} N·m).")
    asked = list_orders("--orders", "1,8,9")
    assert [row.split()[0] for row in asked] == ["1", "8", "9"]


NEGLIGIBLE_ORDER = "Order {} is negligible beside one cylinder, hardly worth a device."


def test_a_scheme_for_a_negligible_order_says_so():
    """The only force of a three is that of order 6, a ten thousandth of one cylinder's; the only
    one of a nine-cylinder star that turns against the crank that of order 8.
    """
    assert NEGLIGIBLE_ORDER.format(6) in run(ENGINES / "i3.toml", "--scheme", "single-shaft").out
    assert NEGLIGIBLE_ORDER.format(8) in run(ENGINES / "radial9.toml", "--scheme", "single-shaft").out
    for order in (2, 4, 6):
        out = run(ENGINES / "i4.toml", "--scheme", "two-shaft", f"--order={order}").out
        assert (NEGLIGIBLE_ORDER.format(order) in out) == (order == 6)
    out = run(ENGINES / "i4.toml", "--scheme", "two-shaft", "--order=2", "--orders=1").out
    assert "hardly worth" not in out
    # Weights opposite the pins are for what each pin carries: the free force is none before.
    assert "hardly worth" not in run(ENGINES / "i4.toml", "--scheme", "factor").out


def test_notes_are_sentences():
    note = "There is no free force of orders 1 and 2: nothing to balance; couple-shaft takes moments."
    assert note in run(ENGINES / "i3.toml", "--scheme", "four-shaft").out.splitlines()
