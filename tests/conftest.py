"""What all tests share: hypothesis repeats itself and has no deadline (machines are shared)."""

import gc
import io
import sys

import numpy as np
import pytest
from hypothesis import settings

from balcli.cli import main

settings.register_profile("repeatable", deadline=None, derandomize=True, max_examples=60)
settings.load_profile("repeatable")


@pytest.fixture(autouse=True)
def _no_silent_infinities():
    """Nothing overflows, divides by 0 or makes a nan, anywhere (matplotlib and scipy too: they say
    what they mean to ignore).
    """
    with np.errstate(over="raise", divide="raise", invalid="raise"):
        yield


@pytest.fixture(autouse=True)
def _no_frozen_garbage():
    """`cli.main` takes its process for ended and freezes what is there, which hypothesis could then
    not see any more.
    """
    yield
    gc.unfreeze()


@pytest.fixture
def balcli(capsys, monkeypatch):
    """Runs a command in this process: (exit status, standard output, standard error)."""

    def run(*args: object, stdin: str = "") -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["balcli", *map(str, args)])
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(stdin.encode())))
        with pytest.raises(SystemExit) as done:
            main()
        out, err = capsys.readouterr()
        return int(done.value.code or 0), out, err

    return run
