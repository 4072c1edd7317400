"""How much is said beside results: -q, -v, and the version."""

import re
from pathlib import Path

import pytest
from support.commands import run_here

LONG_ROD = "crank.stroke = 90\nrod.length = 1600\npiston.mass = 0.5\n"
WARNING = (
    "warning: standard input: crank radius / rod length is 0.02813, where 0.15 to 0.4 is usual; crank.stroke is "
    "twice the crank radius, rod.length the distance between its centres\n"
)


@pytest.mark.parametrize("option", ["-q", "--quiet"])
def test_quiet_leaves_out_warnings_wherever_it_stands(option):
    usual = run_here("analyze", "-", stdin=LONG_ROD)
    assert usual.err == WARNING
    for args in ((option, "analyze", "-"), ("analyze", "-", option)):
        assert run_here(*args, stdin=LONG_ROD) == (0, usual.out, "")
    assert run_here("analyze", "-", stdin=LONG_ROD).err == WARNING  # it was for that command


def test_verbose_tells_what_was_read_taken_and_written(tmp_path: Path):
    target = tmp_path / "x.csv"
    status, out, err = run_here("analyze", "-", "-v", "-o", target, stdin=LONG_ROD)
    assert (status, out) == (0, "")
    *told, took = err.splitlines()
    assert told == [
        f"note: standard input: read, {len(LONG_ROD)} bytes",
        "note: standard input: not in the file: operation.speed = 1000",
        "note: standard input: not in the file: crank.throw_mass = 0",
        "note: standard input: not in the file: rod.mass = 0",
        WARNING.strip(),
        f"note: {target}: written, {target.stat().st_size} bytes",
    ]
    assert re.fullmatch(r"note: \d+\.\d\d s of processor time, including the start of Python", took)
