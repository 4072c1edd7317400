"""What a command refuses, and the whole text with which it does."""

from __future__ import annotations

import pytest
from support.cases import cases
from support.commands import refusal, run_here
from support.gas_engines import FOUR
from support.paths import ENGINES

TWO_STROKE = FOUR.replace("0, 180, 180, 0", "0, 180").replace("1, 3, 4, 2", "1, 2")
FILES = {
    "four.toml": FOUR,
    "offset.toml": (ENGINES / "single.toml").read_text(encoding="utf-8").replace("[piston]", "[piston]\noffset = 2"),
    "own.toml": FOUR + "[cylinder.2]\nthrow = 181\n",
    "odd.toml": FOUR.replace("0, 180, 180, 0", "0, 10, 20, 30").replace("firing_order = [1, 3, 4, 2]", ""),
    "diagram.toml": FOUR + '[gas]\nindicator = "latin.csv"\n',
    "workbook.toml": FOUR + '[gas]\nindicator = "p.xlsx"\n',
    "blank.toml": FOUR + '[gas]\nindicator = "  "\n',
    "exchange.toml": TWO_STROKE.replace("[layout]", "[layout]\nstrokes = 2")
    + '[gas]\nindicator = "latin.csv"\nzero = "gas-exchange"\n',
    "harmonics.toml": FOUR + '[gas]\nharmonics = "heads.csv"\n',
    "bmep.toml": FOUR + '[gas]\ncycle = "otto"\ncompression_ratio = 9\nbmep = -3\nmechanical_efficiency = 0.8\n',
    "nowhere.toml": FOUR.replace("spacing = 100\n", "") + '[gas]\ncycle = "otto"\ncompression_ratio = 9\nimep = 8\n',
    "heads.csv": "order,cos,sin\n",
    "still.csv": "angle_deg,torque_Nm\n0,5\n0,7\n",
}


@pytest.fixture(autouse=True)
def files(tmp_path, monkeypatch):
    """All of them where the command runs."""
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    (tmp_path / "latin.csv").write_bytes(b"angle_deg,pressure_bar\n\xff\xfe")
    (tmp_path / "p.xlsx").write_bytes(b"PK\x03\x04\x14\x00\xff\xfe")
    monkeypatch.chdir(tmp_path)


@cases("commands/refusals", "files")
def test_files(command, message):
    assert refusal(*command.split()) == message


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ("four.toml --radius 0 --max-depth=-2", "--radius: 0 mm, --max-depth: -2 mm; give figures above 0"),
        (
            "four.toml --radius 50 --thickness 10 --disc 60",
            "a semicircular disc has its radius or its thickness given, not both: the other follows",
        ),
        (
            "offset.toml --scheme eccentric-slider",
            "eccentric-slider: two shafts symmetric to the cylinder axis suit a centred mechanism "
            "alone; this one has a piston offset of 2 mm",
        ),
        (
            f"{ENGINES / 'rotary9.toml'} --factor 50%",
            "scheme factor: the cylinders turn and the crank pins stand still, with all that is on "
            "them: there is no rotating mass to balance opposite a pin; counterweights or auto can "
            "balance what is left",
        ),
        (f"{ENGINES / 'i4.toml'} --scheme two-shaft --roll none", '--roll "none": only "zero" can be asked for'),
        (
            f"{ENGINES / 'i4.toml'} --scheme two-shaft --at=-60,50 --at=60,50 --roll zero",
            "--roll zero fixes the place of the second shaft; give one --at, or two without --roll",
        ),
        (
            f"{ENGINES / 'boxer6.toml'} --scheme two-shaft --order 1 --roll zero",
            "order 1 has no free force: nothing to balance; shafts without unbalance can do nothing about the roll",
        ),
    ],
)
def test_balance(options, message):
    assert refusal("balance", *options.split()) == message


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            f"{ENGINES / 'i4.toml'} --over throws --minimise peak.force",
            "a search over throws adds up orders, which peak.force does not allow; name orders, such as force.1.major",
        ),
        (
            "own.toml --over firing_order --minimise force.1.major",
            "cylinders with throws of their own leave no firing order to look for: give crank.throws and splay alone",
        ),
        (
            "own.toml --over throws --minimise force.1.major",
            "cylinders with throws of their own take no part in an arrangement of crank.throws: "
            "give crank.throws and splay alone",
        ),
        (
            "odd.toml --over firing_order --minimise force.1.major",
            "these throws allow no even firing order, and no others are looked for",
        ),
        (
            f"{ENGINES / 'v6_90_common.toml'} --over firing_order --minimise force.1.major",
            "these throws allow no even firing order, and no others are looked for; with split "
            "pins they do: crank.splay = 30",
        ),
    ],
)
def test_search(options, message):
    assert refusal("search", *options.split()) == message


def test_bearings_without_places():
    """Beside a warning that moments are not known."""
    status, out, err = run_here("torque", "nowhere.toml", "--loads", "main")
    assert (status, out) == (2, "")
    wanted = "balcli: main bearings: crank.spacing is missing, so that no bearing is known to stand\n"
    assert err.endswith(wanted)
