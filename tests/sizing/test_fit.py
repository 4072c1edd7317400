"""Devices whose unbalance is "fit": least squares of what is left, in given places."""

import cmath
import json
import math

import numpy as np
import pytest
from support.commands import ask, ask_json, refusal, run_here
from support.engines import engine_text

from balcli.analysis.answer import analyze
from balcli.balancing.answer import insert_remedy
from balcli.engine.build import build
from balcli.engine.parse import parse
from balcli.errors import BalcliError
from balcli.sizing.fit import find_scales, remove_to_fit, size_fit

THREE = engine_text(
    crank="stroke = 77.4\nthrows = [0, 240, 120]\nspacing = 82\nthrow_mass = 0.55",
    rod="length = 130\nmass = 0.39\ncg = 36\ninertia = 1200",
    piston="bore = 74\nmass = 0.32",
    operation="speed = 6000",
)
GAS = '[gas]\ncycle = "otto"\ncompression_ratio = 9\nimep = 8\n'
SINGLE = THREE.replace("[0, 240, 120]", "[0]")


def device(kind: str, **keys: object) -> str:
    lines = [f"{key} = {value}" for key, value in {"unbalance": '"fit"', **keys}.items()]
    return "\n".join([f"[[{kind}]]", *lines, ""])


def fit(text: str, *targets: str):
    """The remedy, and the engine of the file that is written."""
    model = parse(text)
    remedy = size_fit(build(remove_to_fit(model)), model, targets or None)
    return remedy, build(parse(insert_remedy(text.encode(), remedy)))


def vectors(devices) -> list[complex]:
    return [d.unbalance / 1e6 * np.exp(1j * math.radians(d.angle)) for d in devices]


def test_nothing_is_left_where_the_devices_can_take_all():
    """Two planes of each sense and order, wherever: weights of the ends, and two shafts."""
    places = [{"ratio": ratio, "at": [30, -40], "position": z} for ratio in (-1, 2, -2) for z in (-70, 110)]
    text = THREE + "".join(device("counterweight", position=z) for z in (-82, 82))
    remedy, written = fit(text + "".join(device("shaft", **place) for place in places))
    assert (remedy.details["unknowns"], remedy.details["undetermined"]) == (16, 0)
    found = analyze(written, [1, 2], ["force", "moment"]).spectra
    scales = find_scales(written)
    assert found.force.major == pytest.approx([0, 0], abs=1e-12 * scales.force)
    assert found.moment.major == pytest.approx([0, 0], abs=1e-12 * scales.moment)


def test_what_is_left_is_orthogonal_to_every_device():
    """One shaft against the crank for force, moment and roll of a single: a compromise."""
    text = SINGLE + device("shaft", ratio=-1, at=[60, 70], position=30)
    targets = ("force", "moment", "roll")
    remedy, written = fit(text, *targets)
    scales = find_scales(written)

    def left(engine):
        found = analyze(engine, [1], targets).spectra
        parts = [
            *(found.force.forward / scales.force, found.force.backward / scales.force),
            *(found.moment.forward / scales.moment, found.moment.backward / scales.moment),
            2 * found.roll.forward / scales.roll,
        ]
        return np.ravel(np.array(parts)).view(float)

    shaft = remedy.shafts[0]
    for turn in (1e-2, 1e-2j):
        u = complex(vectors([shaft])[0] * (1 + turn))
        changed = f"unbalance = {abs(u) * 1e6!r}\nangle = {math.degrees(cmath.phase(u))!r}"
        moved = left(build(parse(text.replace('unbalance = "fit"', changed))))
        assert left(written) @ (moved - left(written)) == pytest.approx(0, abs=1e-14)
        assert moved @ moved > left(written) @ left(written)


def test_a_given_angle_is_held_and_a_negative_result_turned():
    """The half of a single's reciprocating mass stands at 180 degrees: 30 off, its cosine is taken."""
    free = fit(SINGLE + device("shaft", ratio=-1))[0].shafts[0]
    assert free.angle == pytest.approx(180)
    for angle, turned in ((150, 150), (-30, 150)):
        remedy, written = fit(SINGLE + device("shaft", ratio=-1, angle=angle))
        shaft = remedy.shafts[0]
        assert (shaft.angle, shaft.unbalance) == pytest.approx((turned, free.unbalance * math.cos(math.pi / 6)))
        assert ("turned by 180" in remedy.note) == (angle != turned)
        assert remedy.details["unknowns"] == 1
        assert written.devices[0].backward == pytest.approx(vectors([shaft])[0])


