"""The public engine: its methods are the functions of the library, named like the commands."""

import pickle
import re
from functools import cache

import pytest

import balcli
from balcli.api import Engine
from balcli.cli import COMMANDS
from balcli.core.records import Asked

# Commands that compute nothing for users of Python, or whose function has no engine.
WITHOUT_FUNCTION = {"layouts", "report", "numbers", "new", "engines", "schema", "check", "bench"}
WITHOUT_ENGINE = {"field", "tables"}
FUNCTIONS = sorted(COMMANDS.keys() - WITHOUT_FUNCTION)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_command_has_a_function_and_a_method_of_its_name(name):
    """The method is the function, so that there is one signature and one documentation."""
    function = getattr(balcli, name)
    assert callable(function)
    if name not in WITHOUT_ENGINE:
        assert vars(Engine)[name] is function


def test_a_method_gives_what_the_function_gives():
    engine = balcli.load_example("i4")
    assert engine.analyze([2]).to_dict() == balcli.analyze(engine, [2]).to_dict()
    assert engine.sum(engine, phase=90).to_dict() == balcli.sum(engine, engine, phase=90).to_dict()


@pytest.mark.parametrize(
    "make",
    [
        lambda: balcli.load(balcli.load_example("i4").to_dict()),
        lambda: balcli.load_example("i4").vary({"rod.length": 150}),
        lambda: balcli.load_example("i4").at_speed(1000),
        lambda: balcli.load_example("i3").balance("counterweights").after.engine,
        lambda: balcli.load_example("i4").search("throws", "force.2.major").engine(1),
        lambda: pickle.loads(pickle.dumps(balcli.load_example("i4"))),
    ],
    ids=["load", "vary", "at_speed", "balance", "search", "pickle"],
)
def test_engines_that_come_from_an_engine_have_the_methods(make):
    engine = make()
    assert isinstance(engine, balcli.Engine)
    assert engine.analyze([1]).engine is engine


EXAMPLES = {"analyze": "i4_wiebe", "balance": "i4", "torque": "v8_wiebe", "torsion": "i6_diesel", "mounts": "i4_mounts"}
RESULTS = {
    "analyze": balcli.Analysis,
    "balance": balcli.Balance,
    "torque": balcli.TorqueAnalysis,
    "torsion": balcli.TorsionAnalysis,
    "mounts": balcli.MountReport,
}
ASKED = [
    (function, name, attribute.how)
    for function, kind in RESULTS.items()
    for name, attribute in vars(kind).items()
    if isinstance(attribute, Asked)
]


@pytest.mark.parametrize(("function", "name", "how"), ASKED)
def test_what_an_error_says_is_the_way_to_ask(function, name, how):
    """If an argument of the function decides, and not the file."""
    if "=" not in how:
        assert any(word in how for word in ("file", "scheme", "balcli"))
        return
    arguments = re.split(", (?:or|and) ", how)[0]
    few = ", orders=[3, 4.5, 6]" if function == "torsion" and "orders" not in arguments else ""
    assert hasattr(ask(function, arguments + few), name)


@cache
def ask(function, arguments):
    engine = balcli.load_example(EXAMPLES[function])
    return eval(f"engine.{function}({arguments})", {"engine": engine, "Shapes": balcli.Shapes})


def test_what_was_not_asked_for_says_how_to_ask():
    found = balcli.load_example("i4").analyze(only=["force"])
    with pytest.raises(balcli.NotComputedError, match=r'^peak was not computed; ask for it with only=\["peak"\]$'):
        _ = found.peak
    with pytest.raises(balcli.NotComputedError, match=r'^moment was not computed; ask for it with only=\["moment"\]$'):
        _ = found.spectra["moment"]
    with pytest.raises(KeyError, match="torque of wheels; there are force, moment, "):
        _ = found.spectra["torque of wheels"]
