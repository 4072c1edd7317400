"""Results can be kept, sent to other processes and copied: they come back equal."""

from __future__ import annotations

import copy
import pickle
from dataclasses import fields, is_dataclass
from pathlib import Path

import numpy as np
import pytest
from support.engines import build_text, engine_text

from balcli import (
    analyze,
    analyze_mounts,
    analyze_torque,
    analyze_torsion,
    balance,
    balance_rotor,
    load,
)
from balcli.analysis.curves import compute_cylinder_curves, compute_engine_curves
from balcli.balancing.answer import balance_knuckles
from balcli.engine.parse import parse
from balcli.forces.curves import divide_revolution
from balcli.sizing.options import SchemeOptions
from balcli.sizing.schemes import SCHEMES

ENGINES = Path(__file__).parents[2] / "engines"
EVERYTHING = ["force", "moment", "couple", "torque", "roll", "peak", "sizing", "inner", "guide"]
WAYS = {"pickle": lambda result: pickle.loads(pickle.dumps(result)), "deepcopy": copy.deepcopy}


def difference(one: object, other: object, path: str = "result") -> str:
    """Where two results differ; empty if nowhere."""
    if type(one) is not type(other):
        return f"{path}: {type(one).__name__} is not {type(other).__name__}"
    members: list[tuple[str, object, object]] = []
    if isinstance(one, np.ndarray):
        same = one.dtype == other.dtype and np.array_equal(one, other, equal_nan=one.dtype != "O")
        return "" if same else f"{path}: {one} is not {other}"
    if is_dataclass(one):
        members = [(field.name, getattr(one, field.name), getattr(other, field.name)) for field in fields(one)]
    elif isinstance(one, dict):
        if one.keys() != other.keys():
            return f"{path}: other keys"
        members = [(f"[{key}]", one[key], other[key]) for key in one]
    elif isinstance(one, (tuple, list)):
        if len(one) != len(other):
            return f"{path}: other length"
        members = [(f"[{k}]", *pair) for k, pair in enumerate(zip(one, other, strict=True))]
    else:
        same = one == other or (one != one and other != other)
        return "" if same else f"{path}: {one} is not {other}"
    found = (difference(a, b, f"{path}.{name}") for name, a, b in members)
    return next(filter(None, found), "")


def test_differences_are_found():
    engine = load(ENGINES / "i3.toml")
    assert "orders" in difference(analyze(engine), analyze(engine, orders=[1]))
    one, other = (balance(engine, scheme) for scheme in ("auto", "couple-shaft"))
    assert difference(one, other) == "result.remedy.[0]: auto is not couple-shaft"
    again = balance(engine)
    again.after.spectra.force.forward[0] += 1e-12
    assert difference(one, again).startswith("result.after.spectra.force.vectors:")


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", ["i3", "v8_crossplane", "radial7_articulated", "rotary9"])
def test_an_analysis_comes_back_equal(name, way):
    result = analyze(load(ENGINES / f"{name}.toml"), only=EVERYTHING, by_cylinder=True, reasons=True)
    assert difference(result, WAYS[way](result)) == ""


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_balance_comes_back_equal(scheme, way):
    options = SchemeOptions(step=1) if scheme == "step" else None
    result = balance(build_text(engine_text(operation="speed = 3000")), scheme, options)
    assert difference(result, WAYS[way](result)) == ""


@pytest.mark.parametrize("way", WAYS)
def test_even_knuckles_come_back_equal(way):
    model = parse((ENGINES / "radial7_articulated.toml").read_bytes())
    result = balance_knuckles(model)
    assert difference(result, WAYS[way](result)) == ""


@pytest.mark.parametrize("way", WAYS)
def test_curves_come_back_equal(way):
    angles = divide_revolution(30.0)
    for result in (
        compute_engine_curves(load(ENGINES / "i3.toml"), angles),
        compute_cylinder_curves(load(ENGINES / "i3.toml"), 2, angles),
    ):
        assert difference(result, WAYS[way](result)) == ""


GAS = '\n[gas]\ncycle = "{burn}"\ncompression_ratio = 9\nimep = 9\n'
RUNS = """
planes = ["disc"]
[[run]]
readings = ["5 @ 30"]
[[run]]
readings = ["7 @ 80"]
weights = { disc = "2 @ 0" }
"""
OF_CHAPTERS = {
    "torque": lambda: analyze_torque(load(ENGINES / "i4_wiebe.toml")),
    "torsion": lambda: analyze_torsion(load(ENGINES / "i6_diesel.toml"), [1500, 2000]),
    "mounts": lambda: analyze_mounts(ENGINES / "i4_mounts.toml", [700, 3000]),
    "rotor": lambda: balance_rotor(RUNS),
}


@pytest.mark.slow
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("burn", ["otto", "diesel", "wiebe"])
@pytest.mark.parametrize("name", ["i3", "radial7_articulated"])
def test_engines_with_gas_do_the_same_in_another_process(name, burn, way):
    text = (ENGINES / f"{name}.toml").read_text(encoding="utf-8") + GAS.format(burn=burn)
    engine = load(text)
    again = WAYS[way](engine)
    assert analyze_torque(again).to_dict() == analyze_torque(engine).to_dict()
    result = analyze(engine, only=["roll"])
    assert WAYS[way](result).to_dict() == result.to_dict()


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("chapter", OF_CHAPTERS)
def test_answers_of_chapters_come_back_and_can_be_compared(chapter, way):
    result = OF_CHAPTERS[chapter]()
    again = WAYS[way](result)
    assert again.to_dict() == result.to_dict()
    assert result == result
    assert result != again, "identity, as of all that holds arrays"
