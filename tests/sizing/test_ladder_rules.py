"""Rules of the ladder: what is fitted by default, on both sides of every limit."""

import numpy as np
import pytest
from support.commands import ask, ask_json, run_here
from support.engines import build_text
from support.gas_engines import FOUR as FOUR_WITH_GAS, WIEBE
from support.paths import ROOT, write

from balcli import load
from balcli.analysis.answer import analyze
from balcli.analysis.ladder_show import tell_usual
from balcli.balancing.answer import balance, insert_remedy
from balcli.errors import BalcliError
from balcli.forces.crankshaft import find_crank_loads
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.fitting import Fitting
from balcli.sizing.ladder import (
    SHAFT,
    SHAFTS,
    WEIGHTS,
    WEIGHTS_AT_THROWS,
    find_ladder,
    name_compensators,
)
from balcli.sizing.options import SchemeOptions
from balcli.sizing.remedy import fit_devices, remove_counterweights
from balcli.sizing.residual import is_small
from balcli.sizing.ship_engines import is_judged_by_power, is_type_open
from balcli.sizing.steps import add_at_throws

ECOBOOST = ROOT / "engines" / "car" / "ford_ecoboost_1_0.toml"
I4 = ROOT / "engines" / "i4.toml"


def write_engine(crank: str, layout: str = "", *, lam: float = 0.3, rest: str = "") -> str:
    return (
        f"[crank]\nstroke = 80\nthrow_mass = 0.7\n{crank}\n[rod]\nratio = {lam}\nmass = 0.5\ncg = 40\n"
        f"[piston]\nbore = 80\nmass = 0.4\n[layout]\n{layout}\n[operation]\nspeed = 5000\n{rest}"
    )


# ------------------------------------------------------------------ limits of shafts
@pytest.mark.parametrize(("share", "fitted"), [(0.17, False), (0.19, True)])
def test_a_shaft_of_order_1_is_fitted_from_18_percent(share, fitted):
    """The backward force of a V-twin is one cylinder's first order times the cosine of its bank angle."""
    ladder = find_ladder(build_text(write_engine("", f"bank_angle = {np.degrees(np.arccos(share))}")))
    assert ladder.find_step(SHAFT).share == pytest.approx(share)
    assert ladder.auto == ((WEIGHTS, SHAFT) if fitted else (WEIGHTS,))


FOUR = "throws = [0, 180, 180, 0]\nspacing = 90"
TWO = "throws = [0, 0]\nspacing = 90"
SIX_IN_PHASE = "throws = [0, 0, 0, 0, 0, 0]\nspacing = 90"


@pytest.mark.parametrize(("crank", "limit"), [("", 0.36), (TWO, 0.36), (FOUR, 0.48), (SIX_IN_PHASE, 0.72)])
@pytest.mark.parametrize(("part", "fitted"), [(0.98, False), (1.02, True)])
def test_shafts_of_order_2_are_fitted_from_12_percent_of_all_cylinders(crank, limit, part, fitted):
    """At least three cylinders are counted. Each cylinder adds (1/2) (lambda + lambda^3/4 + ...) to each direction."""
    cylinders = crank.count(",") + 1
    wanted = 2 * part * limit / cylinders  # A_2 of one cylinder
    ladder = find_ladder(build_text(write_engine(crank, lam=find_lambda(wanted))))
    assert ladder.find_step(SHAFTS).share == pytest.approx(part * limit, rel=1e-3)
    assert ladder.find_step(SHAFTS).limit == pytest.approx(limit)
    assert (SHAFTS in ladder.auto) == fitted


@pytest.mark.parametrize(("part", "fitted"), [(0.98, False), (1.02, True)])
def test_a_single_shaft_of_order_2_has_the_limit_of_two(part, fitted):
    """In a radial three, nothing of order 2 turns with the crank: the larger of the two directions counts."""
    ladder = find_ladder(build_text(write_engine("", "radial = 3", lam=find_lambda(2 * part * 0.36 / 3))))
    step = ladder.find_step("shaft at -2")
    assert step.share == pytest.approx(part * 0.36, rel=1e-3)
    assert ("shaft at -2" in ladder.auto) == fitted


