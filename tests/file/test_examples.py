"""The shipped examples: all are listed, each is the file of the repository, and a wheel has them."""

import re
import subprocess
import sys
import tomllib
import zipfile

import pytest
from support.commands import ask, refusal, run_command
from support.paths import ENGINE_FILES, ENGINES, GEARED_FILES, ROOT

from balcli.errors import BalcliError
from balcli.file import examples

EVERY = [*ENGINE_FILES, *GEARED_FILES]


def test_every_engine_is_listed_with_its_lesson():
    lines = ask("engines").splitlines()
    listed = {line.split("  ")[0]: line.split("  ")[-1].strip() for line in lines if "  " in line}
    lessons = {file.stem: file.read_text(encoding="utf-8").splitlines()[0] for file in EVERY}
    assert len(lessons) == len(EVERY), "two engines of one name"
    assert {name: f"# {lesson}" for name, lesson in listed.items()} == lessons
    assert max(map(len, lines)) <= 80


def test_every_engine_says_where_its_figures_come_from():
    """And which are assumed, or that all are."""
    sources = {path.stem: tomllib.loads(path.read_text(encoding="utf-8"))["source"] for path in EVERY}
    silent = {name: text for name, text in sources.items() if not re.search("assumed|made up|own figures", text)}
    assert silent == {}


def test_a_copy_is_the_file(tmp_path):
    original = (ENGINES / "v8_crossplane.toml").read_text(encoding="utf-8")
    target = tmp_path / "mine.toml"
    assert ask("engines", "v8_crossplane") == original
    assert ask("engines", "v8_crossplane", target) == ""
    assert target.read_text(encoding="utf-8") == original
    assert refusal("engines", "i4", target) == f"{target}: already exists; choose another name, or --force"
    assert ask("engines", "i4", target, "--force") == ""
    assert target.read_text(encoding="utf-8") == examples.text("i4")


def test_a_copy_of_geared_engines_comes_with_their_files(tmp_path):
    ask("engines", "napier_deltic", tmp_path / "mine.toml")
    assert ask("analyze", tmp_path / "mine.toml") == ask("analyze", ENGINES / "geared/napier_deltic.toml")
    assert refusal("engines", "napier_deltic", tmp_path / "other.toml")


@pytest.mark.parametrize("name", ["v8crossplane", "../engines/i4", "expected"])
def test_unknown_names(name):
    told = f'^there is no example "{name}": (balcli engines lists all examples|did you mean v8_crossplane)'
    with pytest.raises(BalcliError, match=told):
        examples.text(name)


@pytest.mark.stress
def test_a_wheel_has_the_examples_and_the_page(tmp_path):
    pytest.importorskip("hatchling", reason="hatchling, which builds the wheel, is not installed")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as content:
        inside = content.namelist()
        shipped = {f"balcli/engines/{p.relative_to(ENGINES).as_posix()}" for p in EVERY}
        assert shipped <= set(inside)
        assets = (ROOT / "src" / "balcli" / "report" / "assets").iterdir()
        assert {f"balcli/report/assets/{asset.name}" for asset in assets} <= set(inside)
        content.extractall(tmp_path / "installed")
    listed = run_command("engines", env={"PYTHONPATH": str(tmp_path / "installed")}).stdout
    assert listed == ask("engines")
