"""Reading engine files: every mistake at once, by its path, in words; nothing that a file holds can do harm."""

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
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"[1, 2]")))
    with pytest.raises(InputError, match=r"^standard input: is not an engine file"):
        read("-")


@cases("engine/load", "one_mistake", ANGLE=ANGLE, GOOD=GOOD, LENGTH=LENGTH, WHOLE=WHOLE)
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
        == f"""4 mistakes
  piston.bor: unknown key in [piston]; did you mean bore?
  crank.stroke: -90 is not above 0; {LENGTH}, above 0
  rod.mass: "heavy" is not a number followed by a unit; {MASS}
  shaft.1.ratio: is missing; give it, such as ratio = -2"""
    )


def test_files_that_would_take_too_much():
    nested = "lists or tables are nested too deeply; an engine file needs no more than four levels"
    for text in ("x = " + "[" * 100_000 + "]" * 100_000, "a." * 100_000 + "b = 1", "[" + '"a" . ' * 100_000 + "b]"):
        assert mistakes_in(text) == nested, text[:9]
    assert mistakes_in("#" * (LARGEST_FILE_BYTES + 1)) == "has more than 6 MB; no engine file needs that"
    devices = GOOD + "[[shaft]]\nratio = 1\nunbalance = 1\n" * 1001
    assert mistakes_in(devices) == "shaft: is given 1001 times; at most 1000 are read"
    flood = changed(("[0, 180, 180, 0]", "[" + "[]," * 20_000 + "]"))
    assert mistakes_in(flood).startswith("10000 mistakes")
    for digits in ("9" * 5000, "9_9" * 4000, "-" + "9" * 4400):
        assert mistakes_in(changed(("stroke = 90", f"stroke = {digits}"))) == "has a number with thousands of digits"


def test_what_is_no_text():
    last = GOOD.count("\n") + 1
    assert mistakes_in(GOOD.encode() + b"# \xff\n") == f"is not UTF-8 text (line {last}); save it as UTF-8"
    assert mistakes_in(b"\0" * 9).startswith("is not an engine file, which is TOML text with tables such as [crank]")


def test_messages_carry_no_control_characters():
    text = changed(("stroke = 90", '"st\\u001b[31mroke" = "9\\n0"\nstroke = "\\u001b]0;x"'))
    assert (
        mistakes_in(text)
        == f"""2 mistakes
  crank.st?[31mroke: unknown key in [crank]; did you mean stroke?
  crank.stroke: "?]0;x" is not a number followed by a unit; {LENGTH}"""
    )


def test_what_cannot_be_read(tmp_path):
    missing = tmp_path / "none.toml"
    folder = tmp_path
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
