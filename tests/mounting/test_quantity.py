"""Figures of an engine on its mounts, over variants: each as if the file said so."""

import numpy as np
import pytest
from support.cases import cases
from support.commands import ask_csv, ask_json, refusal
from support.mounts import ENGINE, block
from support.paths import write

TEXT = ENGINE + block("loss = 0.1") + '[[point]]\nname = "shift lever"\nat = [100, 0, 300]\n'
NAMED = TEXT.replace('name = "1"', 'name = "left"').replace('name = "3"', 'name = "rear one"')


@pytest.fixture
def four(tmp_path):
    return write(tmp_path / "four.toml", NAMED)


def sweep(path, *args):
    rows = ask_csv("sweep", path, *args)
    return [{key: float(value) for key, value in row.items()} for row in rows]


def said_by(path, text):
    path.write_text(text, encoding="utf-8")
    return ask_json("mounts", path)


def test_each_variant_is_the_file_that_says_so(four, tmp_path):
    quantities = (
        "mode.3.Hz,mode.roll.Hz,mode.roll.share,mode.2.damping,mount.left.force,"
        "mount.rear_one.static,point.shift_lever.motion,force.2.major"
    )
    rows = sweep(four, "--vary", "mount.left.stiffness.3=300,500", "--vary", "body.mass=150,210", "-q", quantities)
    assert len(rows) == 4
    for row in rows:
        stiffness = row["mount.left.stiffness.3"]
        mass = row["body.mass"]
        text = NAMED.replace("[200, 150, 400]", f"[200, 150, {stiffness}]", 1)
        said = said_by(tmp_path / "one.toml", text.replace("mass = 200", f"mass = {mass}"))
        modes = said["modes"]
        assert row["mode.3.Hz"] == pytest.approx(modes[2]["frequency_Hz"], rel=1e-12)
        roll = max(modes, key=lambda mode: mode["energy_percent"]["rz"])
        assert row["mode.roll.Hz"] == pytest.approx(roll["frequency_Hz"], rel=1e-12)
        assert row["mode.roll.share"] == pytest.approx(roll["energy_percent"]["rz"], rel=1e-9)
        assert row["mode.2.damping"] == pytest.approx(5, rel=1e-9)
        mount = said["response"]["mounts"][0]
        point = said["response"]["points"][0]
        assert row["mount.left.force"] == pytest.approx(mount["worst"]["force_N"], rel=1e-9)
        assert row["point.shift_lever.motion"] == pytest.approx(point["worst"]["motion_mm"], rel=1e-9)
        rest = np.linalg.norm(said["static"]["mounts"][2]["force_N"])
        assert row["mount.rear_one.static"] == pytest.approx(rest, rel=1e-9)
        assert row["force.2.major"] > 1000


@cases("mounting/quantity", "what_is_no_quantity")
def test_what_is_no_quantity(four, quantity, message):
    told = refusal("sweep", four, "--vary", "mount.left.loss=0.1,0.2", "-q", quantity)
    assert told.removeprefix(f"{four}: ").startswith(message)


def test_variants_that_cannot_be_are_told_with_their_figures(four):
    told = refusal("sweep", four, "--vary", "body.inertia.4=0,1e8", "-q", "mode.1.Hz")
    assert told == (
        f"{four}: body.inertia.4 = 1e+08: body: inertia xy is 1e+08 kg mm^2; with xx and yy its magnitude must be below 9.79796e+06 kg mm^2"
    )
    told = refusal("sweep", four, "--vary", "mount.9.loss=0,1", "-q", "mode.1.Hz")
    assert told.startswith("mount.9.loss: unknown parameter; did you mean")


# ------------------------------------------------------------------ tolerances of mounts
@pytest.mark.stress
def test_stiffness_scatters():
    """Up and down of the block is sqrt(sum k / m): by hand, with the same random numbers."""
    said = ask_json(
        "scatter", "-", "-q", "mode.z.Hz", "--samples", "400", "--seed", "7", "--stiffness-scatter", "10%", stdin=NAMED
    )
    found = said["quantities"]["mode.z.Hz"]
    factors = 1 + 0.1 * (2 * np.random.default_rng(7).random((400, 4)) - 1)
    own = np.sqrt(400e3 * factors.sum(axis=1) / 200) / (2 * np.pi)
    assert found["nominal"] == pytest.approx(np.sqrt(8000) / (2 * np.pi), rel=1e-12)
    assert found["mean"] == pytest.approx(own.mean(), rel=2e-3)
    assert found["p95"] == pytest.approx(np.percentile(own, 95), rel=5e-3)
    each = found["nominal"] * 0.1 / 8
    assert found["sensitivity"]["stiffness left"] == pytest.approx(each, rel=0.05)
    assert found["bound"] == pytest.approx(found["nominal"] + 4 * each, rel=0.01)


def test_what_scatters_is_of_the_engine_or_of_its_mounts(four):
    told = refusal("scatter", four, "-q", "mode.1.Hz,force.2.major")
    assert told.startswith("mode.1.Hz, force.2.major: engine, mounts and torsion have different tolerances")
    told = refusal("scatter", four, "-q", "mode.1.Hz", "--samples", "100000")
    assert told == "100 000 samples: give from 1 to 20 000, because mode.1.Hz takes longer to compute"
    told = refusal("scatter", four, "-q", "mode.1.Hz", "--stiffness-scatter", "0%")
    assert told == "all tolerances are 0; give one, such as --stiffness-scatter 15%"


# ------------------------------------------------------------------ with gas
LAYOUT = "[layout]\nfiring_order = [1, 3, 4, 2]\n"
GAS = '[gas]\ncycle = "wiebe"\ncompression_ratio = 10\nimep = 9\n'


@cases("mounting/quantity", "with_gas_every_figure_varies")
def test_with_gas_every_figure_varies(path, old, new, tmp_path):
    text = NAMED + LAYOUT + GAS
    assert old in text
    file = write(tmp_path / "four.toml", text)
    first = float(old.split("=")[1])
    value = 0.11 if path == "mount.left.loss" else 1.05 * first
    (_, row) = sweep(file, "--vary", f"{path}={first},{value}", "-q", "mount.left.force")
    said = said_by(tmp_path / "one.toml", text.replace(old, new.format(value), 1))
    mount = said["response"]["mounts"][0]
    exact = 1e-12
    largest = mount["worst"]["force_N"]
    if path == "operation.speed":  # which makes it the force at this speed, where the range ends
        largest = mount["peak_N"][-1]
        exact = 1e-3
    assert row["mount.left.force"] == pytest.approx(largest, rel=exact)


def test_the_mean_torque_leans_on_the_mounts_whatever_else_is_asked(tmp_path):
    """Of [gas], as `mounts` has the rest: beside a force of the running engine, and alone."""
    file = write(tmp_path / "four.toml", NAMED + LAYOUT + GAS)
    rest = said_by(file, NAMED + LAYOUT + GAS)["static"]["mounts"][0]["force_N"]
    for asked in ("mount.left.static", "mount.left.static,mount.left.force"):
        (row,) = sweep(file, "--vary", "mount.left.loss=0.1", "-q", asked)
        assert row["mount.left.static"] == pytest.approx(np.linalg.norm(rest), rel=1e-12)
    weight = said_by(file, NAMED)["static"]["mounts"][0]["force_N"]
    assert np.linalg.norm(rest) > 1.005 * np.linalg.norm(weight)
