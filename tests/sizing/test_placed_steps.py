"""Rows of the ladder whose devices stand in given places."""

import cmath
import math

import pytest
from support.commands import ask, run_here
from support.engines import build_text, changed
from support.paths import ENGINES, write

from balcli import SchemeOptions, balance, load_example
from balcli.errors import ArgumentError
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.ladder import find_ladder

THREE = changed(
    ("throws = [0, 180, 180, 0]", "throws = [0, 240, 120]"),
    ("firing_order = [1, 3, 4, 2]", "firing_order = [1, 3, 2]"),
)


def fit(engine, scheme="step", **options):
    return balance(engine, scheme, SchemeOptions(**options))


def list_shafts(result):
    """Ratio, place and unbalance of each eccentric."""
    return [
        (shaft.ratio, shaft.at, shaft.position, cmath.rect(shaft.unbalance, math.radians(shaft.angle)))
        for shaft in result.remedy.shafts
    ]


def test_the_row_with_a_shaft_against_the_crank_of_a_three():
    """An eccentric pair 183 mm apart takes the moment of the pair 200 mm apart that the ladder fits."""
    engine = build_text(THREE)
    usual = fit(engine, step="shaft at -1")
    placed = fit(engine, step="shaft at -1", at=(-0.062 + 0.048j,), position=(-0.095, 0.088))
    assert placed.remedy.counterweights == usual.remedy.counterweights
    (_, _, z1, u1), (_, _, z2, u2) = list_shafts(placed)
    (_, _, _, before), _ = list_shafts(usual)
    assert [shaft.at for shaft in placed.remedy.shafts] == [(-62, 48)] * 2
    assert (z1, z2) == (-95, 88)
    assert u1 == pytest.approx(before * 200 / 183)
    assert u2 == pytest.approx(-u1)
    assert compute_spectra(placed.after.engine, [1], ("moment",)).moment.major[0] < 1e-6
    assert placed.remedy.moments_left == ()


def test_places_belong_to_the_shafts_at_minus_1_minus_2_and_plus_2():
    result = fit(load_example("single"), step=3, at=(0.01, 0.02, 0.03))
    assert {shaft.ratio: shaft.at for shaft in result.remedy.shafts} == {-1: (10, 0), -2: (20, 0), 2: (30, 0)}
    complete = fit(load_example("single"), "complete", at=(0.01, 0.02, 0.03))
    assert {shaft.ratio: shaft.at for shaft in complete.remedy.shafts} == {-1: (10, 0), -2: (20, 0), 2: (30, 0)}


@pytest.mark.parametrize("scheme", ["step", "complete"])
def test_one_eccentric_cancels_the_force_and_states_the_moment_left(scheme):
    """The force of a single acts at z = 0: an eccentric at 30 mm leaves 0.03 m times the force."""
    engine = load_example("single")
    options = {"step": 2} if scheme == "step" else {}
    result = fit(engine, scheme, position=0.03, **options)
    shafts = list_shafts(result)
    assert {z for _, _, z, _ in shafts} == {30}
    left = {moment.ratio: moment.moment_Nm for moment in result.remedy.moments_left}
    assert {*left} == {ratio for ratio, *_ in shafts}
    for ratio, _, _, unbalance in shafts:
        force = abs(unbalance) / 1e6 * (ratio * engine.omega) ** 2
        assert left[ratio] == pytest.approx(0.03 * force)
    after = compute_spectra(result.after.engine, [1], ("force", "moment"))
    assert after.force.major[0] < 1e-6
    assert after.moment.major[0] == pytest.approx(left[-1])


def test_a_note_states_the_moment(tmp_path):
    ask("engines", "single", tmp_path / "single.toml")
    told = " ".join(ask("balance", tmp_path / "single.toml", "--step", "2", "--position", "30").split())
    assert "The one eccentric of the shaft at -1 leaves a moment of 172.5 N·m" in told
    told = ask("balance", tmp_path / "single.toml", "--step", "2", "--position=-30,30")
    assert "one eccentric of the shaft" not in told


