"""The one table of quantities of `sweep`, `search` and `scatter`: names, units, meanings, and the
chapters that compute them. Help, errors and completion read it; `quantities` loads a chapter when
one of its quantities is requested.

`N` stands for an order or a number, `NAME` for the name of a part in the file, `MOTION` for one of
x, y, z, rx, ry, rz and roll, `PART` for one of the words in the meaning.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby
from typing import NamedTuple


class Form(NamedTuple):
    """Quantities with names of one pattern.

    Attributes:
        pattern: Pattern of their names.
        unit: SI unit.
        words: Meaning in words.
        table: Table of the engine file that they need; empty: every engine has them.
    """

    pattern: str
    unit: str
    words: str
    table: str = ""

    def matches(self, name: str) -> bool:
        """Return whether a quantity of this name matches the pattern."""
        kind, _, rest = self.pattern.partition(".")
        own, _, other = name.partition(".")
        middle, _, last = rest.rpartition(".")
        whose, _, part = other.rpartition(".")
        alike = last in (part, "PART") or not rest
        numbered = middle != "N" or whose == "N" or whose.isdecimal()
        return kind == own and alike and numbered and rest.count(".") <= other.count(".")


class Chapter(NamedTuple):
    """Quantities that one module computes.

    Attributes:
        name: Key in `names.QUANTITIES`, which has the module (`quantities.ChapterModule`).
        forms: Patterns of their names.
    """

    name: str
    forms: tuple[Form, ...]

    @property
    def beginnings(self) -> tuple[str, ...]:
        """First words of the names of its quantities."""
        return tuple(dict.fromkeys(form.pattern.partition(".")[0] for form in self.forms))


_OF_VECTOR = "major, minor, forward, backward, axis (deg), x, y, x_cos, x_sin, y_cos, y_sin"
_OF_SCALAR = "amplitude, cos, sin"

ENGINE = Chapter(
    "engine",
    (
        Form("force.N.PART", "N", f"free force: {_OF_VECTOR}"),
        Form("moment.N.PART", "N·m", f"free moment: {_OF_VECTOR}"),
        Form("couple.N.PART", "N·m", f"free couple of the rods: {_OF_SCALAR}"),
        Form("torque.N.PART", "N·m", f"torque on the crank, gas included: {_OF_SCALAR}"),
        Form("roll.N.PART", "N·m", f"roll of the block by inertia: {_OF_SCALAR}"),
        Form("gas.N.PART", "N·m", f"torque of the gas: {_OF_SCALAR}", "gas"),
        Form("torque_total.N.PART", "N·m", f"torque of gas and inertia: {_OF_SCALAR}", "gas"),
        Form("roll_total.N.PART", "N·m", f"roll of the block, gas included: {_OF_SCALAR}", "gas"),
        Form("peak.force", "N", "largest free force over a revolution"),
        Form("peak.moment", "N·m", "largest free moment over a revolution"),
    ),
)
GUIDE = Chapter(
    "guide",
    (
        Form("guide.N.H", "N·m", "H-type guide-force moment, gas included"),
        Form("guide.N.X", "N·m", "X-type guide-force moment, gas included"),
    ),
)
CYCLE = Chapter(
    "cycle",
    (
        Form("torque.mean", "N·m", "mean torque of the gas", "gas"),
        Form("torque.max", "N·m", "largest torque over the cycle, at steady speed", "gas"),
        Form("torque.min", "N·m", "smallest torque over the cycle, at steady speed", "gas"),
        Form("fluctuation", "", "highest less lowest speed, over the mean", "gas"),
    ),
)
_OF_MOTION = "the mode that has most of this motion"
MOUNTS = Chapter(
    "mounts",
    (
        Form("mode.N.Hz", "Hz", "natural frequency on the mounts", "mount"),
        Form("mode.N.share", "%", "largest share of its energy in one motion", "mount"),
        Form("mode.N.damping", "%", "its damping ratio", "mount"),
        Form("mode.MOTION.Hz", "Hz", f"natural frequency of {_OF_MOTION}", "mount"),
        Form(
            "mode.MOTION.share",
            "%",
            "share of this motion in the energy of the mode that has most of it",
            "mount",
        ),
        Form("mode.MOTION.damping", "%", f"damping ratio of {_OF_MOTION}", "mount"),
        Form(
            "mount.NAME.force",
            "N",
            "largest force of a mount, from an eighth of the speed up to it",
            "mount",
        ),
        Form("mount.NAME.static", "N", "its load at rest and under the mean torque", "mount"),
        Form(
            "point.NAME.motion",
            "mm",
            "largest motion of a point, from an eighth of the speed up to it",
            "mount",
        ),
    ),
)
TORSION = Chapter(
    "torsion",
    (
        Form("torsion.N.Hz", "Hz", "natural frequency of the crankshaft that twists", "torsion"),
        Form(
            "shaft.NAME.torque",
            "N·m",
            "largest vibratory torque of a shaft, from half to 1.5 times the speed",
            "torsion",
        ),
        Form("shaft.NAME.stress", "Pa", "its largest vibratory stress there", "torsion"),
    ),
)
CHAPTERS = (ENGINE, GUIDE, CYCLE, MOUNTS, TORSION)
# Quantities that are the largest of a range of speeds: its ends over the engine's speed, in words.
_RANGES = (
    (("mount.", "point."), "Mounts and points", (1 / 8, 1.0), "1/8 to 1 times the engine's speed"),
    (("shaft.",), "Shafts", (0.5, 1.5), "0.5 to 1.5 times the engine's speed"),
)
BEGINNINGS = tuple(dict.fromkeys(each for chapter in CHAPTERS for each in chapter.beginnings))
_OF_CYCLE = tuple(form.pattern for form in CYCLE.forms)


def find_chapter(name: str) -> Chapter | None:
    """Return the chapter of the quantity of this name, by its first word; None: unknown."""
    if name in _OF_CYCLE:
        return CYCLE
    beginning = name.partition(".")[0]
    return next((chapter for chapter in CHAPTERS if beginning in chapter.beginnings), None)


def describe_names() -> str:
    """Return all names in words, for help."""
    names = "; ".join(", ".join(_shorten(chapter)) for chapter in CHAPTERS)
    return (
        f"{names}. N: order or number; PART: of force and moment {_OF_VECTOR}; of others "
        f"{_OF_SCALAR}."
    )


def _shorten(chapter: Chapter) -> Iterator[str]:
    """Return the names of a chapter, joined by beginnings (`mount.NAME.force|static`)."""
    for stem, patterns in groupby(chapter.forms, lambda form: form.pattern.rpartition(".")[0]):
        parts = "|".join(form.pattern.rpartition(".")[2] for form in patterns)
        yield f"{stem}.{parts}" if stem else parts


def tell_speeds(names: Iterable[str], rpm: float, varied: Iterable[str] = ()) -> str:
    """Return over which speeds quantities of these names are the largest, for an engine's speed;
    where the speed varies, they are those at each speed.
    """
    if "operation.speed" in varied:
        return ""
    asked = [name for name in names if not name.endswith(".static")]
    return " ".join(
        f"{what}: largest value from {low * rpm:g} to {high * rpm:g} rpm ({words}); resonances at "
        "other speeds are not included."
        for starts, what, (low, high), words in _RANGES
        if any(name.startswith(starts) for name in asked)
    )