def find_lambda(second: float) -> float:
    """Crank radius over rod length at which a cylinder's second order has this share of the first."""
    angles = np.linspace(0, 2 * np.pi, 1024, endpoint=False)
    low = 0.0
    high = 0.99
    for _ in range(60):
        lam = (low + high) / 2
        cosine = np.sqrt(1 - (lam * np.sin(angles)) ** 2)
        acceleration = np.cos(angles) + lam * np.cos(angles) ** 2 / cosine**3 - lam * np.sin(angles) ** 2 / cosine
        is_larger = 2 * float(np.mean(acceleration * np.cos(2 * angles))) > second
        low, high = (low, lam) if is_larger else (lam, high)
    return low


def test_auto_may_skip_a_step():
    """A four with unequal pistons gets shafts of order 2, but not the small shaft of order 1."""
    text = write_engine(FOUR, rest="[cylinder.1]\npiston_mass = 0.55\n")
    ladder = find_ladder(build_text(text))
    assert [step.step for step in ladder.steps[1:]] == [WEIGHTS, WEIGHTS_AT_THROWS, SHAFT, SHAFTS]
    assert ladder.auto == (WEIGHTS_AT_THROWS, SHAFTS)
    assert {shaft.ratio for shaft in ladder.fit().shafts} == {2, -2}
    assert {shaft.ratio for shaft in ladder.fit("4").shafts} == {-1, 2, -2}


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("throws = [0, 0, 0, 0]\nspacing = 90", SHAFTS),
        ("throws = [0]", SHAFTS),
    ],
)
def test_in_line_engines_have_both_parts_of_order_2(text, name):
    assert name in [step.step for step in find_ladder(build_text(write_engine(text))).steps]


@pytest.mark.parametrize(("radial", "name"), [("radial = 3", "shaft at -2"), ("bank_angle = 60", "shaft at +2")])
def test_a_step_with_one_shaft_of_order_2_is_named_after_it(radial, name, tmp_path):
    """In a radial three, order 2 turns against the crank; in a 60 degree vee with common pins, with it."""
    path = write(tmp_path / "engine.toml", write_engine("", radial))
    ladder = ask_json("analyze", path, "--only", "ladder")["ladder"]
    assert ladder["steps"][-1]["step"] == name
    assert ask_json("balance", path, "--step", name)["step"] == name
    assert f"{len(ladder['steps']) - 1} {name}" in ask("analyze", path, "--only", "ladder")
    shafts = ask_json("balance", path, "--step", name)["shafts"]
    assert {shaft["ratio"] for shaft in shafts if abs(shaft["ratio"]) == 2} == {int(name[-2:])}


def test_masses_count_at_the_crank_radius_of_cylinder_1():
    text = "stroke = [80, 100]\nthrows = [0, 150]\nspacing = 90\n"
    engine = build_text(write_engine(text).replace("stroke = 80\n", "", 1))
    step = find_ladder(engine).steps[1]
    unbalance = sum(weight.unbalance for weight in step.remedy.counterweights)
    assert step.mass_kg == pytest.approx(unbalance / 1e6 / 0.040)


def test_cylinder_1_may_be_on_the_second_throw():
    text = write_engine("stroke = [80, 100]\nthrows = [0, 150]\nspacing = 90\n", "numbering = [[2, 1]]")
    step = find_ladder(build_text(text.replace("stroke = 80\n", "", 1))).steps[1]
    unbalance = sum(weight.unbalance for weight in step.remedy.counterweights)
    assert step.mass_kg == pytest.approx(unbalance / 1e6 / 0.050)


@pytest.mark.parametrize(("spacing", "length", "of_crank"), [(79, 0.080, True), (81, 0.081, False)])
def test_moments_are_compared_over_the_length_of_the_cylinders_or_the_stroke(spacing, length, of_crank):
    """At least the stroke, 80 mm."""
    scale = find_ladder(build_text(write_engine(f"throws = [0, 180]\nspacing = {spacing}"))).scale
    assert scale.length == (pytest.approx(length), of_crank)
    assert scale.moment_Nm == pytest.approx(scale.force_N * length)


