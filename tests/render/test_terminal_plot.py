"""Pictures of characters: proportions of bars, shape of loci, 80 columns, and nothing of it where
nobody looks.
"""

from __future__ import annotations

import os
import pty
import subprocess
import sys

import numpy as np
import pytest
from support.engines import GOOD

from balcli.core.phasors import Phasors
from balcli.render.terminal_plot import BAR, SIDE, bars, locus
from balcli.render.units import SI


def phasors(*rows: tuple[float, complex, complex]) -> Phasors:
    orders, forward, backward = (np.array(column) for column in zip(*rows, strict=True))
    return Phasors(
        orders.astype(float), forward.astype(complex), backward.astype(complex), np.zeros(1)
    )


def test_a_bar_is_made_of_both_vectors():
    lines = list(
        bars(phasors((1, 30, 10), (2, 4, 4j), (3, 0, 0), (4, 0.001, 0), (6, 0.1, 0)), SI.force)
    )
    assert lines == [
        f"   1 {'█' * (BAR * 3 // 4)}{'▒' * (BAR // 4)} 40",
        f"   2 {'█' * 5}{'▒' * 5} 8",
        "   6 ▏ 0.1",
    ]


def test_balanced_orders_have_no_bar():
    assert list(bars(phasors((1, 0, 0), (2, 0, 0)), SI.force)) == ["   1 0", "   2 0"]


@pytest.mark.parametrize(("backward", "left", "start"), [(0, True, 0), (1j, False, 4)])
def test_a_circle_is_all_round_and_a_diagonal_is_not(backward, left, start):
    """1 and 1j: a line at 45 degrees, from the lower left to the upper right, as x is up and y to
    the right.
    """
    lines = locus(phasors((1, 1, backward)))
    assert (len(lines), {len(line) for line in lines}) == (SIDE, {2 * SIDE})
    assert bool("".join(line[: SIDE - 1] for line in lines[: SIDE // 2]).strip()) == left
    assert "".join(line[SIDE + 1 :] for line in lines[: SIDE // 2]).strip()
    assert ["+" in line for line in lines].index(True) == start


def test_nothing_shakes():
    assert "+" not in "".join(locus(phasors((1, 0, 0))))


def command(tmp_path, *options):
    file = tmp_path / "four.toml"
    file.write_text(GOOD)
    return [sys.executable, "-m", "balcli", "analyze", str(file), "--plot", *options]


def test_absent_in_pipes(tmp_path):
    for options in ((), ("--format", "markdown")):
        out = subprocess.run(
            command(tmp_path, *options), capture_output=True, text=True, check=True
        ).stdout
        assert "█" not in out
        assert not any(0x2800 <= ord(c) <= 0x28FF for c in out)


def test_in_a_terminal_of_80_columns(tmp_path):
    lines = in_terminal(command(tmp_path), 80).splitlines()
    drawn = [line for line in lines if "█" in line or any(0x2800 <= ord(c) <= 0x28FF for c in line)]
    assert len(drawn) > SIDE
    assert max(map(len, drawn)) <= 80


def in_terminal(argv: list[str], columns: int) -> str:
    """What a program prints in a terminal."""
    ours, theirs = pty.openpty()
    with subprocess.Popen(
        argv,
        stdin=subprocess.DEVNULL,
        stdout=theirs,
        stderr=theirs,
        env={**os.environ, "COLUMNS": str(columns), "TERM": "xterm", "NO_COLOR": "1"},
    ):
        os.close(theirs)
        seen = b""
        while True:
            try:
                part = os.read(ours, 65536)
            except OSError:  # Linux: the other end is closed
                break
            if not part:
                break
            seen += part
    os.close(ours)
    return seen.decode()
