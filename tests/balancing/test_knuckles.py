"""Knuckle angles that make strokes or dead centres even."""

import numpy as np
import pytest
from support.commands import ask_json, refusal
from support.engines import RADIAL

from balcli.balancing.answer import balance_knuckles
from balcli.core.cylinders import Travel, find_travel
from balcli.engine import parse as enginefile
from balcli.sizing.remedy import Remedy


def even(text: str, goal: str = "dead-centres") -> tuple[Remedy, Travel, Travel]:
    """The remedy, and strokes and dead centres of all cylinders before and after."""
    found = balance_knuckles(enginefile.parse(text), goal)
    return found.remedy, find_travel(found.before.engine.cylinders), find_travel(found.after.engine.cylinders)


def test_dead_centres_at_even_intervals():
    """The knuckle pin goes on the cylinder's axis when the crank pin is: turned on by the master rod's lean there,
    arcsin(lambda sin Delta).
    """
    remedy, before, after = even(RADIAL)
    assert np.abs(before.top_deg).max() > 3
    assert np.abs(after.top_deg).max() < 1e-9
    assert remedy.reasons[0].endswith("top dead centres at the same angle as the master's")
    apart = 2 * np.pi * np.arange(7) / 7
    wanted = np.degrees(apart + np.arcsin(60 / 240 * np.sin(apart)))
    assert remedy.knuckle_angles_deg == pytest.approx(wanted, abs=1e-9)


def test_equal_strokes():
    remedy, before, after = even(RADIAL, "strokes")
    assert np.ptp(before.stroke) > 4e-4
    assert np.ptp(after.stroke) < 1e-12
    assert len(remedy.reasons) == 1


def test_two_rows_are_set_by_the_first():
    remedy, _, after = even(RADIAL.replace("stroke = 120", "stroke = 120\nthrows = [0, 180]\nspacing = 160"))
    assert len(remedy.knuckle_angles_deg) == 7
    assert np.abs(after.top_deg).max() < 1e-9


def test_a_bank_that_no_angle_makes_even():
    """Opposite the master, turning the knuckle pin hardly changes the stroke, and this offset has
    added too much to it.
    """
    text = RADIAL.replace("radial = 7", "banks = [0, 180]") + "[cylinder.2]\npiston_offset = 60\n"
    remedy, *_ = even(text, "strokes")
    assert remedy.reasons == ("no angle makes bank 2 even: the knuckle pin stays where it is",)
    assert remedy.knuckle_angles_deg == (0, 180)


# ------------------------------------------------------------------ the command
@pytest.mark.parametrize("older", ["", "knuckle_angles = [0, 50, 100, 150, 200, 250, 300]  # measured\n"])
def test_what_is_written_reads_back_as_it_was_analysed(tmp_path, older):
    file = tmp_path / "radial.toml"
    out = tmp_path / "even.toml"
    file.write_text("# a comment\n" + RADIAL.replace("[articulation]\n", f"[articulation] # seven\n{older}"))
    document = ask_json("balance", file, "--scheme", "knuckles", "--write", out)
    assert document["scheme"] == "knuckles"
    assert document["counterweights"] == []
    assert list(enginefile.read(out).articulation.knuckle_angles) == document["details"]["knuckle_angles_deg"]
    assert out.read_text().startswith("# a comment\n")
    assert np.abs(even(out.read_text())[1].top_deg).max() < 1e-9


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--scheme=knuckles", "--even=colours"], '--even "colours": choose from dead-centres, strokes'),
        (["--scheme=knuckles", "--order=2"], "scheme knuckles takes no option but --even"),
        (["--even=strokes"], "--even belongs to --scheme knuckles; scheme auto has no such option"),
    ],
)
def test_refusals(options, message):
    assert refusal("balance", "-", *options, stdin=RADIAL) == message


def test_an_engine_without_articulated_rods():
    text = RADIAL.partition("[articulation]")[0]
    told = "scheme knuckles needs articulated rods, and a crank that turns"
    assert refusal("balance", "-", "--scheme", "knuckles", stdin=text) == told
