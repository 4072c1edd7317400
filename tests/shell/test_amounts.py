"""Amounts on the command line have the units of the file, one reader for all options."""

import json

import pytest
from support.cases import cases
from support.commands import refusal, run_here
from support.paths import ENGINES, PACKAGE

from balcli.errors import BalcliError
from balcli.shell.values import as_bare_angles, read_share

V8 = ENGINES / "v8_crossplane.toml"
IMPERIAL = ("--units", "imperial")
MOUNTS = PACKAGE / "file" / "starting_files" / "mounts.toml"
COMMANDS = {
    "CURVES": ("curves", V8, "--format", "json"),
    "FACTOR": ("balance", V8, "--scheme", "factor"),
    "GUIDE": ("analyze", V8, "--only", "guide"),
    "SHAFT": ("balance", V8, "--scheme", "two-shaft", "--order", 4),
    "SUM": ("sum", V8, V8),
    "WEIGHTS": ("balance", V8, "--scheme", "counterweights"),
}


@cases("shell/amounts", "a_figure_with_its_unit_is_the_bare_one", **COMMANDS)
def test_a_figure_with_its_unit_is_the_bare_one(command, bare, said):
    texts = [run_here(*command, *options, "-f", "json") for options in (bare, said)]
    assert [text.status for text in texts] == [0, 0], texts[1].err
    assert json.loads(texts[0].out) == json.loads(texts[1].out)


def test_speeds_of_a_range_have_units_too():
    bare = run_here("mounts", MOUNTS, "--speeds", "600:1200:300", "-f", "json")
    assert bare.status == 0
    assert bare == run_here("mounts", MOUNTS, "--speeds", "10turn/s:20turn/s:5turn/s", "-f", "json")
    assert refusal("mounts", MOUNTS, "--speeds", "1 mm:2 mm:1 mm").startswith(
        '--speeds "1 mm:2 mm:1 mm": give first:last:step in rpm'
    )


@cases("shell/amounts", "with_imperial_units_a_bare_length_or_mass_asks_for_its_unit", **COMMANDS)
def test_with_imperial_units_a_bare_length_or_mass_asks_for_its_unit(command, option, text, message):
    told = refusal(*command, option, text, *IMPERIAL)
    assert told == f'{option} "{text}": with --units imperial {message}'


@cases("shell/amounts", "what_is_no_amount_is_told_with_its_option", **COMMANDS)
def test_what_is_no_amount_is_told_with_its_option(command, options, message):
    assert refusal(*command, *options) == message


def test_angles_of_tables():
    assert as_bare_angles("--angle", "0:180:5") == "0:180:5"
    assert as_bare_angles("--angle", "0 deg:0.5 turn:5°,1e1") == "0:180:5,1e1"
    with pytest.raises(BalcliError, match='--angle "5 mm": is a length, but an angle is wanted'):
        as_bare_angles("--angle", "0:180:5 mm")
    travel = ("tables", "tsinghua-1-2", "--format", "csv", "--angle")
    assert run_here(*travel, "0:90:30") == run_here(*travel, "0:1/4turn:30deg")


def test_shares():
    assert read_share("--factor", "51 %", "a share") == 0.51
    with pytest.raises(BalcliError, match='--factor "nan": give a share'):
        read_share("--factor", "nan", "a share")


def test_a_place_that_is_named_twice_is_asked_back():
    """-40,5,40,5 was to be -40.5 and 40.5."""
    status, _, err = run_here("balance", ENGINES / "i4.toml", "--factor", "50%", "--planes=-40,5,40,5")
    warning = 'warning: --planes "-40,5,40,5": names a place twice; decimals take a point, not a comma\n'
    assert (status, err) == (0, warning)
    assert run_here("balance", ENGINES / "i4.toml", "--factor", "50%", "--planes=-40,0,40").err == ""
