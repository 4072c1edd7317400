"""Run the published problems of `tests/published/`; write `src/balcli/books/data/published.csv` and
`docs/published.md`.

Usage: python tools/published_answers.py
"""

import csv
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from support.published import CHAPTERS, VERDICTS, Figure, Problem, load_problems  # noqa: E402

DATA = ROOT / "src" / "balcli" / "books" / "data" / "published.csv"
PAGE = ROOT / "docs" / "published.md"
HEADS = (
    *("chapter", "source", "title", "address", "figure", "unit"),
    *("verdict", "class", "remark", "printed", "balcli"),
)
NAMES = {
    "forces": "Free forces and moments, motion of pistons",
    "balancing": "Balancing",
    "locomotive": "Locomotives",
    "torque": "Gas, torque and flywheels",
    "torsion": "Torsional vibration",
    "mounts": "Mounts and isolation",
    "field": "Balancing rotors",
}
WORDS = {
    "agrees": "in all digits",
    "rounded": "within rounding",
    "definition": "by another definition",
    "wrong": "wrong in the source",
}
INTRODUCTION = """\
# How balcli compares with {figures} published answers

balcli solves {problems} problems from {works} books, papers, guides and web pages that print their
answers. Of the {figures} printed figures,

- {agrees} agree in all printed digits (at most 10 digits are compared),
- {rounded} agree within the rounding of the source, or within the accuracy of its drawing
  ([reasons](#within-the-rounding-of-the-source)),
- {definition} follow [another definition](#other-definitions), such as two terms of a series,
- {wrong} are [wrong in the source](#wrong-in-the-source); {code} of these come from a FOSSEE
  companion, not from its book.

A FOSSEE companion is code that solves the examples of a book; the authors of the code compared its
output with the book. Half of the problems come from these companions. For each figure of the last
two kinds, a second calculation without balcli reproduces the printed figure by the other
definition, or gives the correct value.

No printed answers were found for rotary, articulated and geared engines, for torsional dampers and
pendulums, and for most schemes of `balance` (shafts, minimax, ellipse, compensators, couplings).
For these, tests compare balcli with other calculations and [other programs](programs.md), and with
the tables of five books and papers (`balcli tables`).

The data and commands of all problems are in `tests/published`; tests run them. `balcli tables
published` lists the problems; with `--format csv`, it lists every figure."""


def list_rows(problem: Problem) -> list[tuple[str, ...]]:
    """Return a row of the table for each figure of a problem; balcli's answer has six digits."""
    about = problem.chapter, problem.source, problem.title, problem.address
    return [
        (*about, f.name, f.unit, f.verdict, f.category, f.remark, f.printed, f"{value:.6g}")
        for f, value in zip(problem.figures, problem.answer(), strict=True)
    ]


def write_table(problems: list[Problem]) -> None:
    """Write the table of all figures."""
    with DATA.open("w", encoding="utf-8", newline="") as file:
        file.write("# source: many; each line names its own\n")
        file.write("# title: published problems, and balcli's answers\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADS)
        for problem in problems:
            writer.writerows(list_rows(problem))


def write_page(problems: list[Problem]) -> str:
    """Return the page of the documentation."""
    figures = [(problem, figure) for problem in problems for figure in problem.figures]
    every = Counter(figure.verdict for _, figure in figures)
    introduction = INTRODUCTION.format(
        problems=len(problems),
        works=len({problem.work for problem in problems}),
        figures=len(figures),
        code=sum("companion" in figure.wrong for _, figure in figures),
        **{verdict: every[verdict] for verdict in VERDICTS},
    )
    table = [
        "| chapter | problems | figures | agree | rounded | other definition | wrong |",
        "| --- | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for chapter in CHAPTERS:
        own = [problem for problem in problems if problem.chapter == chapter]
        count = Counter(figure.verdict for problem in own for figure in problem.figures)
        verdicts = (count[verdict] for verdict in VERDICTS)
        cells = (NAMES[chapter], len(own), count.total(), *verdicts)
        table.append(f"| {' | '.join(map(str, cells))} |")
    parts = [introduction, "\n".join(table)]
    parts += ["## Wrong in the source", _list_differing(figures, "wrong", "right")]
    parts += ["## Other definitions", _list_differing(figures, "definition", "balcli")]
    parts += ["## Within the rounding of the source", _list_differing(figures, "rounded", "within")]
    for chapter in CHAPTERS:
        parts.append(f"## {NAMES[chapter]}")
        lines = ["| problem | what | figures |", "| --- | --- | --- |"]
        lines += [_list_problem(problem) for problem in problems if problem.chapter == chapter]
        parts.append("\n".join(lines))
    return "\n\n".join(parts) + "\n"


def _list_problem(problem: Problem) -> str:
    count = Counter(figure.verdict for figure in problem.figures)
    verdict = ", ".join(f"{n} {WORDS[word]}" for word, n in count.items())
    return f"| {_link(problem)} | {problem.title} | {verdict} |"


def _list_differing(figures: list[tuple[Problem, Figure]], verdict: str, head: str) -> str:
    lines = [f"| problem | figure | printed | {head} | why |", "| --- | --- | ---: | ---: | --- |"]
    for problem, f in figures:
        if f.verdict == verdict:
            unit = f" {_write_unit(f.unit)}" if f.unit else ""
            shown = f.balcli or f"{100 * f.within:.2g} %"
            lines.append(
                f"| {_link(problem)} | {f.name} | {f.printed}{unit} | {shown} | {f.remark} |"
            )
    return "\n".join(lines)


def _write_unit(unit: str) -> str:
    """Return a unit in signs: `kg m2` as kg·m²."""
    return unit.replace("^", "").replace(" ", "·").translate(str.maketrans("23", "²³"))


def _link(problem: Problem) -> str:
    return f"[{problem.source}]({problem.address})" if problem.address else problem.source


if __name__ == "__main__":
    found = load_problems()
    write_table(found)
    PAGE.write_text(write_page(found), encoding="utf-8")
