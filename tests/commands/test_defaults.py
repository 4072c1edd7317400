"""Units, format and digits that are usual: from options, environment and files, in this order."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.commands import ask_json, refusal, run_here
from support.paths import ENGINES
from typer.main import get_command

from balcli.cli import COMMANDS, WITHOUT_DEFAULTS, app
from balcli.render.formats import set_digits

ASKED = ("analyze", ENGINES / "i4.toml", "--only", "force", "--orders", "2")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The folder above the one that commands run in."""
    (tmp_path / "below").mkdir()
    monkeypatch.chdir(tmp_path / "below")
    yield tmp_path
    set_digits(None)


def imperial(*more: object) -> bool:
    return "lbf" in run_here(*ASKED, *more).out


def test_an_option_comes_before_the_environment_and_that_before_the_file(folder, monkeypatch):
    assert not imperial()
    (folder / "balcli.toml").write_text('units = "imperial"')
    assert imperial()
    monkeypatch.setenv("BALCLI_UNITS", "si")
    assert not imperial()
    assert imperial("--units", "imperial")
    monkeypatch.setenv("BALCLI_UNITS", "")  # as if it were not there
    assert imperial()


def test_the_nearest_file_counts_and_of_one_folder_balcli_toml(folder):
    (folder / "balcli.toml").write_text('units = "imperial"')
    here = folder / "below" / "pyproject.toml"
    here.write_text('[project]\nname = "a"\n[tool.other]\nx = "balcli"')  # says nothing of it
    assert imperial()
    here.write_text("[tool.balcli]\ndigits = 3")
    assert not imperial()
    here.write_text('[tool.balcli]\nunits = "SI"')
    (folder / "below" / "balcli.toml").write_text('units = "imperial"')
    assert imperial()


def test_another_file_or_none(folder, monkeypatch):
    (folder / "balcli.toml").write_text('units = "imperial"')
    monkeypatch.setenv("BALCLI_CONFIG", "")
    assert not imperial()
    (folder / "other.toml").write_text('units = "imperial"')
    monkeypatch.setenv("BALCLI_CONFIG", str(folder / "other.toml"))
    assert imperial()
    monkeypatch.setenv("BALCLI_CONFIG", "nowhere.toml")
    assert refusal("layouts") == "nowhere.toml: cannot be read (No such file or directory)"


def test_the_format_where_nothing_else_says_one(folder, monkeypatch):
    monkeypatch.setenv("BALCLI_FORMAT", "csv")
    assert run_here(*ASKED).out.startswith("engine,cylinder,")
    assert "Free force by order" in run_here(*ASKED, "-f", "table").out
    run_here(*ASKED, "-o", "x.json")
    assert json.loads(Path("x.json").read_text())["format"] == "balcli.analysis/1"
    run_here(*ASKED, "-o", "plain")
    assert Path("plain").read_text().startswith("engine,cylinder,")
    swept = run_here("sweep", ASKED[1], "--vary", "rod.ratio=0.3", "--quantity", "force.2.major")
    assert swept.out.startswith("rod.ratio,force.2.major\n")


def test_digits_of_tables_and_json_that_nothing_changes(folder, monkeypatch):
    usual = run_here(*ASKED, "-f", "json").out
    monkeypatch.setenv("BALCLI_UNITS", "imperial")
    monkeypatch.setenv("BALCLI_DIGITS", "8")
    assert run_here(*ASKED, "-f", "json").out == usual
    monkeypatch.setenv("BALCLI_UNITS", "si")
    largest = json.loads(usual)["orders"][0]["force_N"]["major"] / 1000
    for options, digits in (((), 8), (("--digits", "3"), 3)):
        assert f" {largest:.{digits}g} " in run_here(*ASKED, *options).out
        assert f" {largest:.{digits}g} " in run_here(*options, *ASKED).out
    monkeypatch.delenv("BALCLI_DIGITS")
    assert f" {largest:.5g} " in run_here(*ASKED).out


@pytest.mark.parametrize("digits", [3, 7, 15])
def test_digits_of_what_is_told_in_brief(folder, digits):
    """The short table, verdict and peaks have as many as are asked for; a speed is as given."""
    asked = ("analyze", ENGINES / "i3.toml", "--speed", "4321.5")
    result = ask_json(*asked)
    moment = result["orders"][1]["moment_Nm"]
    parts = [abs(complex(*moment[side])) for side in ("forward", "backward")]
    brief = run_here(*asked, "--digits", digits).out
    cells = next(line for line in brief.splitlines() if line.startswith("2 ")).split()
    assert cells[2:] == [f"{size:.{digits}g}" for size in (moment["major"], *parts)]
    assert f"moment of up to {moment['major']:.{digits}g} N·m" in brief
    peak = result["peak"]["moment_Nm"]
    assert f"moment      {peak:.{digits}g} N·m" in brief or digits == 3  # no fewer than before the point
    assert "4321.5 rpm" in brief


