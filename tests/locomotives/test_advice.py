"""Verdict and ladder of a locomotive: coupling rods are no counterweights, and there is no room for shafts."""

import numpy as np
import pytest
from support.commands import ask, ask_json
from support.paths import ROOT

from balcli import BalcliError, load
from balcli.analysis.answer import analyze
from balcli.analysis.verdict import Cure
from balcli.forces.crankshaft import find_crank_loads
from balcli.forces.symmetry import explain_symmetry
from balcli.sizing.factor import size_by_factor
from balcli.sizing.ladder import SHAFT, SHAFTS, WEIGHTS, find_ladder, name_compensators
from balcli.sizing.options import SchemeOptions
from balcli.sizing.planes import find_unbalance
from balcli.sizing.remedy import remove_counterweights

DIVIDED = ROOT / "engines" / "historic" / "locomotive4.toml"
TABLES = {
    "crank": {"stroke": 600, "throws": [0, 90], "positions": [-300, 300], "throw_mass": 250},
    "rod": {"length": 1800, "small_end": 40, "big_end": 60},
    "piston": {"mass": 200},
    "operation": {"speed": 240},
}
LOCOMOTIVE = {"planes": [-750, 750], "coupling_planes": [-900, 900], "coupling_angles": [0, 90]}
RODS = {"axle": [{"name": "driving", "driving": True, "coupling_mass": 120}]}
TOO_HEAVY = {"counterweight": [{"unbalance": 9e8, "angle": 225}]}


def build(*, locomotive=True, **tables):
    given = {"locomotive": LOCOMOTIVE} if locomotive else {}
    return load({**TABLES, **given, **tables})


# ------------------------------------------------------------------ coupling rods
@pytest.mark.parametrize(("weights", "takes_back"), [({}, None), (TOO_HEAVY, True)])
def test_a_step_takes_back_counterweights_but_no_coupling_rods(weights, takes_back):
    """The rods add to what turns with the crank; weights of the file that are far too heavy are undone."""
    result = analyze(build(**RODS, **weights), only=["force", "moment", "ladder"])
    assert result.ladder.find_step(WEIGHTS).takes_back is takes_back
    assert result.ladder.auto == (() if takes_back else (WEIGHTS,))
    has_weights = bool(weights)
    assert result.verdict.matter[0].cures == (Cure(1, on_crank=True, further=has_weights, takes_back=takes_back),)


def test_no_sentence_names_counterweights_of_a_file_without_any():
    assert "of the file" not in ask("analyze", DIVIDED)


def test_without_counterweights_the_coupling_rods_remain():
    light = {"counterweight": [{"unbalance": 2e7, "angle": 180, "position": -300}]}
    bare = build(**RODS)
    assert remove_counterweights(build(**RODS, **light)).devices == bare.devices
    assert len(bare.devices) == 2
    assert find_ladder(bare).file_counterweights is None
    found = find_ladder(build(**RODS, **light)).file_counterweights
    assert found.without_N == find_crank_loads(bare).main_N


@pytest.mark.parametrize("planes", [None, (-0.5, 0.5)])
def test_weights_by_a_factor_balance_the_coupling_rods_too(planes):
    """The rods count as masses that turn: in the same planes, they need weights of the size of their own unbalance."""
    options = SchemeOptions(factor=(0.6,), planes=planes)
    rods = build(**RODS)
    with_rods = size_by_factor(rods, options)
    alone = size_by_factor(build(), options)
    assert with_rods.needs == ()
    pairs = zip(with_rods.counterweights, alone.counterweights, strict=True)
    more = sum(vector(one) - vector(other) for one, other in pairs)
    assert more == pytest.approx(-sum(device.forward for device in rods.devices))


def vector(weight):
    return find_unbalance(weight) * np.exp(1j * np.radians(weight.angle))


@pytest.mark.parametrize(
    ("axles", "weights", "told"),
    [
        (RODS, {}, "coupling rods in 2 places included"),
        (RODS, TOO_HEAVY, "1 from the file and coupling rods in 2 places included"),
        ({}, TOO_HEAVY, "1 from the file included"),
    ],
)
def test_the_head_counts_devices_and_coupling_rods(axles, weights, told):
    assert f"devices    {told}\n" in analyze(build(**axles, **weights)).text()


def test_reasons_ignore_coupling_rods_and_say_so():
    assert explain_symmetry(build(**RODS), [1]).scope.startswith("cylinders only: without coupling rods")


# ------------------------------------------------------------------ shafts
def test_shafts_are_listed_without_a_locomotive_and_left_out_with_one():
    with_shafts = find_ladder(build(locomotive=False))
    ladder = find_ladder(build())
    assert [step.step for step in with_shafts.steps[1:]] == [WEIGHTS, SHAFT, SHAFTS]
    assert [step.step for step in ladder.steps[1:]] == [WEIGHTS]
    assert ladder.steps[1].peak_force_N == with_shafts.steps[1].peak_force_N
    assert [out.step for out in ladder.left_out] == [SHAFT, SHAFTS]
    assert SHAFT in with_shafts.auto
    assert ladder.auto == (WEIGHTS,)


def test_positions_of_shafts_against_the_roll_are_not_given_for_a_locomotive():
    single = {"crank": {"stroke": 600, "throw_mass": 250}}
    assert find_ladder(build(locomotive=False, **single)).roll.shafts_at_mm is not None
    assert find_ladder(build(**single)).roll.shafts_at_mm is None


@pytest.mark.parametrize("step", [SHAFT, SHAFTS])
def test_a_step_with_shafts_names_the_command_for_locomotives(step):
    told = f'step "{step}" is left out: a locomotive has no room for shafts; `balcli locomotive` sizes the weights'
    with pytest.raises(BalcliError) as error:
        find_ladder(build()).fit(step)
    assert str(error.value).startswith(told)


def test_verdict_and_ladder_offer_a_locomotive_no_shaft():
    told = ask("analyze", DIVIDED, "--only", "verdict,ladder")
    note = "A locomotive has no room for shafts; `balcli locomotive` sizes the weights in its wheels."
    plain = " ".join(told.split())
    assert note in plain
    assert "shaft" not in plain.replace(note, "").replace("weights shafts steel", "")
    document = ask_json("analyze", DIVIDED, "--only", "verdict,ladder")
    first, second = document["verdict"]["matter"]
    assert [cure["ratio"] for cure in first["cures"]] == [1]
    assert "cures" not in second
    assert [out["step"] for out in document["ladder"]["left_out"]] == [SHAFT, SHAFTS]


@pytest.mark.parametrize(("locomotive", "compensated"), [(False, True), (True, False)])
def test_a_steam_engine_of_long_stroke_gets_no_compensators_in_a_locomotive(locomotive, compensated):
    crank = {**TABLES["crank"], "stroke": 900}
    steam = {"crank": crank, "layout": {"strokes": 2}, "piston": {"mass": 280, "bore": 500}}
    ladder = find_ladder(build(locomotive=locomotive, **steam))
    names = {step.step for step in (*ladder.steps, *ladder.left_out)}
    assert (name_compensators(1) in names) is compensated
    assert ladder.by_power is compensated
