"""What several tests need: a good engine file, the same with some text replaced, and small engines."""

from functools import lru_cache
from typing import Any

import pytest
import tomli_w

from balcli import load
from balcli.engine.build import build
from balcli.engine.engine import Engine
from balcli.engine.parse import parse
from balcli.errors import InputError
from balcli.forces.spectrum import with_only

GOOD = """\
name = "in-line four"
[crank]
stroke = 90
throws = [0, 180, 180, 0]
spacing = 100
throw_mass = 0.8
[rod]
length = 160
mass = 0.6
cg = 45
[piston]
bore = 86
mass = 0.5
[layout]
firing_order = [1, 3, 4, 2]
[operation]
speed = 3000
"""

RADIAL = """\
[crank]
stroke = 120
[rod]
length = 240
mass = 1.9
cg = 55
[piston]
mass = 1.3
[layout]
radial = 7
[articulation]
knuckle_radius = 52
rod = { length = 188, mass = 0.62, cg = 90 }
"""

GNOME = """\
[crank]
stroke = 120
throw_mass = 3
[rod]
length = 230
mass = 0.9
cg = 70
inertia = 7000
[piston]
mass = 0.8
offset = {offset}
[layout]
{layout}
rotary = true
"""
# All that [[web]] tables need beside them
TWIN = """\
[crank]
stroke = 82
throws = [0, 180]
spacing = 96
[rod]
length = 142
mass = 0.58
cg = 40
[piston]
bore = 84
mass = 0.47
skirt = 24
[operation]
speed = 6800
[frame]
crankcase = 80
[bearing]
pin_diameter = 46
pin_length = 28
"""


def changed(*replacements: tuple[str, str], more: str = "") -> str:
    """GOOD with each old text (which must be there) replaced by the new one, and `more` at its end."""
    text = GOOD
    for old, new in replacements:
        if old not in text:
            raise AssertionError(f"{old!r} is not in the good engine file")
        text = text.replace(old, new)
    return text + more


INLINE = changed(
    *(('name = "in-line four"\n', ""), ("[0, 180, 180, 0]", "{throws}"), ("throw_mass = 0.8", "throw_mass = 1.0")),
    *(("cg = 45", "cg = 45\ninertia = 2000"), ("bore = 86\n", ""), ("firing_order = [1, 3, 4, 2]", "{layout}")),
)
SINGLE = changed(("throws = [0, 180, 180, 0]", "throws = [0]"), ("firing_order = [1, 3, 4, 2]", "strokes = 4"))
VEE = changed(
    ("[0, 180, 180, 0]", "[0, 100, 250, 190]"), ("firing_order = [1, 3, 4, 2]", "bank_angle = 70\nstagger = 20")
)


def tables(**parts: dict[str, Any] | list[dict[str, Any]]) -> dict[str, Any]:
    """A plain engine of one cylinder (lambda 1/4, 1 kg piston, rod without mass, 60 rpm) with some tables changed."""
    plain: dict[str, Any] = {
        "crank": {"stroke": 100},
        "rod": {"length": 200},
        "piston": {"mass": 1},
        "operation": {"speed": 60},
    }
    found = plain | {
        name: plain.get(name, {}) | part if isinstance(part, dict) else part for name, part in parts.items()
    }
    if "ratio" in found["rod"]:
        found["rod"].pop("length")
    return found


def engine(**parts: dict[str, Any] | list[dict[str, Any]]) -> Engine:
    """The same, built: through TOML and the loader, as a user's file would be."""
    return build_text(tomli_w.dumps(tables(**parts)))


def build_text(text: str | bytes) -> Engine:
    """The engine of a file's text. Nothing changes an engine, so that a text which names no other file is read once."""
    names_files = ".csv" in str(text)
    return build(parse(text)) if names_files else _build_once(text)


@lru_cache(maxsize=500)
def _build_once(text: str | bytes) -> Engine:
    return build(parse(text))


def inline_engine(throws: list[float], layout: str = "", more: str = "") -> Engine:
    """Cylinders 100 mm apart; lines of [layout], and tables at the end of the file."""
    return build_text(INLINE.format(throws=throws, layout=layout) + more)


def rotary_engine(layout: str = "radial = 7", offset: float = 0, more: str = "") -> Engine:
    """Cylinders that turn about a crank standing still; as above."""
    return build_text(GNOME.format(layout=layout, offset=offset) + more)


def refused(**parts: dict[str, Any] | list[dict[str, Any]]) -> str:
    """All of what is said against such an engine."""
    with pytest.raises(InputError) as caught:
        engine(**parts)
    return str(caught.value)


def mistakes_in(text: str | bytes) -> str:
    """All of what is said against the text of an engine file, without its name."""
    with pytest.raises(InputError) as caught:
        parse(text, "e.toml")
    return str(caught.value).removeprefix("e.toml: ")


def list_problems(source: object) -> list[str]:
    """Every mistake of an engine that cannot be loaded: a text, a path or tables."""
    with pytest.raises(InputError) as caught:
        load(source)
    return [str(problem) for problem in caught.value.problems]


def engine_text(**tables: str) -> str:
    """A small engine in 1 kg, 100 mm stroke, unit figures; each keyword names a table and gives its
    lines, replacing the default.
    """
    lines = {"crank": "stroke = 100", "rod": "ratio = 0.25", "piston": "mass = 1"} | tables
    return "\n".join(f"[{table}]\n{body}" for table, body in lines.items()) + "\n"


def alone(engine: Engine, number: int) -> Engine:
    """The engine with the masses of one cylinder alone, and without devices."""
    return with_only(engine, [n == number for n in engine.numbers])
