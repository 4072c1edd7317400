"""Engines side by side."""

import math
from typing import Any

import pytest
from support.commands import ask_json, run_here
from support.engines import GOOD, build_text, changed
from support.gas_engines import WIEBE

from balcli.analysis.answer import analyze
from balcli.analysis.comparison import Line, compare
from balcli.engine.engine import Engine
from balcli.errors import BalcliError


def compare_lines(*engines: Engine, **options: Any) -> dict[tuple[str, float | None], Line]:
    """The lines of a comparison by kind and order."""
    return {(line.kind.name, line.order): line for line in compare(*engines, **options).figures}


def test_force_of_order_2_goes_with_the_square_of_the_speed() -> None:
    slow = build_text(GOOD)
    fast = build_text(changed(("speed = 3000", "speed = 6000")))
    lines = compare_lines(slow, fast, names=["slow", "fast"])
    assert lines["force", 2].ratios == pytest.approx((1, 4))
    assert lines["force", None].ratios == pytest.approx((1, 4))
    assert lines["force", 1].values == (0, 0)
    assert math.isnan(lines["force", 1].ratios[1])


@pytest.mark.parametrize(
    ("second", "rpm", "told"),
    [
        ("speed = 3000", 3000, "speed  3000 rpm"),
        ("speed = 6000.5", 6000.5, "speeds  3000 rpm; 6000.5 rpm"),
        ("", 1000, "speeds  3000 rpm; 1000 rpm"),
    ],
)
def test_at_which_speeds_engines_are_compared_is_told(tmp_path, second: str, rpm: float, told: str) -> None:
    """Ratios of engines at different speeds are mostly those of their speeds."""
    files = tmp_path / "one.toml", tmp_path / "other.toml"
    for file, speed in zip(files, ("speed = 3000", second), strict=True):
        file.write_text(changed(("speed = 3000", speed)), encoding="utf-8")
    assert told in run_here("compare", *files).out.splitlines()
    document = ask_json("compare", *files)
    assert document["speeds_rpm"] == [3000, rpm]


@pytest.mark.parametrize(("letters", "numbered"), [(27, False), (28, True)])
def test_long_names_head_no_columns(tmp_path, letters: int, numbered: bool) -> None:
    """Two names of 54 letters fit into 80 places beside the ratio; assumed values stand below the figures."""
    names = "a" * 27, "b" * letters
    files = [tmp_path / f"{k}.toml" for k in range(2)]
    for file, name in zip(files, names, strict=True):
        file.write_text(changed(("in-line four", name)), encoding="utf-8")
    lines = run_here("compare", *files).out.splitlines()
    heads = next(line for line in lines if line.endswith("ratio")).split()
    assert heads == (["engine", "1", "engine", "2", "ratio"] if numbered else [*names, "ratio"])
    assert ([f"engine {k + 1}  {name}" for k, name in enumerate(names)] == lines[2:4]) is numbered
    (assumed,) = (k for k, line in enumerate(lines) if line.startswith("assumed"))
    assert assumed > max(k for k, line in enumerate(lines) if line.startswith("order"))
    assert max(map(len, lines)) <= 80


def test_orders_of_every_engine_are_shown() -> None:
    six = build_text(changed(("[0, 180, 180, 0]", "[0, 120, 240, 240, 120, 0]"), ("firing_order = [1, 3, 4, 2]", "")))
    lines = compare_lines(build_text(GOOD), six, names=["4", "6"], only=["force"])
    assert {order for _, order in lines} >= {1, 2, 4, 6}
    assert lines["force", 6].values[1] > 0
    assert {quantity for quantity, _ in lines} == {"force"}


def test_guides_with_gas_do_not_stand_beside_guides_without() -> None:
    """Unless all engines have gas, what is compared is that of inertia."""
    bare = build_text(GOOD)
    fired = build_text(GOOD + WIEBE)
    lines = compare_lines(fired, bare, orders=[0.5, 1, 2], only=["guide"])
    assert lines["guide_h", 2].ratios == (1, 1)
    assert lines["guide_x", 0.5].values == (0, 0)
    assert lines["guide_h", 2].kind.label == "H-type guide moment of inertia only"
    lines = compare_lines(fired, fired, orders=[0.5, 1, 2], only=["guide"])
    assert lines["guide_x", 0.5].values[0] > 0
    assert lines["guide_h", 2].kind.label == "H-type guide moment"


def test_one_engine_is_refused() -> None:
    with pytest.raises(BalcliError, match="compare needs at least two engines"):
        compare(build_text(GOOD))


def test_inner_guide_and_sizing_stand_side_by_side() -> None:
    engines = [build_text(GOOD), build_text(changed(("stroke = 90", "stroke = 80")))]
    found = compare_lines(*engines, only=["inner", "guide", "sizing"])
    lines = {key: line.values for key, line in found.items()}
    alone = [analyze(engine, [2], ["inner", "guide", "sizing"]) for engine in engines]
    bending = tuple(float(one.inner.bending.phasors.major[0].max()) for one in alone)
    assert lines["bending", 2] == pytest.approx(bending, rel=1e-12)
    assert lines["guide_h", 2] == pytest.approx([float(one.guide.h.major[0]) for one in alone])
    left = [one.sizing.after.peak.force.value for one in alone]
    assert lines["force with devices", None] == pytest.approx(left)
    assert {"shear", "bearing", "guide_x", "moment with devices"} <= {name for name, _ in lines}


def test_orders_that_are_asked_for_are_there_balanced_or_not() -> None:
    """In-line fours have no odd order of any force, moment or torque of inertia."""
    four = build_text(GOOD)
    kinds = ["force", "moment", "couple", "torque", "roll"]
    asked = compare(four, four, orders=[7], only=kinds).figures
    assert [(line.kind.name, line.order, line.values) for line in asked] == [(kind, 7, (0, 0)) for kind in kinds]
    unasked = compare(four, four, only=kinds, all=True).figures
    assert 7 not in {line.order for line in unasked}
