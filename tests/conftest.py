"""What all tests share: hypothesis repeats itself and has no deadline (machines are shared)."""

import os

import numpy as np
import pytest
from hypothesis import settings
from support.commands import run_here

for variable in [name for name in os.environ if name.startswith("BALCLI_")]:
    del os.environ[variable]  # what whoever runs the tests finds usual
settings.register_profile("repeatable", deadline=None, derandomize=True, max_examples=60)
settings.load_profile("repeatable")


@pytest.fixture(autouse=True)
def _no_silent_infinities():
    """Nothing overflows, divides by 0 or makes a nan, anywhere (matplotlib and scipy too: they say
    what they mean to ignore).
    """
    with np.errstate(over="raise", divide="raise", invalid="raise"):
        yield


@pytest.fixture
def balcli():
    """Runs a command in this process: (exit status, standard output, standard error)."""
    return run_here
