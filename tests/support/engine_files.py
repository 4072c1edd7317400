"""Random engine files, sound and damaged, as strategies of hypothesis."""

from typing import Any

import tomli_w
from hypothesis import strategies as st

Tables = dict[str, Any]
HOSTILE = (
    *("", "nan", "inf", -1, 0, 1e308, 1e-308, True, [], {}, [[0]], "90 mm", "1/2 turn", "9**9**9 mm"),
    *("furlong", "\x1b[31mred", "$x_{", "<script>alert(1)</script>", "[bold]x[/]", "=1+1", "发动机", "x" * 5000),
    *(float("nan"), float("inf"), [1, "a", None is None], {"kind": "none"}, 2**70),
)


def numbers(low: float, high: float) -> st.SearchStrategy[float]:
    """Floats, often short ones."""
    return st.floats(low, high).map(lambda x: round(x, 3)) | st.floats(low, high)


@st.composite
def engine_tables(draw: st.DrawFn) -> Tables:
    """Tables of an engine file that is sound, if not always of an engine that anybody would build."""
    stroke = draw(numbers(20, 500))
    throws = draw(st.lists(st.sampled_from([0, 72, 90, 120, 180, 240, 270, 33.3]), min_size=1, max_size=8))
    tables: Tables = {
        "name": draw(st.text(st.characters(exclude_categories=["C", "Z"]), max_size=20)),
        "crank": {"stroke": stroke, "throws": throws, "throw_mass": draw(numbers(0, 5)), "spacing": 120},
        "rod": {"length": stroke * draw(numbers(0.8, 5)), "mass": draw(numbers(0, 5))},
        "piston": {"mass": draw(numbers(0, 5)), "bore": draw(numbers(20, 500))},
        "operation": {"speed": draw(numbers(1, 15000))},
    }
    tables["rod"]["cg"] = tables["rod"]["length"] * draw(numbers(0, 1))
    _add_chapters(draw, tables)
    return tables


def _add_chapters(draw: st.DrawFn, tables: Tables) -> None:
    """Add some of gas, body, torsion, devices, exceptions, uneven speed and banks."""
    if draw(st.booleans()):
        tables["gas"] = {"cycle": "wiebe", "compression_ratio": draw(numbers(5, 25)), "imep": draw(numbers(1, 30))}
        tables.setdefault("layout", {})["strokes"] = 2  # four-stroke engines need a firing order that fits
    if draw(st.booleans()):
        spring = st.lists(numbers(1, 5000), min_size=3, max_size=3)
        tables["body"] = {"mass": draw(numbers(10, 500)), "cg": [0, 0, 0], "inertia": [8e6, 12e6, 14e6, 0, 0, 0]}
        tables["mount"] = [
            {"name": str(k), "at": [x, y, -200], "stiffness": draw(spring), "loss": draw(numbers(0, 1))}
            for k, (x, y) in enumerate([(400, 300), (400, -300), (-400, 0)])
        ]
    if draw(st.booleans()):
        flywheel = {"name": "flywheel", "inertia": draw(numbers(1e5, 1e8)), "stiffness": draw(numbers(1e3, 1e7))}
        tables["torsion"] = {"throw_inertia": draw(numbers(1e3, 1e6)), "rear": [flywheel]}
        if len(tables["crank"]["throws"]) > 1:
            tables["torsion"]["throw_stiffness"] = draw(numbers(1e4, 1e7))
    if draw(st.booleans()):
        tables["counterweight"] = [{"unbalance": draw(numbers(0, 1e5)), "angle": draw(numbers(-360, 360))}]
        ratio = draw(st.sampled_from([1, -1, 2, -2]))
        tables["shaft"] = [{"ratio": ratio, "unbalance": draw(numbers(0, 1e4)), "at": [30, 40]}]
    if draw(st.booleans()):
        tables["cylinder"] = {"1": {"piston_mass": draw(numbers(0, 5))}}
        tables["piston"]["offset"] = draw(numbers(-3, 3))
    if draw(st.booleans()):
        line = {"order": draw(st.integers(1, 6)), "amplitude": draw(numbers(0, 0.2))}
        tables["operation"]["speed_ripple"] = [line]
    if draw(st.booleans()):
        tables.setdefault("layout", {})["bank_angle"] = draw(numbers(0, 180))


@st.composite
def engine_files(draw: st.DrawFn) -> str:
    """Engine files, three of four as they are, the others with a few values replaced, left out or added."""
    tables = draw(engine_tables())
    if draw(st.integers(0, 3)) == 0:
        for _ in range(draw(st.integers(1, 3))):
            _damage(draw, tables)
    text = tomli_w.dumps(tables)
    if draw(st.integers(0, 15)) == 0:
        text = text[: draw(st.integers(0, len(text)))] + draw(st.text(max_size=5))
    return text


def _damage(draw: st.DrawFn, tables: Tables) -> None:
    """Change one key of the file or of one of its tables."""
    inner = [table for table in tables.values() if isinstance(table, dict) and table]
    table = draw(st.sampled_from([tables, *inner]))
    key = draw(st.sampled_from(sorted(table)) | st.sampled_from(["strok", "gas", "torsion", "x", "inertia"]))
    if draw(st.booleans()):
        table.pop(key, None)
    else:
        table[key] = draw(st.sampled_from(HOSTILE))
