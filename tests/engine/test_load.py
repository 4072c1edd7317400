"""Reading engine files: every mistake at once, by its path, in words; nothing that a file holds can
do harm.
"""

from __future__ import annotations

import io
import json
import re
import sys
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given, strategies as st
from support.cases import cases
from support.engines import GOOD, changed, mistakes_in

from balcli.engine.parse import parse, read
from balcli.errors import BalcliError, InputError
from balcli.limits import LARGEST_FILE_BYTES

LENGTH = 'a length is wanted: a bare number in mm, or "90 mm" or "3.5 in"'
ANGLE = 'an angle is wanted: a bare number in deg, or "30 deg" or "1.2 rad" or "1/7 turn"'
MASS = 'a mass is wanted: a bare number in kg, or "650 g" or "0.8 lb"'
WHOLE = "a whole number from 1 to 10000 is wanted"


def test_a_good_file(tmp_path):
    path = tmp_path / "good.toml"
    path.write_text(GOOD)
    assert read(path) == read(str(path))
    assert parse(GOOD) == parse(GOOD.encode()) == parse("\ufeff".encode() + GOOD.encode())
    assert [*read(path)] == [*parse(GOOD)]
    assert (read(path).folder, parse(GOOD).folder) == (tmp_path, Path())
    assert read(path).crank.throws == (0.0, 180.0, 180.0, 0.0)


def test_standard_input(monkeypatch):
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(GOOD.encode())))
    assert read("-") == parse(GOOD)
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"[crank")))
    with pytest.raises(InputError, match=r"^standard input: is not valid TOML"):
        read("-")