@pytest.mark.parametrize(
    ("size", "least", "small"),
    [(0.05, 0.05, False), (0.0499, 0.05, True), (0.0501, 0.05, False), (0, 0, True), (1e-9, 0, False)],
)
def test_a_part_at_the_limit_is_not_small(size, least, small):
    assert is_small(size, least) == small


def test_a_shaft_with_two_eccentrics_is_one_shaft():
    """A three has a moment of order 1 and no force: one shaft with an eccentric at each end cancels its backward part."""
    step = find_ladder(build_text(write_engine("throws = [0, 240, 120]\nspacing = 90"))).find_step(SHAFT)
    assert len(step.own.shafts) == 2
    assert step.shafts == 1


# ------------------------------------------------------------------ weights at every throw
@pytest.mark.parametrize(("throws", "offered"), [("[0, 180]", False), ("[0, 240, 120]", True)])
def test_weights_at_every_throw_need_three_throws(throws, offered):
    ladder = find_ladder(build_text(write_engine(f"throws = {throws}\nspacing = 90")))
    names = {step.step for step in (*ladder.steps, *ladder.left_out)}
    assert (WEIGHTS_AT_THROWS in names) == offered


def test_weights_at_every_throw_take_the_place_of_small_ones_at_the_ends():
    """A four with a piston that is a little heavier: the first step is not even named, and the second has its share."""
    ladder = find_ladder(build_text(write_engine(FOUR, rest="[cylinder.1]\npiston_mass = 0.41\n")))
    names = {step.step for step in (*ladder.steps, *ladder.left_out)}
    assert WEIGHTS not in names
    assert 0 < ladder.find_step(WEIGHTS_AT_THROWS).share < 0.05


def test_weights_at_every_throw_cancel_nothing_that_those_at_the_ends_have_cancelled():
    ladder = find_ladder(build_text(write_engine("throws = [0, 240, 120]\nspacing = 90")))
    assert ladder.find_step(WEIGHTS).share > 0.05
    assert ladder.find_step(WEIGHTS_AT_THROWS).share == 0


def find_need(engine) -> float:
    """Unbalance of the counterweight that a throw needs, g mm: revolving and half the reciprocating mass."""
    c = engine.cylinders
    return 1e6 * float((c.rotating + c.reciprocating / 2)[0] * c.radius[0])


def test_a_throw_that_has_its_weight_gets_no_other():
    """Weights of the file count at the nearest throw, here a few millimetres beside it."""
    need = find_need(build_text(write_engine(FOUR)))
    given = "".join(
        WEIGHT.format(need, angle).replace("position = 0", f"position = {z}")
        for angle, z in ((180, -135), (0, -40), (0, 40))
    )
    fitting = add_at_throws(Fitting.start(build_text(write_engine(FOUR, rest=given)), ""))
    sizes = {weight.position: weight.unbalance for weight in fitting.remedy.counterweights}
    assert sizes.keys() >= {135}
    assert sizes.pop(135) == pytest.approx(need, rel=0.01)
    assert max(sizes.values(), default=0) < 0.05 * need


# ------------------------------------------------------------------ weights of the file
WEIGHT = "[[counterweight]]\nunbalance = {}\nangle = {}\nposition = 0\n"


@pytest.mark.parametrize(
    ("unbalance", "angle", "takes_back"),
    [
        (10_000, 180, False),  # opposite the pin, too light: a step adds to it
        (60_000, 180, True),  # too heavy: a step takes some of it back
        (10_000, 0, True),  # on the side of the pin: a step undoes it
        (None, None, False),
    ],
)
def test_steps_that_take_back_weights_of_the_file(unbalance, angle, takes_back):
    """A single cylinder needs about 44 000 g mm opposite its pin."""
    weight = "" if unbalance is None else WEIGHT.format(unbalance, angle)
    ladder = find_ladder(build_text(write_engine("", rest=weight)))
    step = ladder.find_step(WEIGHTS)
    assert step.takes_back == (True if takes_back else None)
    assert (WEIGHTS in ladder.auto) == (not takes_back)
    assert (SHAFT in ladder.auto) == (not takes_back)


