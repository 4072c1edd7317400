"""Equal figures stand in the order of the file, or of the search, whatever the last digits of the machine."""

from collections.abc import Callable
from itertools import groupby

import numpy as np
import pytest
from docs_examples import ROOT
from support.searches import search_least

from balcli import load
from balcli.engine.parse import read
from balcli.forces.crankshaft import compute_inner_loads
from balcli.studies.deviations import Tolerances
from balcli.studies.scatter import Variants
from balcli.studies.search.designs import Objective

pytestmark = pytest.mark.stress

ENGINES = ROOT / "engines"


@pytest.mark.parametrize("name", ["car/tsinghua_6120q", "car/tsinghua_eq6100", "v10_split", "vr6"])
def test_equal_shares_of_a_scatter(name: str) -> None:
    """Parts of one kind stand by their numbers."""
    model = read(ENGINES / f"{name}.toml")
    for spread in Variants(model, None, Tolerances(mass=0.01)).draw(10, 1).quantities.values():
        named = [(*source.rsplit(" ", 1), f"{abs(share):.6g}") for source, share in spread.sensitivity.items()]
        for _, equal in groupby(named, key=lambda one: (one[2], one[0])):
            numbers = [int(number) for _, number, _ in equal]
            assert numbers == sorted(numbers)


def test_equal_inner_moments() -> None:
    bending = compute_inner_loads(load(ENGINES / "flat12.toml")).bending
    values = np.array([peak.value for peak in bending.peaks])
    assert bending.largest == np.flatnonzero(values >= values.max() * (1 - 1e-12))[0]


@pytest.mark.parametrize("name", ["i5", "flat12", "car/tsinghua_6120q"])
def test_equal_arrangements_of_a_search(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """With other last digits the same cranks are found, in the same order."""

    def found() -> list[object]:
        return [
            one.design
            for one in search_least(read(ENGINES / f"{name}.toml"), "throws", "moment.1.major", count=10).results
        ]

    before = found()
    random = np.random.default_rng(5)
    exact = Objective.add_up

    def add_up(objective: Objective, value: Callable[[object], object]) -> object:
        total = np.asarray(exact(objective, value))
        return total * (1 + 1e-15 * random.uniform(-1, 1, total.shape))

    monkeypatch.setattr(Objective, "add_up", add_up)
    assert found() == before
