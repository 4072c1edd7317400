"""Figures that vary: each takes the place of what the file says, wherever an engine needs it."""

import tomllib
from dataclasses import fields
from functools import cache
from typing import Any

import numpy as np
import pytest
import tomli_w
from support.engines import GOOD, RADIAL, changed

from balcli.engine.build import build
from balcli.engine.engine import Engine
from balcli.engine.figures import find_first_largest, ranked
from balcli.engine.parse import parse
from balcli.errors import BalcliError
from balcli.studies.parameters import find_numbers

VEE = """
crank = { stroke = 90, throws = [0, 95], positions = [-40, 60], splay = 10, throw_mass = 0.8 }
rod = { length = 160, small_end = 0.2, big_end = 0.5, pendulum = { pivot = "small_end", period = 0.9 } }
piston = { bore = 86, mass = 0.5, offset = 2 }
layout = { banks = [-40, 45], stagger = 20 }
operation = { speed = 3000, speed_ripple = [{ order = 2, amplitude = 0.01, angle = 20 }] }
frame = { reference = [1, 2, 3] }
cylinder = { 3 = { piston_mass = 0.51, rod_ratio = 0.28, rod_mass = 0.7, rod_cg = 50, rod_inertia = 3000 } }
shaft = [
    { ratio = -2, unbalance = 9000, at = [-40, 60], angle = 15 },
    { ratio = -1, unbalance = 50, at = [5, 6], inertia = 150 },
]
counterweight = [
    { mass = 2, radius = 30, position = 11, inertia = 500 },
    { sector = { inner_radius = 20, outer_radius = 70, opening = 130, thickness = 18 } },
    { unbalance = 9000, sector = { inner_radius = 20, outer_radius = 70, opening = 130 } },
]
slider = [{ order = 2, unbalance = 800, direction = 90 }]
"""
FIRED = """
crank = { stroke = 90, spacing = 100 }
rod = { ratio = 0.28, mass = 0.6, cg = 45, inertia = 2300 }
piston = { mass = 0.5 }
layout = { firing_order = [1, 3, 2], firing_intervals = [230, 250, 240] }
"""
KNUCKLES = RADIAL.replace(
    "knuckle_radius", "knuckle_angles = [0, 50, 100, 150, 200, 250, 300]\nknuckle_radius"
).replace("cg = 90", "cg = 90, inertia = 3500")
ROTARY = RADIAL.partition("[articulation]")[0] + "rotary = true\n"
FILES = {"vee": VEE, "fired": FIRED, "knuckles": KNUCKLES, "rotary": ROTARY}
RIVALS = {
    "bank_angle": ["banks"],
    "ratio": ["length"],
    "length": ["ratio"],
    "inertia": ["pendulum"],
    "spacing": ["positions"],
    "unbalance": ["mass", "radius"],
}
DEFAULTS = {"ratio": 0.3, "length": 200.0}
IDLE = {  # nothing moves by them: one bank, one throw, articulated rods
    ("fired", "crank.splay"),
    ("fired", "layout.stagger"),
    ("knuckles", "crank.spacing"),
    ("rotary", "crank.spacing"),
    ("vee", "counterweight.3.sector.density"),  # its thickness follows
    *((name, "operation.power") for name in FILES),  # for the power related unbalance
    *((name, "piston.rod_diameter") for name in FILES),  # for gas at the crank end
    *((name, f"cylinder.{n}.piston_rod_diameter") for name in FILES for n in (2, 3)),
}


parse_once = cache(parse)


def list_paths(name: str) -> list[str]:
    """Every number of a file, and of each table of a cylinder once."""
    paths = find_numbers(parse_once(FILES[name]))
    return [
        path for path in paths if not path.startswith("cylinder.") or path.startswith(("cylinder.2.", "cylinder.3."))
    ]


def place(data: Any, path: str) -> tuple[Any, Any]:
    """The table or list in which a number stands, and its key; tables that are not there come."""
    *parts, last = path.split(".")
    for part in parts:
        data = data[int(part) - 1] if isinstance(data, list) else data.setdefault(part, {})
    return data, int(last) - 1 if isinstance(data, list) else last


def rewritten(text: str, path: str) -> tuple[str, float]:
    """The text with a number a little larger, without what says the same, and that number."""
    data = tomllib.loads(text)
    if path.startswith("slider.1.at"):
        data["slider"][0]["at"] = [0.0, 0.0]
    table, key = place(data, path)
    if isinstance(table, list):
        table[key] = table[key] * 1.001 + 0.01
        return tomli_w.dumps(data), table[key]
    prefix, name = ("rod_", key[4:]) if key.startswith("rod_") else ("", key)
    table[key] = table.get(key, DEFAULTS.get(name, 1.0)) * 1.001 + 0.01
    for rival in RIVALS.get(name, ()):
        table.pop(prefix + rival, None)
    return tomli_w.dumps(data), table[key]


