"""The shipped examples: all are listed, each is the file of the repository, and a wheel has
them.
"""

from __future__ import annotations

import subprocess
import sys
import zipfile

import pytest
from support.commands import run_command
from support.paths import ENGINES, ROOT

from balcli.enginefile import examples
from balcli.errors import BalcliError


def test_every_engine_is_listed_by_name():
    listed = [line.split("  ")[0].strip() for line in run_command("engines").stdout.splitlines()]
    assert listed == sorted(path.stem for path in ENGINES.glob("*.toml"))
    assert all(examples.names().values())


def test_a_copy_is_the_file(tmp_path):
    original = (ENGINES / "v8_crossplane.toml").read_text(encoding="utf-8")
    assert run_command("engines", "v8_crossplane").stdout == original
    target = tmp_path / "mine.toml"
    assert run_command("engines", "v8_crossplane", target).returncode == 0
    assert target.read_text(encoding="utf-8") == original
    again = run_command("engines", "i4", target)
    assert (again.returncode, again.stderr) == (
        2,
        f"balcli: {target}: already exists; choose another name, or --force to overwrite it\n",
    )
    assert run_command("engines", "i4", target, "--force").returncode == 0
    assert target.read_text(encoding="utf-8") == examples.text("i4")


@pytest.mark.parametrize("name", ["v8crossplane", "../engines/i4", "expected"])
def test_unknown_names(name):
    with pytest.raises(
        BalcliError, match=f'^there is no example "{name}": balcli engines lists them'
    ):
        examples.text(name)


def test_a_misspelt_name_gets_a_hint():
    with pytest.raises(BalcliError, match=r"Did you mean v8_crossplane"):
        examples.text("v8_crosplane")


@pytest.mark.stress
def test_a_wheel_has_the_examples_and_the_page(tmp_path):
    pytest.importorskip("hatchling", reason="hatchling, which builds the wheel, is not installed")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as content:
        inside = content.namelist()
        assert {f"balcli/engines/{path.name}" for path in ENGINES.glob("*.toml")} <= set(inside)
        assert {f"balcli/render/page/report.{end}" for end in ("html", "css", "js")} <= set(inside)
        content.extractall(tmp_path / "installed")
    listed = run_command("engines", env={"PYTHONPATH": str(tmp_path / "installed")}).stdout
    assert listed == run_command("engines").stdout


def test_an_installation_without_them_says_so(monkeypatch, tmp_path):
    monkeypatch.setattr(examples, "_PLACES", (tmp_path / "engines",))
    with pytest.raises(
        BalcliError,
        match=r"the example engines are missing from this installation .*: install balcli again",
    ):
        examples.names()
