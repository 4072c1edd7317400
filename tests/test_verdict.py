"""The verdict: a sentence for each order, in words that need no key."""
from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

from balcli.core.phasors import Phasors
from balcli.render.units import SI
from balcli.render.verdict import verdict
from balcli.spectrum import Spectra

CASES = [
    (1, "force", (0, 0), "First order: free of force."),
    (1, "force", (100, 0), "First order: force of 100 N, turning with the crank: counterweights on the crankshaft cancel it."),
    (1, "force", (0, 5), "First order: force of 5 N, turning against the crank: nothing on the crankshaft cancels it; "
                         "it takes a shaft at −1 times crank speed."),
    (1, "moment", (20j, 10j), "First order: moment of up to 30 N·m about y (20 turns with the crank, 10 against it): counterweights "
                              "cancel the first part, a shaft at −1 times crank speed the second."),
    (2, "force", (2, 2), "Second order: force of up to 4 N along x (2 turns with the crank, 2 against it): nothing on the "
                         "crankshaft cancels it; it takes shafts at +2 and −2 times crank speed."),
    (2, "force", (2, 0), "Second order: force of 2 N, turning with the crank: nothing on the crankshaft cancels it; "
                         "it takes a shaft at +2 times crank speed."),
    (2, "moment", (3, cmath.rect(1, math.radians(60))),
     "Second order: moment of up to 4 N·m about an axis at 30.0 deg (3 turns with the crank, 1 against it): nothing on the "
     "crankshaft cancels it; it takes shafts at +2 and −2 times crank speed."),
    (4, "force", (250, 250), "Fourth order: force up to 500 N; rarely balanced, it would take shafts at 4 times crank speed."),
]


@pytest.mark.parametrize(("order", "what", "vectors", "text"), CASES)
def test_each_order_in_words(order: int, what: str, vectors: tuple[complex, complex], text: str) -> None:
    orders = np.array([float(order)])
    phasors = Phasors(orders, *np.array(vectors, complex).reshape(2, 1), np.zeros(1))
    assert verdict(Spectra(orders, **{what: phasors}), SI) == (text,)


def test_force_and_moment_of_one_order() -> None:
    orders = np.array([1.0])
    none, some = (Phasors(orders, *np.array(v, complex).reshape(2, 1), np.zeros(1)) for v in ((0, 0), (7, 0)))
    assert verdict(Spectra(orders, force=none, moment=some), SI) == (
        "First order: moment of 7 N·m, turning with the crank: counterweights on the crankshaft cancel it. No force.",)
