"""`balcli mounts`: every format says the same figures; options, files to start from."""

import json
import re

import numpy as np
import pytest
from support.cases import cases
from support.commands import ask, ask_csv, ask_json, refusal, run_here
from support.gas_engines import WIEBE
from support.mounts import ENGINE, block
from support.paths import write

from balcli.file.examples import template

DAMPED = ENGINE + block("loss = 0.1") + '[[point]]\nname = "lever"\nat = [100, 0, 300]\n'


@pytest.fixture
def four(tmp_path):
    return write(tmp_path / "four.toml", DAMPED)


def test_json_and_csv_are_what_they_promise(four):
    said = ask_json("mounts", four, "--speeds", "600:3000:100")
    assert said["format"] == "balcli.mounts/1"
    assert [len(mode["shape"]) for mode in said["modes"]] == [6] * 6
    assert list(said["modes"][0]["energy_percent"]) == ["x", "y", "z", "rx", "ry", "rz"]
    assert said["roll_axis"] == pytest.approx([0, 0, 1])
    assert [mount["name"] for mount in said["static"]["mounts"]] == ["1", "2", "3", "4"]
    assert sum(mount["force_N"][2] for mount in said["static"]["mounts"]) == pytest.approx(-200 * 9.80665)
    response = said["response"]
    assert response["speeds_rpm"] == list(range(600, 3001, 100))
    mount = response["mounts"][0]
    point = response["points"][0]
    assert (mount["name"], point["name"]) == ("1", "lever")
    assert [order["order"] for order in mount["orders"]][:2] == [1, 2]
    assert len(mount["orders"][0]["force_N"]) == len(mount["peak_N"]) == 25
    assert len(point["orders"][0]["motion_mm"]) == len(point["peak_mm"]) == 25
    lines = ask_csv("mounts", four, "--speeds", "600:3000:100")
    keys = ("part", "name", "order", "speed_rpm", "figure")
    found = {tuple(row[key] for key in keys): (row["value"], row["unit"]) for row in lines}
    mount = response["mounts"][2]
    assert found["mount", "3", "2", "900.0", "force"] == (str(mount["orders"][1]["force_N"][3]), "N")
    assert found["mount", "3", "", "3000.0", "peak force"][0] == str(mount["peak_N"][-1])
    assert found["mode", "mode 6", "", "", "frequency"] == (str(said["modes"][5]["frequency_Hz"]), "Hz")
    imperial = run_here("mounts", four, "--units", "imperial").out
    assert "lbf" in imperial
    assert "Largest motion of each point, in" in imperial
    said = ask_json("mounts", four, "--speeds", "700:702:0.1")  # as they were asked for
    assert said["response"]["speeds_rpm"] == [k / 10 for k in range(7000, 7021)]


def test_why_a_force_is_the_largest(tmp_path):
    """A resonance is that of the mode that moves: the nearest one, lengthways, is driven by nothing."""
    places = [(y, z) for y in (300, -300) for z in (300, -300)]
    mounts = "".join(
        f'[[mount]]\nname = "{k}"\nat = [0, {y}, {z}]\nstiffness = [300, 300, 900]\nloss = 0.1\n'
        for k, (y, z) in enumerate(places, 1)
    )
    body = "[body]\nmass = 185\ncg = [0, 0, 0]\ninertia = [17.8e6, 19.1e6, 6.4e6, 0, 0, 0]\n"
    equal = ENGINE.replace("[cylinder.2]\npiston_mass = 0.55\n", "")
    even = equal + "[layout]\nfiring_order = [1, 3, 4, 2]\n" + WIEBE + body
    roll = np.sqrt(4 * 300e3 * 0.3**2 / 6.4) / (2 * np.pi)  # the others: 22.2 lengthways, ...
    of_roll = rf"mode 4 \(roll, {roll:.1f} Hz\)"

    def tell(text, speeds, *options):
        path = write(tmp_path / "even.toml", text)
        return " ".join(run_here("mounts", path, "--speeds", speeds, *options).out.split())

    near = tell(even + mounts, "660:3000:20", "--orders", "2")
    assert " at 660 rpm at mount 1; order 2 alone makes " in near
    assert re.search(rf"the slowest speed of the range; most of the force is from {of_roll}\.", near)
    out = tell(even + mounts, "500:3000:20", "--orders", "2")
    assert re.search(rf"Order 2 meets {of_roll} at [\d.]+ rpm: resonance", out)
    stiff = even + mounts.replace("[300, 300, 900]\nloss = 0.1", "4000\nloss = 1.2")
    assert "yaw" not in tell(stiff, "400:3000:50", "--orders", "2").partition("Largest force")[0]
    out = tell(ENGINE + body + mounts.replace("loss = 0.1", "loss = 0.6"), "100:3000:50")
    told = r"at ([\d.]+) rpm at mount .* Most of the force is from mode \d \([^()]+, [\d.]+ Hz\); this order then has ([\d.]+) Hz\."
    rpm, hertz = re.search(told, out).groups()
    assert float(hertz) == pytest.approx(2 * float(rpm) / 60, rel=5e-3)


