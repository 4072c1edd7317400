"""Counterweights at every throw, and the loads within the crankshaft before and after."""

import re

import numpy as np
import pytest
from support.commands import ask, ask_json
from support.engines import build_text, engine_text
from support.paths import ENGINES
from support.remedies import weigh

from balcli import load
from balcli.analysis.answer import analyze
from balcli.errors import BalcliError
from balcli.forces.crankshaft import find_crank_loads
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.options import SchemeOptions
from balcli.sizing.remedy import fit_devices
from balcli.sizing.sizing import size

AT_THROWS = SchemeOptions(planes="throws")
FOUR = engine_text(
    crank="stroke = 86\nthrows = [0, 180, 180, 0]\nspacing = 94\nthrow_mass = 0.8",
    rod="length = 139\nmass = 0.57\ncg = 39\ninertia = 2000",
    piston="bore = 86\nmass = 0.51",
    layout="firing_order = [1, 3, 4, 2]",
    operation="speed = 7000",
)


def test_weights_at_every_throw_unload_the_bearings_of_an_in_line_four():
    """48.23 to 12.53 kN, by momentum of rigid bodies on a grid; free forces stay as they are."""
    engine = build_text(FOUR)
    fitted = fit_devices(engine, size(engine, "counterweights", AT_THROWS))
    before = find_crank_loads(engine)
    after = find_crank_loads(fitted)
    assert (before.main_N, before.main_mm) == pytest.approx((48227.52541877826, 0))
    assert (before.inner_moment_Nm, abs(before.inner_mm)) == pytest.approx((5433.633892708877, 47))
    assert (after.main_N, after.main_mm) == pytest.approx((12528.170661290325, 0))
    assert after.inner_moment_Nm == pytest.approx(2840.0513186818853)
    peaks = [analyze(one, [1], ["force", "peak"]).peak.force.value for one in (engine, fitted)]
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-12)


@pytest.mark.parametrize("name", ["i4", "i5", "v8_crossplane"])
def test_they_are_those_of_half_the_reciprocating_mass(name):
    """For centered rods on common pins; of an offset they are not."""
    engine = load(ENGINES / f"{name}.toml")

    def vectors(remedy):
        return sorted(
            (one.position, one.unbalance * np.cos(np.radians(one.angle)), one.unbalance * np.sin(np.radians(one.angle)))
            for one in remedy.counterweights
        )

    half = size(engine, "factor", SchemeOptions(factor=(0.5,)))
    ours = size(engine, "counterweights", AT_THROWS)
    largest = max(one.unbalance for one in half.counterweights)
    assert np.allclose(vectors(ours), vectors(half), rtol=0, atol=1e-9 * largest)


@pytest.mark.parametrize("change", ["", weigh(20000, 30, 11)])
def test_nothing_of_order_1_is_left_whatever_the_file_has(change):
    cross = FOUR.replace("[0, 180, 180, 0]", "[0, 90, 270, 180]").replace("firing_order = [1, 3, 4, 2]", "")
    engine = build_text(cross + change)
    fitted = fit_devices(engine, size(engine, "counterweights", AT_THROWS))
    found = compute_spectra(fitted, [1], ("force", "moment"))
    assert abs(found["force"].forward[0]) < 1e-9 * engine.omega**2
    assert abs(found["moment"].forward[0]) < 1e-9 * engine.omega**2


def test_loads_before_and_after_are_printed(tmp_path):
    (tmp_path / "four.toml").write_text(FOUR)
    found = ask_json("balance", tmp_path / "four.toml", "--scheme", "counterweights", "--planes", "throws")
    assert found["before"]["bearings"]["main_N"] == pytest.approx(48227.52541877826)
    assert set(found["after"]["bearings"]) == {"main_N", "main_mm", "inner_moment_Nm", "inner_mm"}
    told = ask("balance", tmp_path / "four.toml", "--scheme", "counterweights")
    assert "Order 1 is balanced already: counterweights change no free force or moment." in told
    assert re.search(r"counterweights at every throw .* 12\.53", told)
    assert "Nothing changes by 1 % or more." in told
    weighed = ask("balance", tmp_path / "four.toml", "--scheme", "counterweights", "--planes", "throws")
    assert "largest main bearing load, kN" in weighed
    assert "largest inner moment, kN·m" in weighed
    (tmp_path / "single.toml").write_text(FOUR.replace("[0, 180, 180, 0]", "[0]").replace("[1, 3, 4, 2]", "[1]"))
    assert set(ask_json("balance", tmp_path / "single.toml")["before"]["bearings"]) == {"inner_moment_Nm", "inner_mm"}


def test_weights_at_throws_need_known_positions():
    unknown = build_text(FOUR.replace("spacing = 94\n", ""))
    with pytest.raises(BalcliError, match="planes throws: moments are not known"):
        size(unknown, "counterweights", AT_THROWS)


def test_no_weight_at_a_throw_where_none_is_needed():
    engine = build_text(FOUR)
    fitted = fit_devices(engine, size(engine, "counterweights", AT_THROWS))
    again = size(fitted, "counterweights", AT_THROWS)
    assert (again.devices, again.note) == ((), "Forces turning with the crank are balanced already")
