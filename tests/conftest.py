"""What all tests share: hypothesis repeats itself and has no deadline (machines are shared)."""
import gc

import numpy as np
import pytest
from hypothesis import settings

settings.register_profile("repeatable", deadline=None, derandomize=True, max_examples=60)
settings.load_profile("repeatable")


@pytest.fixture(autouse=True)
def _no_silent_infinities():
    """Nothing overflows, divides by 0 or makes a nan, anywhere (matplotlib and scipy too: they say what they mean to ignore)."""
    with np.errstate(over="raise", divide="raise", invalid="raise"):
        yield


@pytest.fixture(autouse=True)
def _no_frozen_garbage():
    """`cli.main` takes its process for ended and freezes what is there, which hypothesis could then not see any more."""
    yield
    gc.unfreeze()
