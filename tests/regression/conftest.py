"""Fixtures of the tests of `balcli check`: the command, and an engine file with its record."""

import json
from pathlib import Path

import pytest
from support.engines import GOOD, build_text
from support.paths import write

from balcli.regression.recording import find_record, record_result


@pytest.fixture
def check(balcli):
    return lambda *args: balcli("check", *args)


@pytest.fixture
def file(tmp_path):
    """An engine file with its recorded result."""
    engine_file = write(tmp_path / "four.toml", GOOD)
    target = find_record(engine_file)
    target.parent.mkdir()
    target.write_text(record_result(build_text(GOOD)))
    return engine_file


@pytest.fixture
def edit_record():
    """Changes the record of an engine file."""

    def edit(engine_file: Path, change) -> None:
        target = find_record(engine_file)
        document = json.loads(target.read_text())
        change(document)
        target.write_text(json.dumps(document))

    return edit
