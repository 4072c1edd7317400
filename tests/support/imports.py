"""What every module imports when it is imported itself, and what its functions import later."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from .paths import PACKAGE

WEIGHTY = frozenset(
    ["numpy", "pydantic", "rich", "matplotlib", "jinja2", "tomli_w", "distributed", "pyarrow", "scipy", "typer"]
)


@cache
def tree(file: Path) -> ast.Module:
    """What a file says, parsed once."""
    return ast.parse(file.read_text(encoding="utf-8"))


def module_name(file: Path) -> str:
    """`balcli.core.phasors`; of an `__init__.py` the package."""
    parts = file.relative_to(PACKAGE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


FILES = {module_name(file): file for file in sorted(PACKAGE.rglob("*.py"))}


@cache
def at_once(module: str) -> frozenset[str]:
    """The modules that are imported together with this one, by its own lines."""
    return frozenset(name for name, later in _imports(module) if not later)


@cache
def later(module: str) -> frozenset[str]:
    """The modules that its functions import when they are called."""
    return frozenset(name for name, later in _imports(module) if later)


@cache
def weight(module: str) -> frozenset[str]:
    """The weighty packages of others that come with a module, by way of others, too."""
    found: set[str] = set()
    waiting = [module]
    while waiting:
        name = waiting.pop()
        if name not in found:
            found.add(name)
            parent = name.rpartition(".")[0]
            waiting += [*at_once(name), *([parent] if parent in FILES else [])]
    return WEIGHTY & {name.partition(".")[0] for name in found}


def _imports(module: str) -> Iterator[tuple[str, bool]]:
    """Names of modules, and whether a function imports them; what only types need is left out."""
    if module not in FILES:
        return
    file = FILES[module]
    package = module.split(".") if file.name == "__init__.py" else module.split(".")[:-1]
    for node, later in _statements(tree(file), False):
        if isinstance(node, ast.Import):
            yield from ((alias.name, later) for alias in node.names)
            continue
        base = package[: len(package) - node.level + 1] if node.level else []
        origin = ".".join([*base, *([node.module] if node.module else [])])
        for alias in node.names:
            inner = f"{origin}.{alias.name}"
            yield (inner if inner in FILES else origin), later


def _statements(node: ast.AST, inside: bool) -> Iterator[tuple[ast.Import | ast.ImportFrom, bool]]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, (ast.Import, ast.ImportFrom)):
            yield child, inside
        elif not isinstance(child, ast.expr) and not (
            isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING"
        ):
            yield from _statements(child, inside or isinstance(child, ast.FunctionDef))
