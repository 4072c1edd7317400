"""A kind of force or moment is added by a line in the table of kinds: everything takes it from there.

The table is read when other modules are imported, so that the kinds are added in a process of its own.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]

ADD_KINDS = """
import json
import numpy as np
from balcli.core import loads
from balcli.forces import kinds

# A sum of other kinds, and a kind with a computation of its own: the forces of all pistons, counted
# in one direction.
sway = kinds.Kind("sway", "sway moment", "C + T", "sway_Nm", plus=("couple", "torque"))
thrust = kinds.Kind("thrust", "thrust of pistons", "P", "thrust_N", dimension="force")
kinds.KINDS |= {"sway": sway, "thrust": thrust}
kinds.EVERY_KIND = kinds.KINDS | kinds.GAS_KINDS


def sum_thrust(self):
    c = self.cylinders
    return self.phases.add_scalars((-c.reciprocating * c.radius * self.square) * self.harmonics["piston"])


loads.Loads.thrust = property(sum_thrust)
loads.LOADS["thrust"] = loads.LoadForm(frozenset({"piston"}))
"""
ASK = """
from balcli import analyze, compare, curves, load, sweep
from balcli.core.records import describe_record
from balcli.analysis.answer import Analysis
from support.engines import GOOD

uneven = load(GOOD.replace("speed = 3000", "speed = 3000\\nspeed_ripple = [{order = 2, amplitude = 0.01}]"))
engine = load(GOOD)
result = analyze(engine, [2])
alone = analyze(engine, [2], only=["sway", "thrust"])
curve = curves(engine, 1).to_pandas()
swept = sweep(engine, {"rod.length": [160.0, 140.0]}, ["sway.2.major", "thrust.2.major"])
answers = {
    "orders": result.to_dict()["orders"][0],
    "columns": list(result.to_pandas().columns),
    "alone": [list(alone.to_dict()["orders"][0]), alone.text()],
    "compared": compare(engine, engine).text(),
    "largest on a curve": max(abs(curve["sway_Nm"] - curve["couple_Nm"] - curve["inertia_torque_Nm"])),
    "swept": [list(swept["sway.2.major"]), list(swept["thrust.2.major"])],
    "uneven": analyze(uneven, [2]).to_dict()["orders"][0]["thrust_N"]["amplitude"],
    "schema": json.dumps(describe_record(Analysis)),
}
print(json.dumps(answers))
"""


@pytest.fixture(scope="module")
def answers() -> dict:
    done = subprocess.run(
        [sys.executable, "-c", ADD_KINDS + ASK], cwd=TESTS, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_new_kinds_are_in_documents(answers: dict) -> None:
    order = answers["orders"]
    assert order["sway_Nm"]["sin"] == pytest.approx(order["couple_Nm"]["sin"] + order["inertia_torque_Nm"]["sin"])
    assert order["thrust_N"]["amplitude"] == pytest.approx(order["force_N"]["major"])  # four cylinders in line
    assert answers["alone"][0] == ["order", "sway_Nm", "thrust_N"]


@pytest.mark.parametrize("key", ["sway_Nm", "thrust_N"])
def test_new_kinds_are_in_the_schema(answers: dict, key: str) -> None:
    assert key in json.loads(answers["schema"])["$defs"]["OrderFigures"]["properties"]


def test_new_kinds_are_in_tables_and_columns(answers: dict) -> None:
    assert "sway moment" in answers["alone"][1]
    assert "thrust of pistons" in answers["alone"][1]
    assert {"sway.amplitude", "thrust.amplitude"} <= {*answers["columns"]}
    assert "Sway moment, N·m: largest by order" in answers["compared"]
    assert "Thrust of pistons, N: largest by order" in answers["compared"]


def test_a_sum_is_a_sum_over_the_crank_angle(answers: dict) -> None:
    assert answers["largest on a curve"] < 1e-9


def test_new_kinds_can_be_swept(answers: dict) -> None:
    sway, thrust = answers["swept"]
    assert sway[0] != sway[1]
    assert thrust[0] < thrust[1]


def test_new_kinds_are_computed_at_uneven_speed(answers: dict) -> None:
    assert answers["uneven"] > 0