@cases("engine/load", "what_is_no_length", LENGTH=LENGTH)
def test_what_is_no_length(stroke, message):
    text = changed(("stroke = 90", f"stroke = {stroke}"))
    assert mistakes_in(text) == f"crank.stroke: {message}"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (changed(("cg = 45", "cg = -1e300")), f"rod.cg: -1e+300 is less than -1e+09; {LENGTH}, -1e+09 or more"),
        (changed(("stroke = 90\n", "")), "crank.stroke: is missing; give it, such as stroke = 90"),
        (changed(("stroke = 90", "strok = 90")), "crank.strok: unknown key in [crank]; did you mean stroke?"),
        (
            changed(("stroke = 90", "stroke = 90\nbore = 86")),
            "crank.bore: unknown key in [crank]; bore belongs to [piston]",
        ),
        (
            changed(("stroke = 90", "stroke = 90\nratios = 1")),
            "crank.ratios: unknown key in [crank]; ratio belongs to [rod]",
        ),
        (
            changed(("stroke = 90", "stroke = 90\nxyz = 1")),
            "crank.xyz: unknown key in [crank]; it has stroke, throws, spacing, positions, throw_mass, inertia, splay",
        ),
        (
            changed(("[piston]", "[pistons]\nmass = 0.5\n[piston]")),
            "pistons: unknown key in an engine file; did you mean piston?",
        ),
        ("stroke = 90\n" + GOOD, "stroke: unknown key in an engine file; stroke belongs to [crank]"),
        (
            changed(("[0, 180, 180, 0]", "180")),
            "crank.throws: 180 is not a list; write it in square brackets, such as [0, 180, 180, 0]",
        ),
        (
            changed(("[0, 180, 180, 0]", '[0, "half", 180, 0]')),
            f'crank.throws: the 2nd value "half" is not a number followed by a unit; {ANGLE}',
        ),
        (
            changed(("[0, 180, 180, 0]", "[]")),
            "crank.throws: is an empty list; give at least one value, or leave the key out",
        ),
        (
            changed(("[layout]", "[layout]\nnumbering = [[1, 2], [3, 4.5]]")),
            f"layout.numbering.2: the 2nd value 4.5 is not a whole number; {WHOLE}",
        ),
        (changed(("[layout]", "[layout]\nstrokes = 3")), "layout.strokes: 3 is not 2 or 4"),
        (changed(("[layout]", "[layout]\nstrokes = true")), "layout.strokes: true is not 2 or 4"),
        (
            changed(("[layout]", '[layout]\nrods = "alternate"')),
            'layout.rods: "alternate" is not "shared" or "alternating"; did you mean alternating?',
        ),
        (changed(("[layout]", "[layout]\nradial = 0")), f"layout.radial: 0 is out of range; {WHOLE}"),
        (changed(('"in-line four"', "4")), "name: 4 is not text; write it in quotes"),
        (
            "rod = 5\n[crank]\nstroke = 90\n[piston]\nmass = 1\n",
            "rod: 5 stands where a table belongs; write [rod] and its keys below it",
        ),
        (
            changed(("speed = 3000", "speed_ripple = [{ order = 1.25, amplitude = 0.01 }]")),
            "operation.speed_ripple.1.order: 1.25 is not a multiple of 1/2; a whole number or a "
            "half from 0.5 to 256 is wanted",
        ),
        (
            changed(("speed = 3000", "speed_ripple = [{ order = 1, amplitude = 2 }]")),
            "operation.speed_ripple.1.amplitude: 2 is more than 1; a plain number is wanted, without quotes, up to 1",
        ),
        (
            changed(("speed = 3000", "speed_ripple = [3]")),
            "operation.speed_ripple: the 1st value 3 is not a table; write it in braces with its keys",
        ),
        (
            changed(("speed = 3000", "speed_ripple = [{ order = 1, amplitud = 0.1 }]")),
            "operation.speed_ripple.1.amplitud: unknown key in [operation.speed_ripple]; did you mean amplitude?",
        ),
        (
            GOOD + "[frame]\nreference = [0, 0]\n",
            "frame.reference: [0, 0] has 2 values where 3 are wanted: x, y, z of the point about "
            "which all moments are taken",
        ),
        (
            GOOD + "[shaft]\nratio = 1\n",
            "shaft: is one of several; write [[shaft]] in double brackets, once for each shaft",
        ),
        (
            GOOD + "[[shaft]]\nratio = 1\nunbalance = 1\nat = [80]\n",
            "shaft.1.at: [80] has 1 value where 2 are wanted: x, y of the shaft",
        ),
        (GOOD + "[[slider]]\nunbalance = 1\ndirection = 0\n", "slider.1.order: is missing; give it, such as order = 2"),
        (
            GOOD + "[frame]\nreference = [1, inf, 0]\n",
            f"frame.reference: the 2nd value inf is no finite number; {LENGTH}",
        ),
        (
            changed(("firing_order = [1, 3, 4, 2]", "radial = 3"), more="[articulation]\nknuckle_radius = 50\n"),
            "articulation.rod: is missing; give it, such as rod = { length = 200 }",
        ),
        (changed(("length = 160", "lenght = 160")), "rod.lenght: unknown key in [rod]; did you mean length?"),
        (
            changed(("mass = 0.5\n", "pin = 0.1\nlocks = 0.004\n")),
            "piston: has pin and locks without piston and rings; give either mass or piston, pin, rings and locks",
        ),
        (
            changed(("mass = 0.5\n", "piston = 0.4\n")),
            "piston: has piston without pin, rings and locks; give either mass or piston, pin, rings and locks",
        ),
        (
            changed(("mass = 0.5\n", "mass = 0.5\npin = 0.1\n")),
            "piston: has mass and pin; give either mass or piston, pin, rings and locks",
        ),
        (
            changed(("mass = 0.5\n", "")),
            "piston: has neither mass nor piston, pin, rings and locks; give either mass or "
            "piston, pin, rings and locks",
        ),
        (
            GOOD + "[cylinder.x]\npiston_mass = 1\n",
            "cylinder.x: does not name a cylinder; write [cylinder.3] for what differs in cylinder 3",
        ),
        (
            GOOD + "[cylinder]\n3 = 5\n",
            "cylinder.3: 5 stands where a table belongs; write [cylinder.3] and its keys below it",
        ),
        (
            GOOD + "[cylinder.2]\npiston_mas = 1\n",
            "cylinder.2.piston_mas: unknown key in [cylinder]; did you mean piston_mass?",
        ),
    ],
)
def test_one_mistake(text, message):
    assert mistakes_in(text) == message


