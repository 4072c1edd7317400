"""What `help` says of the public functions: an example that runs, what goes in, what is wrong."""

import inspect
import re
import shutil

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
