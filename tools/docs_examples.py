"""What README.md and docs/**/*.md show, and how to run it.

In a ```console block a line that begins with `$ ` is a command, the lines below are all that it
prints, and a line `…` stands for any lines left out. A ```toml block whose first line is `#
NAME.toml` is written under that name; a ```python block is run, and what it prints is the ```text
block below. Everything in a document runs in one folder, top to bottom.

`python tools/docs_examples.py FILE.md…` writes what is printed now into the documents; lines that
stand between `…` are replaced by the ones most like them, so look at the difference before you
believe it.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import chdir, redirect_stderr, redirect_stdout
from difflib import SequenceMatcher
from io import StringIO
from itertools import groupby
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple
from unittest.mock import patch

ROOT = Path(__file__).resolve().parent.parent
DOCUMENTS = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
LEFT_OUT = "…"
WIDTH = patch.dict(os.environ, {"COLUMNS": "80"})
FUNCTION = (
    f'balcli() {{ "{sys.executable}" -m balcli "$@"; }}; python() {{ "{sys.executable}" "$@"; }}\n'
    'uvx() { "$@"; }\n'
)
ENVIRONMENT = os.environ | {
    "PYTHONPATH": str(ROOT / "src"),
    "NO_COLOR": "1",
    "COLUMNS": "80",
}


class Shown(NamedTuple):
    """A command (or a Python program) and what a document says it prints, with the lines of the
    document it fills.
    """

    command: str
    expected: list[str]
    first: int
    last: int
    python: bool = False


class Block(NamedTuple):
    """A fenced block: its language, its lines, and the line of the document with which it
    begins.
    """

    language: str
    lines: list[str]
    first: int


def blocks(text: str) -> Iterator[Block]:
    open_block: Block | None = None
    for number, line in enumerate(text.splitlines()):
        if line.startswith("```"):
            if open_block:
                yield open_block
            open_block = None if open_block else Block(line[3:].strip(), [], number + 1)
        elif open_block:
            open_block.lines.append(line)


def files(text: str) -> dict[str, str]:
    """Files that a document asks its reader to write."""
    named = (
        (re.fullmatch(r"# ([\w-]+\.toml)", b.lines[0]), b)
        for b in blocks(text)
        if b.language == "toml" and b.lines
    )
    return {name[1]: "\n".join(block.lines[1:]) + "\n" for name, block in named if name}


def shown(text: str) -> Iterator[Shown]:
    """All commands of a document with their output, in order."""
    before: Block | None = None
    for block in blocks(text):
        if block.language == "console":
            starts = [k for k, line in enumerate(block.lines) if line.startswith("$ ")]
            for start, end in zip(starts, [*starts[1:], len(block.lines)], strict=True):
                yield Shown(
                    block.lines[start][2:],
                    block.lines[start + 1 : end],
                    block.first + start + 1,
                    block.first + end,
                )
        elif block.language == "text" and before and before.language == "python":
            yield Shown(
                "\n".join(before.lines),
                block.lines,
                block.first,
                block.first + len(block.lines),
                python=True,
            )
        before = block


def printed(one: Shown, folder: Path) -> list[str]:
    """What a command prints, standard error included. AssertionError if it fails."""
    plain = (
        one.command.startswith("balcli ")
        and not one.python
        and not set("|&;<>$*?") & set(one.command)
    )
    status, output = _inside(one.command, folder) if plain else _outside(one, folder)
    if status:
        raise AssertionError(f"{one.command}\nends with status {status}:\n{output}")
    return [line.rstrip() for line in output.splitlines()]


def _inside(command: str, folder: Path) -> tuple[object, str]:
    """A command without a shell's help, in this process, which is quicker."""
    from balcli.cli import main

    output = StringIO()
    argv = sys.argv
    sys.argv = shlex.split(command)
    try:
        with chdir(folder), redirect_stdout(output), redirect_stderr(output), WIDTH:
            main()
    except SystemExit as end:
        return end.code, output.getvalue()
    finally:
        sys.argv = argv
    return 0, output.getvalue()


def _outside(one: Shown, folder: Path) -> tuple[object, str]:
    command = (
        [sys.executable, "-c", one.command]
        if one.python
        else ["bash", "-c", FUNCTION + one.command]
    )
    done = subprocess.run(
        command,
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env=ENVIRONMENT,
        text=True,
        encoding="utf-8",
        timeout=300,
    )
    return done.returncode, done.stdout


def agrees(expected: list[str], found: list[str]) -> bool:
    """Whether the lines are the same but for those that are left out; at either end, empty lines
    count for nothing.

    Figures in full precision need to agree to nine digits: the last ones are the machine's.
    """
    parts = [
        r"(?:.*\n)*?" if line.strip() == LEFT_OUT else re.escape(_rounded(line.rstrip())) + "\n"
        for line in _trimmed(expected)
    ]
    return (
        re.fullmatch("".join(parts), "".join(_rounded(line) + "\n" for line in _trimmed(found)))
        is not None
    )


def _rounded(line: str) -> str:
    """With numbers of more than nine decimals to nine digits, and rounding errors as what they are:
    0.
    """

    def nine(number: re.Match[str]) -> str:
        value = float(number[0])
        return f"{value if abs(value) > 1e-12 else 0:.9g}"

    return re.sub(
        r"-?\b\d+\.\d{9,}(?:e[-+]\d+)?|-?\b0\.0\b|-?\b\d+(?:\.\d+)?e-(?:1[3-9]|[2-9]\d)\b",
        nine,
        line,
    )


def _trimmed(lines: list[str]) -> list[str]:
    return "\n".join(lines).strip("\n").split("\n") if any(lines) else []


def project(folder: Path) -> Path:
    """The example engines in a folder of their own, as in a fresh copy of the project."""
    shutil.copytree(ROOT / "engines", folder / "engines")
    return folder


def renewed(text: str, folder: Path) -> str:
    """The document with everything it shows as it is printed now."""
    lines = text.splitlines()
    fresh = []
    for one in shown(text):
        found = printed(one, folder)
        fresh.append(
            (one, one.expected if agrees(one.expected, found) else _alike(one.expected, found))
        )
    for one, output in reversed(fresh):
        lines[one.first : one.last] = output
    return "\n".join(lines) + "\n"


def _alike(expected: list[str], found: list[str]) -> list[str]:
    """For every run of lines the printed ones from that most like its first to that most like its
    last, with the rest of a paragraph; all lines where none is left out.
    """
    if LEFT_OUT not in expected:
        return _trimmed(found)
    result: list[str] = []
    for left_out, lines in groupby(expected, key=lambda line: line.strip() == LEFT_OUT):
        run = _trimmed(list(lines))
        if left_out or not any(run):
            result += run
            continue
        first = _find_like(run[0], found)
        last = first + _find_like(run[-1], found[first:])
        while last + 1 < len(found) and len(found[last]) > 60 and "  " not in found[last].strip():
            if not found[last + 1]:
                break
            last += 1
        result += found[first : last + 1]
        found = found[last + 1 :]
    return result


def _find_like(line: str, found: list[str]) -> int:
    return max(range(len(found)), key=lambda k: SequenceMatcher(None, line, found[k]).ratio())


def main() -> None:
    for name in sys.argv[1:]:
        document = Path(name)
        text = document.read_text(encoding="utf-8")
        with TemporaryDirectory() as temporary:
            folder = project(Path(temporary))
            for file, content in files(text).items():
                (folder / file).write_text(content, encoding="utf-8")
            document.write_text(renewed(text, folder), encoding="utf-8")


if __name__ == "__main__":
    main()