@pytest.mark.parametrize(("share", "takes_back"), [(0.38, False), (0.42, True)])
def test_force_and_moment_of_the_weights_of_the_file_count_by_the_length_of_the_engine(share, takes_back):
    """Of two throws at 0 and 180 deg, a length L apart, only one has a weight: the share k of its need U. The step takes
    back its force k U, and adds (1 - k/2) U L to its moment k U L/2. It works against the weight if
    k^2 > (k/2) (1 - k/2), which is k > 0.4.
    """
    two = "throws = [0, 180]\nspacing = 90"
    weight = WEIGHT.format(share * find_need(build_text(write_engine(two))), 180)
    text = write_engine(two, rest=weight.replace("position = 0", "position = -45"))
    assert find_ladder(build_text(text)).find_step(WEIGHTS).takes_back == (takes_back or None)


def test_weights_that_cancel_each_other_are_not_taken_back():
    """Weights of a flat crank, one for each throw, have no sum that a step could take back."""
    heavy = "".join(
        f"[[counterweight]]\nunbalance = 90000\nangle = {angle}\nposition = {z}\n"
        for angle, z in ((180, -135), (0, -45), (0, 45), (180, 135))
    )
    ladder = find_ladder(build_text(write_engine(FOUR, rest=heavy)))
    assert not any(step.takes_back for step in ladder.steps)


def test_loads_without_and_with_the_weights_of_the_file():
    engine = load(ECOBOOST)
    found = find_ladder(engine).file_counterweights
    assert found.with_N == find_crank_loads(engine).main_N
    assert found.without_N == find_crank_loads(remove_counterweights(engine)).main_N
    assert found.with_N > found.without_N
    assert find_ladder(load(I4)).file_counterweights is None


def test_words_on_weights_of_the_file():
    told = " ".join(ask("analyze", ECOBOOST, "--only", "ladder").split())
    assert "The counterweights of the file raise the largest main bearing load from 11.59 to 15.23 kN." in told
    assert "Step 1 takes back counterweights of the file. Step 2 takes back counterweights of the file." in told
    assert "Step 1 raises the largest main bearing load from 15.23 to 16.57 kN." in told
    assert "Nothing is worth fitting by default; `--step 1` to `--step 4` fit a row." in told
    balanced = run_here("balance", ECOBOOST).out
    assert "Ford EcoBoost 1.0, in-line three: nothing (auto)" in balanced
    assert ask_json("balance", ECOBOOST)["steps"] == []


# ------------------------------------------------------------------ crossheads
SHIP = """\
[crank]
stroke = 2400
throws = [0, 120, 240, 180, 300, 60]
spacing = 1020
throw_mass = 1800
[rod]
length = 2628
mass = 4600
cg = 1000
[piston]
bore = 600
mass = 2300
[crosshead]
mass = 2500
[layout]
strokes = 2
[operation]
speed = 105
power = {power}
"""
FIVE = SHIP.replace("[0, 120, 240, 180, 300, 60]", "[0, 144, 216, 288, 72]")


def measure_vertical(engine, order: int) -> float:
    """Amplitude of the moment about y."""
    return float(abs(compute_spectra(engine, [order], ("moment",)).moment.y[0]))


@pytest.mark.parametrize(("related", "fitted"), [(119.0, False), (121.0, True)])
def test_compensators_are_fitted_above_a_power_related_unbalance_of_120(related, fitted):
    engine = build_text(SHIP.format(power=1))
    power_kW = measure_vertical(engine, 2) / related
    ladder = find_ladder(build_text(SHIP.format(power=power_kW)))
    name = name_compensators(2)
    assert ladder.find_step(name).pru_Nm_per_kW == pytest.approx(related)
    assert ladder.auto == ((name,) if fitted else ())
    assert [out.step for out in ladder.left_out] == [WEIGHTS_AT_THROWS]


def test_power_counts_at_the_speed_of_the_file():
    engine = build_text(SHIP.format(power=10_000))
    slower = engine.at_speed(70)
    name = name_compensators(2)
    full, part = (find_ladder(one).find_step(name) for one in (engine, slower))
    assert full.pru_Nm_per_kW == pytest.approx(part.pru_Nm_per_kW)
    assert full.pru_Nm_per_kW == pytest.approx(measure_vertical(engine, 2) / 10_000)


