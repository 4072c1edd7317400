"""`balance --grade --mass`: what ISO 21940-11 permits beside each counterweight."""

import math
import tomllib

import pytest
from support.commands import ask_csv, ask_json, refusal, run_here
from support.paths import ENGINES

V8 = ENGINES / "v8_crossplane.toml"
ASKED = ("balance", V8, "--scheme", "counterweights", "--grade", 16, "--mass", 31, "--speed", 6000)
WHOLE = 31e3 * 16 / (6000 * math.pi / 30)  # g mm


def test_all_counterweights_share_what_is_permitted():
    said = ask_json(*ASKED)
    count = len(said["counterweights"])
    assert count == 2
    assert said["permitted"] == {"grade": 16, "mass_kg": 31, "each_g_mm": pytest.approx(WHOLE / count, rel=1e-12)}
    rows = ask_csv(*ASKED)
    figures = {row["figure"]: row["value"] for row in rows if row["part"] == "permitted"}
    assert float(figures["each_g_mm"]) == pytest.approx(WHOLE / count, rel=1e-12)


def test_a_grade_may_be_written_as_the_standard_writes_it():
    in_words = run_here("balance", V8, "--factor", "51%", "--grade", "G16", "--mass", "31 kg")
    assert in_words.out == run_here("balance", V8, "--factor", "51%", "--grade", 16, "--mass", 31).out
    assert refusal("balance", V8, "--grade", "good", "--mass", 3) == (
        '--grade "good": give a grade of ISO 21940-11 such as G16 or 6.3'
    )


def test_what_is_missing_is_told_in_percent_of_what_may_be(tmp_path):
    """Half as much again as the grade permits is over it; the heavier crank may lack that."""
    whole = tmp_path / "whole.toml"
    light = tmp_path / "light.toml"
    asked = ("--factor", "51%", "--planes=-200,200", "--grade", "G16")
    run_here("balance", V8, "--factor", "51%", "--planes=-200,200", "--write", whole)
    model = tomllib.loads(whole.read_text())
    unbalance = model["counterweight"][0]["unbalance"]
    lacking = 1.5 * WHOLE * 6000 / 5000 / 2
    text = whole.read_text()
    light.write_text(text.replace(f"{unbalance!r}", f"{unbalance - lacking!r}", 1))
    for mass, told in ((31, "150.0%, over"), (62, "75.0%, within")):
        table = run_here("balance", light, *asked, "--mass", mass).out
        head, _, row, *_ = table.partition("ISO 21940-11, G 16\n")[2].splitlines()
        assert head.endswith("of permitted")
        assert row.endswith(told)
        markdown = run_here("balance", light, *asked, "--mass", mass, "-f", "md").out
        assert f"{told} |" in markdown


def test_planes_that_have_their_weights_already_share_it_too(tmp_path):
    """Two planes, of which the first lacks nothing."""
    whole = tmp_path / "whole.toml"
    half = tmp_path / "half.toml"
    asked = ("--factor", "51%", "--planes=-200,200", "--grade", "G16", "--mass", 31)
    run_here("balance", V8, "--factor", "51%", "--planes=-200,200", "--write", whole)
    text = whole.read_text()
    half.write_text(text[: text.rindex("[[counterweight]]")])
    for file, complete in ((whole, [True, True]), (half, [True, False])):
        result = run_here("balance", file, *asked)
        assert result.status == 0, result.err
        table = result.out.partition("ISO 21940-11, G 16\n")[2].splitlines()
        assert [row.split()[0] for row in table[2:4]] == ["-200", "200"]
        assert [row.split()[1] == "0" for row in table[2:4]] == complete
        assert [row.endswith("0.0%, within") for row in table[2:4]] == complete
        said = ask_json("balance", file, *asked)["permitted"]
        assert said["each_g_mm"] == pytest.approx(WHOLE * 6000 / 5000 / 2, rel=1e-12)


def test_refusals():
    assert refusal("balance", V8, "--grade", 16) == (
        "--grade and --mass belong together: give the mass of the crankshaft, kg"
    )
    assert refusal("balance", V8, "--grade", 16, "--mass", -1) == (
        "--grade 16 --mass -1: both must be positive numbers"
    )


def test_a_crank_without_new_counterweights_has_two_planes():
    """Both end planes share it, or the planes that are given; the place of the plane is shown."""
    asked = ("--scheme", "complete", "--grade", 16, "--mass", 20)
    said = ask_json("balance", ENGINES / "i4.toml", *asked)["permitted"]
    assert said["each_g_mm"] == pytest.approx(20e3 * 16 / (7000 * math.pi / 30) / 2, rel=1e-12)
    table = run_here("balance", ENGINES / "i4.toml", *asked).out.partition("ISO 21940-11, G 16\n")[2].splitlines()
    assert [row.split() for row in table[2:4]] == [["-141", "218.3"], ["141", "218.3"]]
    given = ("--factor", "50%", "--planes=-120,0,120", "--grade", 16, "--mass", 20)
    webs = ask_json("balance", ENGINES / "i4_webs.toml", *given)
    assert [plane["permitted_kg_m"] for plane in webs["initial"]["planes"]] == pytest.approx(
        [20 * 16e-3 / (7000 * math.pi / 30) / 3] * 3, rel=1e-12
    )
