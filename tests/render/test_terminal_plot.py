"""Pictures of characters: proportions of bars, shape of loci, 80 columns, and words in place of
what is negligible.
"""

from __future__ import annotations

import sys

import numpy as np
import pytest
from support.commands import ask, run_in_terminal
from support.engines import GOOD, changed
from support.paths import write

from balcli.core.phasors import Phasors
from balcli.render.terminal_plot import BAR_COLUMNS, LOCUS_ROWS, bars, locus
from balcli.render.units import SI


def phasors(*rows: tuple[float, complex, complex]) -> Phasors:
    orders, forward, backward = (np.array(column) for column in zip(*rows, strict=True))
    return Phasors.of(orders.astype(float), forward.astype(complex), backward.astype(complex), np.zeros(1))


def test_a_bar_is_made_of_both_vectors():
    lines = list(bars(phasors((1, 30, 10), (2, 4, 4j), (3, 0, 0), (4, 0.001, 0), (6, 0.1, 0)), SI.force))
    assert lines == [
        f"   1 {'█' * (BAR_COLUMNS * 3 // 4)}{'▒' * (BAR_COLUMNS // 4)} 40",
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
    assert (len(lines), {len(line) for line in lines}) == (LOCUS_ROWS, {2 * LOCUS_ROWS})
    assert bool("".join(line[: LOCUS_ROWS - 1] for line in lines[: LOCUS_ROWS // 2]).strip()) == left
    assert "".join(line[LOCUS_ROWS + 1 :] for line in lines[: LOCUS_ROWS // 2]).strip()
    assert ["+" in line for line in lines].index(True) == start


def test_nothing_shakes():
    assert "+" not in "".join(locus(phasors((1, 0, 0))))


@pytest.fixture
def four(tmp_path):
    return write(tmp_path / "four.toml", GOOD)


def is_drawn(line):
    return "█" in line or any(0x2800 <= ord(c) <= 0x28FF for c in line)


def test_drawn_wherever_a_table_goes(balcli, four, tmp_path):
    """In a pipe and in a file as in a terminal: they were asked for."""
    out = ask("analyze", four, "--plot")
    assert len(list(filter(is_drawn, out.splitlines()))) > LOCUS_ROWS
    file = tmp_path / "four.txt"
    balcli("analyze", four, "--plot", "-o", file)
    assert file.read_text(encoding="utf-8") == out


@pytest.mark.parametrize("form", ["markdown", "json", "csv"])
def test_where_there_is_no_table_a_word_says_so(balcli, four, form):
    status, out, err = balcli("analyze", four, "--plot", "--format", form)
    assert (status, out) == balcli("analyze", four, "--format", form)[:2]
    told = "--plot draws with characters into a table; there are no pictures in"
    assert err == f"warning: {told} {form}\n"


def test_what_is_negligible_is_said_and_not_drawn(balcli, tmp_path):
    """An in-line five has a free force of 1e-6 of one cylinder's, and a moment."""
    file = write(
        tmp_path / "five.toml",
        changed(("throws = [0, 180, 180, 0]", "throws = [0, 144, 216, 288, 72]"), ("firing_order = [1, 3, 4, 2]", "")),
    )
    out = balcli("analyze", file, "--plot").out
    assert "Free force\nnegligible (0.00" in out
    assert "Free force by order" not in out
    assert "Free moment by order" in out


@pytest.mark.skipif(sys.platform == "win32", reason="needs a pseudo-terminal")
def test_in_a_terminal_of_80_columns(four):
    plain = {"COLUMNS": "80", "TERM": "xterm", "NO_COLOR": "1"}
    lines = run_in_terminal("analyze", four, "--plot", columns=80, env=plain).out.splitlines()
    drawn = list(filter(is_drawn, lines))
    assert len(drawn) > LOCUS_ROWS
    assert max(map(len, drawn)) <= 80
