"""What all tests share: hypothesis repeats itself and has no deadline (machines are shared)."""

import gc
import os
import shutil
import sys
import tempfile

import numpy as np
import pytest
from hypothesis import settings
from support.commands import run_here

for variable in [name for name in os.environ if name.startswith("BALCLI_")]:
    del os.environ[variable]  # what whoever runs the tests finds usual
settings.register_profile("repeatable", deadline=None, derandomize=True, max_examples=60)
settings.load_profile("repeatable")


def pytest_configure(config):
    """Where nothing may be written beside the source (PYTHONDONTWRITEBYTECODE), processes that
    tests start share their byte code in a temporary folder: compiling takes longer than most run.
    """
    if not sys.dont_write_bytecode:
        return
    if hasattr(config, "workerinput"):
        config.byte_code = config.workerinput["byte_code"]
    else:
        config.byte_code = tempfile.mkdtemp(prefix="balcli-byte-code-")
        config.add_cleanup(lambda: shutil.rmtree(config.byte_code, ignore_errors=True))
    if not config.getoption("numprocesses", None):  # who starts workers does not change what they inherit
        os.environ["PYTHONPYCACHEPREFIX"] = config.byte_code
        del os.environ["PYTHONDONTWRITEBYTECODE"]


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


@pytest.hookimpl(optionalhook=True)  # of pytest-xdist
def pytest_configure_node(node):
    """Workers have the folder of who starts them."""
    node.workerinput["byte_code"] = getattr(node.config, "byte_code", None)


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
