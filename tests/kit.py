"""What several tests need: a good engine file, and the same with some text replaced."""

from __future__ import annotations

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


def changed(*replacements: tuple[str, str], more: str = "") -> str:
    """GOOD with each old text (which must be there) replaced by the new one, and `more` at its end."""
    text = GOOD
    for old, new in replacements:
        if old not in text:
            raise AssertionError(f"{old!r} is not in the good engine file")
        text = text.replace(old, new)
    return text + more
