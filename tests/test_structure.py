"""The house in order: who imports whom, how large its parts are, and that what it promises is there."""

from __future__ import annotations

import ast
import importlib
import re
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from support.paths import PACKAGE, ROOT

import balcli
from balcli.cli import COMMANDS, MODULES
from balcli.show.formats import DOCUMENTS

FILES = sorted(PACKAGE.rglob("*.py"))
MOST_MODULES, MOST_LINES = 230, 630  # of the package; of a module, docstrings and all
LIMITS = ("MOST", "LARGEST", "LONGEST", "HIGHEST", "DEEPEST", "FARTHEST", "FINEST", "NEAREST")


def name_of(file: Path) -> str:
    return file.relative_to(PACKAGE).as_posix()


@cache
def parse(file: Path) -> ast.Module:
    return ast.parse(file.read_text(encoding="utf-8"))


def test_the_import_contract_is_kept() -> None:
    """One way through the packages, and a core of numpy alone: `[tool.importlinter]` of pyproject.toml."""
    pytest.importorskip("importlinter")
    run = [sys.executable, "-c", "from importlinter.cli import lint_imports; raise SystemExit(lint_imports())"]
    done = subprocess.run(run, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_package_keeps_to_its_budgets() -> None:
    lengths = {name_of(file): len(file.read_text(encoding="utf-8").splitlines()) for file in FILES}
    assert len(lengths) <= MOST_MODULES
    assert {name: length for name, length in lengths.items() if length > MOST_LINES} == {}


def find_faults(module: ast.Module, outermost: bool) -> Iterator[str]:
    """What fails silently: a blanket except (but at the end of the process), assert as a check, eval."""
    for node in ast.walk(module):
        if isinstance(node, ast.Assert):
            yield f"line {node.lineno}: assert"
        elif isinstance(node, ast.ExceptHandler) and not outermost:
            if node.type is None or ast.unparse(node.type) in ("Exception", "BaseException"):
                yield f"line {node.lineno}: blanket except"
        elif isinstance(node, ast.Call) and ast.unparse(node.func) in ("eval", "exec"):
            yield f"line {node.lineno}: eval"


def test_nothing_fails_silently() -> None:
    found = {name_of(file): [*find_faults(parse(file), file.name == "__main__.py")] for file in FILES}
    assert {name: faults for name, faults in found.items() if faults} == {}


def test_every_limit_stands_in_limits() -> None:
    """Outside the core, whose bounds belong to its methods."""
    found = {
        f"{name_of(file)}: {target.id}"
        for file in FILES
        if not name_of(file).startswith(("core/", "limits.py"))
        for node in parse(file).body
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name) and target.id.startswith(LIMITS)
    }
    assert found == set()


def test_a_command_is_a_function_of_its_name() -> None:
    modules = {name: importlib.import_module(f"balcli.{module}") for name, module in MODULES.items()}
    assert [*COMMANDS] == [*dict.fromkeys(name for name in COMMANDS if callable(getattr(modules[name], name)))]


def test_public_names_are_there() -> None:
    """The library's door: what it promises can be had, and is offered for completion."""
    assert dir(balcli) == sorted(balcli.__all__)
    assert [name for name in balcli.__all__ if getattr(balcli, name) is None] == []
    with pytest.raises(AttributeError, match="module 'balcli' has no attribute 'frobnicate'"):
        _ = balcli.frobnicate


def test_every_document_of_the_package_has_a_schema() -> None:
    """Its name is in `DOCUMENTS` of show/formats.py."""
    found = {name for file in FILES for name in re.findall(r'"balcli\.([a-z_]+)/1"', file.read_text(encoding="utf-8"))}
    assert found == {*DOCUMENTS}
