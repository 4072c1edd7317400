"""What all tests share: hypothesis repeats itself and has no deadline (machines are shared)."""

import gc

import support.environment  # noqa: F401 - before all others

# isort: split
import numpy as np
import pytest
from hypothesis import settings
from support.commands import run_here

settings.register_profile("repeatable", deadline=None, derandomize=True, max_examples=30)
settings.load_profile("repeatable")


def pytest_collection(session):
    """Nothing becomes garbage while modules are imported: the collector would walk through all of them in vain."""
    gc.disable()


def pytest_collection_finish(session):
    """Modules and tests stay to the end: the collector leaves them alone from now on, and looks more seldom at what
    tests keep for each other.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(10_000, 10, 100)
    gc.enable()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    """Nothing overflows, divides by 0 or makes a nan, anywhere (matplotlib and scipy too: they say
    what they mean to ignore).
    """
    with np.errstate(over="raise", divide="raise", invalid="raise"):
        return (yield)


@pytest.fixture
def balcli():
    """Runs a command in this process: (exit status, standard output, standard error)."""
    return run_here
