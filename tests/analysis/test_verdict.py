"""The verdict: a sentence for each order, in words that need no key."""

import numpy as np
import pytest
from support.cases import cases
from support.engines import GOOD, build_text

from balcli import analyze, curves
from balcli.analysis.overview import tell_couple, verdict
from balcli.core.phasors import Phasors
from balcli.forces.spectrum import Spectra
from balcli.show.units import SI
from balcli.sizing.residual import Scales

SCALES = Scales(1000.0, 2000.0, 100.0)


def spectra(order: float, forward: complex, backward: complex, kind: str = "force") -> Spectra:
    """One order of a force or moment."""
    orders = np.array([float(order)])
    phasors = Phasors.of(orders, np.array([forward], complex), np.array([backward], complex), np.zeros(1))
    return Spectra(orders, **{kind: phasors})


@cases("analysis/verdict", "each_order_in_words")
def test_each_order_in_words(order: int, what: str, vectors: list[list[float]], text: str) -> None:
    assert verdict(spectra(order, *(complex(*vector) for vector in vectors), what), SI) == (text,)


@cases("analysis/verdict", "what_is_small_beside_one_cylinder")
def test_what_is_small_beside_one_cylinder(force: dict, moment: dict, told: list[str]) -> None:
    """A cylinder makes 1000 N and 2000 N m; vectors of equal size turn both ways."""
    orders = np.array([1.0, 2, 4, 6, 12])

    def phasors(sizes: dict) -> Phasors:
        v = np.array([sizes.get(f"{n:g}", 0) for n in orders], complex)
        return Phasors.of(orders, v, v, np.zeros(5))

    found = Spectra(orders, force=phasors(force), moment=phasors(moment))
    assert verdict(found, SI, SCALES) == tuple(told)


DEVICES = [
    f"{table}\nunbalance = 9\n" for table in ("[[counterweight]]", "[[shaft]]\nratio = -1", "[[shaft]]\nratio = 2")
]
ENGINES = [build_text(GOOD + "".join(DEVICES[:k])) for k in range(4)]


@pytest.mark.parametrize(
    ("order", "text"),
    [
        (1, "further counterweights cancel 50 N of it, a further shaft at -1 the other 50 N."),
        (2, "further shafts at +2 and -2 cancel it."),
    ],
)
def test_a_device_like_one_of_the_file_is_a_further_one(order: int, text: str) -> None:
    (told,) = verdict(spectra(order, 50, 50), SI, engine=ENGINES[3])
    assert told.endswith(text)


@pytest.mark.parametrize("seed", range(40))
def test_a_sentence_has_at_most_25_words(seed):
    """Whatever turns, wherever it points, with or without `up`."""
    random = np.random.default_rng(seed)
    orders = np.array([1.0, 2, 3, 4, 6, 8, 10, 12])

    def phasors() -> Phasors:
        parts = random.normal(size=(4, 8)) * (random.random((4, 8)) < 0.7) * 10.0 ** random.integers(-4, 6, (4, 8))
        return Phasors.of(orders, parts[0] + 1j * parts[1], parts[2] + 1j * parts[3], np.zeros(8))

    up = None if seed % 2 else float(random.integers(-180, 180))
    found = Spectra(orders, up, force=phasors(), moment=phasors())
    told = verdict(found, SI, SCALES, engine=ENGINES[seed % 4])
    assert max(len(sentence.split()) for sentence in told) <= 25


def test_small_is_what_is_asked_for():
    found = spectra(2, 10, 10)
    assert verdict(found, SI, SCALES) == ("Small: force of 20 N (order 2).",)
    told = "Second order: force of 20 N along x; shafts at +2 and -2 cancel it."
    assert verdict(found, SI, SCALES, small=0.01) == (told,)


@pytest.mark.parametrize(("couple", "told"), [(0, "force, moment and couple"), (1, "force and moment")])
def test_the_couple_is_judged_with_force_and_moment(couple: float, told: str) -> None:
    none, some = spectra(1, 0, 0).force, spectra(1, couple, couple).force
    found = Spectra(none.orders, force=none, moment=none, couple=some)
    assert verdict(found, SI) == (f"Order 1: {told} balanced.",)


HEAVY = {"crank.stroke": 90, "rod.length": 200, "rod.mass": 2, "rod.cg": 50, "rod.inertia": 15000, "piston.mass": 1}
HEAVY["operation.speed"] = 2000
NO_H = "; a rod dynamically equivalent to two masses at its ends has none."


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({}, None),
        ({"rod.inertia": 9000}, f"the rods{NO_H}"),
        ({"piston.offset": 10}, "offset pistons."),
        ({"rod.inertia": 9000, "piston.offset": 10}, "the rods and offset pistons."),
        ({"frame.reference": [0, 80, 0]}, "forces whose lines miss the point of reference."),
        ({"operation.speed_ripple": "[{ order = 2, amplitude = 0.05 }]"}, "the acceleration of turning parts."),
    ],
)
def test_the_causes_of_the_couple_are_named(changes: dict, told: str | None) -> None:
    """Its size is the largest harmonic of the sampled couple."""
    engine = build_text("".join(f"{key} = {value}\n" for key, value in (HEAVY | changes).items()))
    found = tell_couple(analyze(engine), SI)
    couple = np.abs(np.fft.rfft(curves(engine).curves["couple_Nm"][:360])) / 180
    order = int(couple[1:].argmax()) + 1
    text = f"Transverse couple: up to {couple[order]:.4g} N·m (order {order}), from {told}"
    assert found == ("" if told is None else text)
