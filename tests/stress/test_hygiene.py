"""One engine, one result: from run to run, on any number of threads, in whatever order a file lists its cylinders."""

import os
import subprocess
import sys

import numpy as np
import pytest
from support.commands import run_command
from support.engines import alone, engine
from support.paths import ENGINES

from balcli.core.phasors import EPS
from balcli.engine.engine import Engine
from balcli.forces.kinds import KINDS
from balcli.forces.spectrum import compute_spectra

pytestmark = pytest.mark.stress

ORDERS = np.arange(1.0, 17.0)


def output(threads: int) -> bytes:
    names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
    engines = ENGINES / "vr6.toml", ENGINES / "radial9.toml"
    limits = dict.fromkeys(names, str(threads))
    return run_command("analyze", *engines, "--format", "json", env=limits, encoding=None).stdout


def test_runs_and_threads_do_not_matter():
    """Byte for byte."""
    one = output(1)
    assert one.startswith((b"{", b"["))
    assert output(1) == one == output(8)


def listed(order: list[int]) -> Engine:
    """Eight unequal cylinders on their own throws in two banks, the throws in this order in the file."""
    masses = [0.3 + 0.17 * k for k in range(8)]
    throws = [0, 91.7, 183.1, 274.9, 45, 135.3, 222.2, 311.1]
    table = {
        str(place + 1): {
            "piston_mass": masses[k],
            "throw": float(throws[k]),
            "bank": 30.0 * (k % 3),
            "rod_length": 150.0 + 7 * k,
            "position": 90.0 * k,
            "piston_offset": 0.7 * (k % 2),
        }
        for place, k in enumerate(order)
    }
    return engine(
        crank={"stroke": 100, "throws": [0] * 8, "throw_mass": 0.4},
        rod={"length": 170, "mass": 0.9, "cg": 40, "inertia": 3e3},
        frame={"reference": [12, -5, 200]},
        cylinder=table,
    )


@pytest.mark.parametrize("seed", range(4))
def test_the_order_of_cylinders_in_the_file_does_not_matter(seed):
    """To 8 N roundings of the sum of what single cylinders make, as the noise of the whole has it
    (cylinder 1 stays the first).
    """
    order = [0, *(1 + np.random.default_rng(seed).permutation(7)).tolist()]
    one, other = (compute_spectra(listed(each), ORDERS) for each in (list(range(8)), order))
    whole = listed(list(range(8)))
    parts = [compute_spectra(alone(whole, n), ORDERS) for n in whole.numbers]
    for q in KINDS:
        p = getattr(one, q)
        o = getattr(other, q)
        sizes = sum(getattr(part, q).major for part in parts)
        for way in ("forward", "backward"):
            error = np.abs(getattr(p, way) - getattr(o, way))
            assert np.all(error <= 8 * len(order) * EPS * sizes), q


LARGEST = """
import tracemalloc
from support.engines import alone, engine
from balcli.core.peaks import find_peak
from balcli.forces.spectrum import find_relevant_orders
from balcli.forces.spectrum import compute_spectra
whole = engine(crank={"stroke": 100, "throws": [7.3 * k % 360 for k in range(512)], "spacing": 1}, rod={"ratio": 1 - 1e-6})
orders = find_relevant_orders(whole)
tracemalloc.start()
found = compute_spectra(whole, orders, ["force", "moment"])
assert len(orders) == 32768 and find_peak(found.force).value > 0 and find_peak(found.moment).value > 0
print(tracemalloc.get_traced_memory()[1] / 1e6)
"""


def test_512_cylinders_and_32768_orders_ask_for_less_than_100_mb():
    """At a time. All at once they would be 16 million complex numbers, 256 MB, for each of some 16 arrays."""
    env = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    run = subprocess.run([sys.executable, "-c", LARGEST], env=env, capture_output=True, check=True)
    assert float(run.stdout) < 100