def test_all_mistakes_at_once():
    text = changed(
        ("stroke = 90", "stroke = -90"),
        ("mass = 0.6", 'mass = "heavy"'),
        ("bore = 86", "bor = 86"),
        ("length = 160", "length = 160\nratio = 0.3"),
        more="[[shaft]]\nunbalance = 1\n",
    )
    assert (
        mistakes_in(text)
        == f"""5 mistakes
  piston.bor: unknown key in [piston]; did you mean bore?
  crank.stroke: -90 is not above 0; {LENGTH}, above 0
  rod: has length and ratio; give either length or ratio
  rod.mass: "heavy" is not a number followed by a unit; {MASS}
  shaft.1.ratio: is missing; give it, such as ratio = -2"""
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "name = 'x'\n[crank]\nstroke = 90\nthrows = [0, 180\n[rod]\n",
            "is not valid TOML: Unclosed array (at line 5, column 1): [rod]",
        ),
        (
            "[crank]\nstroke = 90\nstroke = 91\n",
            "is not valid TOML: Cannot overwrite a value (at line 3, column 12): stroke = 91",
        ),
        (
            "[crank]\nstroke = 90\nstroke = 91",
            "is not valid TOML: Cannot overwrite a value (at end of document): stroke = 91",
        ),
        (GOOD.encode() + b"# \xff\n", f"is not UTF-8 text (line {GOOD.count(chr(10)) + 1}); save it as UTF-8"),
        (
            b"\0" * 9,
            "is not valid TOML: Invalid statement (at line 1, column 1)",
        ),
        (
            "x = " + "[" * 100_000 + "]" * 100_000,
            "lists or tables are nested too deeply; an engine file needs no more than four levels",
        ),
        (
            "a." * 100_000 + "b = 1",
            "lists or tables are nested too deeply; an engine file needs no more than four levels",
        ),
        (
            "[" + '"a" . ' * 100_000 + "b]",
            "lists or tables are nested too deeply; an engine file needs no more than four levels",
        ),
        ("#" * (LARGEST_FILE_BYTES + 1), "has more than 6 MB; no engine file needs that"),
    ],
    ids=[
        "syntax",
        "key twice",
        "key twice at the end",
        "not UTF-8",
        "zero bytes",
        "deep lists",
        "deep keys",
        "deep headers",
        "too large",
    ],
)
def test_broken_files(text, message):
    assert mistakes_in(text) == message


@pytest.mark.parametrize("digits", ["9" * 5000, "9_9" * 4000, "-" + "9" * 4400])
def test_numbers_of_thousands_of_digits_are_refused(digits):
    assert mistakes_in(changed(("stroke = 90", f"stroke = {digits}"))) == "has a number of thousands of digits"


def test_messages_carry_no_control_characters():
    text = changed(("stroke = 90", '"st\\u001b[31mroke" = "9\\n0"\nstroke = "\\u001b]0;x"'))
    assert (
        mistakes_in(text)
        == f"""2 mistakes
  crank.st?[31mroke: unknown key in [crank]; did you mean stroke?
  crank.stroke: "?]0;x" is not a number followed by a unit; {LENGTH}"""
    )


def test_more_devices_than_an_engine_can_have():
    text = GOOD + "[[shaft]]\nratio = 1\nunbalance = 1\n" * 1001
    assert mistakes_in(text) == "shaft: stands 1001 times; at most 1000 are taken"


def test_enormous_lists_are_refused_whole():
    """One by one, their mistakes would take gigabytes."""
    flood = changed(("[0, 180, 180, 0]", "[" + "[]," * 40_000 + "]"))
    assert mistakes_in(flood) == "crank.throws: holds 40001 values; no engine needs more than 20000"
    nested = changed(("[layout]", "[layout]\nnumbering = [" + f"[{'1,' * 300}]," * 300 + "]"))
    assert mistakes_in(nested) == "layout.numbering: holds 90301 values; no engine needs more than 20000"


def test_what_cannot_be_read(tmp_path):
    missing, folder = tmp_path / "none.toml", tmp_path
    for path, message in (
        (missing, f"{missing}: no such file"),
        (folder, f"{folder}: is a folder; name a file in it"),
        ("a\0b", "'a\\x00b': cannot be read (embedded null byte)"),
    ):
        with pytest.raises(BalcliError) as caught:
            read(path)
        assert str(caught.value) == message


VALUES = st.recursive(
    st.integers() | st.floats() | st.booleans() | st.text("ab 0.5/mminkg^", max_size=8),
    lambda inner: st.lists(inner, max_size=3),
)
KEYS = ("stroke", "throws", "spacing", "length", "mass", "bore", "firing_order", "speed")


@given(st.sampled_from(KEYS), VALUES)
def test_any_value_is_accepted_or_refused_by_its_key(key, value):
    text = re.sub(
        rf"^{key} = .*$",
        f"{key} = {json.dumps(value).replace('Infinity', 'inf').replace('NaN', 'nan')}",
        GOOD,
        flags=re.MULTILINE,
    )
    with suppress(InputError):
        parse(text)
        return
    assert key in mistakes_in(text)
