"""What a command refuses, and the whole text with which it does."""

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


@cases("shell/refusals", "what_is_refused", ENGINES=ENGINES)
def test_what_is_refused(command, message):
    assert refusal(*command.split()) == message


def test_bearings_without_places():
    """Beside a warning that moments are not known."""
    status, out, err = run_here("torque", "nowhere.toml", "--loads", "main")
    assert (status, out) == (2, "")
    wanted = "balcli: main bearings: crank.spacing is missing, so their positions are not known\n"
    assert err.endswith(wanted)
