"""Who imports whom, how large the parts are, and that what the library promises is there."""

from __future__ import annotations

import subprocess
import sys

import pytest
from support.paths import PACKAGE, ROOT

import balcli

FILES = sorted(PACKAGE.rglob("*.py"))
MOST_MODULES, MOST_LINES = 230, 630  # of the package; of a module, docstrings and all


def test_the_import_contract_is_kept() -> None:
    """One way through the packages, and a core of numpy alone: `[tool.importlinter]` of pyproject.toml."""
    pytest.importorskip("importlinter")
    run = [sys.executable, "-c", "from importlinter.cli import lint_imports; raise SystemExit(lint_imports())"]
    done = subprocess.run(run, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_package_keeps_to_its_budgets() -> None:
    lengths = {
        file.relative_to(PACKAGE).as_posix(): len(file.read_text(encoding="utf-8").splitlines()) for file in FILES
    }
    assert len(lengths) <= MOST_MODULES
    assert {name: length for name, length in lengths.items() if length > MOST_LINES} == {}


def test_public_names_are_there() -> None:
    """The library's door: what it promises can be had, and is offered for completion."""
    assert dir(balcli) == sorted(balcli.__all__)
    assert [name for name in balcli.__all__ if getattr(balcli, name) is None] == []
    with pytest.raises(AttributeError, match="module 'balcli' has no attribute 'frobnicate'"):
        _ = balcli.frobnicate
