"""Engine files with [gas], small ones and some drawn at random, for tests."""

import numpy as np

from balcli.engine.engine import Engine

from .engines import build_text, changed

FOUR = changed(
    *(('name = "in-line four"\n', ""), ("throw_mass = 0.8\n", "")),
    *(("length = 160", "length = 150"), ("cg = 45", "cg = 45\ninertia = 2600")),
)
WIEBE = """\
[gas]
cycle = "wiebe"
compression_ratio = 10
imep = 9
"""
PETROL_FOUR = changed(
    *(("in-line four", "four"), ("stroke = 90", "stroke = 86"), ("spacing = 100\nthrow_mass = 0.8", "spacing = 95")),
    *(("length = 160", "length = 150"), ("mass = 0.5", "mass = 0.5\noffset = 0.8"), ("speed = 3000", "speed = 4000")),
    more=WIEBE.replace("imep = 9", "imep = 12"),
)


def draw_engine(seed: int, strokes: int = 4, more: str = "") -> Engine:
    """An engine with a computed cycle, everything drawn: one to six cylinders that fire anyhow, an
    offset, a rod with any inertia, valve events, burn.
    """
    random = np.random.default_rng(seed)
    count = int(random.integers(1, 7))
    cycle = 180 * strokes
    order = [1, *(random.permutation(count - 1) + 2).tolist()]
    cuts = np.sort(random.choice(np.arange(1, cycle // 5), count - 1, replace=False)) * 5
    intervals = np.diff([0, *cuts, cycle]).tolist()
    offset = random.uniform(-8, 8)
    mean = random.uniform(4, 15)
    text = f"""\
[crank]
stroke = {random.uniform(60, 140)}
spacing = 100
throw_mass = {random.uniform(0, 1)}
[rod]
ratio = {random.uniform(0.2, 0.32)}
mass = {random.uniform(0.4, 0.9)}
cg = {random.uniform(30, 50)}
inertia = {random.uniform(1000, 4000)}
[piston]
bore = {random.uniform(60, 120)}
mass = {random.uniform(0.3, 1.0)}
offset = {offset}
[layout]
strokes = {strokes}
firing_order = {order}
firing_intervals = {intervals}
[operation]
speed = {random.uniform(800, 4000)}
[gas]
cycle = "{random.choice(["otto", "diesel", "wiebe"])}"
compression_ratio = {random.uniform(12, 18)}
imep = {mean}
exhaust_opens = {random.uniform(100, 170)}
crankcase = {random.uniform(0, 1.2)}
[cylinder.1]
gas = {random.uniform(0.5, 1.5)}
{more}
"""
    return build_text(text)
