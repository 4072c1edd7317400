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

[Exudyn](https://github.com/jgerstmayr/EXUDYN) {exudyn} simulates rigid bodies. Every example engine
is built there of its parts: a crankshaft that a drive turns at constant speed, rods and pistons
with their joints and guides, balancer shafts, all on a frame that one joint holds. Its motion is
computed in {fewest} to {most} time steps a revolution and extrapolated to a step of zero. Orders 0
to {highest} of force and moment on that joint, and of the torque of the drive, are compared with
`balcli analyze`. Gas is left out: the comparison is of inertia. The table has the largest
difference, as a share of the largest order of its group (of a thousandth of one cylinder's force or
moment, if that is larger), rounded up to a power of ten.

{engines}

## Torsional vibration: openTorsion

[openTorsion](https://github.com/Aalto-Arotor/openTorsion) {opentorsion} computes natural
frequencies (differences relative to each), shapes of modes, damped poles, and the torque in every
shaft over a range of speeds. A dash marks what is not compared: openTorsion has no poles with loss
factors. The torques that excite the throws of engines are balcli's own.

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
