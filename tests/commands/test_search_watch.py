"""A search that is ended by Ctrl-C."""

from __future__ import annotations

import signal

import pytest
import typer

from balcli.commands import search_watch


def search_until_stopped() -> None:
    with search_watch.watching_search("throws") as watch:
        assert watch is not None
        assert not watch(0.25)
        signal.raise_signal(signal.SIGINT)
        assert watch(0.375)
        print("the best so far")


def test_ctrl_c_ends_the_search_and_then_the_command(capsys: pytest.CaptureFixture[str]) -> None:
    """What is shown in between is shown; the status is that of an interruption."""
    with pytest.raises(typer.Exit) as ended:
        search_until_stopped()
    assert ended.value.exit_code == 130
    shown = capsys.readouterr()
    assert shown.out == "the best so far\n"
    assert shown.err == (
        "balcli: stopped after 37.50% of the arrangements; these are the best of them\n"
    )


def test_a_search_that_was_not_ended_says_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    with search_watch.watching_search("throws") as watch:
        assert watch is not None
        assert not watch(1.0)
    with search_watch.watching_search("bank_angle") as none:
        assert none is None
    assert capsys.readouterr() == ("", "")


def test_on_a_terminal_a_long_search_says_how_far_it_is(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """At once here; a quarter in no time leaves three quarters of no time."""
    monkeypatch.setattr(search_watch, "_SILENT_S", 0.0)
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    with search_watch.watching_search("throws") as watch:
        assert watch is not None
        watch(0.25)
        watch(0.5)
    assert capsys.readouterr().err == (
        "balcli: 25.00% of the arrangements in 0 s, about 0 s more at this pace; Ctrl-C shows the "
        "best so far\n"
    )
