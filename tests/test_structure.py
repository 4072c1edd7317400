"""The house in order: who imports whom, how large its parts are, and that what it promises is there."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from support.paths import PACKAGE, ROOT

import balcli
from balcli.cli import COMMANDS
from balcli.documents.names import DOCUMENTS

FILES = sorted(PACKAGE.rglob("*.py"))
MOST_MODULES, MOST_LINES = 365, 630  # of the package; of a module, docstrings and all
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


<<<<<<< HEAD
def test_every_limit_stands_in_limits() -> None:
=======
@pytest.mark.parametrize("command", [name for name in COMMANDS if all(paths_of(name))])
def test_what_reads_engines_and_writes_files_first_refuses_to_overwrite(command):
    """It names every path of an engine among `reads`, every other path by its option."""
    reads, writes = paths_of(command)
    call = definition(command).body[1].value
    assert ast.unparse(call.func) == "refuse_overwriting"
    told = {keyword.arg: keyword.value for keyword in call.keywords}
    assert {n.id for n in ast.walk(told["reads"]) if isinstance(n, ast.Name)} == reads
    assert {key.value: value.id for key, value in zip(told["writes"].keys, told["writes"].values, strict=True)} == {
        "OUT" if name == "target" else f"--{name}": name for name in writes
    }


def test_the_readme_names_every_format():
    (formats,) = set(re.findall(r"`--format ([a-z|]+)`", README))
    assert formats.split("|") == list(Format)


def test_modules_of_commands_are_commands_or_their_helpers():
    """No command is forgotten in the list: a module whose function bears its name and has help is
    one.
    """
    forgotten = []
    for file in (PACKAGE / "commands").glob("*.py"):
        functions = [n for n in tree(file).body if isinstance(n, ast.FunctionDef) and n.name == file.stem]
        if functions and file.stem not in COMMANDS:
            forgotten.append(file.stem)
    assert forgotten == []


# ------------------------------------------------------------------ rooms
@pytest.mark.parametrize("file", CORE, ids=name_of)
def test_core_knows_numpy_and_the_standard_library_alone(file):
    strangers = {
        module
        for module, _ in imported(file)
        if module.partition(".")[0] not in {"numpy", "__future__", *sys.stdlib_module_names}
        and not module.startswith("balcli.core")
    }
    assert strangers == set()


# What is imported by who asks for it: a plain `analyze --format json` is to import no format, chapter
# or kind of engine that it does not need.
ON_REQUEST = {
    "balcli.__main__": ("balcli.cli",),
    "balcli.cli": ("balcli.commands.other_words",),
    "balcli.commands.analysis_answer": (
        *("balcli.render.marine", "balcli.results.marine"),
        *("balcli.render.speeds", "balcli.results.speeds"),
    ),
    "balcli.commands.completion": (
        "balcli.documents.names",
        "balcli.enginefile.examples",
        "balcli.enginefile.templates",
        "balcli.sizing.schemes",
        "balcli.studies.quantity_names",
    ),
    "balcli.commands.defaults": ("balcli.enginefile.toml_text",),
    "balcli.commands.overwrite_guard": ("balcli.commands.named_files",),
    "balcli.core.mechanisms.harmonics": ("balcli.core.mechanisms.sampled", "balcli.core.mechanisms.slidercrank"),
    "balcli.engine.assembly": (
        "balcli.core.strokes",
        "balcli.core.mechanisms.rotary",
        "balcli.engine.articulation",
        "balcli.engine.build_gas",
    ),
    "balcli.engine.build": ("balcli.engine.vary", "balcli.enginefile.suspicious"),
    "balcli.engine.rules": ("balcli.engine.articulation",),
    "balcli.enginefile.toml_text": ("balcli.enginefile.examples", "balcli.enginefile.toml_slips"),
    "balcli.forces.spectrum": ("balcli.forces.gas",),
    "balcli.forces.symmetry": ("balcli.forces.gas_symmetry",),
    "balcli.library.arguments": ("balcli.studies.stated_tolerances",),
    "balcli.render.analyses": ("balcli.render.analysis", "balcli.render.analysis_document"),
    "balcli.render.analysis_document": (
        *("balcli.render.crankshaft", "balcli.render.guide_moments"),
        *("balcli.render.strokes", "balcli.render.symmetry"),
    ),
    "balcli.render.formats": (*(f"balcli.render.{form}" for form in Format), "balcli.render.terminal"),
    "balcli.results.analysis": (
        "balcli.core.strokes",
        "balcli.forces.crankshaft",
        "balcli.forces.guide_moments",
        "balcli.forces.in_bearings",
        "balcli.forces.symmetry",
        "balcli.forces.textbook",
        "balcli.sizing.auto",
        "balcli.sizing.remedy",
    ),
    "balcli.render.html": (
        *("balcli.render.mounts", "balcli.render.page_mounts"),
        *("balcli.render.torsion", "balcli.render.plot.torsion"),
        "balcli.render.page_torque",
    ),
    "balcli.commands.inputs": ("balcli.enginefile.assumed", "balcli.torque.course"),
    "balcli.commands.output": ("balcli.files", "balcli.render.plot.style"),
    "balcli.commands.torque_options": ("balcli.enginefile.edit",),
    "balcli.torque.analysis": ("balcli.torque.find_loads",),
    "balcli.commands.scatter": ("balcli.studies.cycle_scatter", "balcli.studies.part_scatter"),
    "balcli.studies.curves": ("balcli.torque.curves",),
}


def test_own_modules_are_imported_late_only_on_request_or_where_that_spares_a_library():
    """Numpy and pydantic for the help of a command, for one."""
    needless = [
        (module, other)
        for module in imports.FILES
        for other in imports.later(module) - {*ON_REQUEST.get(module, ())}
        if other in imports.FILES and not imports.weight(other) - imports.weight(module)
    ]
    assert needless == []


@pytest.mark.parametrize("module", ON_REQUEST)
def test_what_is_for_those_who_ask_is_imported_late(module):
    assert set(ON_REQUEST[module]) <= imports.later(module) - imports.at_once(module)


@pytest.mark.parametrize("command", COMMANDS)
def test_help_and_completion_of_a_command_wait_for_no_library(command):
    assert imports.weight(f"balcli.commands.{command}") <= {"typer"}


# Types and constants of a room may be named by what shows them, functions not: these shape figures
# for the eye.
SHAPING = {
    ("balcli.core.telling", "tell_nobody"),
    ("balcli.sizing.device_tables", "find_unbalance"),
    ("balcli.sizing.device_tables", "measure_direction"),
    ("balcli.sizing.device_tables", "name_kind"),
    ("balcli.sizing.balance_factor", "name_one_cylinder"),
    ("balcli.printed_tables.recomputed", "deviates"),
    ("balcli.printed_tables.recomputed", "parse_decimal"),
    ("balcli.printed_tables.recomputed", "parse_fraction"),
    ("balcli.printed_tables.recomputed", "round_like"),
}
COMPUTING = (
    "balcli.results.analysis",
    "balcli.results.balance",
    "balcli.forces.spectrum",
    "balcli.sizing",
    "balcli.core",
    "balcli.engine.build",
    "balcli.engine.load",
    "balcli.studies.sweep",
    "balcli.studies.deviations",
    "balcli.studies.tolerances",
    "balcli.studies.search.search",
    "balcli.results.comparison",
    "balcli.forces.curves",
    "balcli.printed_tables",
)


@pytest.mark.parametrize("file", RENDER, ids=name_of)
def test_renderers_call_no_computation(file):
    called = {
        (module, name)
        for module, name in imported(file)
        if module.startswith(COMPUTING) and name[:1].islower() and (module, name) not in SHAPING
    }
    assert called == set()


LIMITS = ("MOST", "LARGEST", "LONGEST", "HIGHEST", "DEEPEST", "FARTHEST", "FINEST", "NEAREST")


def test_every_limit_stands_in_limits():
>>>>>>> own-input
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


def test_a_command_is_a_module_with_a_function_of_its_name() -> None:
    files = {file.stem: parse(file).body for file in (PACKAGE / "commands").glob("*.py")}
    functions = Counter(
        name for name, body in files.items() for n in body if isinstance(n, ast.FunctionDef) and n.name == name
    )
    assert {*COMMANDS} == {*functions}


def test_public_names_are_there() -> None:
    """The library's door: what it promises can be had, and is offered for completion."""
    assert dir(balcli) == sorted(balcli.__all__)
    assert [name for name in balcli.__all__ if getattr(balcli, name) is None] == []
    with pytest.raises(AttributeError, match="module 'balcli' has no attribute 'frobnicate'"):
        _ = balcli.frobnicate


def test_every_document_of_the_package_has_a_schema() -> None:
    """Its types are in documents/, its name in documents/names.py."""
    found = {name for file in FILES for name in re.findall(r'"balcli\.([a-z_]+)/1"', file.read_text(encoding="utf-8"))}
    assert found == {*DOCUMENTS}
