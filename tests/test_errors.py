"""Messages name arguments: a Python function by their names, a command by its options."""

import ast
import inspect
import pickle
from collections.abc import Iterator
from copy import copy
from string import Formatter
from typing import Any, get_type_hints

import pytest
from support.paths import ROOT

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
def _list_templates() -> Iterator[tuple[str, ast.Call]]:
    """The place and the call of every `ArgumentError(…)` and `Message(…)`."""
    for file in sorted(SOURCE.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", None) in ("ArgumentError", "Message"):
                yield f"{file.relative_to(SOURCE)}:{node.lineno}", node


def _list_arguments() -> set[str]:
    """The parameters of all public functions, and those of all commands that are options."""
    names: set[str] = set()
    for name in balcli.__all__:
        public = getattr(balcli, name)
        if inspect.isfunction(public):
            names |= {*inspect.signature(public).parameters}
        elif hasattr(public, "_fields"):  # SchemeOptions, Tools, Shapes: fields are options
            names |= {*get_type_hints(public)}
    for name, module in MODULES.items():
        names |= {*inspect.signature(import_name(f"{module}:{name}")).parameters}
    return names


def test_every_name_in_braces_is_a_value_or_an_argument() -> None:
    arguments = _list_arguments()
    wrong = []
    count = 0
    for place, call in _list_templates():
        if place.startswith("errors.py"):
            continue  # where messages are built of messages
        text, *others = call.args
        if others or not isinstance(text, ast.Constant):
            wrong.append(f"{place}: the text is not a literal")
            continue
        values = {keyword.arg for keyword in call.keywords}
        fields = {field for _, field, _, _ in Formatter().parse(text.value) if field is not None}
        wrong += [f"{place}: {{{field}}}" for field in fields - values - arguments]
        wrong += [f"{place}: {value} is not in the text" for value in values - fields]
        count += 1
    assert wrong == []
    assert count > 40
