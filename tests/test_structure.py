"""Who imports whom, also by name, and how large the parts are."""

import ast
import re
import subprocess
import sys
import tokenize
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.paths import PACKAGE, ROOT

import balcli
from balcli import names

FILES = sorted(file for file in PACKAGE.rglob("*.py") if file.name != "__init__.py")
MOST_MODULES, MOST_LINES = 200, 630  # of the package; of a module, docstrings and all
MOST_OF_A_ROOM = {"studies": 24, "core": 24, "analysis": 20, "file": 20}  # modules; of any other room 16
MOST_CODE_LINES = 26_500  # without docstrings, comments, blank lines and imports
MOST_LAZY_IMPORTS = 40  # of own modules inside functions


def test_the_import_contract_is_kept() -> None:
    """One way through the floors, no circle, and a core of numpy alone: `[tool.importlinter]` of pyproject.toml."""
    pytest.importorskip("importlinter")
    run = [sys.executable, "-c", "from importlinter.cli import lint_imports; raise SystemExit(lint_imports())"]
    done = subprocess.run(run, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_package_keeps_to_its_budgets() -> None:
    rooms = Counter(file.relative_to(PACKAGE).parts[0] for file in FILES if file.parent != PACKAGE)
    lengths = {str(file): len(file.read_text(encoding="utf-8").splitlines()) for file in FILES}
    assert len(FILES) <= MOST_MODULES
    assert {room: count for room, count in rooms.items() if count > MOST_OF_A_ROOM.get(room, 16)} == {}
    assert {name: length for name, length in lengths.items() if length > MOST_LINES} == {}
    assert sum(len(set(list_code_lines(file))) for file in FILES) <= MOST_CODE_LINES
    assert sum(map(count_lazy_imports, FILES)) <= MOST_LAZY_IMPORTS


def list_code_lines(file: Path) -> Iterator[int]:
    """Numbers of the lines with a name, an operator or a number, imports left out."""
    imports = {
        number
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Import | ast.ImportFrom)
        for number in range(node.lineno, node.end_lineno + 1)
    }
    with tokenize.open(file) as lines:
        for token in tokenize.generate_tokens(lines.readline):
            if token.type in (tokenize.NAME, tokenize.OP, tokenize.NUMBER) and token.start[0] not in imports:
                yield token.start[0]


def count_lazy_imports(file: Path) -> int:
    """Imports that are indented, but for those of types alone."""
    text = re.sub(r"(?m)^if TYPE_CHECKING:\n(    .*\n|\n)+", "", file.read_text(encoding="utf-8"))
    return len(re.findall(r"(?m)^ +from \.", text))


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
        names.NOTEBOOK,
    ]
    assert [place for place in places if names.import_name(place) is None] == []
