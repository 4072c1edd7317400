"""The tables of an engine file: values in the file's units, contradictions refused."""

import pytest
from pydantic import ValidationError
from support.cases import cases
from support.engines import GOOD, changed, mistakes_in

from balcli.engine.parse import parse
from balcli.file import model


def test_values_are_numbers_in_the_files_units():
    engine = parse(
        changed(
            ("stroke = 90", 'stroke = "3.5 in"'),
            ("[0, 180, 180, 0]", '[0, "1/2 turn", "180 deg", 0]'),
            ("mass = 0.6", 'mass = "600 g"'),
            ("speed = 3000", 'speed = "50 turn/s"'),
        )
    )
    assert engine.crank.stroke == 88.9
    assert engine.crank.throws == (0.0, 180.0, 180.0, 0.0)
    assert engine.rod.mass == 0.6
    assert engine.operation.speed == 3000.0
    assert all(isinstance(angle, float) for angle in engine.crank.throws)


def test_devices_and_cylinders():
    engine = parse(
        """
cylinder.3 = { piston_mass = 0.502, rod_pendulum = { pivot = "big_end", period = 0.6 } }
counterweight = [{ mass = 0.5, radius = "40 mm" }]
shaft = [{ ratio = -2.0, unbalance = "0.009 kg m", at = [-40, "60 mm"] }, { ratio = 1, unbalance = -3 }]
slider = [{ order = 2, unbalance = 9000, direction = 90 }]
"""
        + GOOD
    )
    assert engine.cylinder[3].piston_mass == 0.502
    assert engine.cylinder[3].rod_pendulum == model.Pendulum(pivot="big_end", period=0.6)
    assert (engine.counterweight[0].mass, engine.counterweight[0].radius) == (0.5, 40.0)
    assert (engine.shaft[0].ratio, type(engine.shaft[0].ratio)) == (-2, int)
    assert (engine.shaft[0].unbalance, engine.shaft[0].at) == (9000.0, (-40.0, 60.0))
    assert (engine.shaft[1].unbalance, engine.shaft[1].at) == (-3.0, (0.0, 0.0))
    assert engine.slider[0].direction == 90.0


@cases("file/model", "unusual_but_allowed")
def test_unusual_but_allowed(text):
    assert parse(text).name == "in-line four"


@cases("file/model", "contradictions", GOOD=GOOD)
def test_contradictions(text, message):
    assert mistakes_in(text) == message


def test_models_check_without_a_file_too():
    with pytest.raises(ValidationError, match="has length and ratio; give either length or ratio"):
        model.Rod(length=160, ratio=0.28)
    with pytest.raises(ValidationError, match="frozen"):
        parse(GOOD).crank.stroke = 80.0
