"""Units and digits by environment variables."""

import json
from collections.abc import Iterator

import pytest
from support.commands import ask_json, run_here
from support.paths import ENGINES

from balcli.show.sheet import set_digits

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
