"""docs/sources.md: every item of the five sources stands there once, with a command that runs."""

import re
import shlex
import shutil
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import pytest
from support.commands import run_here
from support.paths import ENGINES, ROOT

from balcli.books.sources import SOURCES

PAGE = ROOT / "docs" / "sources.md"
OUTSIDE = "outside"
NUMBER = r"\(([0-9]+[.-])?([0-9]+)([Aa]?)\)"

# sections of the sources, with the number of the last equation in each
EQUATIONS = {
    "tsinghua": {"1-": 11},
    "liu": {"1.": 5, "2.": 5, "3.": 1, "4.": 2, "5.": 6, "6.": 21, "7.": 5},
    "wang": {"": 40},
    "kvasnikov": {"": 86},
    "liang": {"": 10},
}
FIGURES = {
    "tsinghua": ["1-1", "1-2", "1-3"],
    "liu": [str(n) for n in range(1, 9)],
    "wang": [str(n) for n in range(1, 9)],
    "kvasnikov": [str(n) for n in range(1, 22)],
    "liang": ["1-1", "1-2", "1-3", "2-1"],
}
TABLES = {
    "tsinghua": ["1-1", "1-2", "1-3", "1-4", "1-5", "1-6"],
    "liu": ["1", "2", "3"],
    "wang": ["1"],
    "kvasnikov": ["I", "II"],
    "liang": [],
}
RECORD = "angle_deg,torque_Nm\n0,30\n90,-30\n180,30\n270,-30\n360,30\n"


class Row(NamedTuple):
    """A line of the page: a place in a source, what stands there, and the command that shows it."""

    source: str
    place: str
    what: str
    command: str


def read_rows() -> list[Row]:
    """Return the lines of all tables of the page."""
    rows = []
    source = ""
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            source = line.rpartition("(")[2].rstrip(")")
        elif line.startswith("| ") and not line.startswith(("| place", "| ---")):
            place, what, command = line.strip("| ").split(" | ")
            rows.append(Row(source, place, what, command.strip("`")))
    return rows


ROWS = read_rows()
COMMANDS = list(dict.fromkeys(row.command for row in ROWS if row.command != OUTSIDE))


def list_equations(place: str) -> list[str]:
    """Return the numbers of the equations at a place: those that it names, and those in its ranges."""
    if place.startswith(("before", "after")):
        return []
    numbers = []
    for part in place.split(", "):
        ends = re.findall(NUMBER, part)
        if not ends:
            continue
        section, first, letter = ends[0]
        last = ends[-1][1]
        numbers += [f"{section}{number}{letter}" for number in range(int(first), int(last) + 1)]
    return numbers


def list_pieces(place: str, kind: str) -> list[str]:
    """Return the numbers of the figures or tables at a place, such as `Figures 1–3`."""
    found = re.fullmatch(rf"{kind}s? ([^–]+)(?:–(.+))?", place)
    if found is None:
        return []
    first, last = found.groups()
    return [str(number) for number in range(int(first), int(last) + 1)] if last else [first]


def test_each_source_has_a_section() -> None:
    assert list(dict.fromkeys(row.source for row in ROWS)) == [source.key for source in SOURCES]


@pytest.mark.parametrize("source", EQUATIONS)
def test_each_equation_stands_there_once(source: str) -> None:
    listed = Counter()
    for row in ROWS:
        if row.source == source:
            listed.update(list_equations(row.place))
    wanted = []
    for section, last in EQUATIONS[source].items():
        wanted += [f"{section}{number}" for number in range(1, last + 1)]
    variants = [number for number in listed if number[-1] in "Aa"]
    assert listed == Counter(wanted + variants)


@pytest.mark.parametrize("source", EQUATIONS)
def test_each_figure_and_table_stands_there_once(source: str) -> None:
    figures = []
    tables = []
    for row in ROWS:
        if row.source == source:
            figures += list_pieces(row.place, "Figure")
            tables += list_pieces(row.place, "Table")
    assert (figures, tables) == (FIGURES[source], TABLES[source])


def test_what_has_no_command_is_outside() -> None:
    for row in ROWS:
        assert row.command == OUTSIDE or row.command.startswith("balcli "), row


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the files that the commands read."""
    made = tmp_path_factory.mktemp("sources")
    engines = {path.name: path for path in ENGINES.rglob("*.toml")}
    for name in sorted({*re.findall(r"\w+\.toml", "\n".join(COMMANDS))} & {*engines}):
        shutil.copy(engines[name], made)
    assert run_here("torque", made / "i4_wiebe.toml", "--write", made / "uneven.toml").status == 0
    assert run_here("new", "field", made / "runs.toml").status == 0
    assert run_here("balance", made / "single.toml", "--factor", "50%", "--write", made / "half.toml").status == 0
    single = (made / "single.toml").read_text(encoding="utf-8")
    (made / "frame.toml").write_text(single + "\n[frame]\nreference = [0, 50, 0]\n", encoding="utf-8")
    v8 = (made / "v8_flatplane.toml").read_text(encoding="utf-8")
    narrow = re.sub(r"bank_angle *= *\d+", "bank_angle = 30", v8)
    assert narrow != v8
    (made / "v8_30.toml").write_text(narrow, encoding="utf-8")
    (made / "record.csv").write_text(RECORD, encoding="utf-8")
    return made


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.stress
def test_each_command_of_the_page_runs(command: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    status, _, err = run_here(*shlex.split(command)[1:])
    assert (status, err) == (0, "")
