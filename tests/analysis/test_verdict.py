"""The verdict: a sentence for each order, in words that need no key."""

from __future__ import annotations

import numpy as np
import pytest
from support.cases import cases

from balcli.analysis.overview import verdict
from balcli.core.phasors import Phasors
from balcli.forces.spectrum import Spectra
from balcli.show.units import SI


@cases("analysis/verdict", "each_order_in_words")
def test_each_order_in_words(order: int, what: str, vectors: list[list[float]], text: str) -> None:
    orders = np.array([float(order)])
    phasors = Phasors.of(orders, *(np.array(vectors) @ [[1], [1j]]), np.zeros(1))
    assert verdict(Spectra(orders, **{what: phasors}), SI) == (text,)


def test_force_and_moment_of_one_order() -> None:
    orders = np.array([1.0])
    none, some = (Phasors.of(orders, *np.array(v, complex).reshape(2, 1), np.zeros(1)) for v in ((0, 0), (7, 0)))
    assert verdict(Spectra(orders, force=none, moment=some), SI) == (
        "First order: moment of 7 N·m, turning with the crank: counterweights on the crankshaft cancel it. No force.",
    )


FREE = ["First order: force and moment balanced.", "Second order: force and moment balanced."]


@cases("analysis/verdict", "what_is_small_beside_one_cylinder_is_negligible", FREE=FREE)
def test_what_is_small_beside_one_cylinder_is_negligible(force: dict, moment: dict, told: list[str]) -> None:
    """A cylinder makes 1000 N and 2000 N m; vectors of equal size turn both ways."""
    orders = np.array([1.0, 2, 4, 6, 12])

    def phasors(sizes: dict) -> Phasors:
        v = np.array([sizes.get(f"{n:g}", 0) for n in orders], complex)
        return Phasors.of(orders, v, v, np.zeros(5))

    found = Spectra(orders, force=phasors(force), moment=phasors(moment))
    assert verdict(found, SI, {"force": 1000.0, "moment": 2000.0}) == tuple(told)


@pytest.mark.parametrize(("order", "name"), [(11, "11th"), (21, "21st"), (22, "22nd"), (13, "13th")])
def test_ordinals(order: int, name: str) -> None:
    one = np.array([5 + 0j])
    force = Phasors.of(np.array([float(order)]), one, one, np.zeros(1))
    (told,) = verdict(Spectra(np.array([float(order)]), force=force), SI)
    assert told.startswith(f"{name} order: force up to 10 N; ")
