"""Who imports whom, also by name."""

import subprocess
import sys

import pytest
from support.paths import ROOT

import balcli
from balcli import names


def test_the_import_contract_is_kept() -> None:
    """One way through the floors, no circle, and a core of numpy alone: `[tool.importlinter]` of pyproject.toml."""
    pytest.importorskip("importlinter")
    run = [sys.executable, "-c", "from importlinter.cli import lint_imports; raise SystemExit(lint_imports())"]
    done = subprocess.run(run, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_public_names_are_there() -> None:
    """The library's door: what it promises can be had, and is offered for completion."""
    assert dir(balcli) == sorted(balcli.__all__)
    assert [name for name in balcli.__all__ if getattr(balcli, name) is None] == []
    with pytest.raises(AttributeError, match="module 'balcli' has no attribute 'frobnicate'"):
        _ = balcli.frobnicate


def test_every_name_leads_to_what_it_says() -> None:
    """Public names, renderers, documents, tables and quantities of chapters."""
    places = [
        *(f"{module}:{name}" for name, module in names.PUBLIC.items()),
        *(f"{module}:RENDERER" for module in names.RENDERERS.values()),
        *(f"{module}:{key.capitalize()}" for key, module in (names.CHAPTERS | names.CHAPTER_LISTS).items()),
        *names.DOCUMENTS.values(),
        *names.QUANTITIES.values(),
    ]
    assert [place for place in places if names.import_name(place) is None] == []
