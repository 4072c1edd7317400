"""What is otherwise on Windows, as far as it can be had elsewhere."""

import errno
import io
import sys

import pytest
from support.commands import refusal, run_python
from support.paths import ENGINES, write

from balcli import process
from balcli.shell import output

I4 = ENGINES / "i4.toml"


RUN_ALL = """
import sys
from balcli.cli import main
for command in {commands}:
    sys.argv = ["balcli", *command]
    try:
        main()
    except SystemExit as end:
        if end.code:
            raise
"""


def test_every_file_is_opened_with_its_encoding(tmp_path):
    """Python itself tells where one is left to the machine."""
    commands = [
        ["analyze", str(I4), "-o", "a.json"],
        ["sweep", str(I4), "--vary", "rod.ratio=0.3", "-o", "s.csv"],
        ["check", str(I4)],
        ["new", "torsion", "chain.toml"],
    ]
    strict = ("-X", "warn_default_encoding", "-W", "error::EncodingWarning")
    done = run_python(*strict, "-c", RUN_ALL.format(commands=commands), cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert {path.name for path in tmp_path.iterdir()} == {"a.json", "s.csv", "chain.toml"}
    assert b"\r" not in (tmp_path / "s.csv").read_bytes()


class Gone(io.StringIO):
    """Standard output that nobody reads any more, as Windows tells it."""

    def flush(self) -> None:
        raise OSError(errno.EINVAL, "Invalid argument")

    def fileno(self) -> int:
        return 1


def test_a_reader_who_has_gone_is_no_error_on_windows(monkeypatch):
    monkeypatch.setattr(sys, "stdout", Gone())
    monkeypatch.setattr("os.dup2", lambda *_: None)
    with pytest.raises(output.BalcliError, match="standard output: cannot be written"):
        output.emit("text")
    monkeypatch.setattr(process, "WINDOWS", True)
    output.emit("text")


def test_a_file_that_another_program_holds_open_is_a_message(tmp_path, monkeypatch):
    """`os.replace` is refused there; the older file stays, and nothing beside it."""
    target = write(tmp_path / "x.csv", "old")

    def refuse(self, other):
        raise PermissionError(errno.EACCES, "Access is denied")

    monkeypatch.setattr("pathlib.Path.replace", refuse)
    assert refusal("analyze", I4, "-o", target) == f"{target}: cannot be written (Access is denied)"
    assert [path.name for path in tmp_path.iterdir()] == ["x.csv"]
    assert target.read_text() == "old"
