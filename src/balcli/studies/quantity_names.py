"""The one table of quantities: what `sweep`, `search` and `scatter` take, who computes it, in which
unit, with what words. Whatever lists names (help, errors, completion) reads it; what computes them
is loaded by `quantities` when one is asked for.

`N` stands for an order or a number, `NAME` for what a part of the file is called, `MOTION` for one
of x, y, z, rx, ry, rz and roll, `PART` for what the words name.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import NamedTuple


class Form(NamedTuple):
    """Quantities that are called alike: the pattern of their names, their SI unit, and what they
    are.
    """

    pattern: str
    unit: str
    words: str

    def matches(self, name: str) -> bool:
        """Whether a quantity of this name is one of these."""
        kind, _, rest = self.pattern.partition(".")
        own, _, other = name.partition(".")
        last, part = rest.rpartition(".")[2], other.rpartition(".")[2]
        alike = last in (part, "PART") or not rest
        return kind == own and alike and rest.count(".") <= other.count(".")


class Chapter(NamedTuple):
    """Quantities that one module computes.

    Attributes:
        module: below `balcli`; what it has to have says `quantities.ChapterModule`.
        table: of the engine file, without which there are none; empty: every engine has them.
        forms: of their names.
    """

    module: str
    table: str
    forms: tuple[Form, ...]

    @property
    def beginnings(self) -> tuple[str, ...]:
        """What their names begin with."""
        return tuple(dict.fromkeys(form.pattern.partition(".")[0] for form in self.forms))


_OF_VECTOR = "major, minor, forward, backward, axis, x, y, x_cos, x_sin, y_cos, y_sin"
_OF_SCALAR = "amplitude, cos, sin"

ENGINE = Chapter(
    "forces.quantity",
    "",
    (
        Form("force.N.PART", "N", f"free force: {_OF_VECTOR} (deg)"),
        Form("moment.N.PART", "N·m", f"free moment: {_OF_VECTOR} (deg)"),
        Form("couple.N.PART", "N·m", f"free couple of the rods: {_OF_SCALAR}"),
        Form("torque.N.PART", "N·m", f"torque on the crank, gas included: {_OF_SCALAR}"),
        Form("roll.N.PART", "N·m", f"roll of the block by inertia: {_OF_SCALAR}"),
        Form("peak.force", "N", "largest free force over a revolution"),
        Form("peak.moment", "N·m", "largest free moment over a revolution"),
    ),
)
GUIDE = Chapter(
    "forces.guide_quantity",
    "",
    (
        Form("guide.N.H", "N·m", "H-type guide-force moment, gas included"),
        Form("guide.N.X", "N·m", "X-type guide-force moment, gas included"),
    ),
)
GAS = Chapter(
    "torque.quantity",
    "gas",
    (
        Form("gas.N.PART", "N·m", f"torque of the gas: {_OF_SCALAR}"),
        Form("torque_total.N.PART", "N·m", f"torque of gas and inertia: {_OF_SCALAR}"),
        Form("roll_total.N.PART", "N·m", f"roll of the block, gas included: {_OF_SCALAR}"),
        Form("torque.mean", "N·m", "mean torque of the gas"),
        Form("torque.max", "N·m", "largest torque over the cycle"),
        Form("torque.min", "N·m", "smallest torque over the cycle"),
        Form("fluctuation", "", "highest less lowest speed, over the mean"),
    ),
)
MOUNTS = Chapter(
    "mounting.quantity",
    "mount",
    (
        Form("mode.N.Hz", "Hz", "natural frequency of the body on its mounts, N from 1 to 6"),
        Form("mode.N.share", "%", "largest share of its energy in one motion"),
        Form("mode.N.damping", "%", "its damping ratio"),
        Form("mode.MOTION.Hz", "Hz", "of the mode with most of this motion; share, damping too"),
        Form("mount.NAME.force", "N", "largest force of a mount, over all speeds"),
        Form("mount.NAME.static", "N", "its load at rest and under the mean torque"),
        Form("point.NAME.motion", "m", "largest motion of a point, over all speeds"),
    ),
)
TORSION = Chapter(
    "torsion.quantity",
    "torsion",
    (
        Form("torsion.N.Hz", "Hz", "natural frequency of the crankshaft that twists"),
        Form("shaft.NAME.torque", "N·m", "largest vibratory torque of a shaft, over all speeds"),
        Form("shaft.NAME.stress", "Pa", "its largest vibratory stress"),
    ),
)
CHAPTERS = (ENGINE, GUIDE, GAS, MOUNTS, TORSION)
BEGINNINGS = tuple(dict.fromkeys(each for chapter in CHAPTERS for each in chapter.beginnings))
_OF_CYCLE = ("torque.mean", "torque.max", "torque.min")


def find_chapter(name: str, *, with_gas: bool = False) -> Chapter | None:
    """The chapter of the quantity of this name, by how it begins; None: of none.

    Args:
        with_gas: whether the engine has gas: its `torque` is then that of gas and inertia.
    """
    beginning = name.partition(".")[0]
    if beginning == "torque" and (with_gas or name in _OF_CYCLE):
        return GAS
    return next((chapter for chapter in CHAPTERS if beginning in chapter.beginnings), None)


def describe_names(chapters: Sequence[Chapter] = CHAPTERS) -> str:
    """All names in words, for help."""
    names = "; ".join(", ".join(_shorten(chapter)) for chapter in chapters)
    return (
        f"{names}. N: order or number; PART: of force and moment {_OF_VECTOR}; of others "
        f"{_OF_SCALAR}."
    )


def _shorten(chapter: Chapter) -> Iterator[str]:
    """Names of a chapter; those that begin alike as one (`mount.NAME.force|static`)."""
    for stem, patterns in groupby(chapter.forms, lambda form: form.pattern.rpartition(".")[0]):
        parts = "|".join(form.pattern.rpartition(".")[2] for form in patterns)
        yield f"{stem}.{parts}" if stem else parts
