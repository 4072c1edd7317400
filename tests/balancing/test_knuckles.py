"""Knuckle angles that make strokes or dead centres even."""

import json

import numpy as np
import pytest
from support.commands import ask_json, refusal, run_here
from support.engines import RADIAL
from support.paths import ENGINES

from balcli.balancing.answer import even_knuckles
from balcli.engine import parse as enginefile
from balcli.errors import BalcliError


def test_dead_centres_at_even_intervals():
    found = even_knuckles(enginefile.parse(RADIAL))
    assert np.abs(found.before.top_deg).max() > 3
    assert np.abs(found.after.top_deg).max() < 1e-9
    assert found.angles_deg[0] == 0
    assert found.reasons[0].endswith("top dead centres at the same angle as the master's")


def test_equal_strokes():
    found = even_knuckles(enginefile.parse(RADIAL), "strokes")
    assert np.ptp(found.before.stroke) > 4e-4
    assert np.ptp(found.after.stroke) < 1e-12
    assert len(found.reasons) == 1


def test_two_rows_are_set_by_the_first():
    text = RADIAL.replace("stroke = 120", "stroke = 120\nthrows = [0, 180]\nspacing = 160")
    found = even_knuckles(enginefile.parse(text))
    assert len(found.angles_deg) == 7
    assert np.abs(found.after.top_deg).max() < 1e-9


def test_where_the_knuckle_pin_goes_for_an_even_dead_centre():
    """On the cylinder's axis when the crank pin is: turned on by the master rod's lean there,
    arcsin(lambda sin Delta).
    """
    angles = even_knuckles(enginefile.parse(RADIAL)).angles_deg
    for bank in range(1, 7):
        apart = 2 * np.pi * bank / 7
        assert angles[bank] == pytest.approx(np.degrees(apart + np.arcsin(60 / 240 * np.sin(apart))), abs=1e-9)


def test_a_bank_that_no_angle_makes_even():
    """Opposite the master, turning the knuckle pin hardly changes the stroke, and this offset has
    added too much to it.
    """
    text = RADIAL.replace("radial = 7", "banks = [0, 180]") + "[cylinder.2]\npiston_offset = 60\n"
    found = even_knuckles(enginefile.parse(text), "strokes")
    assert found.reasons == ("no angle makes bank 2 even: the knuckle pin stays where it is",)
    assert found.angles_deg == (0, 180)


def test_an_engine_without_articulated_rods():
    with pytest.raises(BalcliError) as caught:
        even_knuckles(enginefile.parse(RADIAL[: RADIAL.index("[articulation]")]))
    assert str(caught.value) == "knuckles: needs articulated rods, and a crank that turns"


# ------------------------------------------------------------------ the command
def run(*arguments):
    return run_here("balance", *arguments, "--scheme", "knuckles")


@pytest.mark.parametrize("older", ["", "knuckle_angles = [0, 50, 100, 150, 200, 250, 300]  # measured\n"])
def test_what_is_written_reads_back_as_it_was_analysed(tmp_path, older):
    file, out = tmp_path / "radial.toml", tmp_path / "even.toml"
    file.write_text("# a comment\n" + RADIAL.replace("[articulation]\n", f"[articulation] # seven\n{older}"))
    document = json.loads(run(file, "--write", out, "--format", "json").out)
    assert document["scheme"] == "knuckles"
    assert document["counterweights"] == []
    read = enginefile.read(out)
    assert list(read.articulation.knuckle_angles) == document["details"]["knuckle_angles_deg"]
    assert out.read_text().startswith("# a comment\n")
    assert np.abs(even_knuckles(read).before.top_deg).max() < 1e-9


def test_with_gas_the_roll_is_that_of_both(tmp_path):
    """Knuckles move pistons, and with them what the gas does in every order."""
    file, out = tmp_path / "radial.toml", tmp_path / "even.toml"
    gas = '[gas]\ncycle = "wiebe"\ncompression_ratio = 6\nimep = 8\n'
    file.write_text((ENGINES / "radial7_articulated.toml").read_text() + gas)
    found = json.loads(run(file, "--write", out, "-f", "json").out)
    for state, path in (("before", file), ("after", out)):
        told = ask_json("analyze", path, "--orders", "1-4")
        rolls = {entry["order"]: entry["roll_total_Nm"] for entry in found[state]["orders"]}
        for entry in told["orders"]:
            assert rolls[entry["order"]] == pytest.approx(entry["roll_total_Nm"], rel=1e-12)
    table = run(file).out
    assert "with gas," in table
    assert "stays as it is" not in table


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--even", "colours"], '--even "colours": choose from dead-centres, strokes'),
        (["--order", "2"], "scheme knuckles takes no option but --even"),
    ],
)
def test_options_that_knuckles_do_not_take_are_refused(options, message):
    assert refusal("balance", "-", "--scheme", "knuckles", *options, stdin=RADIAL) == message


def test_even_without_the_scheme():
    assert refusal("balance", "-", "--even", "strokes", stdin=RADIAL) == (
        "--even belongs to --scheme knuckles; scheme auto has no such option"
    )
