"""Guide-force moments as quantities: what the analysis says of each variant."""

import json

import pytest
from support.cases import cases
from support.commands import ask_csv, refusal, run_here
from support.paths import ENGINES

MARINE = ENGINES / "marine/marine6.toml"
FOUR = ENGINES / "i4.toml"


@pytest.mark.parametrize(
    ("path", "vary", "line"),
    [
        (MARINE, "gas.crankcase", "crankcase         = 3.5"),
        (MARINE, "rod.mass", "mass   = 2600"),
        (FOUR, "piston.mass", "mass = 0.51"),
    ],
)
def test_each_variant_is_what_the_analysis_says(path, vary, line):
    text = path.read_text(encoding="utf-8")
    key = line.split()[0]
    assert text.count(line) == 1
    quantities = ("-q", "guide.4.H,guide.6.X,guide.6.H")
    for row in ask_csv("sweep", path, "--vary", f"{vary}=0.4,1.4", *quantities):
        own = text.replace(line, f"{key} = {row[vary]}")
        asked = ("--only", "guide", "--orders", "4,6", "-f", "json")
        said = json.loads(run_here("analyze", "-", *asked, stdin=own).out)
        four, six = said["guide"]["orders"]
        assert float(row["guide.4.H"]) == pytest.approx(four["h_Nm"]["amplitude"], rel=1e-12)
        assert float(row["guide.6.H"]) == pytest.approx(six["h_Nm"]["amplitude"], rel=1e-12)
        assert float(row["guide.6.X"]) == pytest.approx(six["x_Nm"]["amplitude"], rel=1e-12)


@cases("forces/guide_quantity", "what_is_no_quantity", ENGINES=ENGINES, FOUR=FOUR)
def test_what_is_no_quantity(path, quantity, message):
    assert refusal("sweep", path, "--vary", "rod.length=150", "-q", quantity) == message
