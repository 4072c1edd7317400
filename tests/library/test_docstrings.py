"""What `help` says of the public functions: an example that runs, what goes in, what is wrong."""

from __future__ import annotations

import dataclasses
import inspect
import re
import shutil
import sys

import pytest
from support.paths import ENGINES
from support.rotors import three_runs

import balcli

FUNCTIONS = [name for name in balcli.__all__ if inspect.isfunction(getattr(balcli, name))]
METHODS = {"Engine.vary": balcli.Engine.vary}
TOLD = {name: getattr(balcli, name) for name in FUNCTIONS} | METHODS
NAMES = {"v8": "v8_crossplane"}


@pytest.mark.parametrize("name", TOLD)
def test_the_example_runs(name, tmp_path, monkeypatch):
    """As it stands, beside files of these names."""
    for file in ("v8", "i3", "i4", "i6", "i4_mounts", "i4_wiebe", "i6_diesel"):
        shutil.copy(ENGINES / f"{NAMES.get(file, file)}.toml", tmp_path / f"{file}.toml")
    (tmp_path / "fan.toml").write_text(three_runs())
    monkeypatch.chdir(tmp_path)
    lines = re.findall(r"^ *>>> (.*)$", TOLD[name].__doc__, re.MULTILINE)
    assert lines
    names = {each: getattr(balcli, each) for each in balcli.__all__}
    if not any("load" in line for line in lines):
        names["engine"] = balcli.load("v8.toml")
    for line in lines:
        exec(line, names)


@pytest.mark.parametrize("name", TOLD)
def test_every_parameter_and_error_is_told(name):
    text = inspect.getdoc(TOLD[name])
    parameters = [p for p in inspect.signature(TOLD[name]).parameters if p != "self"]
    args = text.partition("Args:")[2].partition("\n\n")[0]
    assert [p for p in parameters if not re.search(rf"\b{p}\b", args)] == []
    assert "Raises:" in text
    assert "Error: " in text.partition("Raises:")[2]


def list_fields(shown):
    if dataclasses.is_dataclass(shown):
        return [field.name for field in dataclasses.fields(shown)]
    return list(getattr(shown, "_fields", ()))


RECORDS = [name for name in balcli.__all__ if list_fields(getattr(balcli, name))]


@pytest.mark.parametrize("name", RECORDS)
def test_every_attribute_is_told_on_a_line_of_its_own(name):
    """The reference in Python takes what stands before the colon for one name."""
    shown = getattr(balcli, name)
    told = inspect.getdoc(shown).partition("Attributes:")[2]
    named = re.findall(r"^ {4}(\S[^:]*):", told, re.MULTILINE)
    assert sorted(named) == sorted(list_fields(shown))


@pytest.mark.parametrize("name", [name for name in balcli.__all__ if name[0] != "_"])
def test_no_name_of_our_own_stands_for_what_it_means(name):
    """A constant, or a function that is not promised, says nothing to who asks for help."""
    shown = getattr(balcli, name)
    inside = vars(sys.modules[inspect.unwrap(shown).__module__]).keys() - set(balcli.__all__)
    told = inspect.getdoc(shown)
    quoted = {word.rpartition(".")[2] for word in re.findall(r"`([\w.]+)`", told)}
    own = inside & (quoted | set(re.findall(r"[A-Z_]{3,}", told)))
    assert own == set()
