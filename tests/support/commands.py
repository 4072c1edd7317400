"""Commands as users give them: in this process, or in processes of their own."""

import csv
import io
import json
import os
import subprocess
import sys
from typing import Any, NamedTuple
from unittest.mock import patch

import typer
from typer.main import get_command

from balcli import cli

from .paths import SOURCE

HANGS = 300  # seconds: what takes longer has hung, however busy the machine


def _make_commands_once() -> None:
    """Keep each command of `cli` once it is made: typer builds it anew for every call, which takes half of the time of
    most commands.
    """
    group = type(get_command(cli.app))
    make = group.get_command
    made = {}

    def get_made(self: Any, context: Any, name: str) -> Any:
        if name not in made:
            made[name] = make(self, context, name)
        return made[name]

    group.get_command = get_made
    whole = get_command(cli.app)
    typer.Typer.__call__ = lambda app, *args, **options: (whole if app is cli.app else get_command(app))(
        *args, **options
    )


_make_commands_once()


class Outcome(NamedTuple):
    """What a command that has ended leaves: exit status, standard output and standard error."""

    status: int
    out: str
    err: str


class _Stream(io.TextIOWrapper):
    """A stream into memory that may call itself a terminal."""

    def __init__(self, content: str = "", terminal: bool = False) -> None:
        super().__init__(io.BytesIO(content.encode()), encoding="utf-8", write_through=True)
        self.terminal = terminal

    def isatty(self) -> bool:
        return self.terminal

    @property
    def content(self) -> str:
        return self.buffer.getvalue().decode()


def run_here(*args: object, stdin: str = "", terminal: bool = False) -> Outcome:
    """Run `balcli` with these arguments in this process; whether its outputs are a terminal."""
    streams = _Stream(stdin), _Stream(terminal=terminal), _Stream(terminal=terminal)
    status: object = None
    with (
        patch.object(sys, "argv", ["balcli", *map(str, args)]),
        patch.object(sys, "stdin", streams[0]),
        patch.object(sys, "stdout", streams[1]),
        patch.object(sys, "stderr", streams[2]),
    ):
        try:
            cli.main()
        except SystemExit as end:
            status = end.code
    return Outcome(int(status or 0), streams[1].content, streams[2].content)


def refusal(*args: object, stdin: str = "") -> str:
    """The message with which a command refuses, on standard error alone and with status 2."""
    status, out, err = run_here(*args, stdin=stdin)
    assert (status, out) == (2, "")
    assert err.startswith("balcli: ")
    return err.removeprefix("balcli: ").removesuffix("\n")


def ask(*args: object, stdin: str = "") -> str:
    """What a command prints, with status 0 and nothing on standard error."""
    status, out, err = run_here(*args, stdin=stdin)
    assert (status, err) == (0, "")
    return out


def ask_json(*args: object, stdin: str = "") -> Any:
    """What a command answers as JSON, likewise."""
    return json.loads(ask(*args, "--format", "json", stdin=stdin))


def ask_csv(*args: object, stdin: str = "") -> list[dict[str, str]]:
    """What a command answers as CSV, a dict a line, likewise."""
    return list(csv.DictReader(io.StringIO(ask(*args, "--format", "csv", stdin=stdin))))


def ask_torsion(text: str, *options: object) -> Any:
    """What `balcli torsion` answers about a file of this text."""
    return ask_json("torsion", "-", *options, stdin=text)


def run_command(*args: object, **options: Any) -> subprocess.CompletedProcess:
    """Run `balcli` with these arguments to its end, in a process.

    Args:
        options: of `subprocess.run`; both outputs are captured, as text, unless they say otherwise,
            and `env` is added to this process's environment.
    """
    return run_python("-m", "balcli", *args, **options)


def run_python(*args: object, **options: Any) -> subprocess.CompletedProcess:
    """Run Python, which finds this balcli and `support`; options as above."""
    defaults = {"capture_output": "stdout" not in options, "encoding": "utf-8", "timeout": HANGS}
    return subprocess.run(_argv(args), check=False, **defaults | options | _environment(options))


def start_command(*args: object, **options: Any) -> subprocess.Popen:
    """Start `balcli` with these arguments; options of `subprocess.Popen`, `env` as above."""
    return subprocess.Popen(_argv(("-m", "balcli", *args)), **options | _environment(options))


def run_in_terminal(*args: object, columns: int = 80, **options: Any) -> Outcome:
    """Run `balcli` in a pseudo-terminal of that width, where both outputs are one; options of
    `subprocess.Popen`, `env` as above.
    """
    import fcntl  # these are Unix's
    import pty
    import struct
    import termios

    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 50, columns, 0, 0))
    with start_command(*args, stdin=subprocess.DEVNULL, stdout=theirs, stderr=theirs, **options) as running:
        os.close(theirs)
        text = b"".join(iter(lambda: _read(ours), b""))
    os.close(ours)
    return Outcome(running.returncode, text.decode(), "")


def _read(descriptor: int) -> bytes:
    try:
        return os.read(descriptor, 65536)
    except OSError:  # Linux: the other end is closed
        return b""


def _argv(args: tuple[object, ...]) -> list[str]:
    return [sys.executable, *map(str, args)]


def _environment(options: dict[str, Any]) -> dict[str, Any]:
    path = os.pathsep.join([str(SOURCE), str(SOURCE.parent / "tests")])
    return {"env": {**os.environ, "PYTHONPATH": path, **options.get("env", {})}}
