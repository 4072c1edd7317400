"""The verdict: a sentence for each order, in words that need no key."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from balcli.analysis.overview import verdict
from balcli.core.phasors import Phasors
from balcli.forces.spectrum import Spectra
from balcli.show.units import SI

CASES = [
    (1, "force", (0, 0), "First order: free of force."),
    (
        1,
        "force",
        (100, 0),
        "First order: force of 100 N, turning with the crank: counterweights on the crankshaft cancel it.",
    ),
    (
        1,
        "force",
        (0, 5),
        "First order: force of 5 N, turning against the crank: nothing on the crankshaft cancels "
        "it; it needs a balancer shaft at -1 times crank speed.",
    ),
    (
        1,
        "moment",
        (20j, 10j),
        "First order: moment of up to 30 N·m pitching (about y) (20 turns with the crank, 10 against it): "
        "counterweights "
        "cancel the first part, a shaft at -1 times crank speed the second.",
    ),
    (
        2,
        "force",
        (2, 2),
        "Second order: force of up to 4 N along x (2 turns with the crank, 2 against it): nothing "
        "on the "
        "crankshaft cancels it; it needs two balancer shafts, at +2 and -2 times crank speed.",
    ),
    (
        2,
        "force",
        (2, 0),
        "Second order: force of 2 N, turning with the crank: nothing on the crankshaft cancels it; "
        "it needs a balancer shaft at +2 times crank speed.",
    ),
    (
        2,
        "moment",
        (3, cmath.rect(1, math.radians(60))),
        "Second order: moment of up to 4 N·m about an axis at 30.0 deg (3 turns with the crank, 1 "
        "against it): nothing on the "
        "crankshaft cancels it; it needs two balancer shafts, at +2 and -2 times crank speed.",
    ),
    (
        4,
        "force",
        (250, 250),
        "Fourth order: force up to 500 N; rarely balanced, it would take shafts at 4 times crank speed.",
    ),
]


@pytest.mark.parametrize(("order", "what", "vectors", "text"), CASES)
def test_each_order_in_words(order: int, what: str, vectors: tuple[complex, complex], text: str) -> None:
    orders = np.array([float(order)])
    phasors = Phasors.of(orders, *np.array(vectors, complex).reshape(2, 1), np.zeros(1))
    assert verdict(Spectra(orders, **{what: phasors}), SI) == (text,)


def test_force_and_moment_of_one_order() -> None:
    orders = np.array([1.0])
    none, some = (Phasors.of(orders, *np.array(v, complex).reshape(2, 1), np.zeros(1)) for v in ((0, 0), (7, 0)))
    assert verdict(Spectra(orders, force=none, moment=some), SI) == (
        "First order: moment of 7 N·m, turning with the crank: counterweights on the crankshaft cancel it. No force.",
    )


LINES = {"free": ("First order: free of force and moment.", "Second order: free of force and moment.")}


@pytest.mark.parametrize(
    ("force", "moment", "told"),
    [
        ({}, {}, LINES["free"]),
        (
            {6: 0.004},
            {6: 0.5, 12: 0.6},
            (
                *LINES["free"],
                "Higher orders: negligible, at most a force of 0.008 N in order 6 and a moment of 1.2 N·m in order 12.",
            ),
        ),
        ({12: 1e-5}, {}, (*LINES["free"], "Higher orders: negligible, at most a force of 2e-5 N in order 12.")),
        (
            {2: 0.4, 4: 0.3},
            {},
            (
                LINES["free"][0],
                "Second order: force of up to 0.8 N, negligible. No moment.",
                "Higher orders: negligible, at most a force of 0.6 N in order 4.",
            ),
        ),
        (
            {4: 0.3, 6: 30},
            {},
            (
                *LINES["free"],
                "Sixth order: force up to 60 N; rarely balanced, it would take shafts at 6 times crank speed.",
            ),
        ),
    ],
)
def test_what_is_small_beside_one_cylinder_is_negligible(force: dict, moment: dict, told: tuple[str, ...]) -> None:
    """A cylinder makes 1000 N and 2000 N m; vectors of equal size turn both ways."""
    orders = np.array([1.0, 2, 4, 6, 12])

    def phasors(sizes: dict) -> Phasors:
        v = np.array([sizes.get(int(n), 0) for n in orders], complex)
        return Phasors.of(orders, v, v, np.zeros(5))

    found = Spectra(orders, force=phasors(force), moment=phasors(moment))
    assert verdict(found, SI, {"force": 1000.0, "moment": 2000.0}) == told


@pytest.mark.parametrize(("order", "name"), [(11, "11th"), (21, "21st"), (22, "22nd"), (13, "13th")])
def test_ordinals(order: int, name: str) -> None:
    one = np.array([5 + 0j])
    force = Phasors.of(np.array([float(order)]), one, one, np.zeros(1))
    (told,) = verdict(Spectra(np.array([float(order)]), force=force), SI)
    assert told.startswith(f"{name} order: force up to 10 N; ")
