"""The verdict on two-stroke engines with crossheads: compensators by power related unbalance, no shafts."""

import pytest
from support.commands import ask, ask_json
from support.engines import build_text
from support.paths import ROOT, write

from balcli.analysis.verdict import judge
from balcli.forces.power import find_power, name_need, needs_compensator
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.residual import find_scales

SIX = ROOT / "engines" / "marine" / "wartsila_6rtflex96c.toml"
SHIP = """\
[crank]
stroke = 2400
throws = {throws}
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
{power}
"""
FIVE = SHIP.format(throws="[0, 144, 216, 288, 72]", power="power = 11900")


def read_verdict(path) -> str:
    return " ".join(ask("-q", "analyze", path, "--only", "verdict").partition("Verdict")[2].split())


@pytest.mark.parametrize(
    ("related", "need", "is_needed"),
    [
        (0.0, "not relevant", False),
        (60.0, "not relevant", False),
        (60.1, "unlikely", False),
        (120.0, "unlikely", False),
        (120.1, "likely", True),
        (220.0, "likely", True),
        (220.1, "most likely", True),
        (float("nan"), None, False),
    ],
)
def test_needs_of_compensators_by_power_related_unbalance(related, need, is_needed):
    assert name_need(related) == need
    assert needs_compensator(related) == is_needed


def test_each_order_has_its_own_sentence(tmp_path):
    told = read_verdict(write(tmp_path / "five.toml", FIVE))
    assert (
        "First order: longitudinal moment of 744.2 kN·m about y, PRU 62.5 N·m/kW: a compensator is unlikely to be "
        "needed." in told
    )
    assert (
        "Second order: longitudinal moment of 2332 kN·m about y, PRU 196 N·m/kW: a compensator is likely needed; "
        "pairs at the engine's ends cancel it." in told
    )
    assert "shaft" not in told


def test_a_moment_is_vertical_only_if_the_file_says_which_way_is_up(tmp_path):
    standing = write(tmp_path / "standing.toml", f"{FIVE}[frame]\nup = 0\n")
    assert "Second order: vertical moment of 2332 kN·m, PRU 196" in read_verdict(standing)
    assert "vertical" not in read_verdict(write(tmp_path / "five.toml", FIVE))
    fitted = tmp_path / "fitted.toml"
    ask("balance", standing, "--write", fitted)
    assert "Second order: vertical moment balanced by the compensators" in read_verdict(fitted)


def test_json_has_the_needs(tmp_path):
    path = write(tmp_path / "five.toml", FIVE)
    document = ask_json("analyze", path)
    first, second = document["verdict"]["compensators"]
    assert (first["order"], first["class"]) == (1, "unlikely")
    assert (second["order"], second["class"]) == (2, "likely")
    moments = {entry["order"]: entry["moment_Nm"]["y"]["amplitude"] for entry in document["orders"]}
    assert second["Nm_per_kW"] == pytest.approx(moments[2] / 11900)
    assert "compensators" not in ask_json("analyze", ROOT / "engines" / "i3.toml")["verdict"]


def test_the_need_does_not_depend_on_the_speed_of_the_analysis(tmp_path):
    path = write(tmp_path / "five.toml", FIVE)
    fast, slow = (ask_json("analyze", path, "--speed", speed)["verdict"]["compensators"] for speed in (105, 60))
    assert slow[1]["Nm_per_kW"] == pytest.approx(fast[1]["Nm_per_kW"])


def test_without_a_power_the_verdict_asks_for_it(tmp_path):
    text = SHIP.format(throws="[0, 144, 216, 288, 72]", power="")
    told = read_verdict(write(tmp_path / "five.toml", text))
    assert "Second order: longitudinal moment of 2332 kN·m about y." in told
    assert told.count("Give operation.power: compensators are judged by power related unbalance.") == 1


def test_power_of_the_gas_counts_where_the_file_gives_none():
    engine = build_text((ROOT / "engines" / "marine" / "marine6.toml").read_text())
    power = find_power(engine)
    assert power.kind == "indicated"
    (need,) = judge_engine(engine).compensators
    moment = compute_spectra(engine, [2], ("moment",)).moment.y[0]
    assert need.Nm_per_kW == pytest.approx(1e3 * abs(moment) / power.watts)


def judge_engine(engine, small: float = 0.05):
    spectra = compute_spectra(engine, [1, 2, 4], ("force", "moment"))
    return judge(spectra, find_scales(engine), small=small, engine=engine)


@pytest.mark.parametrize(("small", "count"), [(0.28, 1), (0.29, 0)])
def test_a_small_vertical_moment_needs_none(small, count):
    """Order 2 of the six has 28.2 % of one cylinder's moment."""
    engine = build_text(SIX.read_text())
    assert len(judge_engine(engine, small).compensators) == count


def test_an_order_with_compensators_is_not_judged(tmp_path):
    fitted = tmp_path / "fitted.toml"
    ask("balance", SIX, "--write", fitted)
    told = read_verdict(fitted)
    assert "moment about y balanced by the compensators" in told
    assert "PRU" not in told
    assert ask_json("analyze", fitted)["verdict"]["compensators"] == []


def test_a_force_is_named_without_shafts(tmp_path):
    """Two equal throws: the forces of both orders add up; there is no moment."""
    text = SHIP.format(throws="[0, 0]", power="power = 4000")
    told = read_verdict(write(tmp_path / "two.toml", text))
    assert "Second order: force of" in told
    assert "shaft at" not in told
    assert "shafts at" not in told
