"""Where results go: never onto what is read, through links and into pipes, whole or not at all."""

import errno
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import pytest
from support.commands import HANGS, refusal, run_here, run_python, start_command
from support.engines import GOOD

unix = pytest.mark.skipif(sys.platform == "win32", reason="needs links, pipes and signals")


@pytest.fixture
def balcli():
    """Runs a command in this process, with an engine file as standard input."""
    return lambda *args: run_here(*args, stdin=GOOD)


@pytest.fixture
def good(tmp_path, monkeypatch):
    """A folder with good.toml, other.toml and a symbolic and a hard link to the first, in which commands run."""
    monkeypatch.chdir(tmp_path)
    for name in ("good.toml", "other.toml"):
        Path(name).write_text(GOOD)
    if sys.platform != "win32":
        Path("link.toml").symlink_to("good.toml")
        os.link("good.toml", "hard.toml")
    return Path("good.toml")


def contents() -> dict[str, str]:
    return {path.name: path.read_text() for path in Path().iterdir() if path.is_file()}


SWEEP = "sweep --vary crank.stroke=80,90"
SEARCH = "search --over throws --minimise moment.1.major"
COMMANDS = [
    *("analyze", "analyze other.toml", "balance", "balance -o x --write", "sum other.toml", "compare other.toml"),
    *("curves --step 90", "report", "scatter --samples 9", "plot"),
    *(SWEEP, f"{SWEEP} --plot", SEARCH, f"{SEARCH} --write"),
]


# ------------------------------------------------------------------ onto what is read
@unix
@pytest.mark.parametrize("target", ["good.toml", "./good.toml", "link.toml", "hard.toml"])
def test_never_onto_the_engine_file(good, target):
    before = contents()
    for command in COMMANDS:
        name, *rest = command.split()
        option = rest.pop() if rest and rest[-1].startswith("--") else "--output"
        assert refusal(name, good, *rest, option, target) == (
            f"{option} {Path(target)}: this file is read and must not change; choose another name"
        )
    assert contents() == before


@pytest.mark.parametrize("table", ['[gas]\nindicator = "p.csv"', '[gas]\nharmonics = "p.csv"', "[cylinder.2]\n{}"])
@pytest.mark.parametrize("command", [["curves"], ["sweep", "--vary", "crank.stroke=80,90"]])
def test_never_onto_a_file_that_the_engine_file_names(good, command, table):
    """Whatever else is wrong with either file: a diagram that was measured is not there twice."""
    good.write_text(GOOD + table.format('indicator = "p.csv"'))
    Path("p.csv").write_text("measured")
    before = contents()
    assert refusal(command[0], good, *command[1:], "-o", "./p.csv") == (
        "--output p.csv: this file is read and must not change; choose another name"
    )
    assert contents() == before


@pytest.mark.parametrize("before", [{}, {"x.toml": "old"}], ids=["new", "there"])
def test_two_results_never_go_to_one_place(good, before):
    for name, text in before.items():
        Path(name).write_text(text)
    told = refusal("balance", good, "-o", "x.toml", "--write", "./x.toml")
    assert told == "--write x.toml: another result is written there as well; choose another name"
    assert {name: text for name, text in contents().items() if name == "x.toml"} == before


# ------------------------------------------------------------------ links, folders, pipes
@unix
@pytest.mark.parametrize("there", [True, False], ids=["there", "dangling"])
def test_through_a_link_to_what_it_points_to(balcli, good, there):
    Path("inner").mkdir()
    if there:
        Path("inner/real.txt").write_text("old")
    Path("out.txt").symlink_to("inner/real.txt")
    assert balcli("analyze", good, "-o", "out.txt") == (0, "", "")
    assert Path("out.txt").is_symlink()
    assert Path("inner/real.txt").read_text().startswith("in-line four")
    assert os.listdir("inner") == ["real.txt"]


@unix
def test_a_target_that_the_system_refuses_is_never_taken_for_a_missing_one(good, monkeypatch):
    """From Python 3.14, `Path.exists` is false where the system refuses to look, as it does with
    another user's link in a shared folder.
    """
    Path("victim.txt").write_text("old")
    Path("link.txt").symlink_to("victim.txt")
    look = os.stat

    def refuse(path, *args, **kwargs):
        if str(path) == "link.txt" and kwargs.get("follow_symlinks", True):
            raise PermissionError(errno.EACCES, "Permission denied", str(path))
        return look(path, *args, **kwargs)

    with monkeypatch.context() as emulated:
        for name in ("exists", "is_dir", "is_file"):
            emulated.setattr(Path, name, lambda self: False)
        emulated.setattr(os, "stat", refuse)
        told = refusal("analyze", good, "-o", "link.txt")
    assert told == "link.txt: cannot be written (Permission denied)"
    assert Path("victim.txt").read_text() == "old"


