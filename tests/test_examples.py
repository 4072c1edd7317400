"""Python examples of documents and docstrings, read by a type checker: they use only names and attributes that exist.

One run of mypy checks all examples, each as a file of its own, beside two that are wrong.
"""

import ast
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from textwrap import dedent

import docs_examples as guide
import pytest

pytest.importorskip("mypy")

pytestmark = pytest.mark.slow
SOURCE = guide.ROOT / "src"
CACHE = guide.ROOT / ".mypy_cache" / "examples"
SHOWS_A_WRONG_TYPE = "except TypeError as error:"
NAMES = "from balcli import *\nfrom balcli.errors import ArgumentError, Message\n"  # those of `help`
ENGINE = 'engine = load("v8.toml")\n'  # what examples without `load` are about
WRONG = {
    "wrong_attribute.py": 'from balcli import analyze, load\nanalyze(load("v8.toml")).peak.forces\n',
    "wrong_argument.py": 'from balcli import load\nload("v8.toml").balance(schema="two-shaft")\n',
}


def name_file(path: Path, line: int) -> str:
    """Return a name of a module that says where an example stands."""
    place = path.relative_to(guide.ROOT).with_suffix("").as_posix()
    return f"{re.sub(r'[^a-zA-Z]+', '_', place)}_{line}.py"


def read_documents() -> Iterator[tuple[str, str]]:
    """Yield name and code of each Python block in README.md and docs/**/*.md."""
    for path in guide.DOCUMENTS:
        for block in guide.blocks(path.read_text("utf-8")):
            if block.language == "python" and SHOWS_A_WRONG_TYPE not in block.lines:
                yield name_file(path, block.first), "\n".join(block.lines) + "\n"


def read_docstrings() -> Iterator[tuple[str, str]]:
    """Yield name and code of each docstring with `>>>`."""
    for path in SOURCE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if not isinstance(node, ast.FunctionDef | ast.ClassDef):
                continue
            lines = re.findall(r"^ *>>> (.*)$", ast.get_docstring(node) or "", re.MULTILINE)
            if lines:
                code = "\n".join(lines) + "\n"
                start = "" if "load" in code else ENGINE
                yield name_file(path, node.lineno), NAMES + start + code


def read_package() -> Iterator[tuple[str, str]]:
    """Yield the example at the head of the package."""
    path = SOURCE / "balcli" / "__init__.py"
    head = ast.get_docstring(ast.parse(path.read_text("utf-8"))) or ""
    yield name_file(path, 1), dedent("\n".join(re.findall(r"^(?: {4}.*)?$", head, re.MULTILINE)))


@pytest.fixture(scope="module")
def examples() -> dict[str, str]:
    return dict([*read_documents(), *read_docstrings(), *read_package()])


@pytest.fixture(scope="module")
def errors(examples: dict[str, str], tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Messages of mypy, each with the name of its file."""
    folder = tmp_path_factory.mktemp("examples")
    for name, code in (examples | WRONG).items():
        (folder / name).write_text(code, encoding="utf-8")
    options = ("--config-file=", "--ignore-missing-imports", "--check-untyped-defs", f"--cache-dir={CACHE}")
    run = subprocess.run(
        [sys.executable, "-m", "mypy", *options, "--no-error-summary", "."],
        cwd=folder,
        env=os.environ | {"MYPYPATH": str(SOURCE)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 1, run.stdout + run.stderr  # of what is wrong on purpose
    return run.stdout.splitlines()


def test_there_are_examples_of_documents_and_docstrings(examples: dict[str, str]) -> None:
    assert any(name.startswith(("README", "docs_tour")) for name in examples)
    assert any(name.startswith("src_balcli_analysis_answer") for name in examples)
    assert any("counterweights" in code for name, code in examples.items() if name.startswith("src_balcli_init"))


def test_examples_use_what_exists(errors: list[str]) -> None:
    assert [line for line in errors if not line.startswith("wrong_")] == []


def test_an_attribute_or_argument_that_does_not_exist_is_an_error(errors: list[str]) -> None:
    told = "\n".join(errors)
    assert 'wrong_attribute.py:2: error: "Peaks" has no attribute "forces"' in told
    assert 'wrong_argument.py:2: error: Unexpected keyword argument "schema"' in told
