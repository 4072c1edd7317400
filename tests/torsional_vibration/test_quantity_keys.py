"""Quantities with gas over every number of an engine file: as of a file that says so."""

import tomllib
from typing import Any

import numpy as np
import pytest
import tomli_w

from balcli.engine.build import build
from balcli.engine.engine import Engine
from balcli.engine.load import EngineVariants
from balcli.engine.parse import parse
from balcli.file.model import EngineFile
from balcli.forces.quantity import TargetQuantity
from balcli.studies.parameters import find_numbers
from balcli.torsional_vibration.build import build_engine_system, excite_engine
from balcli.torsional_vibration.modes import find_natural_modes
from balcli.torsional_vibration.quantity import Variants, choose_torsion_speeds
from balcli.torsional_vibration.response import find_response

FILE = """
name = "three with everything"
crank = { stroke = 100, spacing = 110, throw_mass = 0.9, inertia = 90000 }
rod = { length = 165, mass = 0.9, cg = 50, inertia = 4000 }
piston = { bore = 86, mass = 0.6, offset = 0.8 }
layout = { firing_order = [1, 3, 2] }
operation = { speed = 3000 }
cylinder.2 = { piston_mass = 0.62, gas = 0.9, rod_length = 166 }
flywheel = { inertia = 200000 }
counterweight = [{ unbalance = 20000, angle = 180, position = -110 }]
gas = { cycle = "wiebe", compression_ratio = 10, imep = 9, burn_start = -12, burn_duration = 55, burn_shape = 2, \
    intake = 0.9, exhaust = 1.1, crankcase = 1.0, compression_index = 1.32, expansion_index = 1.28, \
    exhaust_opens = 140, intake_closes = 580 }
[torsion]
throw_stiffness = [0.8e6, 0.9e6]
damping = 1.5
loss = 0.03
rear = [{ name = "wheel", inertia = 300000, stiffness = 1.1e6, diameter = 70 }]
front = [{ name = "pulley", inertia = 8000, stiffness = 0.3e6, \
    damper = { kind = "viscous", inertia = 9000, damping = 4 } }]
"""
MODEL = parse(FILE)
RIVALS = {"rod.ratio": "length", "gas.heat": "imep", "cylinder.2.rod_ratio": "rod_length"}
NEW = {"rod.ratio": 0.31, "gas.heat": 900.0, "cylinder.3.piston_mass": 0.7, "cylinder.1.gas": 0.5}


def find_place(tables: Any, path: str) -> tuple[Any, Any]:
    """The table or list that a dotted name leads to, and its last key there."""
    *way, last = path.split(".")
    for key in way:
        tables = tables[int(key) - 1] if isinstance(tables, list) else tables.setdefault(key, {})
    return tables, int(last) - 1 if isinstance(tables, list) else last


def is_given(path: str) -> bool:
    inner, last = find_place(tomllib.loads(FILE), path)
    return isinstance(inner, list) or last in inner


def vary(path: str) -> tuple[float, EngineFile]:
    """Another value of a figure, and the file with this value in it."""
    tables = tomllib.loads(FILE)
    inner, last = find_place(tables, path)
    value = NEW[path] if path in NEW else float(inner[last]) * 1.03
    if path in RIVALS:
        inner.pop(RIVALS[path])
    inner[last] = value
    return value, parse(tomli_w.dumps(tables))


PATHS = [path for path in find_numbers(MODEL) if path in NEW or is_given(path)]
SOME = [
    *("rod.length", "rod.ratio", "rod.inertia", "piston.mass", "piston.offset", "crank.stroke"),
    *("crank.inertia", "operation.speed", "gas.imep", "gas.heat", "gas.burn_start"),
    *("cylinder.2.gas", "cylinder.3.piston_mass", "torsion.front.1.damper.damping"),
    *("torsion.throw_stiffness.2", "torsion.rear.1.diameter", "counterweight.1.unbalance"),
]


def test_every_number_is_looked_at():
    assert len(PATHS) > 45
    assert {*SOME} <= {*PATHS}


def twist(engine: Engine) -> list[complex]:
    """Harmonics of the gas in every cylinder, with phase and share."""
    assert engine.gas is not None
    halves = np.arange(1, 13)
    return [
        c.share * value * np.exp(-1j * half / 2 * c.fires)
        for c in engine.gas.cylinders
        for half, value in zip(halves, c.torque.harmonics(halves), strict=True)
    ]


def test_gas_is_kept_only_where_a_number_leaves_it_alone():
    """Built one after the other from what is remembered, and each from its own file."""
    variants = EngineVariants(MODEL)
    variants.build({})
    stale = []
    for path in PATHS:
        if not path.startswith("torsion."):
            value, model = vary(path)
            if twist(variants.build({path: value})) != twist(build(model)):
                stale.append(path)
    assert not stale


@pytest.mark.slow
@pytest.mark.parametrize("path", [path for path in SOME if path != "operation.speed"])
def test_shaft_torque_is_that_of_a_file_that_says_so(path):
    names = ("shaft.wheel.torque", "shaft.wheel.stress", "torsion.2.Hz")
    variants = Variants(MODEL, list(map(TargetQuantity, names)))
    variants.evaluate({})
    value, model = vary(path)
    torque, stress, hertz = variants.evaluate({path: value})
    engine = build(model)
    system = build_engine_system(model, engine, excite_engine(model, engine, None))
    said = find_response(system, choose_torsion_speeds(engine)).shafts[-1]
    highest = said.half_peak_to_peak_Nm.max()
    assert highest <= torque * (1 + 1e-12)
    assert torque == pytest.approx(highest, rel=1e-3), "between those speeds"
    assert torque == pytest.approx(said.worst.half_peak_to_peak_Nm, rel=1e-12)
    assert stress / torque == pytest.approx(said.stress_Pa[0] / said.half_peak_to_peak_Nm[0], rel=1e-12)
    assert hertz == pytest.approx(find_natural_modes(system)[1].frequency_Hz, rel=1e-12)
