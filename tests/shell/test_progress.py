"""What is said while something takes long, and when Ctrl-C ends it."""

import signal
import sys
from collections.abc import Iterator

import pytest
import typer
from support.cases import slow
from support.commands import ask, run_here
from support.paths import ENGINES

from balcli import errors
from balcli.shell import progress
from balcli.show.sheet import count_name

unix = pytest.mark.skipif(sys.platform == "win32", reason="signals")


def watch_clock(monkeypatch: pytest.MonkeyPatch, *, terminal: bool = True) -> list[float]:
    """The time in seconds, to be set; whether standard error is a terminal."""
    now = [100.0]
    monkeypatch.setattr("sys.stderr.isatty", lambda: terminal)
    monkeypatch.setattr("time.monotonic", lambda: now[0])
    return now


def test_a_terminal_shows_a_bar_after_two_seconds(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A message meanwhile stands on a line of its own."""
    now = watch_clock(monkeypatch)
    with progress.reporting("samples", 4000) as tell:
        now[0] += 1.9
        assert not tell(100)
        assert capsys.readouterr() == ("", "")
        now[0] += 2.1
        tell(1000)
        shown = capsys.readouterr()
        assert shown.out == ""
        assert "balcli: samples" in shown.err
        assert "1000/4000" in shown.err
        errors.warn("the rod is short")
        assert "warning: the rod is short\n" in capsys.readouterr().err
    errors.warn("it is all")
    assert capsys.readouterr().err.endswith("warning: it is all\n")


@pytest.mark.parametrize("why", ["pipe", "quiet", "results on the same terminal"])
def test_nothing_is_shown_where_nobody_looks(
    why: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    now = watch_clock(monkeypatch, terminal=why != "pipe")
    if why == "quiet":
        monkeypatch.setattr(errors, "_loudness", errors.Loudness.QUIET)
    with progress.reporting("samples", 10, shown="same" not in why) as tell:
        now[0] += 50
        tell(5)
    assert capsys.readouterr() == ("", "")


@pytest.fixture
def interruptible() -> Iterator[None]:
    """The tests themselves may run where Ctrl-C is ignored, in the background of a script."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def stop_in_the_middle(done: float) -> None:
    with progress.reporting_until_stopped("engines", 8) as tell:
        assert not tell(2)
        signal.raise_signal(signal.SIGINT)
        assert tell(done)
    print("what there is")
    progress.exit_if_cut_short(tell, "they are here")


@unix
@pytest.mark.usefixtures("interruptible")
def test_ctrl_c_ends_what_can_be_whole_with_what_there_is(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(typer.Exit) as ended:
        stop_in_the_middle(3)
    assert ended.value.exit_code == 130
    assert capsys.readouterr() == ("what there is\n", "balcli: stopped after 3 of 8 engines; they are here\n")
    stop_in_the_middle(8)  # all was done by then
    assert capsys.readouterr() == ("what there is\n", "")


@unix
def test_an_interrupt_that_is_ignored_stays_so() -> None:
    """As under `nohup`, or in the background of a script."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with progress.reporting_until_stopped("engines", 8) as tell:
            signal.raise_signal(signal.SIGINT)
            assert not tell(2)
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)


@unix
@pytest.mark.usefixtures("interruptible")
def test_the_last_word_of_what_cannot_end_early(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(typer.Exit) as ended, progress.reporting("speeds", 200) as tell:  # noqa: PT012 - within it
        tell(50)
        signal.raise_signal(signal.SIGINT)
        print("still here")
    assert ended.value.exit_code == 130
    assert capsys.readouterr() == ("", "balcli: stopped after 50 of 200 speeds\n")


LONG = {
    "sweep": ("sweep", ENGINES / "i4.toml", "--vary", "rod.ratio=0.2:0.3:0.001", "-o", "x.csv"),
    "scatter": ("scatter", ENGINES / "i4.toml", "--samples", "20000"),
    "search": ("search", ENGINES / "v8_crossplane.toml", "--over", "throws", "--minimise", "moment.1.major"),
    "check": ("check", ENGINES / "i4.toml"),
    "mounts": ("mounts", ENGINES / "i4_mounts.toml"),
    "torsion": ("torsion", ENGINES / "i6_diesel.toml", "--speeds", "1000:1200:10"),
    "damper": ("torsion", ENGINES / "i6_diesel.toml", "--speeds", "1000:2500:500", "--damper", "viscous"),
}


@pytest.mark.parametrize("command", [*sorted({*LONG} - {"damper"}), *slow("damper")])
def test_all_that_may_take_long_tells_how_far_it_is_to_the_end(
    command: str, monkeypatch: pytest.MonkeyPatch, tmp_path
) -> None:
    """The share that was told last is all, and every one is more than the one before."""
    monkeypatch.chdir(tmp_path)
    told: list[float] = []
    listen = progress.Progress.__call__

    def call(self: progress.Progress, done: float) -> bool:
        told.append(done / (self._total or 1))
        return listen(self, done)

    monkeypatch.setattr(progress.Progress, "__call__", call)
    ask(*LONG[command])
    assert told == sorted(told)
    assert told[-1] == pytest.approx(1)


@pytest.mark.parametrize("asked", [("i4", "force.2.major", 20_000, 8192), ("i4_mounts", "mode.1.Hz", 30, 7)])
def test_a_scatter_that_ctrl_c_ends_is_one_of_fewer_samples(asked: tuple, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same as of so many samples asked for."""
    file, what, all_of_them, some = asked
    listen = progress.Progress.__call__

    def stop(self: progress.Progress, done: float) -> bool:
        self.stopped = done >= some
        return listen(self, done)

    args = ("scatter", ENGINES / f"{file}.toml", "--quantity", what, "--seed", "1", "-f", "json", "--samples")
    whole = run_here(*args, some)
    monkeypatch.setattr(progress.Progress, "__call__", stop)
    status, out, err = run_here(*args, all_of_them)
    assert out == whole.out
    assert status == 130
    assert err == (f"balcli: stopped after {some} of {count_name(all_of_them)} samples; the results cover only these\n")
