"""Compare balcli with Exudyn and openTorsion, and write docs/programs.md. It takes some minutes.

Usage: pip install '.[test,verify]'; python tools/other_programs.py
"""

import math
import sys
from importlib.metadata import version
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from oracle.test_exudyn import HIGHEST, STEPS, compare_engines  # noqa: E402
from oracle.test_torsion_programs import compare_chains  # noqa: E402

WORDS = ("engine", "parts", "chain")  # columns of words; the others are numbers
PAGE = ROOT / "docs" / "programs.md"
TEXT = """\
# How balcli compares with other programs

Two independent programs compute the same engines and shafts. Tests repeat the comparison (`pip
install '.[test,verify]'`, `pytest -m stress tests/oracle`), and `python tools/other_programs.py`
writes this page.

## Free forces and moments: Exudyn

[Exudyn](https://github.com/jgerstmayr/EXUDYN) {exudyn} simulates rigid bodies. The comparison
builds every example engine from its parts: a crankshaft that a drive turns at constant speed, rods
and pistons with their joints and guides, and balancer shafts. All of them are mounted on a frame
that one joint holds. Exudyn computes the motion in {fewest} to {most} time steps per revolution;
the results are extrapolated to a step of zero. Orders 0 to {highest} of the force and moment on
that joint, and of the torque of the drive, are compared with `balcli analyze`. Gas is left out, so
that only inertia is compared. The table lists the largest difference in each column, rounded up to
a power of ten. A difference is relative to the largest amplitude of all orders in its column, or to
a thousandth of one cylinder's force or moment if that is larger.

{engines}

## Torsional vibration: openTorsion

[openTorsion](https://github.com/Aalto-Arotor/openTorsion) {opentorsion} computes natural
frequencies, mode shapes, damped poles, and the torque in every shaft over a range of speeds. The
difference of a frequency is relative to that frequency. A dash marks poles that cannot be compared,
because openTorsion computes no poles for shafts with loss factors. In the rows of engines, both
programs use the torques on the throws that balcli computes.

{chains}
"""


def _write(difference: float | None) -> str:
    """Return a difference, rounded up to a power of ten."""
    if difference is None:
        return "–"
    return f"1e{math.ceil(math.log10(max(difference, 1e-15)))}"


def _lay_out(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    marks = ["---" if head in WORDS else "---:" for head in heads]
    return "\n".join(f"| {' | '.join(row)} |" for row in (heads, marks, *rows))


def write_page() -> str:
    """Return the page of the documentation."""
    engines = [
        (each.file, each.reason or each.compared, *map(_write, each[2:5]))
        for each in compare_engines()
    ]
    chains = [
        (each.chain, str(each.modes), *map(_write, each[2:6]))
        for each in compare_chains()
        if not each.chain.startswith("random")
    ]
    return TEXT.format(
        exudyn=version("exudyn"),
        opentorsion=version("opentorsion"),
        fewest=STEPS[0],
        most=STEPS[-1],
        highest=HIGHEST,
        engines=_lay_out(("engine", "parts", "force", "moment", "couple, torque, roll"), engines),
        chains=_lay_out(("chain", "modes", "frequency", "shape", "pole", "torque"), chains),
    )


if __name__ == "__main__":
    PAGE.write_text(write_page(), encoding="utf-8")
