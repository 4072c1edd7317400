"""Amounts on the command line have the units of the file, one reader for all options."""

from __future__ import annotations

import json

import pytest
from support.cases import cases
from support.commands import refusal, run_here
from support.paths import ENGINES, PACKAGE

from balcli.commands.amounts import as_bare_angles, read_share
from balcli.errors import BalcliError

V8 = ENGINES / "v8_crossplane.toml"
IMPERIAL = ("--units", "imperial")
FACTOR = ("balance", V8, "--scheme", "factor")
WEIGHTS = ("balance", V8, "--scheme", "counterweights")
SHAFT = ("balance", V8, "--scheme", "two-shaft", "--order", 4)
GUIDE = ("analyze", V8, "--only", "guide")
SUM = ("sum", V8, V8)
MOUNTS = PACKAGE / "enginefile" / "starting_files" / "mounts.toml"
CURVES = ("curves", V8, "--format", "json")


@cases(
    "commands/amounts",
    "a_figure_with_its_unit_is_the_bare_one",
    CURVES=CURVES,
    FACTOR=FACTOR,
    GUIDE=GUIDE,
    SHAFT=SHAFT,
    SUM=SUM,
    WEIGHTS=WEIGHTS,
)
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


@cases(
    "commands/amounts",
    "with_imperial_units_a_bare_length_or_mass_asks_for_its_unit",
    GUIDE=GUIDE,
    SHAFT=SHAFT,
    WEIGHTS=WEIGHTS,
)
def test_with_imperial_units_a_bare_length_or_mass_asks_for_its_unit(command, option, text, message):
    told = refusal(*command, option, text, *IMPERIAL)
    assert told == f'{option} "{text}": with --units imperial {message}'


@pytest.mark.parametrize(
    ("command", "options", "first"),
    [
        (WEIGHTS, ["--planes=-10,12"], '--planes "-10"'),
        (SHAFT, ["--at=0,3"], '--at "3"'),
        (SUM, ["--at", "0,20,0"], '--at "20"'),
    ],
)
def test_so_do_bare_places(command, options, first):
    told = refusal(*command, *options, *IMPERIAL)
    assert told.startswith(f"{first}: with --units imperial a length needs its unit: ")


def test_speeds_angles_and_nothing_need_no_unit_there():
    options = ("--speed", "6000", "--planes", "0", *IMPERIAL)
    assert run_here(*WEIGHTS, *options).status == 0
    assert run_here(*SUM, "--phase", "90", "--at", "0,0,0", *IMPERIAL).status == 0


@cases(
    "commands/amounts",
    "what_is_no_amount_is_told_with_its_option",
    CURVES=CURVES,
    FACTOR=FACTOR,
    SHAFT=SHAFT,
    SUM=SUM,
    WEIGHTS=WEIGHTS,
)
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
    told = run_here("balance", ENGINES / "i4.toml", "--factor", "50%", "--planes=-40,5,40,5")
    assert (told.status, told.err) == (
        0,
        'warning: --planes "-40,5,40,5": names a place twice; decimals take a point, not a comma\n',
    )
    assert run_here("balance", ENGINES / "i4.toml", "--factor", "50%", "--planes=-40,0,40").err == ""


@pytest.mark.parametrize(
    ("asked", "doubted"),
    [([], True), (["--only", "force"], True), (["--only", "force,guide"], False), (["--all"], False)],
)
def test_a_guide_height_where_no_guides_are_asked_for(asked, doubted):
    status, _, err = run_here("analyze", ENGINES / "i4.toml", "--guide-height", "300", *asked)
    assert (status, err.startswith("warning: --guide-height changes")) == (0, doubted)


@cases("commands/amounts", "bare_metres_are_asked_back")
def test_bare_metres_are_asked_back(options, told):
    result = run_here("balance", ENGINES / "i4.toml", "--factor", "50%", *options)
    assert result.status == 0
    assert result.err == (f"warning: {told}\n" if told else "")


@cases("commands/amounts", "speeds_with_the_thousands_parted_are_asked_back")
def test_speeds_with_the_thousands_parted_are_asked_back(text, meant):
    result = run_here("analyze", V8, "--only", "force", "--speed", text)
    told = f'--speed "{text}": a point parts decimals and a comma speeds, not thousands'
    assert result.status == 0
    assert result.err == (f"warning: {told}: was {meant} rpm meant?\n" if meant else "")


def test_no_speed_is_too_slow_to_be_told_so():
    told = refusal("analyze", V8, "--speed", "1e-300")
    assert told == "--speed 1e-300: the crank speed must be a positive number of rpm, below 1e9"
