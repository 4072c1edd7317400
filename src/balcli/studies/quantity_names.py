"""Define the table of all quantities of `numbers`, `sweep`, `search`, `scatter` and `check`: names,
units, meanings, and the chapter (a subject, such as mounts) whose module computes each. Help,
errors and completion use the table.

`N` stands for an order or a number, `NAME` for the name of a mount, point or shaft, `MOTION` for
one of x, y, z, rx, ry, rz and roll, `PART` for one of the words in the meaning.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby
from typing import Annotated, NamedTuple

from ..core.records import HIDDEN
from ..forces.kinds import FREE, GAS_KINDS, KINDS, Kind

ENGINE = "engine"
GUIDE = "guide"
CYCLE = "cycle"
PISTON = "piston"
JOURNALS = "journals"
MOUNTS = "mounts"
TORSION = "torsion"
_OF_VECTOR = "major, minor, forward, backward, axis (deg), x, y, x_cos, x_sin, y_cos, y_sin"
_OF_SCALAR = "amplitude, cos, sin"
_PLACES = {"N": r"\d+(?:\.\d+)?", "MOTION": "(?:r?[xyz]|roll)", "NAME": ".+", "PART": ".+"}


class Form(NamedTuple):
    """Quantities whose names match a pattern.

    Attributes:
        chapter: Chapter that computes them: ENGINE, or a key of `names.QUANTITIES`.
        name: Pattern; N stands for an order or a number, PART for a word of the meaning.
        unit: SI unit.
        table: Table of the engine file that they require; empty if every engine has them.
        meaning: Meaning in words.
    """

    chapter: Annotated[str, HIDDEN]
    name: str
    unit: str
    table: Annotated[str, HIDDEN]
    meaning: str

    @property
    def beginning(self) -> str:
        """First word of the names."""
        return self.name.partition(".")[0]

    def matches(self, name: str) -> bool:
        """Return whether a quantity of this name matches the pattern."""
        parts = (_PLACES.get(part, part) for part in self.name.split("."))
        return re.fullmatch(r"\.".join(parts), name) is not None

    def begins_with(self, words: str) -> bool:
        """Return whether names that match the pattern may begin with these words: `force.2`."""
        parts = [_PLACES.get(part, part) for part in self.name.split(".")]
        beginning = parts[: len(words.split("."))]
        return re.fullmatch(r"\.".join(beginning), words) is not None


def _list_forms(chapter: str, table: str, *rows: tuple[str, str, str]) -> Iterator[Form]:
    """Yield the quantities of a chapter that require the same table of the engine file.

    Args:
        chapter: Chapter that computes them.
        table: Table of the engine file; empty if every engine has them.
        rows: Pattern, SI unit and meaning of each.
    """
    for name, unit, meaning in rows:
        yield Form(chapter, name, unit, table, meaning)


def _list_kinds(kinds: Mapping[str, Kind], table: str) -> Iterator[Form]:
    """Yield the quantities by order of kinds of forces and moments; `table`: as for
    `_list_forms`.
    """
    for name, kind in kinds.items():
        parts = _OF_VECTOR if kind.vector else _OF_SCALAR
        meaning = f"{kind.meaning or kind.label}: {parts}"
        yield Form(ENGINE, f"{name}.N.PART", kind.si_unit, table, meaning)


def _name_peak(kind: Kind) -> tuple[str, str, str]:
    """Return name, unit and meaning of the peak of a kind."""
    return f"peak.{kind.name}", kind.si_unit, f"largest {kind.label} over a revolution"


FORMS = (
    *_list_kinds(KINDS, ""),
    *_list_kinds(GAS_KINDS, "gas"),
    *_list_forms(ENGINE, "", *map(_name_peak, FREE)),
    *_list_forms(
        GUIDE,
        "",
        ("guide.N.H", "N·m", "H-type guide-force moment (rocks the block), gas included"),
        ("guide.N.X", "N·m", "X-type guide-force moment (twists the block), gas included"),
    ),
    *_list_forms(
        CYCLE,
        "gas",
        ("torque.mean", "N·m", "mean torque of the gas"),
        ("torque.max", "N·m", "largest torque over the cycle, at steady speed"),
        ("torque.min", "N·m", "smallest torque over the cycle, at steady speed"),
        ("fluctuation", "", "highest minus lowest speed, divided by the mean speed"),
    ),
    *_list_forms(
        PISTON,
        "",
        ("piston.mean_speed", "m/s", "mean speed of piston 1"),
        ("piston.max_speed", "m/s", "largest speed of piston 1, in either direction"),
        ("piston.max_acceleration", "m/s²", "largest acceleration of piston 1 towards the crank"),
        ("piston.stroke", "m", "true stroke of piston 1"),
        ("piston.N.mean_speed", "m/s", "mean speed of piston N"),
        ("piston.N.max_speed", "m/s", "largest speed of piston N, in either direction"),
        ("piston.N.max_acceleration", "m/s²", "largest acceleration of piston N towards the crank"),
        ("piston.N.stroke", "m", "true stroke of piston N"),
    ),
    *_list_forms(
        JOURNALS,
        "",
        ("journal.N.range", "N·m", "highest minus lowest torque in main journal N, with gas"),
        ("journal.N.max", "N·m", "highest torque in main journal N, gas included"),
        ("journal.N.min", "N·m", "lowest torque in main journal N, gas included"),
        ("pin.N.range", "N·m", "highest minus lowest torque in the crank pin of throw N"),
        ("pin.N.max", "N·m", "highest torque in the crank pin of throw N"),
        ("pin.N.min", "N·m", "lowest torque in the crank pin of throw N"),
    ),
    *_list_forms(
        MOUNTS,
        "mount",
        ("mode.N.Hz", "Hz", "natural frequency on the mounts"),
        ("mode.N.share", "%", "largest share of one motion in the energy of the mode"),
        ("mode.N.damping", "%", "damping ratio of the mode"),
        ("mode.MOTION.Hz", "Hz", "natural frequency of the mode that has most of this motion"),
        (
            "mode.MOTION.share",
            "%",
            "share of this motion in the energy of the mode that has most of it",
        ),
        ("mode.MOTION.damping", "%", "damping ratio of the mode that has most of this motion"),
        ("mount.NAME.force", "N", "largest force of a mount, at 1/8 to 1 times the engine's speed"),
        ("mount.NAME.static", "N", "force of a mount at rest, mean torque included"),
        (
            "point.NAME.motion",
            "mm",
            "largest motion of a point, at 1/8 to 1 times the engine's speed",
        ),
    ),
    *_list_forms(
        TORSION,
        "torsion",
        ("torsion.N.Hz", "Hz", "torsional natural frequency of the crankshaft"),
        ("torsion.misfit", "deg", "root mean square difference from the measured curve"),
        (
            "shaft.NAME.torque",
            "N·m",
            "largest vibratory torque of a shaft, at 0.5 to 1.5 times the engine's speed",
        ),
        (
            "shaft.NAME.stress",
            "Pa",
            "largest vibratory stress of a shaft, at 0.5 to 1.5 times the engine's speed",
        ),
    ),
)
BEGINNINGS = tuple(dict.fromkeys(form.beginning for form in FORMS))
# Notes on quantities that are the largest value over a range of speeds, by the beginnings of names.
_RANGES = {
    ("mount.", "point."): "Mounts and points: largest value at 1/8 to 1 times the engine's speed",
    ("shaft.",): "Shafts: largest value at 0.5 to 1.5 times the engine's speed",
}


def describe_names() -> str:
    """Return a description of all names for help."""
    chapters = (join_patterns(forms) for _, forms in groupby(FORMS, lambda form: form.chapter))
    names = "; ".join(", ".join(chapter) for chapter in chapters)
    names = re.sub(r"[^ ]{44,}", lambda name: name[0].replace("|", " | "), names)  # may be folded
    return (
        f"{names}. N: order or number. PART of force and moment: {_OF_VECTOR}; PART of others: "
        f"{_OF_SCALAR}."
    )


def join_patterns(forms: Iterable[Form]) -> Iterator[str]:
    """Yield patterns, joined if they differ only in the last part: `mount.NAME.force|static`."""
    for stem, patterns in groupby(forms, lambda form: form.name.rpartition(".")[0]):
        parts = "|".join(form.name.rpartition(".")[2] for form in patterns)
        yield f"{stem}.{parts}" if stem else parts


def tell_speeds(names: Iterable[str], varied: Iterable[str] = ()) -> str:
    """Return a note on those of the named quantities that are the largest value over a range of
    speeds: it states the range. The note is empty if `varied` contains the speed of the engine.
    """
    if "operation.speed" in varied:
        return ""
    asked = [name for name in names if not name.endswith(".static")]
    notes = []
    for starts, note in _RANGES.items():
        if any(name.startswith(starts) for name in asked):
            notes.append(f"{note}.")
    return " ".join(notes)
