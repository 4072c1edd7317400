"""Variants that are computed together, of random engines: each as alone, and impossible ones told as alone."""

import numpy as np
import pytest
from support.gas_engines import draw_engine

import balcli
from balcli.engine.load import vary_engine
from balcli.errors import BalcliError

pytestmark = pytest.mark.stress
NAMES = "torque.max,torque.min,torque.mean,gas.0.cos,gas.1.amplitude,torque.2.sin,gas.6.sin,roll_total.3.amplitude"


def sweep(engine, grid) -> np.ndarray | str:
    """Each quantity on the grid, or the error."""
    try:
        found = balcli.sweep(engine, grid, NAMES, jobs=1)
    except BalcliError as error:
        return str(error)
    return np.array([found[name] for name in NAMES.split(",")])


@pytest.mark.parametrize("seed", range(24))
def test_variants_together_are_each_of_them(seed):
    random = np.random.default_rng(seed)
    engine = draw_engine(seed, strokes=2 + 2 * (seed % 2))
    if seed % 4 == 1:
        engine = vary_engine(engine, {"piston.offset": 0})
    gas = engine.model.gas
    pool = {
        "gas.imep": gas.imep * random.uniform(0.5, 1.4, 3),
        "gas.compression_ratio": gas.compression_ratio * random.uniform(0.8, 1.2, 2),
        "gas.intake": random.uniform(0.8, 2, 2),
        "gas.expansion_index": random.uniform(1.2, 1.35, 2),
        "piston.mass": random.uniform(0.2, 1, 2),
        "operation.speed": random.uniform(800, 4000, 2),
        "crank.stroke": random.uniform(60, 140, 2),
        "piston.bore": random.uniform(60, 120, 2),
        "rod.ratio": random.uniform(0.2, 0.3, 2),
    }
    grid = {path: pool[path] for path in random.choice([*pool], size=3, replace=False)}
    together = sweep(engine, grid)
    for place in np.ndindex(*map(len, grid.values())):
        own = {path: float(values[k]) for (path, values), k in zip(grid.items(), place, strict=True)}
        alone = sweep(engine, own)
        if isinstance(alone, str):
            assert together == alone
            return
        if not isinstance(together, str):
            expected = alone.ravel()
            assert together[(slice(None), *place)] == pytest.approx(
                expected, rel=1e-12, abs=1e-12 * np.abs(expected).max()
            )
    assert not isinstance(together, str)
