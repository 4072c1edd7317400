"""Balcli against published answers, and each verdict against a second way."""

import csv

import published_answers as tool
import pytest
from support.published import FOLDER, load_problem, load_problems

from balcli.books.recomputed import CLASSES


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.toml")), ids=lambda path: path.stem)
def test_published_problem(path):
    """Each figure agrees with its print, or with what the file says instead, which a second way proves."""
    problem = load_problem(path)
    for figure, value in zip(problem.figures, problem.answer(), strict=True):
        where = f"{figure.name}: balcli {value:.8g}, printed {figure.printed}"
        assert figure.agrees(value, figure.balcli or figure.printed, figure.within), where
        assert bool(figure.within) == bool(figure.why), f"{figure.name}: a tolerance and its reason"
        assert bool(figure.wrong) == (figure.category in CLASSES), f"{figure.name}: class of the error"
        assert bool(figure.balcli) == (figure.verdict in ("definition", "wrong")), f"{figure.name}: balcli's figure"
        if not figure.balcli:
            needless = figure.within and figure.agrees(value, figure.printed)
            assert not needless, f"{where}: agrees without a tolerance"
            continue
        assert not figure.agrees(value, figure.printed), f"{where}: it agrees"
        assert figure.check, f"{figure.name}: a second way"
        proved = figure.balcli if figure.wrong else figure.printed
        assert figure.agrees(figure.checked(), proved, figure.within), (
            f"{figure.name}: the second way gives {figure.checked():.8g}"
        )


@pytest.mark.slow
def test_the_corpus_is_wide_and_written_down():
    """Page and table are current; balcli's figures in the table are rounded."""
    problems = load_problems()
    assert len(problems) >= 100
    assert len({problem.work for problem in problems}) >= 20
    assert tool.PAGE.read_text(encoding="utf-8") == tool.write_page(problems)
    with tool.DATA.open(encoding="utf-8", newline="") as file:
        _, _, heads, *written = csv.reader(file)
    assert tuple(heads) == tool.HEADS
    for row, expected in zip(written, (row for one in problems for row in tool.list_rows(one)), strict=True):
        assert row[:-1] == list(expected[:-1])
        assert float(row[-1]) == pytest.approx(float(expected[-1]), rel=1e-5)