@unix
def test_a_pipe_is_written_to_and_stays_a_pipe(balcli, good):
    """As /dev/null must, which whoever may do everything could replace by a file."""
    os.mkfifo("pipe")
    with ThreadPoolExecutor() as pool:
        read = pool.submit(Path("pipe").read_text)
        assert balcli("analyze", good, "-o", "pipe") == (0, "", "")
        assert read.result(10).startswith("in-line four")
    assert Path("pipe").is_fifo()


@pytest.mark.parametrize(
    ("target", "reason"),
    [
        ("x" * 300, "File name too long"),
        ("good.toml/x", "Not a directory"),
        ("none/x", "there is no folder none"),
        ("none/within/x", "there is no folder none/within"),
    ],
)
def test_places_that_cannot_be(good, target, reason):
    for command in (["analyze", good, "-o"], ["balance", good, "--write"], ["new", "single"], ["engines", "i4"]):
        assert refusal(*command, target) == f"{target}: cannot be written ({reason})"


@pytest.mark.parametrize("path", ["x" * 300, "x" * 300 + "/y"])
def test_paths_too_long_to_be_read(path):
    assert all(refusal(command, path) for command in ("analyze", "check", "compare"))


def test_new_leaves_even_a_dangling_link_alone(balcli, good):
    Path("new.toml").symlink_to("nowhere.toml")
    for command in (["new", "single"], ["engines", "i4"]):
        assert balcli(*command, "new.toml")[0] == 2
        assert balcli(*command, good)[0] == 2
    assert not Path("nowhere.toml").exists()
    assert good.read_text() == GOOD


# ------------------------------------------------------------------ no room, no right
def _partly(self: Path, data: bytes) -> int:
    with self.open("wb") as stream:
        stream.write(data[:100])
    raise OSError(28, "No space left on device")


@pytest.mark.parametrize("command", [["analyze", "-o", "out.txt"], ["balance", "--write", "out.toml"]], ids=" ".join)
def test_a_disk_that_fills_up_midway(good, monkeypatch, command):
    name, option, target = command
    Path(target).write_text("old")
    before = contents()
    monkeypatch.setattr(Path, "write_bytes", _partly)
    assert refusal(name, good, option, target) == f"{target}: cannot be written (No space left on device)"
    assert contents() == before


def test_a_disk_that_fills_up_during_a_sweep(good, monkeypatch):
    Path("out.csv").write_text("old")
    before = contents()

    def full(*_: object) -> Iterator[str]:
        yield "crank.stroke,force.2.major\n"
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("balcli.studies.sweep_write.sweep_csv", full)
    told = refusal("sweep", good, "--vary", "crank.stroke=80,90", "-o", "out.csv")
    assert told == "out.csv: cannot be written (No space left on device)"
    assert contents() == before


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize("command", [["analyze"], ["sweep", "--vary", "crank.stroke=1:90:0.01"]], ids=" ".join)
def test_standard_output_that_is_full(good, command):
    name, *rest = command
    with Path("/dev/full").open("wb") as full:
        running = start_command(name, good, *rest, stdout=full, stderr=subprocess.PIPE)
        err = running.communicate(timeout=HANGS)[1].decode()
    assert (running.returncode, err) == (2, "balcli: standard output: cannot be written (No space left on device)\n")


@unix
def test_an_interrupt_is_no_traceback():
    """It waits for the rest of its standard input: more than a pipe holds has been read."""
    # Jobs in the background of a script ignore it.
    heeded = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    running = start_command(
        *("analyze", "-"), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=heeded
    )
    assert running.stdin is not None
    running.stdin.write(b"#\n" * 200_000)
    running.stdin.flush()
    running.send_signal(signal.SIGINT)
    out, err = running.communicate(timeout=HANGS)
    assert (running.returncode, out, err.strip()) == (130, b"", b"")


@unix
@pytest.mark.parametrize("name", ["SIGTERM", "SIGUSR1"])
def test_a_signal_leaves_the_older_file_and_nothing_beside_it(good, name):
    """It comes while the new file is being written: the sweep's text never ends."""
    Path("out.csv").write_text("old")
    before = contents()
    number = getattr(signal, name)
    code = f"""
import os, signal
from collections.abc import Iterator
from pathlib import Path
from balcli.files import replacing
from balcli.process import exit_on_signals
signal.signal({int(number)}, signal.SIG_DFL)
exit_on_signals()
with replacing(Path("out.csv")) as place:
    place.write_text("half")
    print(len(list(Path().iterdir())))
    os.kill(os.getpid(), {int(number)})
    print("still here")
"""
    done = run_python("-u", "-c", code)
    assert (done.returncode, done.stdout, done.stderr) == (128 + number, f"{len(before) + 1}\n", "")
    assert contents() == before
    assert not list(Path().glob(".*"))