def test_every_mistake_of_a_file_is_told_by_its_path(folder):
    file = folder / "balcli.toml"
    file.write_text('unit = "si"\nformat = "xml"\ndigits = "4"\nunits = 7\ncolour = 1')
    assert refusal("layouts") == (
        f"{file}: 5 mistakes\n"
        "  unit: unknown key; did you mean units?\n"
        '  format: "xml": choose from table, json, csv, markdown\n'
        '  digits: "4": give a whole number from 1 to 15\n'
        "  units: 7: choose from si, imperial\n"
        "  colour: unknown key; there are units, format, digits"
    )
    file.write_text("units = ")
    assert refusal("layouts").startswith(f"{file}: is not valid TOML: Invalid value")
    file.unlink()
    project = folder / "pyproject.toml"
    project.write_text('[tool.balcli]\nunits = "metric"')
    assert refusal("layouts") == (f'{project}: tool.balcli.units: "metric": choose from si, imperial')


@pytest.mark.parametrize(
    ("variable", "value", "told"),
    [
        ("BALCLI_UNITS", "metric", '"metric": choose from si, imperial'),
        ("BALCLI_FORMAT", "xml", '"xml": choose from table, json, csv, markdown'),
        ("BALCLI_DIGITS", "0", "0: give a whole number from 1 to 15"),
        ("BALCLI_DIGITS", "9" * 5000, f'"{"9" * 59}: give a whole number from 1 to 15'),
        ("BALCLI_DIGITS", "many", '"many": give a whole number from 1 to 15'),
    ],
)
def test_a_variable_that_says_nothing_right(folder, monkeypatch, variable, value, told):
    monkeypatch.setenv(variable, value)
    assert refusal("layouts") == f"{variable}: {told}"


def test_a_file_that_nobody_could_read_whole(folder, monkeypatch):
    file = folder / "balcli.toml"
    file.write_text("a = " + "[" * 5000)
    assert refusal("layouts").startswith(f"{file}: lists or tables are nested too deeply")
    file.write_bytes(b'units = "\xff"')
    assert refusal("layouts") == f"{file}: is not UTF-8 text (line 1); save it as UTF-8"
    if Path("/dev/zero").exists():
        monkeypatch.setenv("BALCLI_CONFIG", "/dev/zero")
        assert refusal("layouts").startswith("/dev/zero: has more than 6 MB")


def test_help_and_commands_without_defaults_do_not_need_a_right_file(folder):
    file = folder / "balcli.toml"
    file.write_text('unit = "si"')
    told = f"{file}: unit: unknown key; did you mean units?"
    assert refusal("analyze", ASKED[1]) == told
    for args in (("analyze", "--help"), ("tables", "-h"), ("schema",), ("new", "inline")):
        status, out, err = run_here(*args)
        assert (status, err) == (0, f"warning: {told}\n")
        assert out


def test_which_commands_have_no_defaults():
    commands = {name: get_command(app).get_command(None, name) for name in COMMANDS}
    words = {name: {word for p in one.params for word in p.opts} for name, one in commands.items()}
    taking = {"--format", "--units", "--digits"}
    assert {name for name in COMMANDS if not words[name] & taking} == {*WITHOUT_DEFAULTS}


def test_every_way_to_write_the_table_in_a_project(folder):
    project = folder / "pyproject.toml"
    for text in (
        '[tool]\nbalcli = {units = "imperial"}',
        '[tool.balcli]\nunits = "imperial"',
        '[ tool . "balcli" ]\nunits = "imperial"',
        'tool.balcli.units = "imperial"',
    ):
        project.write_text(text)
        assert imperial(), text
    for text in ('tool = "balcli"', 'project.dependencies = ["balcli"]'):
        project.write_text(text)
        assert not imperial(), text


def test_short_names_of_formats(folder, monkeypatch):
    monkeypatch.setenv("BALCLI_FORMAT", "MD")
    assert run_here(*ASKED).out == run_here(*ASKED, "-f", "markdown").out
    monkeypatch.delenv("BALCLI_FORMAT")
    (folder / "balcli.toml").write_text('format = "md"')
    assert run_here(*ASKED).out == run_here(*ASKED, "-f", "markdown").out


def test_verbose_says_what_came_from_where(folder, monkeypatch):
    (folder / "balcli.toml").write_text("digits = 4")
    monkeypatch.setenv("BALCLI_UNITS", "si")
    told = run_here(*ASKED, "-v").err.splitlines()
    assert f"note: {folder / 'balcli.toml'}: digits = 4" in told
    assert "note: BALCLI_UNITS: units = si" in told