def test_a_scheme_is_shown_next_to_the_engine(four):
    out = run_here("mounts", four, "--scheme", "two-shaft").out
    assert "With two-shaft the largest force of any mount is " in out
    said = ask_json("mounts", four, "--scheme", "two-shaft")
    assert said["fitted"]["scheme"] == "two-shaft"
    assert len(said["fitted"]["response"]["mounts"]) == 4
    assert refusal("mounts", four, "--scheme", "nonsense").startswith(f"{four}: there is no scheme")


def test_other_engines_on_the_same_mounts(four, tmp_path):
    """Each as if it stood there alone; a body without an engine takes any."""
    asked = ("--speeds", "1000:3000:500")
    text = ENGINE.replace("mass = 0.5\n", "mass = 0.4\n").replace('"four"', '"light four"')
    light = write(tmp_path / "light.toml", f"{text}[layout]\nfiring_order = [1, 3, 4, 2]\n{WIEBE}")
    gas = "Inertia and gas torque, with the same gas diagram at every speed."
    assert " ".join(run_here("mounts", four, light, *asked).out.split()).count(gas) == 1
    light.write_text(text, encoding="utf-8")
    out = " ".join(run_here("mounts", four, light, *asked).out.split())
    assert re.search(r"With light four the largest force .* rpm \(.*%\); ", out)
    assert gas not in out
    said = ask_json("mounts", four, light, *asked)
    (other,) = said["others"]
    own = ask_json("mounts", "-", *asked, stdin=DAMPED.replace(ENGINE, text))
    assert (other["name"], other["response"]) == ("light four", own["response"])
    on_bare = ask_json("mounts", "-", light, *asked, stdin=DAMPED.replace(ENGINE, ""))
    assert (on_bare["name"], on_bare["response"]) == ("light four", own["response"])
    parts = {row["part"] for row in ask_csv("mounts", four, light, *asked)}
    assert {"mount", "light four: mount", "light four: point"} <= parts


def test_a_misfire_is_a_cylinder_whose_gas_does_nothing(tmp_path):
    """As the file has it with `gas = 0`; of every engine that is shown."""
    text = f"{ENGINE}[layout]\nfiring_order = [1, 3, 4, 2]\n{WIEBE}{block('loss = 0.1')}"
    fired = write(tmp_path / "fired.toml", text)
    weak = write(tmp_path / "weak.toml", f"{text}[cylinder.3]\ngas = 0\n")
    asked = ("--speeds", "700:900:50")
    assert ask_json("mounts", fired, "--misfire", "3", *asked) == ask_json("mounts", weak, *asked)
    beside = ask_json("mounts", fired, weak, "--misfire", "1", *asked)
    assert beside["response"]["no_gas_in"] == [1]
    assert "no gas in cylinder 1, 3" in run_here("mounts", fired, weak, "--misfire", "1", *asked).out
    assert "there is no cylinder 9: " in refusal("mounts", fired, "--misfire", "9")


def test_rounding_is_no_share_of_a_mode_and_turns_no_shape():
    """Mounts at the height of the centre of gravity, stiff along the diagonals of x and y: two modes
    move along these, half and half; which half is larger is rounding.
    """
    text = block("angles = [0, 0, 45]").replace("-200]", "0]")
    found = []
    for stiff in range(150, 250, 5):
        found += ask_json("mounts", "-", stdin=text.replace("[200, 150", f"[200.7, {stiff}.3"))["modes"]
    diagonal = [mode for mode in found if mode["energy_percent"]["x"] > 49]
    assert len(diagonal) == 40
    assert all(mode["shape"][0] > 0 for mode in diagonal)
    shares = [share for mode in found for share in mode["energy_percent"].values()]
    assert all(share == 0 or abs(share) > 1e-6 for share in shares)


@pytest.mark.stress
def test_picture(four, tmp_path):
    picture = tmp_path / "mounts.svg"
    done = run_here("mounts", four, "--speeds", "300:900:50", "--scheme", "two-shaft", "--plot", picture)
    assert (done.status, done.err) == (0, "")
    for words in ("Force of each mount", "Motion of points", "1, two-shaft", "4: 17.4 Hz", "roll"):
        assert words in picture.read_text(encoding="utf-8")


