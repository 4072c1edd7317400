"""Messages name arguments: a Python function by their names, a command by its options."""

import ast
import inspect
import pickle
import re
from collections.abc import Iterator
from copy import copy
from functools import cache
from string import Formatter
from typing import Any

import pytest
import typer
from support.paths import ROOT
from support.trees import list_nodes
from typer.main import get_command

import balcli
from balcli.cli import MODULES
from balcli.errors import Argument, ArgumentError, BalcliError, InputError, Message, Problem, name_option
from balcli.names import import_name

SOURCE = ROOT / "src" / "balcli"
WRONG = ArgumentError("{damper_at} {node!r}: choose from {nodes}", node="{hub}", nodes=["{a}", "b"])


def test_an_error_names_arguments_and_a_command_options() -> None:
    assert str(WRONG) == "damper_at '{hub}': choose from ['{a}', 'b']"
    assert WRONG.tell(name_option) == "--damper-at '{hub}': choose from ['{a}', 'b']"
    assert WRONG.args == (str(WRONG),)


@pytest.mark.parametrize(
    ("argument", "option"), [("speeds", "--speeds"), ("damper_at", "--damper-at"), ("lambda_", "--lambda")]
)
def test_an_option_follows_from_the_name_of_its_argument(argument: str, option: str) -> None:
    assert name_option(argument) == option


def test_values_that_name_arguments_are_told_as_well() -> None:
    hint = Message("leave {roll} out")
    error = ArgumentError("{name}: {reason}; {hint}", name=Argument("max_depth"), reason=WRONG, hint=hint)
    assert str(error) == f"max_depth: {WRONG}; leave roll out"
    assert error.tell(name_option) == f"--max-depth: {WRONG.tell(name_option)}; leave --roll out"


@pytest.mark.parametrize(
    ("error", "text", "told"),
    [
        (BalcliError("{b}"), "file: {b}", "file: {b}"),
        (ArgumentError("{at} is {b}", b="{at}"), "file: at is {at}", "file: --at is {at}"),
        (InputError([Problem("rod", "wrong")], "v8"), "file: v8: rod: wrong", "file: v8: rod: wrong"),
        (InputError([Problem("run", Message("see {without}"))]), "file: run: see without", "file: run: see --without"),
    ],
)
def test_a_name_in_front_keeps_the_kind_of_an_error_and_its_arguments(error: BalcliError, text: str, told: str) -> None:
    named = error.within("file")
    assert (type(named), str(named), named.tell(name_option)) == (type(error), text, told)
    assert error.within("").tell(name_option) == error.tell(name_option)


@pytest.mark.parametrize("renew", [copy, lambda error: pickle.loads(pickle.dumps(error))])
@pytest.mark.parametrize("error", [WRONG, InputError([Problem("run", Message("see {at} {b:g}", b=1.5))], "f")])
def test_errors_can_be_copied_and_pickled(renew: Any, error: BalcliError) -> None:
    again = renew(error)
    assert type(again) is type(error)
    assert str(again) == str(error)
    assert again.tell(name_option) == error.tell(name_option)


# ------------------------------------------------------------------ all messages of the source
def _list_modules() -> Iterator[tuple[str, tuple[ast.AST, ...]]]:
    """The path of every module below `balcli`, and the nodes of its syntax tree."""
    for file, nodes in list_nodes():
        yield str(file.relative_to(SOURCE)), nodes


def _list_kinds() -> set[str]:
    """The names of classes whose first argument is a text with arguments in braces."""
    kinds = {"ArgumentError", "Message"}
    for _, nodes in _list_modules():
        for node in nodes:
            if isinstance(node, ast.ClassDef) and "ArgumentError" in map(ast.unparse, node.bases):
                kinds.add(node.name)
    return kinds


def _list_texts() -> Iterator[tuple[str, ast.Call]]:
    """The place and the call of every `ArgumentError(…)` and `Message(…)`."""
    kinds = _list_kinds()
    for path, nodes in _list_modules():
        for node in nodes:
            if path != "errors.py" and isinstance(node, ast.Call) and getattr(node.func, "id", None) in kinds:
                yield f"{path}:{node.lineno}", node


@cache
def _list_options(command: str) -> set[str]:
    """All options of a command, as typed."""
    app = typer.Typer()
    app.command(command)(import_name(f"{MODULES[command]}:{command}"))
    return {spelling for parameter in get_command(app).params for spelling in parameter.opts}


def test_every_name_in_braces_is_a_value_or_an_option() -> None:
    options = set().union(*map(_list_options, MODULES))
    wrong = []
    count = 0
    for place, call in _list_texts():
        text, *others = call.args
        if others or not isinstance(text, ast.Constant):
            wrong.append(f"{place}: the text is not a literal")
            continue
        values = {keyword.arg for keyword in call.keywords}
        fields = {field for _, field, _, _ in Formatter().parse(text.value) if field is not None}
        wrong += [f"{place}: {{{field}}}" for field in fields - values if name_option(field) not in options]
        wrong += [f"{place}: {value} is not in the text" for value in values - fields]
        count += 1
    assert wrong == []
    assert count > 100


@pytest.mark.parametrize("name", sorted(MODULES.keys() & {*balcli.__all__}))
def test_arguments_have_the_names_of_options(name: str) -> None:
    """Those with a default, but for objects that only Python has."""
    objects = {"beside", "names", "options", "others", "shapes", "tools"}
    parameters = inspect.signature(getattr(balcli, name)).parameters
    optional = {key for key, parameter in parameters.items() if parameter.default is not parameter.empty}
    assert {*map(name_option, optional - objects)} <= _list_options(name)


@pytest.mark.parametrize("kind", [balcli.SchemeOptions, balcli.Tools, balcli.Shapes])
def test_fields_have_the_names_of_options(kind: Any) -> None:
    assert {*map(name_option, kind._fields)} <= _list_options("balance")


# Modules that write what a command prints or asks; all others may name arguments only.
OF_COMMANDS = ("cli", "commands", "shell/", "show/", "regression/", "analysis/options", "report/live")
OF_TABLES = ("analysis/overview", "analysis/sections")
OPTION = re.compile(r"(?<![\w-])--[a-z]")


def _is_of_a_command(path: str) -> bool:
    named = path.removesuffix(".py").endswith(("command", "show"))
    return named or path.startswith((*OF_COMMANDS, *OF_TABLES))


def test_no_message_below_the_commands_names_an_option() -> None:
    wrong = []
    for path, nodes in _list_modules():
        if _is_of_a_command(path):
            continue
        docstrings = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
        for node in nodes:
            if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docstrings:
                wrong += [f"{path}:{node.lineno}: {node.value}"] if OPTION.search(node.value) else []
    assert wrong == []
