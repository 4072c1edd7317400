"""Limits of doubts: just inside nothing is said, just outside one warning."""

from __future__ import annotations

import pytest
from support.commands import run_here
from support.engines import build_text, changed
from support.paths import write


@pytest.mark.parametrize(
    ("old", "new", "inside", "outside"),
    [
        ("mass = 0.5", "mass = {}", 3.17, 3.19),  # 5000 kg/m^3 of the bore's cube
        ("mass = 0.6", "mass = {}", 3.99, 4.01),  # 8 times the piston
        ("mass = 0.6", "mass = {}", 0.051, 0.049),  # a tenth of the piston
        ("cg = 45", "cg = {}", 87.9, 88.1),  # 0.55 of the rod's length
        ("length = 160", "length = {}", 112.6, 112.4),  # lambda 0.4
        ("length = 160", "length = {}", 299, 301),  # lambda 0.15
        ("speed = 3000", "speed = {}", 13330, 13340),  # mean piston speed 40 m/s
        ("speed = 3000", "speed = {}", 9.1, 8.9),
    ],
)
def test_an_engine_file(old, new, inside, outside):
    said = [build_text(changed((old, new.format(value)))).doubts for value in (inside, outside)]
    assert [len(each) for each in said] == [0, 1]


@pytest.mark.parametrize(("before", "far"), [(4.95, False), (5.05, True)])
def test_a_correction_far_beyond_its_trial_weight(tmp_path, before, far):
    """A reading of `before` that a trial weight of 1 makes larger by 1."""
    runs = f"""planes = ["fan"]
[[run]]
readings = ["{before} @ 0"]
[[run]]
weights = {{ fan = "1 @ 0" }}
readings = ["{before + 1} @ 0"]
"""
    found = run_here("field", write(tmp_path / "runs.toml", runs), "--format", "json")
    assert found.status == 0
    assert ("times" in found.err) == far, found.err
