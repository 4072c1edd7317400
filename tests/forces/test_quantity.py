"""Quantities such as `force.2.major`: named, and what they are of an engine."""

import numpy as np
import pytest
from support.cases import cases
from support.engines import VEE

from balcli.analysis.answer import analyze
from balcli.engine.build import build
from balcli.engine.parse import parse as load
from balcli.errors import BalcliError
from balcli.forces.quantity import evaluate_quantities
from balcli.forces.spectrum import compute_spectra
from balcli.studies.quantities import parse_quantities


@cases("forces/quantity", "mistakes_in_words")
def test_mistakes_in_words(text: str, message: str) -> None:
    with pytest.raises(BalcliError) as caught:
        parse_quantities(text)
    assert str(caught.value) == message


def test_they_are_what_analyze_gives() -> None:
    engine = build(load(VEE))
    found = analyze(engine, [1, 2])
    force = found.spectra.force
    moment = found.spectra.moment
    roll = found.spectra.roll
    expected = {
        "force.2.major": force.major[1],
        "force.1.minor": force.minor[0],
        "force.1.forward": abs(force.forward[0]),
        "moment.2.backward": abs(moment.backward[1]),
        "moment.1.axis": moment.axis_deg[0],
        "force.2.x": abs(force.x[1]),
        "force.2.y": abs(force.y[1]),
        "roll.2.amplitude": roll.major[1],
        "peak.force": found.peak.force.value,
    }
    values = evaluate_quantities(engine, parse_quantities(",".join(expected)))
    assert list(map(float, values)) == pytest.approx(list(map(float, expected.values())), rel=1e-13)


def test_the_signed_parts_of_an_order_are_those_of_the_curve() -> None:
    """Value = cos cos n theta + sin sin n theta; order 0, the mean under uneven speed, is its cos."""
    engine = build(load(VEE + "speed_ripple = [{ order = 2, amplitude = 0.02, angle = 25 }]\n"))
    theta = np.radians(np.arange(0.0, 360.0, 0.5))
    curves = {f"{kind}.{{}}.{axis}_": turn for kind in ("force", "moment") for axis, turn in (("x", 1), ("y", 1j))}
    curves |= dict.fromkeys(("couple.{}.", "torque.{}.", "roll.{}."), 1)
    for stem, axis in curves.items():
        for order in (0, 1, 2, 3):
            phasors = getattr(compute_spectra(engine, [order]), stem.split(".")[0])
            asked = parse_quantities(f"{stem}cos,{stem}sin".format(order, order))
            cos, sin = map(float, evaluate_quantities(engine, asked))
            value = (phasors.values(theta) * np.conj(axis)).real
            found = cos * np.cos(order * theta) + sin * np.sin(order * theta)
            assert found == pytest.approx(value, abs=1e-9 * np.abs(value).max(initial=1))
            assert order or sin == 0


def test_senses_are_named_as_tables_head_them() -> None:
    assert parse_quantities("force.1.against,moment.2.with") == parse_quantities("force.1.backward,moment.2.forward")
