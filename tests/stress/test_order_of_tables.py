"""Where the order of tables in a file has no meaning, neither has it an effect."""

from typing import Any

import numpy as np
import pytest
import tomli_w

from balcli import analyze, load, mounts, torsion
from balcli.core.records import to_document

pytestmark = pytest.mark.stress

SPEEDS = [900.0, 1700, 2600]


def draw_tables(random: np.random.Generator) -> dict[str, Any]:
    """An in-line six with gas, of unequal cylinders, and all lists of tables that a file can have."""

    def near(value: float) -> float:
        return round(value * random.uniform(0.8, 1.2), 4)

    def place(x: float, y: float, z: float) -> list[float]:
        return [near(x), near(y), near(z)]

    def device(**more: Any) -> dict[str, Any]:
        return {"unbalance": near(9000), "angle": near(200), "position": near(120), **more}

    return {
        "crank": {"stroke": 120, "throws": [0, 240, 120, 120, 240, 0], "spacing": 130, "throw_mass": 3},
        "rod": {"length": 220, "mass": 2, "cg": 70},
        "piston": {"mass": 1.5, "bore": 105},
        "layout": {"firing_order": [1, 5, 3, 6, 2, 4]},
        "gas": {"cycle": "wiebe", "compression_ratio": 16, "imep": 9},
        "operation": {"speed": 2200},
        "cylinder": {str(n): {"piston_mass": near(1.5), "rod_mass": near(2)} for n in range(1, 7)},
        "counterweight": [device() for _ in range(3)],
        "shaft": [device(ratio=ratio, at=[near(60), near(80)]) for ratio in (2, -2, 1)],
        "slider": [device(order=2, direction=near(30), at=[near(5), near(9)]) for _ in range(2)],
        "body": {"mass": 600, "cg": [0, 0, 0], "inertia": [8e7, 7e7, 3e7, 0, 0, 0]},
        "mount": [
            {"name": f"m{k}", "at": place(-200, y, z), "stiffness": place(900, 300, 400), "loss": 0.1}
            for k, (y, z) in enumerate([(300, 0), (-300, 0), (250, 700), (-250, 700)])
        ],
        "point": [{"name": f"p{k}", "at": place(300, 100 * k, 400)} for k in range(3)],
        "torsion": {
            "throw_inertia": 40000,
            "throw_stiffness": 1.4e6,
            "damping": 2,
            "front": [
                {"name": "hub", "inertia": near(9000), "stiffness": near(1.6e6), "of": "throw 1"},
                {"name": "pulley", "inertia": near(17000), "stiffness": near(1.1e6), "of": "hub"},
                {"name": "cam", "inertia": near(3000), "stiffness": near(1e5), "of": "hub", "gear": 0.5},
            ],
            "rear": [
                {"name": "wheel", "inertia": near(2e6), "stiffness": near(2e6), "of": "throw 6"},
                {"name": "pump", "inertia": near(5000), "stiffness": near(2e5), "of": "throw 5", "gear": 1.5},
            ],
        },
    }


def permute(value: Any, random: np.random.Generator) -> Any:
    """Other orders of tables of a kind, and of cylinders."""
    if isinstance(value, list) and all(isinstance(one, dict) for one in value):
        return [permute(value[k], random) for k in random.permutation(len(value))]
    if isinstance(value, dict):
        keys = list(value)
        keys = [keys[k] for k in random.permutation(len(keys))] if keys[0].isdigit() else keys
        return {key: permute(value[key], random) for key in keys}
    return value


def list_figures(value: Any, path: str = "") -> dict[str, Any]:
    """Leaves of a document by their paths; those of named things by the name."""
    if not isinstance(value, dict | list):
        return {path: value}
    parts = value.items() if isinstance(value, dict) else enumerate(value)
    found: dict[str, Any] = {}
    for key, part in parts:
        name = part.get("name", key) if isinstance(part, dict) else key
        found |= list_figures(part, f"{path}.{name}")
    return found


def answer(tables: dict[str, Any], chapter: str, folder) -> dict[str, Any]:
    path = folder / "engine.toml"
    path.write_text(tomli_w.dumps(tables))
    engine = load(path)
    found = {
        "analyze": lambda: to_document(analyze(engine, [1, 1.5, 2, 3, 4, 6])),
        "mounts": lambda: mounts(engine, SPEEDS).to_dict(),
        "torsion": lambda: torsion(engine, SPEEDS).to_dict(),
    }[chapter]()
    nodes = [node["name"] for node in found.get("nodes", ())]
    for mode in found["modes"] if nodes else ():
        mode["shape"] = dict(zip(nodes, mode["shape"], strict=True))
        mode["node_in"].sort()
    for shaft in found.get("response", {}).get("shafts", ()):
        del shaft["mean_Nm"]  # flows to the last part behind the throws, whatever its name
    return list_figures(found)


@pytest.mark.parametrize("chapter", ["analyze", "mounts", "torsion"])
@pytest.mark.parametrize("seed", range(6))
def test_the_order_of_tables_does_not_matter(tmp_path, chapter, seed):
    random = np.random.default_rng(seed)
    tables = draw_tables(random)
    one, other = (answer(each, chapter, tmp_path) for each in (tables, permute(tables, random)))
    assert one.keys() == other.keys()
    largest: dict[str, float] = {}
    for path, figure in one.items():
        if isinstance(figure, float):
            kind = path.rpartition(".")[2]
            largest[kind] = max(largest.get(kind, 0.0), abs(figure))
    for path, figure in one.items():
        if isinstance(figure, float) and isinstance(other[path], float):
            assert other[path] == pytest.approx(figure, rel=1e-9, abs=1e-9 * largest[path.rpartition(".")[2]]), path
        else:
            assert other[path] == figure, path
