"""README and docs/ cannot go stale: their commands are run, and what they show is what comes out.

In a ```console block a line that begins with `$ ` is a command, run by a shell in a copy of engines/ (one copy for the whole
file, so that later commands find what earlier ones wrote); the lines up to the next command are its whole output, where a
line of only `…` stands for any lines. A command without lines below it is only run. Python examples are run as they stand.
"""
from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
OMITTED = "…"


@dataclass
class Example:
    """A command of a page, and what the page shows below it."""

    page: Path
    line: int
    command: str
    shown: list[str]

    def __str__(self) -> str:
        return f"{self.page.name}:{self.line}"


def examples(page: Path) -> list[Example]:
    """All commands of a page, in order."""
    text, found = page.read_text(encoding="utf-8"), []
    for block in BLOCK.finditer(text):
        if block[1] == "console":
            start = text.count("\n", 0, block.start(2)) + 1
            for number, line in enumerate(block[2].splitlines(), start):
                if line.startswith("$ "):
                    found.append(Example(page, number, line[2:], []))
                elif found:
                    found[-1].shown.append(line.rstrip())
    return found


def fits(shown: list[str], printed: list[str]) -> bool:
    """Whether an output is the one shown, where a line of only `…` stands for any lines."""
    pattern = "".join(r"(?:.*\n)*?" if line.strip() == OMITTED else re.escape(line) + "\n" for line in shown)
    return re.fullmatch(pattern, "".join(f"{line.rstrip()}\n" for line in printed)) is not None


EXAMPLES = [example for page in PAGES for example in examples(page)]


@pytest.fixture(scope="module")
def outputs(tmp_path_factory) -> dict[str, subprocess.CompletedProcess[str]]:
    """What every command of every page says, run in order, each page in a folder of its own."""
    done = {}
    for page in PAGES:
        folder = tmp_path_factory.mktemp(page.stem)
        shutil.copytree(ROOT / "engines", folder / "engines")
        for example in examples(page):
            done[str(example)] = subprocess.run(
                ["bash", "-c", example.command], cwd=folder, env=environment(folder), text=True, encoding="utf-8", check=False,
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120)
    return done


def environment(folder: Path) -> dict[str, str]:
    """One in which `balcli` is this program."""
    program = folder.parent / "bin" / "balcli"
    program.parent.mkdir(exist_ok=True)
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m balcli "$@"\n')
    program.chmod(0o755)
    return {**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}", "PYTHONPATH": str(ROOT / "src"), "PYTHONWARNINGS": "error"}


@pytest.mark.parametrize("example", EXAMPLES, ids=str)
def test_what_a_page_shows_is_what_comes_out(example, outputs):
    done = outputs[str(example)]
    allowed = {0, 1} if "check" in example.command else {0}
    assert done.returncode in allowed, done.stdout
    if example.shown:
        assert fits(example.shown, done.stdout.splitlines()), f"$ {example.command}\n{done.stdout}"


def test_the_readme_shows_output():
    """Not only commands: at least one of its examples pins figures."""
    shown = [line for example in examples(PAGES[0]) for line in example.shown if re.search(r"\d", line)]
    assert len(shown) > 5


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_python_examples_run(page, tmp_path, monkeypatch):
    shutil.copytree(ROOT / "engines", tmp_path / "engines")
    monkeypatch.chdir(tmp_path)
    for block in BLOCK.finditer(page.read_text(encoding="utf-8")):
        if block[1] == "python":
            exec(compile(block[2], page.name, "exec"), {"__name__": "example"})


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    links = re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8"))
    assert [link for link in links if not link.startswith("http") and not (page.parent / link).exists()] == []


@pytest.mark.parametrize(("shown", "printed", "same"), [
    (["a", "b"], ["a", "b"], True), (["a"], ["a", "b"], False), (["a", "…"], ["a", "b", "c"], True), (["…", "c"], ["a", "b", "c"], True),
    (["a", "…", "c"], ["a", "c"], True), (["a", "…", "d"], ["a", "b", "c"], False), (["…"], [], True), (["a  b"], ["a b"], False)])
def test_how_output_is_compared(shown, printed, same):
    assert fits(shown, printed) is same