def test_each_row_of_a_ship_cancels_the_vertical_moment_that_the_rows_before_leave():
    text = FIVE.format(power=11_900)
    engine = build_text(text)
    ladder = find_ladder(engine)
    names = [step.step for step in ladder.steps]
    assert names == ["as drawn", WEIGHTS, name_compensators(1), name_compensators(2)]
    states = [fit_devices(engine, step.remedy) for step in ladder.steps]
    scale = ladder.scale.moment_Nm
    first, second = ([measure_vertical(state, order) / scale for state in states] for order in (1, 2))
    assert first[0] > first[1] > 0.05
    assert max(first[2:]) < 1e-9
    assert second[2] > 0.5
    assert second[3] < 1e-9
    assert ladder.find_step(name_compensators(1)).share == pytest.approx(first[1])
    for state in states:  # pairs at both ends make no force
        forces = compute_spectra(state, [1, 2], ("force",)).force.major
        assert max(forces) < 1e-9 * ladder.scale.force_N
    last = ladder.steps[-1]
    assert {shaft.role for shaft in last.remedy.shafts} == {"compensator"}
    written = find_ladder(build_text(insert_remedy(text.encode(), last.remedy, "ship"))).steps[0]
    assert written.peak_moment_Nm == pytest.approx(last.peak_moment_Nm)


def test_without_a_power_a_ship_gets_nothing_by_default(tmp_path):
    path = write(tmp_path / "ship.toml", FIVE.replace("power = {power}\n", ""))
    assert find_ladder(load(path)).auto == ()
    told = " ".join(ask("analyze", path, "--only", "ladder").split())
    assert "Give operation.power: compensators are judged by power related unbalance." in told
    refused = run_here("balance", path, "--step", WEIGHTS_AT_THROWS)
    assert refused.status == 2
    assert "--scheme counterweights --planes throws" in refused.err


MASSES_MOVED = {"[piston]\nbore = 600\nmass = 2300\n[crosshead]\nmass = 2500": "[piston]\nbore = 600\nmass = 4800"}
WITHOUT_POWER = {"power = 10000\n": ""}
BY_THROWS = "throws = [0, 120, 240, 180, 300, 60]\n"
LYING = {"strokes = 2": "strokes = 2\n[frame]\nup = 90"}
STANDING = {"strokes = 2": "strokes = 2\n[frame]\nup = 10"}
PUMP_GAS = {"[operation]": '[gas]\ncycle = "compressor"\nsuction = 1\ndischarge = 4\nclearance = 0.1\n[operation]'}


@pytest.mark.parametrize(
    ("changes", "is_ship"),
    [
        ({}, True),
        (MASSES_MOVED, True),
        ({"stroke = 2400": "stroke = 801", **MASSES_MOVED}, True),
        ({"stroke = 2400": "stroke = 800", **MASSES_MOVED}, False),
        ({"stroke = 2400": "stroke = 753", **MASSES_MOVED, "bore = 600": "bore = 300"}, True),
        ({"stroke = 2400": "stroke = 750", **MASSES_MOVED, "bore = 600": "bore = 300"}, False),
        ({"stroke = 2400": "stroke = 501"}, True),
        ({"stroke = 2400": "stroke = 500", "bore = 600": "bore = 100"}, False),
        ({"strokes = 2": "strokes = 4"}, False),
        (STANDING, True),
        (LYING, False),
        (PUMP_GAS, False),
    ],
)
def test_which_engines_are_judged_by_power(changes, is_ship):
    engine = build_text(replace_all(SHIP.format(power=10_000), changes))
    assert is_judged_by_power(engine) == is_ship
    assert any("compensators" in step.step for step in find_ladder(engine).steps) == is_ship


def replace_all(text: str, changes: dict[str, str]) -> str:
    """Return a text in which every old text, which it must have, is replaced by the new one."""
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    return text


