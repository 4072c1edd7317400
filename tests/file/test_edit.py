"""Keys of an engine file's text are changed, and all else stays: comments, lay-out, other tables."""

import tomllib

import pytest
from support.cases import cases
from support.engines import changed

from balcli.file.edit import set_keys

COMMENTED = changed(
    ("throws = [0, 180, 180, 0]", "throws     = [0, 180,\n  180, 0]   # deg, free end first"),
    ("[crank]", "[crank]  # forged"),
    ("speed = 3000", "speed = 3000  # rpm"),
    more="# the end\n",
)


@cases("file/edit", "only_the_key_changes")
@pytest.mark.parametrize("ends", ["\n", "\r\n"])
def test_only_the_key_changes(table, keys, old, new, ends):
    text, wanted = (t.replace("\n", ends) for t in (COMMENTED, COMMENTED.replace(old, new, 1)))
    found = set_keys(text, table, keys, "a note")
    assert found == wanted
    assert set_keys(found, table, keys, "a note") == wanted


def test_a_last_line_without_an_end():
    assert set_keys("[operation]", "operation", {"speed": 5.0}, "a note") == "[operation]\nspeed = 5.0    # a note\n"


@cases("file/edit", "what_is_written_in_an_unusual_way_is_right_all_the_same")
def test_what_is_written_in_an_unusual_way_is_right_all_the_same(text):
    assert tomllib.loads(set_keys(text, "operation", {"speed": 5.0}, "a note")) == {
        **tomllib.loads(text),
        "operation": {"speed": 5.0},
    }


@cases("file/edit", "a_table_within_another")
def test_a_table_within_another(text):
    wanted = tomllib.loads(text)
    wanted["cylinder"].setdefault("3", {})["gas"] = 0
    assert tomllib.loads(set_keys(text, "cylinder.3", {"gas": 0}, "a note")) == wanted


DOTTED = "# mine\nlayout.bank_angle = 75   # as built\nlayout.firing_order = [1, 2]\n[rod]\nlength = 1  # l\n"
INLINE = "# mine\nlayout = { bank_angle = 75, firing_order = [1, 2] }   # as built\n[rod]\nlength = 1  # l\n"


@cases("file/edit", "dotted_keys_and_braces_keep_comments_too", DOTTED=DOTTED, INLINE=INLINE)
def test_dotted_keys_and_braces_keep_comments_too(text, keys, old, new):
    assert set_keys(text, "layout", keys, "a note") == text.replace(old, new, 1)