def test_two_eccentrics_cancel_force_and_moment_of_every_order():
    result = fit(load_example("single"), step=3, position=(0.02, 0.05))
    left = compute_spectra(result.after.engine, [1, 2], ("force", "moment"))
    assert [shaft.position for shaft in result.remedy.shafts] == [20, 50] * 3
    assert max(*left.force.major, *left.moment.major) < 1e-6


@pytest.mark.parametrize(
    ("planes", "places"), [((-0.04, 0.06), [-40, 60]), ("throws", [-100, 0, 100]), ("ends", [-100, 100])]
)
def test_planes_are_those_of_scheme_counterweights(planes, places):
    """The counterweights of a step, and those of the scheme, are the same."""
    engine = build_text(THREE)
    weights = fit(engine, step="counterweights", planes=planes).remedy.counterweights
    assert [weight.position for weight in weights] == places
    alone = fit(engine, "counterweights", planes=planes).remedy.counterweights
    for weight, wanted in zip(weights, alone, strict=True):
        assert weight.unbalance == pytest.approx(wanted.unbalance)
        assert weight.angle == pytest.approx(wanted.angle)
    complete = fit(engine, "complete", planes=planes).remedy.counterweights
    assert [weight.position for weight in complete] == places


def test_weights_in_one_plane_say_what_they_leave():
    note = fit(build_text(THREE), step="counterweights", planes=(0.04,)).remedy.note
    assert note.startswith("one plane, or planes at the same z, cannot take a moment")


def test_default_places_change_nothing():
    """Throws are where weights at every throw stand already; steps by default take places as well."""
    engine = build_text(THREE)
    assert fit(engine, step=3, planes="throws").remedy.devices == find_ladder(engine).fit(3).devices
    auto = fit(engine, "auto", at=(0.05j,))
    assert auto.remedy.steps == find_ladder(engine).auto
    assert {shaft.at for shaft in auto.remedy.shafts} == {(0, 50)}
    assert auto.remedy.counterweights == find_ladder(engine).fit().counterweights


def test_the_written_file_has_the_forces_that_were_promised(tmp_path):
    file = write(tmp_path / "three.toml", THREE)
    out = tmp_path / "out.toml"
    args = ("--step", "3+4", "--at=-62,48", "--at=1,2", "--at=3,4", "--position=-95,88")
    promised = balance(build_text(THREE), "step", SchemeOptions(
        step="3+4", at=(-0.062 + 0.048j, 0.001 + 0.002j, 0.003 + 0.004j), position=(-0.095, 0.088)
    )).after  # fmt: skip
    ask("balance", file, *args, "--write", out)
    written = compute_spectra(build_text(out.read_text(encoding="utf-8")), [1, 2], ("roll", "moment"))
    expected = compute_spectra(promised.engine, [1, 2], ("roll", "moment"))
    assert written.roll.major == pytest.approx(expected.roll.major)
    assert written.moment.major == pytest.approx(expected.moment.major)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"step": 3, "at": (0.1, 0.2)}, r"at: 2 of 1 places; the row has a shaft at -1: give one place for each"),
        ({"step": 4, "at": (0.1,)}, r"1 of 3 places; the row has shafts at -1, -2 and \+2"),
        ({"step": 1, "at": (0.1,)}, "at: the row fits no shafts"),
        ({"step": 1, "position": 0.1}, "position: the row fits no shafts"),
        ({"step": "3", "position": (0.1, 0.2, 0.3)}, "position: 3 places along z; give one, or two"),
        ({"step": 3, "position": (0.1, 0.1)}, "position: one plane, or planes at the same z"),
        ({"step": 3, "position": 0.1}, "position: the shaft at -1 cancels a moment and no force; give two places"),
        ({"step": 3, "planes": "ends"}, "planes: the row has counterweights at every throw"),
        ({"step": "3+4", "planes": "throws"}, "planes: the row fits no counterweights"),
    ],
)
def test_places_that_a_row_does_not_have(options, message):
    with pytest.raises(ArgumentError, match=message):
        fit(build_text(THREE), **options)


def test_compensators_are_placed_by_their_scheme():
    result = run_here("balance", ENGINES / "marine" / "wartsila_6rtflex96c.toml", "--step", "1", "--at", "1,2")
    assert result.status == 2
    assert "--at: the row has compensators; --scheme compensator places them" in result.err
