"""Limits of doubts: just inside nothing is said, just outside one warning."""

import pytest
from support.cases import cases
from support.commands import run_here
from support.engines import build_text, changed
from support.paths import write


@cases("file/thresholds", "an_engine_file")
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
