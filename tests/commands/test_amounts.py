"""Amounts on the command line have the units of the file, one reader for all options."""

from __future__ import annotations

import json

import pytest
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


@pytest.mark.parametrize(
    ("command", "bare", "said"),
    [
        (WEIGHTS, ["--radius", "63.5"], ["--radius", "2.5 in"]),
        (WEIGHTS, ["--radius", "63.5", "--drill", "25.4"], ["--radius=2.5in", "--drill=1 in"]),
        (WEIGHTS, ["--thickness", "12.7"], ["--thickness", "1/2 in"]),
        (WEIGHTS, ["--disc", "100"], ["--disc", "0.1 m"]),
        (WEIGHTS, ["--planes=-254,304.8"], ["--planes=-10in,12 in"]),
        (SHAFT, ["--at=-50.8,76.2"], ["--at=-2in,3in"]),
        (SHAFT, ["--at=0,76.2"], ["--at=0,3in"]),
        (SHAFT, ["--position", "25.4"], ["--position", "1in"]),
        (WEIGHTS, ["--grade=16", "--mass=0.45359237"], ["--grade=16", "--mass=1 lb"]),
        (WEIGHTS, ["--speed", "6000"], ["--speed", "100 turn/s"]),
        (GUIDE, ["--guide-height", "2032"], ["--guide-height", "80 in"]),
        (SUM, ["--at", "0,508,0"], ["--at", "0,20in,0"]),
        (SUM, ["--phase", "90", "--turn", "30"], ["--phase", "1/4 turn", "--turn", "30 deg"]),
        (CURVES, ["--step", "45"], ["--step", "1/8 turn"]),
        (FACTOR, ["--factor", "0.51"], ["--factor", "51%"]),
        (FACTOR, ["--factor", "0.5:0.54:0.01"], ["--factor", "50%:54%:1%"]),
    ],
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


@pytest.mark.parametrize(
    ("command", "option", "text", "message"),
    [
        (WEIGHTS, "--radius", "2.5", 'a length needs its unit: "2.5 in" or "2.5 mm"'),
        (WEIGHTS, "--thickness", "1", 'a length needs its unit: "1 in" or "1 mm"'),
        (WEIGHTS, "--disc", "4", 'a length needs its unit: "4 in" or "4 mm"'),
        (WEIGHTS, "--drill", "1", 'a length needs its unit: "1 in" or "1 mm"'),
        (GUIDE, "--guide-height", "80", 'a length needs its unit: "80 in" or "80 mm"'),
        (SHAFT, "--position", "4", 'a length needs its unit: "4 in" or "4 mm"'),
        (WEIGHTS, "--mass", "60", 'a mass needs its unit: "60 lb" or "60 kg"'),
    ],
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


@pytest.mark.parametrize(
    ("command", "options", "message"),
    [
        (
            WEIGHTS,
            ["--radius", "2.5 kg"],
            '--radius "2.5 kg": is a mass, but a length is wanted: a bare number in mm, or "90 mm" or "3.5 in"',
        ),
        (
            WEIGHTS,
            ["--radius", "wide"],
            '--radius "wide": is not a number followed by a unit; a length is wanted: a bare '
            'number in mm, or "90 mm" or "3.5 in"',
        ),
        (
            WEIGHTS,
            ["--speed", "90 mm"],
            '--speed "90 mm": is a length, but a speed of rotation is wanted: a bare number in '
            'rpm, or "6000 rpm" or "300 rad/s"',
        ),
        (WEIGHTS, ["--planes=-10,12 in"], '--planes "-10,12 in": give every number its unit, or none'),
        (SHAFT, ["--at", "x,2"], '--at "x,2": give x,y of a shaft in mm, such as -40,60'),
        (SUM, ["--at", "x,2,3"], '--at "x,2,3": give three numbers, X,Y,Z in mm, such as 0,300,0'),
        (SHAFT, ["--at", "1in,2in,3in"], '--at "1in,2in,3in": give x,y of a shaft in mm, such as -40,60'),
        (
            CURVES,
            ["--step", "1 mm"],
            '--step "1 mm": is a length, but an angle is wanted: a bare number in deg, or "30 deg" '
            'or "1.2 rad" or "1/7 turn"',
        ),
        (
            FACTOR,
            ["--measured", "812 gramms of"],
            '--measured "812 gramms of": has the unknown unit "gramms"; did you mean gramme? a '
            'mass is wanted: a bare number in g, or "812 g" or "1.8 lb"',
        ),
        (FACTOR, ["--factor", "0,5"], '--factor "0,5": decimals take a point, such as 0.5'),
        (FACTOR, ["--factor", "51,5%"], '--factor "51,5%": decimals take a point, such as 51.5%'),
        (
            FACTOR,
            ["--factor", "51%%"],
            '--factor "51%%": give a share of the reciprocating mass such as 51% or 0.51, or a '
            "range such as 50%:54%:1%",
        ),
    ],
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


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--planes=-0.2,0.2"], '--planes "-0.2,0.2": bare lengths are mm; metres are said as in "0.2 m"'),
        (["--radius", "0.08"], '--radius "0.08": bare lengths are mm; metres are said as in "0.08 m"'),
        (["--planes=-0.2 m,0.2 m", "--radius", "0.08 m"], ""),
        (["--planes=0,0.5,100"], ""),
    ],
)  # fmt: skip
def test_bare_metres_are_asked_back(options, told):
    result = run_here("balance", ENGINES / "i4.toml", "--factor", "50%", *options)
    assert result.status == 0
    assert result.err == (f"warning: {told}\n" if told else "")


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("6.000", "6000"),
        ("12.500", "12500"),
        ("6,500", "6500"),
        ("1.000:6.000", "1000"),
        ("6000", ""),
        ("6.5,7.25", ""),
        ("90,120", ""),
        ("127.324", ""),
        ("100.000 rad/s", ""),
    ],
)
def test_speeds_with_the_thousands_parted_are_asked_back(text, meant):
    result = run_here("analyze", V8, "--only", "force", "--speed", text)
    told = f'--speed "{text}": a point parts decimals and a comma speeds, not thousands'
    assert result.status == 0
    assert result.err == (f"warning: {told}: was {meant} rpm meant?\n" if meant else "")


def test_no_speed_is_too_slow_to_be_told_so():
    told = refusal("analyze", V8, "--speed", "1e-300")
    assert told == "--speed 1e-300: the crank speed must be a positive number of rpm, below 1e9"