@pytest.mark.parametrize(("highest_deg", "is_ship"), [(90, True), (270, False)])
def test_a_gas_that_takes_power_is_not_that_of_a_ship(tmp_path, highest_deg, is_ship):
    """An engine has the higher pressure after the outer dead center (0 deg), a pump before it."""
    lines = ["angle_deg,pressure_bar"]
    lines += [f"{angle},{30 + 20 * np.cos(np.radians(angle - highest_deg)):.3f}" for angle in range(0, 360, 10)]
    write(tmp_path / "card.csv", "\n".join([*lines, ""]))
    text = replace_all(SHIP.format(power=10_000), {"[operation]": '[gas]\nindicator = "card.csv"\n[operation]'})
    engine = load(write(tmp_path / "machine.toml", text))
    assert is_judged_by_power(engine) == is_ship


@pytest.mark.parametrize(
    ("changes", "is_open"),
    [
        (WITHOUT_POWER, True),
        ({}, False),
        ({**WITHOUT_POWER, BY_THROWS: "", "strokes = 2": "strokes = 2\nfiring_order = [1, 5, 3, 4, 2, 6]"}, False),
    ],
)
def test_what_only_the_size_tells_is_said(tmp_path, changes, is_open):
    path = write(tmp_path / "ship.toml", replace_all(SHIP.format(power=10_000), changes))
    assert is_type_open(load(path)) == is_open
    told = " ".join(ask("analyze", path, "--only", "verdict,ladder").split())
    asks = "give [gas] if it is a pump, a compressor or a steam engine."
    assert told.count(asks) == (2 if is_open else 0)


def test_bearings_are_not_said_to_be_governed_by_a_gas_that_is_not_known(tmp_path):
    told = " ".join(
        ask("analyze", write(tmp_path / "ship.toml", FIVE.format(power=11_900)), "--only", "ladder").split()
    )
    assert "left out; these bearings also carry gas forces, which the file does not give." in told
    marine = " ".join(ask("analyze", ROOT / "engines" / "marine" / "marine6.toml", "--only", "ladder").split())
    assert "left out, because gas, not inertia, governs these bearings." in marine


WITHOUT_MASS = FIVE.format(power=11_900).replace("mass = 4600", "mass = 0").replace("mass = 2300", "mass = 0")
WITHOUT_MASS = WITHOUT_MASS.replace("mass = 2500", "mass = 0")
SHAFTS_ALONE = "".join(
    f"[[shaft]]\nratio = 2\nunbalance = 10000\nangle = {angle}\nposition = {z}\n"
    for angle, z in ((0, 500), (180, -500))
)


def test_a_left_out_step_is_explained_without_a_share_of_pistons_without_mass():
    ladder = find_ladder(build_text(WITHOUT_MASS))
    assert ladder.scale.force_N == 0
    assert WEIGHTS_AT_THROWS in [out.step for out in ladder.left_out]
    with pytest.raises(BalcliError, match="the bearings of a ship's two-stroke engine also carry its gas forces"):
        ladder.fit(WEIGHTS_AT_THROWS)


def test_no_moment_is_small_beside_pistons_without_mass():
    step = find_ladder(build_text(WITHOUT_MASS + SHAFTS_ALONE)).find_step(name_compensators(2))
    assert step.share == np.inf


def test_trunk_piston_two_strokes_are_as_all_others():
    ladder = find_ladder(load(ROOT / "engines" / "marine" / "detroit_4_71.toml"))
    assert ladder.auto == (WEIGHTS_AT_THROWS, SHAFT)


# ------------------------------------------------------------------ roll
@pytest.mark.parametrize("name", ["i4.toml", "single.toml", "i4_wiebe.toml", "i6_diesel.toml", "v8_flatplane.toml"])
def test_the_largest_roll_is_that_of_the_analysis(name):
    engine = load(ROOT / "engines" / name)
    found = analyze(engine, np.arange(0, 13) if engine.gas is None else np.arange(0, 25) / 2)
    phasors = found.spectra.roll if engine.gas is None else found.spectra.roll_total
    sizes = phasors.major[1:]
    roll = find_ladder(engine).roll
    assert roll.of == ("inertia" if engine.gas is None else "total")
    assert roll.order == phasors.orders[1:][int(np.argmax(sizes))]
    assert roll.amplitude_Nm == pytest.approx(max(sizes))


