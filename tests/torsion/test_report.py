"""The page of an engine that has [torsion] shows how its crankshaft twists."""

from __future__ import annotations

import re

import pytest
from support.commands import ask, ask_json, run_here
from support.diesel import write_diesel
from support.paths import ENGINES, write


@pytest.mark.stress
def test_the_page_shows_torsion(tmp_path):
    engine, page = tmp_path / "six.toml", tmp_path / "six.html"
    engine.write_text(write_diesel("limit = 20"), encoding="utf-8")
    ask("report", engine, "-o", page)
    text = page.read_text(encoding="utf-8")
    section = text[text.index('<section id="torsion">') :]
    section = section[: section.index("</section>")]
    for what in ("modes", "campbell", "response", "waterfall"):
        assert f'id="torsion-{what}-' in section
    for title in ("Natural modes", "Critical speeds", "Vibratory torque, 1000 to 3000 rpm", "Limits"):
        assert title in section
    ids = re.findall(r' id="([^"]+)"', text)
    assert len(ids) == len(set(ids))


def test_that_gas_stays_is_said_of_an_engine_with_gas(tmp_path):
    """The published six has none, the shipped one has."""
    without = write(tmp_path / "six.toml", write_diesel())
    for engine, told in ((ENGINES / "i6_diesel.toml", 1), (without, 0)):
        out = ask("torsion", engine, "--speeds", "1000:1100:50")
        assert " ".join(out.split()).count("Gas as in the file at every speed.") == told
        assert run_here("torsion", engine, "--speed", "1000:1100:50").out == out


def test_large_torques_are_in_kilonewton_metres():
    """Sums from 5000 N m on; JSON has N m."""
    asked = ("torsion", ENGINES / "i6_diesel.toml", "--speeds", "2000:2200:25")
    out = run_here(*asked).out
    assert re.search(r"shaft +± kN·m +at rpm +sum, kN·m", out)
    row = re.search(r"(?m)^flywheel +([\d.]+) +[\d.]+ +([\d.]+) ", out[out.index("Vibratory") :])
    assert row is not None
    shafts = {each["name"]: each for each in ask_json(*asked)["response"]["shafts"]}
    largest = shafts["flywheel"]["worst"]["half_peak_to_peak_Nm"]
    assert float(row[1]) == pytest.approx(largest / 1e3, rel=1e-4)


def test_what_cannot_be_told_is_a_warning(tmp_path):
    """Nothing damps it, and the range runs through order 3 of the first mode."""
    engine, page = tmp_path / "six.toml", tmp_path / "six.html"
    text = write_diesel().replace("loss = 0.035", "loss = 0").replace("damping = 2", "damping = 0")
    engine.write_text(text.replace("speed = 2000", "speed = 4000"), encoding="utf-8")
    status, _, err = run_here("report", engine, "-o", page)
    assert status == 0
    told = f"warning: the page does not show the torsion: {engine}: the natural frequency"
    assert err.startswith(told)
    assert 'id="torsion"' not in page.read_text(encoding="utf-8")
