"""Keys of an engine file's text are changed, and all else stays: comments, lay-out, other
tables.
"""

from __future__ import annotations

import tomllib

import pytest
from support.engines import changed

from balcli.enginefile.edit import set_keys

COMMENTED = changed(
    ("throws = [0, 180, 180, 0]", "throws     = [0, 180,\n  180, 0]   # deg, free end first"),
    ("[crank]", "[crank]  # forged"),
    ("speed = 3000", "speed = 3000  # rpm"),
    more="# the end\n",
)


@pytest.mark.parametrize(
    ("table", "keys", "old", "new"),
    [
        (
            "crank",
            {"throws": [0.0, 90.5]},
            "throws     = [0, 180,\n  180, 0]   # deg, free end first",
            "throws     = [0.0, 90.5]   # deg, free end first (a note)",
        ),
        ("operation", {"speed": 1000.0}, "speed = 3000  # rpm", "speed = 1000.0  # rpm (a note)"),
        (
            "layout",
            {"firing_order": [1, 2, 4, 3]},
            "firing_order = [1, 3, 4, 2]",
            "firing_order = [1, 2, 4, 3]    # a note",
        ),
        ("crank", {"splay": -30.0}, "[crank]  # forged\n", "[crank]  # forged\nsplay = -30.0    # a note\n"),
        ("layout", {"firing_order": None, "firing_intervals": None}, "firing_order = [1, 3, 4, 2]\n", ""),
        ("layout", {"firing_intervals": None}, "", ""),
        ("operation", {"speed": 3000.0}, "", ""),
        (
            "frame",
            {"reference": [0.0, 0.0, 5.0]},
            "# the end\n",
            "# the end\n\n[frame]\nreference = [0.0, 0.0, 5.0]    # a note\n",
        ),
        ("cylinder.3", {"gas": 0}, "# the end\n", "# the end\n\n[cylinder.3]\ngas = 0    # a note\n"),
    ],
)
@pytest.mark.parametrize("ends", ["\n", "\r\n"])
def test_only_the_key_changes(table, keys, old, new, ends):
    text, wanted = (t.replace("\n", ends) for t in (COMMENTED, COMMENTED.replace(old, new, 1)))
    found = set_keys(text, table, keys, "a note")
    assert found == wanted
    assert set_keys(found, table, keys, "a note") == wanted


def test_a_last_line_without_an_end():
    assert set_keys("[operation]", "operation", {"speed": 5.0}, "a note") == "[operation]\nspeed = 5.0    # a note\n"


@pytest.mark.parametrize(
    "text",
    [
        "operation = { speed = 3000 }  # inline\n",
        "operation.speed = 3000  # dotted\n",
        '"operation".speed = 3000\n',
        '[operation]\n"speed" = 3000\n',
        '[operation]\nspeed = 3000\n[crank]\nnote = """\n[operation]\nspeed = 1\n"""\n',
    ],
)
def test_what_is_written_in_an_unusual_way_is_right_all_the_same(text):
    assert tomllib.loads(set_keys(text, "operation", {"speed": 5.0}, "a note")) == {
        **tomllib.loads(text),
        "operation": {"speed": 5.0},
    }


@pytest.mark.parametrize(
    "text",
    [
        "[cylinder.3]  # weak\ngas = 0.5  # measured\n",
        "[cylinder]\n3 = { piston_mass = 0.5, gas = 0.5 }\n",
        "[cylinder]\n3.gas = 0.5\n",
        "cylinder.3.piston_mass = 0.5\n",
        "cylinder = { 3 = { gas = 0.5 }, 4 = { gas = 0.4 } }\n",
        "[cylinder.13]\ngas = 0.5\n[cylinder.4]\ngas = 0.4\n",
    ],
)
def test_a_table_within_another(text):
    wanted = tomllib.loads(text)
    wanted["cylinder"].setdefault("3", {})["gas"] = 0
    assert tomllib.loads(set_keys(text, "cylinder.3", {"gas": 0}, "a note")) == wanted


DOTTED = "# mine\nlayout.bank_angle = 75   # as built\nlayout.firing_order = [1, 2]\n[rod]\nlength = 1  # l\n"
INLINE = "# mine\nlayout = { bank_angle = 75, firing_order = [1, 2] }   # as built\n[rod]\nlength = 1  # l\n"


@pytest.mark.parametrize(
    ("text", "keys", "old", "new"),
    [
        (DOTTED, {"bank_angle": 90.0}, "bank_angle = 75   # as built", "bank_angle = 90.0   # as built (a note)"),
        (DOTTED, {"firing_order": None}, "layout.firing_order = [1, 2]\n", ""),
        (DOTTED, {"stagger": 3}, "# mine\n", "# mine\nlayout.stagger = 3    # a note\n"),
        (
            INLINE,
            {"bank_angle": 90.0},
            "bank_angle = 75, firing_order = [1, 2] }   # as built",
            "bank_angle = 90.0, firing_order = [1, 2] }   # as built (a note)",
        ),
        (
            INLINE,
            {"firing_order": None},
            "bank_angle = 75, firing_order = [1, 2] }   # as built",
            "bank_angle = 75 }   # as built (a note)",
        ),
        (
            INLINE,
            {"stagger": 3, "bank_angle": None},
            "bank_angle = 75, firing_order = [1, 2] }   # as built",
            "stagger = 3, firing_order = [1, 2] }   # as built (a note)",
        ),
        (
            INLINE.replace("as built", "{as built}"),
            {"bank_angle": 60},
            "bank_angle = 75, firing_order = [1, 2] }   # {as built}",
            "bank_angle = 60, firing_order = [1, 2] }   # {as built} (a note)",
        ),
        (
            INLINE.replace("   # as built", ""),
            {"bank_angle": 60},
            "bank_angle = 75, firing_order = [1, 2] }",
            "bank_angle = 60, firing_order = [1, 2] }    # a note",
        ),
    ],
)
def test_dotted_keys_and_braces_keep_comments_too(text, keys, old, new):
    assert set_keys(text, "layout", keys, "a note") == text.replace(old, new, 1)
