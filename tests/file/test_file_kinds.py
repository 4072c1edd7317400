"""A file of another kind is told as such, in one line; a file with slips is told its slips."""

import pytest
from support.cases import cases
from support.engines import GOOD
from support.mounts import block
from support.rotors import three_runs

from balcli.engine.parse import parse
from balcli.errors import InputError
from balcli.file.examples import template

CHAIN, BODY, RUNS = template("torsion"), block(), three_runs()


@cases("file/file_kinds", "a_file_of_another_kind", BODY=BODY, CHAIN=CHAIN, GOOD=GOOD, RUNS=RUNS)
def test_a_file_of_another_kind(balcli, command, text, message):
    outcome = balcli(command, "-", stdin=text)
    assert outcome == (2, "", f"balcli: standard input: {message}\n")


@cases("file/file_kinds", "an_engine_file_with_slips_is_an_engine_file")
def test_an_engine_file_with_slips_is_an_engine_file(old, new):
    with pytest.raises(InputError) as caught:
        parse(GOOD.replace(old, new, 1) if old else new + GOOD)
    assert " mistakes\n" in str(caught.value)


def test_what_could_be_two_kinds_is_judged_by_what_was_wanted():
    with pytest.raises(InputError, match="5 mistakes"):
        parse("[[run]]\n[[node]]\n")
