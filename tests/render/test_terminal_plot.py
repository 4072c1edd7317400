"""Pictures of characters: proportions of bars, shape of loci, 80 columns, and nothing of it where
nobody looks.
"""

from __future__ import annotations

import sys

import numpy as np
import pytest
from support.commands import run_in_terminal
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


@pytest.fixture
def four(tmp_path):
    file = tmp_path / "four.toml"
    file.write_text(GOOD)
    return file


def is_drawn(line):
    return "█" in line or any(0x2800 <= ord(c) <= 0x28FF for c in line)


def test_absent_in_pipes(balcli, four):
    for options in ((), ("--format", "markdown")):
        status, out, _ = balcli("analyze", four, "--plot", *options)
        assert status == 0
        assert not any(map(is_drawn, out.splitlines()))


@pytest.mark.skipif(sys.platform == "win32", reason="needs a pseudo-terminal")
def test_in_a_terminal_of_80_columns(four):
    plain = {"COLUMNS": "80", "TERM": "xterm", "NO_COLOR": "1"}
    lines = run_in_terminal("analyze", four, "--plot", columns=80, env=plain).out.splitlines()
    drawn = list(filter(is_drawn, lines))
    assert len(drawn) > SIDE
    assert max(map(len, drawn)) <= 80
