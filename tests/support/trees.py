"""Syntax trees of the source, read once for all tests of a process."""

import ast
from functools import cache
from pathlib import Path

from .paths import PACKAGE


@cache
def list_trees() -> tuple[tuple[Path, ast.Module], ...]:
    """The path of every module of the package, and its syntax tree."""
    files = sorted(PACKAGE.rglob("*.py"))
    return tuple((file, ast.parse(file.read_text(encoding="utf-8"))) for file in files)
