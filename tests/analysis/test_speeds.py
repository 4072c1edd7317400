"""`analyze --speed` with several speeds."""

import json

import pytest
from support.cases import cases
from support.commands import ask, ask_csv, ask_json, refusal
from support.paths import ENGINES

from balcli import analyze, load
from balcli.limits import MOST_ANALYSED_SPEEDS

FIVE = ENGINES / "i5.toml"
DIESEL = ENGINES / "i6_diesel.toml"


def test_a_range_has_its_ends_and_every_analysis_is_that_of_its_speed(balcli):
    found = ask_json("analyze", FIVE, "--speed", "60:124:8", "--only", "moment")
    assert found["format"] == "balcli.speeds/1"
    assert [one["speed_rpm"] for one in found["analyses"]] == list(range(60, 125, 8))
    own = balcli("analyze", FIVE, "--speed", "84", "-f", "json", "--only", "moment")[1]
    orders = {entry["order"]: entry for entry in json.loads(own)["orders"]}
    for entry in found["analyses"][3]["orders"]:
        assert entry["moment_Nm"]["major"] == pytest.approx(
            orders[entry["order"]]["moment_Nm"]["major"], rel=1e-12, abs=1e-12
        )


def test_gas_stays_and_inertia_grows_with_the_square():
    asked = ("--speed", "1000,2000", "--only", "gas,torque", "--orders", "3")
    lines = ask_csv("analyze", DIESEL, *asked)
    sizes = {
        (line["speed_rpm"], line["quantity"]): float(line["value"]) for line in lines if line["figure"] == "amplitude"
    }
    assert sizes["2000.0", "gas"] == pytest.approx(sizes["1000.0", "gas"])
    assert sizes["2000.0", "torque"] == pytest.approx(4 * sizes["1000.0", "torque"])


def test_a_table_a_kind_a_row_a_speed():
    out = ask("analyze", FIVE, "--speed", "3000,6000")
    assert "speed      3000 to 6000 rpm, 2 speeds" in out
    moment = analyze(load(FIVE), [1, 2], ["moment"]).spectra.moment.major * (6000 / 5700) ** 2
    row = next(line for line in out.splitlines() if line.startswith("6000"))
    assert [float(cell) for cell in row.split()[1:3]] == pytest.approx(moment.tolist(), rel=5e-4)
    assert "Negligible: free force (at most 0.006 N)." in out
    assert "Sizing" not in out
    assert max(map(len, out.splitlines())) <= 80


@cases("analysis/speeds", "what_does_not_go_together_is_refused", MOST_ANALYSED_SPEEDS=MOST_ANALYSED_SPEEDS)
def test_what_does_not_go_together_is_refused(given, told):
    assert told in refusal("analyze", FIVE, *given)
