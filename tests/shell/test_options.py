"""Options that several commands share: orders, formats, units, digits, and how much is said beside results."""

import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.cases import cases
from support.commands import ask_json, run_here
from support.paths import ENGINES

from balcli.shell.options import parse_orders
from balcli.show.sheet import order_name, set_digits
from balcli.torsional_vibration.answer import parse_half_orders


@cases("shell/options", "a_range_that_begins_or_ends_with_a_half_goes_in_halves")
def test_a_range_that_begins_or_ends_with_a_half_goes_in_halves(text, orders):
    assert parse_orders(text) == parse_half_orders(text).tolist() == orders


@pytest.mark.parametrize(("order", "name"), [(0, "0"), (0.5, "½"), (1, "1"), (1.5, "1½"), (12.5, "12½")])
def test_what_tables_call_an_order(order, name):
    assert order_name(order) == name


@pytest.mark.parametrize("name", ["md", "MD", "Markdown"])
def test_a_format_has_a_short_name_and_any_case(balcli, name):
    assert balcli("layouts", "-f", name) == balcli("layouts", "--format", "markdown")


@pytest.mark.parametrize("name", ["txt", "text", "Table"])
def test_a_table_is_a_text(balcli, name):
    assert balcli("balance", ENGINES / "i4.toml", "-f", name) == balcli("balance", ENGINES / "i4.toml")


@cases("shell/options", "what_is_no_format_is_told_with_those_that_are")
def test_what_is_no_format_is_told_with_those_that_are(balcli, command, known):
    status, out, err = balcli(command, ENGINES / "i4.toml", "-f", "xml")
    assert (status, out) == (2, "")
    assert f"'xml' is not one of {known}." in err


# ------------------------------------------------------------------ units and digits, by variables too
ASKED = ("analyze", ENGINES / "i4.toml", "--only", "force", "--orders", "2")


@pytest.fixture(autouse=True)
def usual_digits() -> Iterator[None]:
    yield
    set_digits(None)


def test_an_option_comes_before_its_variable(monkeypatch):
    def imperial(*more: object) -> bool:
        return "lbf" in run_here(*ASKED, *more).out

    assert not imperial()
    monkeypatch.setenv("BALCLI_UNITS", "imperial")
    assert imperial()
    assert not imperial("--units", "si")


def test_digits_of_tables_and_json_that_nothing_changes(monkeypatch):
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
    assert f" {largest:.4g} " in run_here(*ASKED).out


@pytest.mark.parametrize("digits", [3, 7, 15])
def test_digits_of_what_is_told_in_brief(digits):
    """The short table, verdict and peaks have as many as are asked for; a speed is as given."""
    asked = ("analyze", ENGINES / "i3.toml", "--speed", "4321.5")
    result = ask_json(*asked)
    moment = result["orders"][1]["moment_Nm"]
    parts = [abs(complex(*moment[side])) for side in ("forward", "backward")]
    brief = run_here(*asked, "--digits", digits).out
    cells = next(line for line in brief.splitlines() if line.startswith("2 ")).split()
    assert cells[2:] == [f"{size:.{digits}g}" for size in (moment["major"], *parts)]
    assert f"moment of {moment['major']:.{digits}g} N·m" in brief
    peak = result["peak"]["moment_Nm"]
    assert f"moment       {peak:.{digits}g} N·m" in brief or digits == 3  # no fewer than before the point
    assert "4321.5 rpm" in brief


@pytest.mark.parametrize(("option", "value"), [("units", "metric"), ("digits", "0")])
def test_a_wrong_variable_is_refused(monkeypatch, option, value):
    monkeypatch.setenv(f"BALCLI_{option.upper()}", value)
    status, out, err = run_here(*ASKED)
    assert (status, out) == (2, "")
    assert f"Invalid value for '--{option}'" in err


# ------------------------------------------------------------------ -q and -v
LONG_ROD = "crank.stroke = 90\nrod.length = 1600\npiston.mass = 0.5\n"
WARNING = (
    "warning: standard input: rod.length: crank radius / rod length is 0.02813, where 0.15 to 0.4 is usual; "
    "crank.stroke is twice the crank radius, rod.length the distance between its centres\n"
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
        "note: standard input: not in the file: operation.speed = 1000 rpm",
        "note: standard input: not in the file: crank.throw_mass = 0 kg",
        "note: standard input: not in the file: rod.mass = 0 kg",
        WARNING.strip(),
        f"note: {target}: written, {target.stat().st_size} bytes",
    ]
    assert re.fullmatch(r"note: \d+\.\d\d s of processor time, including the start of Python", took)
