"""Random engine files, sound and damaged, through the commands: an answer or a message, never a
traceback, a warning of numpy or a figure that is no number.
"""

import json
import warnings

import pytest
from hypothesis import given, settings, strategies as st
from support.commands import run_here
from support.engine_files import engine_files

pytestmark = pytest.mark.stress
COMMANDS = (
    *("analyze", "analyze --only inner", "balance", "balance --scheme auto", "curves --step 30"),
    *("mounts", "torque", "torsion", "torsion --speeds 1000:3000:500"),
)


def refuse_constant(name: str) -> None:
    raise AssertionError(f"{name} in JSON")


@settings(max_examples=400)
@given(text=engine_files(), command=st.sampled_from(COMMANDS))
def test_a_command_answers_or_refuses(text, command):
    name, *options = command.split()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        status, out, err = run_here(name, "-", *options, "--format", "json", stdin=text)
    assert status in (0, 2), err
    assert "Traceback" not in err
    assert "\x1b" not in out + err
    if status == 0:
        json.loads(out, parse_constant=refuse_constant)
