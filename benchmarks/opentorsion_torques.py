"""Torques of a torsional chain by openTorsion. `ratios.py` runs this program in an environment of
its own: it reads a chain as JSON, and then computes it once for every further line that it reads,
and writes the processor time (s) and the largest sum of amplitudes (N m).
"""

import json
import sys
import time

import numpy as np
import opentorsion


def compute(chain: dict[str, list]) -> float:
    """Return the largest sum over all orders of the amplitudes of the torque of a shaft, N m."""
    orders = np.array(chain["orders"])
    speeds = np.array(chain["rpm"]) * 2 * np.pi / 60
    stiffness = np.array(chain["stiffness"])
    damping = np.array(chain["damping"])
    discs = [opentorsion.Disk(k, inertia) for k, inertia in enumerate(chain["inertia"])]
    shafts = []
    for k, (spring, dashpot) in enumerate(zip(stiffness, damping, strict=True)):
        shafts.append(opentorsion.Shaft(k, k + 1, k=spring, c=dashpot))
    assembly = opentorsion.Assembly(shafts, disk_elements=discs)
    w = np.multiply.outer(orders, speeds)
    torques = np.array(chain["cos"]) - 1j * np.array(chain["sin"])  # (orders, nodes)
    load = np.repeat(torques[:, None], len(speeds), axis=1).reshape(-1, len(discs)).T
    angles, _ = assembly.ss_response(load, w.ravel())
    factors = stiffness[:, None] + 1j * w.ravel() * damping[:, None]
    amplitudes = np.abs(factors * np.diff(angles, axis=0))
    return float(amplitudes.reshape(len(shafts), *w.shape).sum(axis=1).max())


given = json.loads(sys.stdin.readline())
for _ in sys.stdin:
    start = time.process_time()
    largest = compute(given)
    print(json.dumps([time.process_time() - start, largest]), flush=True)
