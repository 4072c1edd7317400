"""Syntax trees of the source, read once for all tests of a process."""

import ast
from functools import cache
from pathlib import Path

from .paths import PACKAGE


@cache
def list_nodes() -> tuple[tuple[Path, tuple[ast.AST, ...]], ...]:
    """The path of every module of the package, and all nodes of its syntax tree, a parent before its children."""
    files = sorted(PACKAGE.rglob("*.py"))
    return tuple((file, tuple(ast.walk(ast.parse(file.read_text(encoding="utf-8"))))) for file in files)