def test_two_sliders_take_a_force_of_order_2():
    text = SINGLE + "".join(device("slider", order=2, direction=way) for way in (0, 90))
    remedy, written = fit(text, "force")
    assert analyze(written, [2], ["force"]).spectra.force.major == pytest.approx([0], abs=1e-9)
    assert remedy.sliders[1].unbalance == pytest.approx(0, abs=1e-9 * remedy.sliders[0].unbalance)


def test_the_smallest_weights_where_nothing_says_more():
    """Two equal places share alike; a shaft at the point of reference has no moment."""
    remedy, _ = fit(SINGLE + 2 * device("shaft", ratio=-1))
    assert remedy.details["undetermined"] == 2
    assert remedy.note.startswith("2 unknowns are not determined by these targets; the smallest unbalances")
    one, other = vectors(remedy.shafts)
    assert one == pytest.approx(other)
    remedy, _ = fit(THREE + device("shaft", ratio=-1) + device("shaft", ratio=-1, position=50), "moment")
    assert remedy.shafts[0].unbalance == 0
    assert "shaft.1 has no effect on these targets" in remedy.note


def test_the_roll_with_gas_is_another_target():
    shafts = device("shaft", ratio=2, at=[0, 80]) + device("shaft", ratio=-2, at=[30, 60])
    _, written = fit(SINGLE + GAS + shafts, "roll_total")
    assert analyze(written, [2], ["roll_total"]).spectra.roll_total.major == pytest.approx([0], abs=1e-9)


def test_written_figures_stand_where_the_word_stood(tmp_path):
    text = THREE + device("counterweight", position="-82   # front") + device("counterweight", position=82, angle=-30)
    (tmp_path / "e.toml").write_text(text)
    out = tmp_path / "out.toml"
    found = ask_json("balance", tmp_path / "e.toml", "--write", out)
    assert (found["scheme"], found["details"]["target"]) == ("fit", ["force", "moment"])
    lines = out.read_text().splitlines()
    assert "position = -82   # front" in lines
    assert not any('"fit"' in line for line in lines)
    assert [line for line in lines if not line.startswith(("unbalance", "angle"))] == [
        line for line in text.splitlines() if not line.startswith(("unbalance", "angle"))
    ]
    after = ask_json("analyze", out, "--orders", "1")["orders"][0]
    assert after["moment_Nm"]["forward"] == pytest.approx(found["after"]["orders"][0]["moment_Nm"]["forward"])
    assert "not determined" not in ask("balance", tmp_path / "e.toml")


@pytest.mark.parametrize("command", ["analyze", "curves", "check"])
def test_other_commands_name_the_device(tmp_path, command):
    (tmp_path / "e.toml").write_text(THREE + device("shaft", ratio=-1))
    status, _, err = run_here(command, tmp_path / "e.toml")
    assert (
        status,
        'shaft.1.unbalance is "fit": run balcli balance, which puts a figure in its place (--write names the new file)'
        in err,
    ) == (2, True)


def test_what_does_not_go_together(tmp_path):
    (tmp_path / "e.toml").write_text(THREE + device("shaft", ratio=-1))
    (tmp_path / "plain.toml").write_text(THREE)
    assert "leave out scheme auto and its options" in refusal("balance", tmp_path / "e.toml", "--scheme", "auto")
    for options in (("--scheme", "fit"), ("--target", "force")):
        assert 'no device has unbalance = "fit"' in refusal("balance", tmp_path / "plain.toml", *options)
    told = refusal("balance", tmp_path / "e.toml", "--target", "forces")
    assert told == '--target "forces": choose from force, moment, roll, roll_total'
    assert "[gas]" in refusal("balance", tmp_path / "e.toml", "--target", "roll_total")
    with pytest.raises(BalcliError, match="moment"):
        fit(THREE.replace("spacing = 82", "") + device("shaft", ratio=-1), "moment")
    remedy, _ = fit(THREE.replace("spacing = 82", "") + device("shaft", ratio=-1))
    assert remedy.details["target"] == ["force"]


def test_an_engine_in_which_nothing_reciprocates(tmp_path):
    """There is no cylinder to compare with, and a pair of shafts has nothing left to take."""
    still = THREE.replace("mass = 0.32", "mass = 0").replace("cg = 36\ninertia = 1200", "cg = 0")
    (file := tmp_path / "still.toml").write_text(still + device("counterweight", position=0))
    status, _, err = run_here("balance", file)
    assert (status, "needs reciprocating masses" in err) == (2, True)
    file.write_text(still.replace("[0, 240, 120]", "[0]").replace("spacing = 82", ""))
    status, out, _ = run_here("balance", file, "--scheme", "two-shaft", "--order", "1", "-f", "json")
    fitted = json.loads(out)
    assert (status, len(fitted["counterweights"]), fitted["shafts"]) == (0, 1, [])
