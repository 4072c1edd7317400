"""The house in order: one way through it, rooms that keep to themselves, commands that only call,
all of them documented.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import get_type_hints

import pytest
from support import imports
from support.imports import tree
from support.paths import ENGINES, PACKAGE, ROOT

import balcli
from balcli.cli import COMMANDS
from balcli.commands import options
from balcli.commands.file_names import Place
from balcli.documents.names import DOCUMENTS
from balcli.render.formats import Format

README = (ROOT / "README.md").read_text(encoding="utf-8")
CORE = sorted((PACKAGE / "core").rglob("*.py"))
RENDER = sorted((PACKAGE / "render").rglob("*.py"))
LINES_OF_A_COMMAND = 25


def name_of(file: Path) -> str:
    return file.relative_to(PACKAGE).as_posix()


def imported(file: Path) -> Iterator[tuple[str, str]]:
    """(module, name) of everything a file imports, modules of its own with their full name; also
    inside functions.
    """
    package = ["balcli", *file.relative_to(PACKAGE).parts[:-1]]
    for node in ast.walk(tree(file)):
        if isinstance(node, ast.Import):
            yield from ((alias.name, "") for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            own = package[: len(package) - node.level + 1] if node.level else []
            module = ".".join([*own, *([node.module] if node.module else [])])
            yield from ((module, alias.name) for alias in node.names)


# ------------------------------------------------------------------ commands
def definition(command: str) -> ast.FunctionDef:
    """The one function of a command's module that bears its name."""
    body = tree(PACKAGE / "commands" / f"{command}.py").body
    (function,) = (n for n in body if isinstance(n, ast.FunctionDef) and n.name == command)
    return function


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_is_a_module_with_a_function_of_its_name(command):
    described, *body = definition(command).body
    assert isinstance(described, ast.Expr), "help is the docstring"
    length = body[-1].end_lineno - body[0].lineno + 1
    assert length <= LINES_OF_A_COMMAND


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_computes_nothing_and_prints_by_way_of_output(command):
    """It imports no library that computes or writes, and no call of it prints."""
    file = PACKAGE / "commands" / f"{command}.py"
    assert not {module.partition(".")[0] for module, _ in imported(file)} & {"numpy", "rich", "matplotlib", "csv"}
    calls = [ast.unparse(n.func) for n in ast.walk(tree(file)) if isinstance(n, ast.Call)]
    assert "print" not in calls
    assert "sys.stdout.write" not in calls


def paths_of(command: str) -> tuple[set[str], set[str]]:
    """Parameters of a command that name engine files, and those that name other files."""
    function = getattr(import_module(f"balcli.commands.{command}"), command)
    engines = (options.EnginePath, options.EnginePaths)
    marked = get_type_hints(function, include_extras=True).items()
    plain = get_type_hints(function).items()
    return (
        {name for name, kind in marked if kind in engines},
        {name for name, kind in plain if kind in (Path, Path | None, Place | None)},
    )


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
    """Outside the core, whose bounds belong to its methods."""
    found = {
        f"{name_of(file)}: {target.id}"
        for file in {*PACKAGE.rglob("*.py")} - {*CORE, PACKAGE / "limits.py"}
        for node in tree(file).body
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name) and target.id.startswith(LIMITS)
    }
    assert found == set()


# Where a name may stand again, by the module's name and a name.
OF_THE_SAME_THING = [
    (r"documents/.*", r".*"),  # a result as JSON has it
    (r"(commands|library)/\w+\.py", "|".join([*COMMANDS, "main"])),  # doors to what is computed
    (r"(__main__|cli)\.py", r"main"),
    # tables of files, which are built into the same in SI units
    (r"enginefile/(model|\w+_tables)\.py|torsion/chain_file\.py", r".*"),
    (r"render/\w+\.py", r"document|sheet|sheet_parts|rows|columns"),  # one of each a result
    (
        r"(mounting|torque|torsion|forces)/\w*quantity\.py",  # chapters, as sweeps call them
        r"Variants|evaluate_engine|list_names|parse_quantity|refuse_unknown",
    ),
    (r"core/mechanisms/\w+\.py", r".*"),  # the same figure by another method
]


def test_a_public_name_stands_for_one_thing():
    """In the whole house; what only a module knows has a name that begins with an underscore."""
    rooms: dict[str, list[str]] = {}
    for file in sorted(PACKAGE.rglob("*.py")):
        for node in tree(file).body:
            if isinstance(node, ast.ClassDef | ast.FunctionDef) and node.name[0] != "_":
                rooms.setdefault(node.name, []).append(name_of(file))

    def count(name: str) -> int:
        return sum(
            not any(re.fullmatch(where, room) and re.fullmatch(what, name) for where, what in known)
            for room in rooms[name]
        )

    known = OF_THE_SAME_THING
    assert {name: rooms[name] for name in rooms if count(name) > 1} == {}


@pytest.mark.parametrize("file", sorted(PACKAGE.rglob("*.py")), ids=name_of)
def test_files_speak_for_themselves(file):
    """A docstring, and none of what fails silently: blanket except (but at the process's end, where
    it is told as our fault), assert as a check, eval.
    """
    module = tree(file)
    if file.name != "__main__.py":
        assert ast.get_docstring(module)
    for node in ast.walk(module):
        assert not isinstance(node, ast.Assert), f"line {node.lineno}"
        assert not (isinstance(node, ast.ExceptHandler) and node.type is None), f"line {node.lineno}"
        assert not (
            isinstance(node, ast.ExceptHandler)
            and file.name != "__main__.py"
            and ast.unparse(node.type) in ("Exception", "BaseException")
        ), f"line {node.lineno}"
        assert not (isinstance(node, ast.Call) and ast.unparse(node.func) in ("eval", "exec")), f"line {node.lineno}"


def names_for_type_checkers() -> set[str]:
    """Of the library's door, as far as they are those of its rooms."""
    block, _ = (node for node in tree(PACKAGE / "__init__.py").body if isinstance(node, ast.If))
    imports = [node for node in block.body if isinstance(node, ast.ImportFrom) and node.level]
    assert all(balcli._ROOMS[alias.name] == node.module for node in imports for alias in node.names)
    return {alias.name for node in imports for alias in node.names}


def test_public_names_are_there():
    """The library's door: what it promises can be had, and is offered for completion."""
    assert dir(balcli) == sorted(balcli.__all__)
    assert {*balcli._ROOMS, "__version__"} == {*balcli.__all__}
    assert balcli._ROOMS.keys() == names_for_type_checkers()
    for name in balcli.__all__:
        assert getattr(balcli, name) is not None
    with pytest.raises(AttributeError, match="module 'balcli' has no attribute 'frobnicate'"):
        _ = balcli.frobnicate


def test_the_library_does_what_the_command_does():
    engine = balcli.load(ENGINES / "v8_crossplane.toml")
    found = balcli.analyze(engine, only=["moment"]).spectra.moment
    left = balcli.balance(engine, "counterweights").after.spectra.moment
    assert found.major[0] > 1000
    assert left.major[0] < 1e-9 * found.major[0]


def test_every_format_of_json_has_a_schema():
    """Its types are in documents/, its name in documents/names.py; docs/json.md lists it."""
    found = set()
    for file in PACKAGE.rglob("*.py"):
        found |= {*re.findall(r'"balcli\.([a-z_]+)/1"', file.read_text(encoding="utf-8"))}
    assert found == {*DOCUMENTS}