def figures(engine: Engine) -> dict[str, list[float]]:
    """All that an engine consists of, as arrays."""
    c = engine.cylinders
    found = {f.name: getattr(c, f.name) for f in fields(c) if f.name not in ("linkage", "starts", "first")}
    hung = getattr(c.linkage, "hung", None) or c.linkage
    if hung is not None:
        found |= {f.name: getattr(hung, f.name) for f in fields(hung) if f.name != "hung"}
    found |= {"numbers": engine.numbers, "bore": engine.bore_m, "throws": engine.throws_m}
    found |= {"speed": engine.speed_rpm, "fires": list(engine.fires_deg.values())}
    found |= {"crank inertia": engine.crank_inertia, "bores": engine.bores_m}
    found |= {f"reference {k}": v for k, v in enumerate(engine.reference_m)}
    found |= {f"ripple {k}": v for line in engine.ripple for k, v in enumerate(line)}
    for number, device in enumerate(engine.devices):
        found |= {f"device {number}, {k}": v for k, v in enumerate(device)}
    for number, weighed in enumerate(engine.weighed):
        found |= {f"weighed {number}, {k}": v for k, v in enumerate(weighed)}
    flat = {k: np.nan_to_num(np.ravel(v), nan=-1).tolist() for k, v in found.items() if v is not None}
    return {key: values[:1] if len(set(values)) == 1 else values for key, values in flat.items()}


def outcome(text: str, varied: dict[str, float]) -> dict[str, list[float]] | str:
    """All that an engine consists of, or why it cannot be."""
    try:
        return figures(build(parse_once(text), varied))
    except BalcliError as error:
        return str(error)


@cache
def unchanged(name: str) -> dict[str, list[float]] | str:
    return outcome(FILES[name], {})


@pytest.mark.parametrize("name", FILES)
def test_a_figure_that_varies_is_as_if_the_file_said_so(name):
    """And it matters: nothing reads a figure past what varies in its place."""
    paths = list_paths(name)
    assert len(paths) > 40
    for path in paths:
        text, value = rewritten(FILES[name], path)
        varied = outcome(FILES[name], {path: value})
        if "the file gives" not in varied:
            assert varied == outcome(text, {}), path
            assert (varied == unchanged(name)) == ((name, path) in IDLE), path


def test_variants_stand_along_an_axis_of_their_own():
    variants = build(parse(GOOD), {"rod.ratio": np.array([0.25, 0.3])})
    assert variants.cylinders.lam.tolist() == [[0.25, pytest.approx(0.3)]]
    assert variants.cylinders.pin_deg.shape == (4, 1)


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("rod.length", "rod.ratio"),
        ("cylinder.2.rod_ratio", "cylinder.2.rod_length"),
        ("layout.bank_angle", "layout.banks.2"),
    ],
)
def test_two_figures_that_say_the_same_do_not_vary_together(first, second):
    with pytest.raises(BalcliError, match=f"^{first} and {second} give the same figure; vary one of them$"):
        build(parse(VEE), {first: 0.3, second: 0.3})


def test_a_firing_order_beside_throws_is_left_out():
    """It would have to fit every variant, and adds nothing."""
    crank = {"crank.stroke": np.array([80.0, 90.0])}
    assert not build(parse(GOOD), crank).fires_deg
    following = parse(changed(("throws = [0, 180, 180, 0]\n", "")))
    assert list(build(following, crank).fires_deg) == [1, 3, 4, 2]


def test_shells_and_parts_of_a_piston_vary_as_the_whole_does():
    """To vary a part is to vary the sum; `piston.mass` stands for all parts."""
    weighed = "piston = 0.3\npin = 0.2\nrings = 0\nlocks = 0\n"
    parts = GOOD.replace("mass = 0.5\n", weighed) + "[bobweight]\noil = 0.1\n"
    masses = np.array([0.4, 0.55])
    for path, varied in (("piston.mass", masses), ("piston.pin", masses - 0.3)):
        found = build(parse(parts), {path: varied}).cylinders.reciprocating.ravel()
        assert found == pytest.approx(masses + 0.6 * 45 / 160, rel=1e-14)
    found = build(parse(parts), {"bobweight.rod_bearing": masses}).cylinders.rotating.ravel()
    assert found == pytest.approx(0.8 + 0.6 * 115 / 160 + 0.1 + masses, rel=1e-14)


def test_what_differs_by_rounding_alone_is_equal_where_it_is_put_in_order():
    values = np.array([1e-7, 3.0, 2.0, 1e9, 0.0, np.inf])
    assert np.array_equal(ranked(values * (1 + 1e-14)), ranked(values))
    assert (np.argsort(ranked(values)) == np.argsort(values)).all()
    assert np.all(ranked(values[:4] * (1 + 1e-9)) > ranked(values[:4]))


def test_of_equal_values_the_first_is_the_largest_whatever_rounding_says():
    third = 0.1 + 0.2  # an ulp above 0.3
    assert find_first_largest([0.2, 0.3, third]) == 1
    assert find_first_largest([0.2, 0.3, 0.3 * (1 + 1e-6)]) == 2
    assert find_first_largest([-third, -0.3, -0.3]) == 0
    columns = [[1.0, 0.0], [1.0 + 1e-15, 0.0], [0.5, 2.0]]
    assert find_first_largest(columns).tolist() == [0, 2]
