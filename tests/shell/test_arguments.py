"""What is wrong names the function's own arguments, not the options of the command line."""

from itertools import count, repeat

import pytest
from support.cases import cases

import balcli

V8 = balcli.load_example("v8_crossplane")
CHAIN = {
    "fixed": ["wall"],
    "node": [{"name": "disc", "inertia": 1e6}, {"name": "wall"}],
    "shaft": [{"from": "disc", "to": "wall", "stiffness": 1e4}],
    "excitation": [{"node": "disc", "order": 1, "cos": 100}],
}


def refused(ask, *given, **options):
    """What a function says against its arguments; those of `balance` are options of its scheme."""
    if ask is balcli.balance:
        given = (*given, balcli.SchemeOptions(**options))
        options = {}
    with pytest.raises((balcli.BalcliError, TypeError)) as refusal:
        ask(*given, **options)
    return refusal.type, str(refusal.value)


@cases("shell/arguments", "errors_name_arguments", V8=V8, CHAIN=CHAIN, WIEBE=balcli.load_example("i4_wiebe"))
def test_errors_name_arguments(ask, given, options, told):
    kind, message = refused(getattr(balcli, ask), *given, **options)
    assert issubclass(kind, balcli.BalcliError)
    assert message == told


@pytest.mark.parametrize(
    "ask",
    [
        lambda: balcli.analyze(V8, range(1_000_000)),
        lambda: balcli.analyze(V8, count()),
        lambda: balcli.analyze(V8, only=repeat("force", 1_000_000)),
        lambda: balcli.balance(V8, orders=repeat(1, 1_000_000)),
        lambda: balcli.compare(V8, V8, names=repeat("a", 1_000_000)),
        lambda: balcli.torsion(CHAIN, range(1_000_000)),
        lambda: balcli.sweep(V8, {"rod.ratio": range(10_000_001)}, "force.1.major"),
        lambda: balcli.sweep(V8, {"rod.ratio": [0.2, 0.3]}, repeat("force.1.major", 1_000_000)),
        lambda: balcli.load({"crank": {"stroke": 90, "throws": repeat(0, 1_000_000)}}),
    ],
)
def test_iterables_are_read_no_farther_than_a_limit(ask):
    with pytest.raises(balcli.BalcliError, match=r"has more than \d+ values|has 20001 values; give at most"):
        ask()


def test_a_sweep_of_one_value_is_no_picture():
    told = "0 parameters have several values; a picture shows one or two of them"
    assert refused(balcli.plot, balcli.sweep(V8, {"rod.ratio": [0.25]}, "force.1.major"))[1] == told


@cases("shell/arguments", "what_is_of_another_type")
def test_what_is_of_another_type(options, told):
    assert refused(balcli.sum, V8, V8, **options) == (TypeError, told)
