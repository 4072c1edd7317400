"""Every kind of result in every format, as its command shows it."""

from __future__ import annotations

import csv
import io
import json
import re

import pytest
from support.commands import ask
from support.paths import ENGINES, PACKAGE
from support.rotors import three_runs

from balcli import bench
from balcli.shell import output
from balcli.show.formats import Format

V6, V8, SINGLE = (ENGINES / f"{name}.toml" for name in ("vr6", "v8_crossplane", "single"))
RUNS = three_runs()
SHOWN = {  # by renderer
    "analyses": ("analyze", V6, V8, "--only", "force,roll,peak,inner,guide", "--why"),
    "balance": ("balance", SINGLE, "--scheme", "factor", "--factor", "0:1:0.25"),
    "bench": ("bench",),
    "comparison": ("compare", V6, V8),
    "errata": ("tables", "liu-3", "--errata"),
    "field_balancing": ("field", "-"),
    "layouts": ("layouts",),
    "marine": ("analyze", V6, V8, "--format", "marine", "--speed", "60,124"),
    "mounts": ("mounts", PACKAGE / "file" / "starting_files" / "mounts.toml"),
    "numbers": ("numbers", V8),
    "printed_table": ("tables", "liu-1"),
    "search": ("search", V8, "--over", "throws", "--minimise", "moment.1.major"),
    "speeds": ("analyze", V6, V8, "--speed", "60:124:8", "--only", "force,peak,inner"),
    "table_list": ("tables",),
    "scatter": ("scatter", V8, "--samples", "100", "--seed", "1"),
    "torque": ("torque", ENGINES / "v8_wiebe.toml"),
    "torsion": ("torsion", ENGINES / "i6_diesel.toml"),
    "two_engines": ("sum", V6, SINGLE),
}


@pytest.fixture
def show(monkeypatch):
    """Runs the command of a renderer, which has to call one."""
    called = []
    render = output.render

    def recorded(results, renderer, *args, **options):
        called.append(renderer)
        return render(results, renderer, *args, **options)

    rows = (bench.Row(task="task", method="way", seconds=1e-6, error=1e-3),)
    measured = bench.Bench(rows=rows, ratios=(bench.Ratio(what="one to other", value=2.0),))
    monkeypatch.setattr(output, "render", recorded)
    monkeypatch.setattr(bench, "measure", lambda: measured)

    def run(name: str, form: Format) -> str:
        out = ask(*SHOWN[name], "--format", form, stdin=RUNS)
        assert len(called) == 1
        return out

    return run


def test_every_renderer_is_shown_here():
    texts = [file.read_text("utf-8") for file in PACKAGE.rglob("*.py")]
    assert sum(text.count("Renderer(sheet=") for text in texts) == len(SHOWN) + 1  # one analysis, in "analyses"


@pytest.mark.parametrize("name", SHOWN)
def test_a_table_is_text_without_blanks_at_the_ends_of_lines(show, name):
    lines = show(name, Format.TABLE).splitlines()
    assert lines[0]
    assert [line for line in lines if line != line.rstrip()] == []


@pytest.mark.parametrize("name", SHOWN)
def test_markdown_has_a_title_and_tables_whose_rows_are_as_wide_as_their_headings(show, name):
    text = show(name, Format.MARKDOWN)
    assert text.startswith("# ")
    tables = re.findall(r"(?:^\|.*\n)+", text, re.M)
    assert tables
    for table in tables:
        assert len({len(re.findall(r"(?<!\\)\|", row)) for row in table.splitlines()}) == 1


@pytest.mark.parametrize("name", SHOWN)
def test_csv_has_one_header_and_rows_of_its_width(show, name):
    header, *rows = csv.reader(io.StringIO(show(name, Format.CSV)))
    assert len(set(header)) == len(header)
    assert rows
    assert {len(row) for row in rows} == {len(header)}
    assert header not in rows
    assert not {"nan", "inf", "None", "True", "False"} & {cell for row in rows for cell in row}


@pytest.mark.parametrize("name", SHOWN)
def test_json_is_one_document_a_line_without_what_json_has_no_word_for(show, name):
    def refuse(constant):
        raise AssertionError(constant)

    lines = show(name, Format.JSON).splitlines()
    assert len(lines) == (2 if name in ("analyses", "marine", "speeds") else 1)
    for line in lines:
        document = json.loads(line, parse_constant=refuse)
        assert isinstance(document, list) or document["format"].startswith("balcli.")


def test_the_table_of_a_search_fits_a_terminal_and_one_quantity_is_its_own_objective(balcli):
    throws = ("search", ENGINES / "i5.toml", "--over", "throws", "--minimise")
    one = balcli(*throws, "moment.1.major").out.splitlines()
    assert one[3].split() == ["throws", "moment.1.major,", "kN·m"]
    assert re.fullmatch(r"0-144-216-288-72 +0[.]97312", one[5])
    two = balcli(*throws, "moment.1.major,moment.2.major").out.splitlines()
    assert two[3].split()[:2] == ["throws", "objective"]
    assert max(map(len, two[:-2])) <= 80


def test_the_list_of_tables_names_each_source_once(balcli):
    titles, _, sources = balcli("tables").out.partition("Sources\n")
    assert "tsinghua-1-6" in titles
    assert sources.count("Automobile Engine Design") == 1
    assert max(map(len, titles.splitlines())) <= 80
