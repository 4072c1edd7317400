"""Random vee, boxer and W engines, told as makers tell them: by firing order, intervals and bank
angle, numbered in a usual way that the file does not name. Never another engine without a word.
"""

from collections import Counter
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import pytest

from balcli import Engine, InputError, load
from balcli.forces.spectrum import compute_spectra

pytestmark = pytest.mark.stress

Place = tuple[int, int]  # throw and bank, from 0


class Built(NamedTuple):
    """An engine as it stands there: places of cylinders, and when they fire."""

    layout: dict[str, Any]
    throws: list[float]
    fires: dict[Place, float]

    def number(self, key: Any) -> dict[Place, int]:
        return {place: n for n, place in enumerate(sorted(self.fires, key=key), 1)}

    def tell(self, numbers: dict[Place, int], *, whole: bool) -> Engine:
        """Load it by its firing order; `whole`: with numbering and throws, too."""
        start = next(angle for place, angle in self.fires.items() if numbers[place] == 1)
        rising = sorted(((angle - start) % 720, numbers[place]) for place, angle in self.fires.items())
        angles = [angle for angle, _ in rising] + [720.0]
        layout: dict[str, Any] = self.layout | {
            "firing_order": [number for _, number in rising],
            "firing_intervals": [after - before for before, after in pairwise(angles)],
        }
        crank: dict[str, Any] = {"stroke": 90, "spacing": 100}
        if whole:
            banks = sorted({bank for _, bank in self.fires})
            rows = [[numbers[place] for place in sorted(self.fires) if place[1] == bank] for bank in banks]
            crank = crank | {"throws": self.throws}
            layout = layout | {"numbering": rows}
        return load(
            {
                "crank": crank,
                "rod": {"length": 150, "mass": 0.6, "cg": 40},
                "piston": {"mass": 0.5, "bore": 86},
                "layout": layout,
            }
        )


def build(random: np.random.Generator) -> Built | None:
    """None where two cylinders would fire at once."""
    angle = float(random.choice([15, 45, 60, 72, 90, 120, 180]))
    banks = int(random.choice([2, 2, 3]))
    apart = bool(random.integers(2))
    throws = int(random.integers(1, 4)) * 2 if apart and banks == 2 else int(random.integers(2, 5))
    if apart and banks == 2:
        places = [(throw, throw % 2) for throw in range(throws)]
    else:
        places = [(throw, bank) for throw in range(throws) for bank in range(banks)]
    axes = [-angle / 2, angle / 2] if banks == 2 else [-angle, 0.0, angle]
    step = float(random.choice([360 / throws, 90, 120, 180]))
    pins = [0.0, *(step * random.integers(0, 8, throws - 1) % 360).tolist()]
    fires = {(throw, bank): (axes[bank] - pins[throw] + 360 * int(random.integers(2))) % 720 for throw, bank in places}
    if len({round(angle, 6) for angle in fires.values()}) < len(fires):
        return None
    layout = {"banks": axes} if banks == 3 else {"bank_angle": angle, "rods": "alternating" if apart else "shared"}
    return Built(layout, pins, fires)


def find_figures(engine: Engine) -> list[float]:
    """Largest and smallest force and moment of order 1 and 2, whichever way the engine is seen."""
    found = compute_spectra(engine, [1.0, 2.0], ["force", "moment"])
    return [abs(v) for kind in ("force", "moment") for v in (*found[kind].major, *found[kind].minor)]


def bank_by_bank(place):
    return place[::-1]


def along(place):
    return place


SECOND_BANK_FIRST = (lambda place: (-place[1], place[0])), (lambda place: (place[0], -place[1]))


def test_an_engine_is_never_another_one_without_a_word():
    """Bank by bank or along the crank: warned of, if not refused. From another bank: the numbering
    is at least among what is assumed.
    """
    outcomes = Counter[str]()
    for seed in range(300):
        built = build(np.random.default_rng(seed))
        for key in (bank_by_bank, along, *SECOND_BANK_FIRST) if built else ():
            numbers = built.number(key)
            true = find_figures(built.tell(numbers, whole=True))
            try:
                engine = built.tell(numbers, whole=False)
            except InputError as refusal:
                outcomes["refused" if "layout.numbering" in str(refusal) else str(refusal)] += 1
                continue
            if find_figures(engine) == pytest.approx(true, rel=1e-9, abs=1e-6 * max(true)):
                outcomes["same"] += 1
                continue
            outcomes["named"] += 1
            named = "layout.numbering" in [doubt.path for doubt in engine.doubts]
            if key in SECOND_BANK_FIRST:
                named = "layout.numbering" in [value.path for value in engine.inferred]
            assert named, (seed, key)
    assert outcomes.keys() == {"refused", "same", "named"}
    assert min(outcomes["refused"], outcomes["same"]) > 100
