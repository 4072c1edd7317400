"""Every kind of result in every format, as its command shows it."""

import csv
import io
import json
import re

import pytest
from support.commands import ask
from support.paths import ENGINES, PACKAGE
from support.rotors import three_runs

from balcli.bench import tasks
from balcli.bench.records import Bench, Block, Measured, OrderError, Ratio, Times
from balcli.shell import output
from balcli.show.formats import Format, render
from balcli.show.units import SI

V6, V8, SINGLE = (ENGINES / f"{name}.toml" for name in ("vr6", "v8_crossplane", "single"))
RUNS = three_runs()
ORDER = (Format.TABLE, Format.MARKDOWN, Format.CSV, Format.JSON)
SHOWN = {  # by renderer
    "analyses": ("analyze", V6, V8, "--only", "force,roll,peak,inner,guide", "--why"),
    "balance": ("balance", SINGLE, "--scheme", "factor", "--factor", "0:1:0.25"),
    "bench": ("bench",),
    "comparison": ("compare", V6, V8),
    "piston": ("piston", V6),
    "errata": ("tables", "liu-3", "--errata"),
    "all_schemes": ("balance", V8, "--scheme", "all"),
    "field_balancing": ("field", "-"),
    "layouts": ("layouts",),
    "marine": ("analyze", V6, V8, "--format", "marine", "--speed", "60,124"),
    "mounts": ("mounts", PACKAGE / "file" / "starting_files" / "mounts.toml"),
    "numbers": ("numbers", V8),
    "printed_table": ("tables", "liu-1"),
    "published": ("tables", "published"),
    "record": ("torque", "--curve", ENGINES.parent / "benchmark" / "25-gas-of-a-single" / "pressure.csv", "--quiet"),
    "search": ("search", V8, "--over", "throws", "--minimise", "moment.1.major"),
    "speeds": ("analyze", V6, V8, "--speed", "60:124:32", "--only", "force,peak,inner"),
    "table_list": ("tables",),
    "scatter": ("scatter", V8, "--samples", "100", "--seed", "1"),
    "locomotive": ("locomotive", ENGINES / "historic/locomotive4.toml"),
    "torque": ("torque", ENGINES / "v8_wiebe.toml"),
    "torsion": ("torsion", ENGINES / "i6_diesel.toml"),
    "two_engines": ("sum", V6, SINGLE),
}


def test_every_renderer_is_shown_here():
    texts = [file.read_text("utf-8") for file in PACKAGE.rglob("*.py")]
    assert (
        sum(text.count("Renderer(sheet=") for text in texts) == len(SHOWN) + 3
    )  # one analysis, in "analyses"; factors of a locomotive; a source


@pytest.mark.parametrize("name", SHOWN)
def test_every_result_in_every_format(name, monkeypatch):
    """Text has no blanks at the ends of lines, tables of Markdown and rows of CSV are as wide as their heads, and JSON
    has one document a line; the command computes once.
    """
    method = Measured("way", "exact", Times(1e-6, 1e-6, 2e-6), (OrderError(2, 1e-3),))
    measured = Bench.of([Block("task", (method,))], [Ratio(what="one to other", value=2.0)])
    monkeypatch.setattr(tasks, "measure", lambda: measured)
    calls = []
    monkeypatch.setattr(output, "render", lambda *call, **_: calls.append(call) or "text")
    ask(*SHOWN[name], stdin=RUNS)
    ((results, renderer, *_),) = calls
    text, marked, table, lines = (render(results, renderer, form, SI) for form in ORDER)
    assert text.splitlines()[0]
    assert [line for line in text.splitlines() if line != line.rstrip()] == []
    assert marked.startswith("# ")
    grids = re.findall(r"(?:^\|.*\n)+", marked, re.M)
    assert grids
    for grid in grids:
        assert len({len(re.findall(r"(?<!\\)\|", row)) for row in grid.splitlines()}) == 1
    header, *cells = csv.reader(io.StringIO(table))
    assert len(set(header)) == len(header)
    assert {len(row) for row in cells} == {len(header)}
    assert header not in cells
    assert not {"nan", "inf", "None", "True", "False"} & {cell for row in cells for cell in row}
    documents = [json.loads(line, parse_constant=pytest.fail) for line in lines.splitlines()]
    assert len(documents) == (2 if name in ("analyses", "marine", "speeds") else 1)
    assert all(isinstance(one, list) or one["format"].startswith("balcli.") for one in documents)


def test_the_table_of_a_search_fits_a_terminal_and_one_quantity_is_its_own_objective(balcli):
    throws = ("search", ENGINES / "i5.toml", "--over", "throws", "--minimise")
    one = balcli(*throws, "moment.1.major").out.splitlines()
    assert one[3].split() == ["throws", "moment.1.major,", "kN·m"]
    assert re.fullmatch(r"0-144-216-288-72 +0[.]9731", one[5])
    two = balcli(*throws, "moment.1.major,moment.2.major").out.splitlines()
    assert two[3].split()[:2] == ["throws", "objective"]
    assert max(map(len, two[:-2])) <= 80