def test_the_mean_torque_is_no_order_of_the_roll():
    """Of a twelve, it is three times as large as the largest order."""
    twelve = FOUR_WITH_GAS.replace("[0, 180, 180, 0]", "[0, 240, 120, 120, 240, 0]").replace(
        "firing_order = [1, 3, 4, 2]", "bank_angle = 60\nfiring_order = [1, 7, 5, 11, 3, 9, 6, 12, 2, 8, 4, 10]"
    )
    engine = build_text(twelve + WIEBE)
    roll = find_ladder(engine).roll
    mean, sixth = compute_spectra(engine, [0, 6], ("roll_total",)).roll_total.major
    assert mean > 2 * sixth
    assert (roll.of, roll.order) == ("total", 6)
    assert roll.amplitude_Nm == pytest.approx(sixth)


def test_an_engine_without_reciprocating_masses_has_no_roll():
    text = write_engine(FOUR).replace("mass = 0.5\ncg = 40", "mass = 0").replace("mass = 0.4", "mass = 0")
    assert find_ladder(build_text(text)).roll is None


@pytest.mark.parametrize("reference", ["", "[frame]\nreference = [30, -40, 10]\n"])
@pytest.mark.parametrize("name", ["i4.toml", "single.toml", "twin360.toml"])
def test_shafts_at_these_places_take_force_and_roll_of_order_2(name, reference):
    text = (ROOT / "engines" / name).read_text() + reference
    engine = build_text(text)
    at = find_ladder(engine).roll.shafts_at_mm
    places = tuple(complex(*at[ratio]) / 1e3 for ratio in ("-2", "+2"))
    fitted = balance(engine, "two-shaft", SchemeOptions(order=2, at=places)).after.engine
    left, before = (compute_spectra(one, [2], ("force", "roll")) for one in (fitted, engine))
    assert left.force.major[0] < 1e-9 * before.force.major[0]
    assert left.roll.major[0] < 1e-9 * before.roll.major[0]
    details = balance(engine, "two-shaft", SchemeOptions(order=2, roll="zero")).remedy.details
    assert details["order_2"]["distance_mm"] == pytest.approx(1e3 * abs(places[0] - places[1]))


def test_only_the_distance_along_the_force_counts():
    """Places to the sides, equally far from the crank on opposite sides, change nothing."""
    engine = load(I4)
    against, with_crank = (complex(*find_ladder(engine).roll.shafts_at_mm[key]) / 1e3 for key in ("-2", "+2"))
    sides = against + 0.05j - 0.02, with_crank - 0.05j - 0.02
    left = balance(engine, "two-shaft", SchemeOptions(order=2, at=sides)).after.engine
    assert compute_spectra(left, [2], ("roll",)).roll.major[0] < 1e-6
    told = " ".join(ask("balance", I4, "--scheme", "two-shaft", "--order", "2", "--roll", "zero").split())
    assert "138 mm apart along the force; only this distance counts" in told


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("i4_wiebe.toml", "the gas roll is not in phase with the force"),
        ("v6_60.toml", "there is no force of order 2"),
        ("vtwin45.toml", "the two directions have forces of different size"),
    ],
)
def test_no_two_places_take_the_roll(name, why):
    roll = find_ladder(load(ROOT / "engines" / name)).roll
    assert roll.shafts_at_mm is None, why


# ------------------------------------------------------------------ words
def test_negligible_bearing_loads_are_no_figures():
    """Weights in the planes of the two throws of a radial leave 2 N of 60 kN."""
    lines = ask("analyze", ROOT / "engines" / "aero" / "pratt_whitney_r1830.toml", "--only", "ladder").splitlines()
    (row,) = (line.split() for line in lines if line.startswith("1 counterweights"))
    assert row[2:] == ["balanced", "<0.1", "%", "<0.1", "%", "2", "–", "50.2"]


def test_opposed_pistons_with_crossheads_get_no_shafts_and_weights():
    ladder = find_ladder(load(ROOT / "engines" / "historic" / "doxford_1913.toml"))
    assert [step.step for step in ladder.steps] == ["as drawn"]