def test_of_a_body_alone_nothing_of_an_engine_can_be_told(tmp_path):
    bare = write(tmp_path / "bare.toml", block("loss = 0.1"))
    plain = run_here("mounts", bare).out
    for asked in (("--speeds", "1000"), ("--orders", "2"), ("--scheme", "auto"), ("--misfire", "1")):
        assert run_here("mounts", bare, *asked) == (
            0,
            plain,
            f"warning: {bare}: has no engine, so --speeds, --orders, --misfire and --scheme have no "
            "effect; add [crank], [rod] and [piston], or name an engine file after this one\n",
        )


@pytest.mark.stress
def test_the_page_rocks_the_body(four):
    """Its motion at one speed is that of the point in the answer, to the figures of the page."""
    page = ask("report", four, "-o", "-")
    assert "On its mounts" in page
    assert "Largest mount force" in page
    (text,) = re.findall(r'id="rocking-data">(.*?)</script>', page, re.S)
    data = json.loads(text)
    said = ask_json("mounts", four)["response"]
    k = 20
    place = int(np.argmin(np.abs(np.array(said["speeds_rpm"]) - data["speeds"][k])))
    angles = np.linspace(0, 4 * np.pi, 7201)
    arm = np.array([100, 0, 300])
    path = np.zeros((3, len(angles)))
    for order, row in zip(data["orders"], data["motion"][k], strict=True):
        parts = np.array(row)
        q = np.outer(parts[:6], np.cos(order * angles)) + np.outer(parts[6:], np.sin(order * angles))
        path += q[:3] + np.cross(q[3:].T, arm).T
    largest = np.linalg.norm(path, axis=0).max()
    assert largest == pytest.approx(said["points"][0]["peak_mm"][place], rel=1e-3)


@cases("mounting/command", "speeds_that_are_none")
def test_speeds_that_are_none(four, text, message):
    assert refusal("mounts", four, "--speeds", text).startswith(message)


def test_an_engine_that_shakes_nothing():
    weightless = re.sub(r"((throw_|piston_)?mass|inertia) = [\d.]+", r"\1 = 0", ENGINE)
    out = run_here("mounts", "-", stdin=weightless + block("loss = 0.1")).out
    assert "The orders included put no force on the mounts." in out


def test_what_is_refused(four):
    assert "must not change" in refusal("mounts", four, "-o", four)
    told = refusal("mounts", four, "--orders", "0-2")
    assert told.endswith('order 0 is steady and does not vibrate; leave it out (see the table "At rest")')
    mounts = "".join(
        f'[[mount]]\nname = "{k}"\nat = [{k + 9}, {k % 7}, {k % 3}]\nstiffness = [9, 9, 9]\nloss = 1\n'
        for k in range(100)
    )
    text = ENGINE + block("loss = 1", count=0) + mounts
    told = refusal("mounts", "-", "--speeds", "1:19000:1", "--orders", "1-3", stdin=text)
    assert "3 orders at 19000 speeds of 100 mounts and 0 points are 5700000 results" in told


def test_the_starting_file_runs():
    assert "Largest mount force" in ask("mounts", "-", stdin=template("mounts"))
    assert ask("analyze", "-", stdin=template("mounts"))


def test_a_mount_that_nothing_moves_has_no_force(tmp_path):
    """A six, which rolls alone in order 3, and a mount on the axis of roll: no force of 1e-17 N."""
    six = ENGINE.replace("throws = [0, 180, 180, 0]", "throws = [0, 240, 120, 120, 240, 0]")
    six = six.replace("[cylinder.2]\npiston_mass = 0.55\n", "")
    body = "[body]\nmass = 150\ncg = [0, 0, 0]\ninertia = [9e6, 9e6, 5e6, 0, 0, 0]\n"
    places = {"left": [0, 290, 10], "right": [0, -290, 10], "rear": [0, 0, 500]}
    mounts = (f'[[mount]]\nname = "{name}"\nat = {at}\nstiffness = 200\nloss = 0.1\n' for name, at in places.items())
    found = ask_json("mounts", write(tmp_path / "six.toml", six + body + "".join(mounts)))
    response = found["response"]
    rear = response["mounts"][2]["orders"][response["orders"].index(3)]["force_N"]
    assert not any(rear)
    passed = response["passed"][response["orders"].index(3)]
    assert set(passed["rigid"]) == set(passed["on_mounts"]) == {"moment_z_Nm"}
    small = np.abs([mode["shape"] for mode in found["modes"]] + found["stiffness_N_per_m"])
    assert np.all((small == 0) | (small > 1e-6))
