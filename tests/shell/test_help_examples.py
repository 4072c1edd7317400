"""Help and completion of every command; the examples in the help run as they stand."""

import shlex
import shutil
from pathlib import Path

import pytest
from support.commands import run_here, run_python
from support.paths import ENGINES

from balcli.cli import COMMANDS
from balcli.file.examples import template

FILES = {
    **{f"{name}.toml": f"{name}.toml" for name in ("i4", "vr6", "v8_wiebe", "i4_mounts", "i6_diesel")},
    "v8.toml": "v8_crossplane.toml",
    "twin.toml": "vtwin90.toml",
    "s50.toml": "marine/marine6.toml",
    "locomotive2.toml": "historic/locomotive2.toml",
}


def examples(command: str) -> list[str]:
    lines = run_here(command, "--help").out.splitlines()
    return [line.strip() for line in lines if line.strip().startswith("balcli ")]


def test_the_help_of_every_command() -> None:
    """It has an example, can be quiet and verbose, and in a pipe is plain."""
    for command in COMMANDS:
        text = run_here(command, "--help").out
        assert f"Usage: balcli {command}" in text
        assert "Example" in text
        assert examples(command)
        words = text.split()
        assert {"--quiet", "--verbose", "-v,"} <= {*words}
        assert words.count("-q,") == 1, "of the program, or of the command"
        assert not {*"│╭─┃\x1b"} & {*text}


# `bench` takes seconds; what else is left out has tests of its own
@pytest.mark.parametrize("command", [name for name in COMMANDS if name not in ("bench", "balance")])
@pytest.mark.stress
def test_the_examples_run(command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name, source in FILES.items():
        shutil.copy(ENGINES / source, name)
    Path("engines").mkdir()
    shutil.copy("v8.toml", "engines")
    Path("runs.toml").write_text(template("field"), encoding="utf-8")
    for line in examples(command):
        if ".parquet" in line:
            pytest.importorskip("pyarrow")
        status, _, err = run_here(*shlex.split(line)[1:])
        assert (line, status, err) == (line, 0, err)


OFFERED = {
    "": {*COMMANDS},
    "ana": {"analyze"},
    "balance --scheme k": {"knuckles"},
    "tables liu-": {"liu-1", "liu-2", "liu-3", "liu-statements"},
    "engines vtwin": {"vtwin45", "vtwin90"},
}


def ask_as_bash(typed: str) -> dict[str, str]:
    """What bash puts into the environment to ask for words."""
    asked = {"_BALCLI_COMPLETE": "complete_bash", "COMP_WORDS": f"balcli {typed}"}
    return asked | {"COMP_CWORD": str(typed.count(" ") + 1)}


@pytest.mark.parametrize("typed", OFFERED)
def test_tab_offers(typed: str, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in ask_as_bash(typed).items():
        monkeypatch.setenv(name, value)
    done = run_here()
    assert ({*done.out.split()}, done.err) == (OFFERED[typed], "")


def test_tab_offers_in_a_process_of_its_own() -> None:
    done = run_python("-m", "balcli", env=ask_as_bash("tables liu-"))
    assert ({*done.stdout.split()}, done.stderr) == (OFFERED["tables liu-"], "")