def test_the_last_line_says_what_one_cylinder_is():
    told = " ".join(ask("analyze", ROOT / "engines" / "i3.toml", "--only", "ladder").split())
    assert "one cylinder's first order (6.539 kN; times 164 mm of engine length: 1072 N·m)." in told
    assert "By default, `balcli balance` fits steps 2 and 3." in told
    assert "Below the limit of a shaft: each shaft of step 4 cancels up to 13.2 % (limit 36 %)." in told
    assert told.count("<0.1 %") == 5
    twin = " ".join(ask("analyze", ROOT / "engines" / "vtwin90.toml", "--only", "ladder").split())
    assert "mm, twice the crank radius: " in twin
    nowhere = run_here("analyze", "-", "--only", "ladder", stdin=write_engine("throws = [0, 180]")).out
    assert "first order (6.031 kN)." in " ".join(nowhere.split())


def test_a_step_that_is_left_out_is_named_with_its_size():
    told = " ".join(ask("analyze", ROOT / "engines" / "radial7_articulated.toml", "--only", "ladder").split())
    assert "A shaft at -1 would remove 119.4 N (2.0 % of one cylinder's first order): left out." in told
    told = " ".join(ask("analyze", ROOT / "engines" / "vr6.toml", "--only", "ladder").split())
    assert "Shafts at +2 and -2 would each remove up to 156.9 N·m (4.9 % of one" in told
    assert "Below the limit of a shaft: step 3 cancels 10.4 % (limit 18 %)." in told


# The cross-plane four has both counterweight steps and a shaft at -1; the five of a ship nothing but order 2.
@pytest.mark.parametrize(
    ("text", "fits"),
    [
        (
            FIVE.format(power=11_900),
            "the devices of step 3 without those of steps 1 and 2; `--step 3` fits all of row 3.",
        ),
        (SHIP.format(power=5_000), "step 1."),
        ((ROOT / "engines" / "i3.toml").read_text(), "steps 2 and 3."),
        ((ROOT / "engines" / "vr6.toml").read_text(), "step 2."),
    ],
)
def test_what_is_fitted_by_default_is_a_row_or_said_not_to_be_one(text, fits):
    ladder = find_ladder(build_text(text))
    assert tell_usual(ladder) == f"By default, `balcli balance` fits {fits}"
    row = ladder.find_row(ladder.auto[-1])
    assert (ladder.fit(row).devices == ladder.fit().devices) == ("without" not in fits)


def test_limits_are_named_with_what_sets_them():
    limits = "Limits from makers' practice:"
    of_order_2 = "12 % in order 2 for each cylinder, counted as at least 3."
    for name, told in (
        ("i3", f"{limits} {of_order_2}"),
        ("vr6", f"{limits} 18 % in order 1."),
        ("vtwin90", f"{limits} 18 % in order 1, {of_order_2}"),
    ):
        assert told in " ".join(ask("analyze", ROOT / "engines" / f"{name}.toml", "--only", "ladder").split())
    assert limits not in ask("analyze", ROOT / "engines" / "v8_crossplane.toml", "--only", "ladder")


@pytest.mark.parametrize(("name", "has_percentage"), [("v8_crossplane", False), ("i3", True), ("v6_60", True)])
def test_percentages_are_explained_where_there_are_some(name, has_percentage):
    told = ask("-q", "analyze", ROOT / "engines" / f"{name}.toml", "--only", "ladder")
    before, _, after = told.partition("Percentages are of one")
    assert bool(after) == has_percentage
    assert ("%" in before) == has_percentage


def test_balance_says_what_is_left():
    told = " ".join(ask("balance", ROOT / "engines" / "i3.toml").split())
    assert "Leaves order 2: moment 282.9 N·m." in told
    assert "Leaves no force or moment of orders 1 and 2." in " ".join(
        ask("balance", ROOT / "engines" / "i3.toml", "--step", "4").split()
    )


def test_steps_are_named_in_words_too():
    path = ROOT / "engines" / "i3.toml"
    by_number = ask_json("balance", path, "--step", "2+4")
    by_name = ask_json("balance", path, "--step", f"{WEIGHTS_AT_THROWS} + {SHAFTS}")
    assert by_name["steps"] == by_number["steps"] == [WEIGHTS_AT_THROWS, SHAFTS]
    assert by_name["shafts"] == by_number["shafts"]
