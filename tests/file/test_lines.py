"""Lines of keys, for messages that lead to the place in an engine file."""

import tomllib

import pytest
from support.paths import ENGINE_FILES

from balcli.file.lines import LineFinder

TEXT = b"""\
name = "x"
[[shaft]]
ratio = 1 # a comment
# another

[[shaft]]
at = [
  1, # with a comment
  2,
]

note = '''
[crank]
'''
[crank]
throws = [[0, 1], [2, 3]]
[check.limits]
"moment.1.major" = { below = 5 }
force.2.major = { above = 5 }
"""


@pytest.mark.parametrize(
    ("path", "line"),
    [
        ("name", 1),
        ("shaft.1", 2),
        ("shaft.1.ratio", 3),
        ("shaft.2", 6),
        ("shaft.2.at", 7),
        ("shaft.2.at.2", 7),
        ("shaft.2.note", 12),
        ("crank", 15),
        ("crank.throws.2.1", 16),
        ("check.limits.moment.1.major", 18),
        ("check.limits.moment.1.major.below", 18),
        ("check.limits.force.2.major", 19),
        ("crank.stroke", 15),  # missing: the table that should have it
        ("shaft.2.ratio", 6),
        ("rod", None),
        ("rod.length", None),
        ("", None),
    ],
)
def test_the_line_of_a_key(path, line):
    for text in (TEXT, TEXT.replace(b"\n", b"\r\n"), b"\xef\xbb\xbf" + TEXT, TEXT.rstrip(b"\n")):
        assert LineFinder(text).find(path) == line


@pytest.mark.parametrize("text", [b"", b"[crank", b"\xff\xfe", b"a = 1\n" * 3])
def test_a_text_that_is_no_toml_has_no_lines(text):
    assert LineFinder(text).find("crank.stroke") is None


def test_texts_and_statements_that_are_too_long_have_no_lines():
    """Otherwise they would be read hundreds of times. An engine file has up to 300 lines."""
    assert LineFinder(b"x = 1\n" + 990 * b"\n").find("x") == 1
    assert LineFinder(b"x = 1\n" + 1000 * b"\n").find("x") is None
    assert LineFinder(b"y = 1\nx = [\n" + 190 * b"1,\n" + b"]\n").find("x") == 2
    assert LineFinder(b"y = 1\nx = [\n" + 210 * b"1,\n" + b"]\n").find("x") is None


def test_keys_of_the_examples_are_on_their_lines():
    """The line begins with the key, or the table of this name, for every key of a table that is not in a list."""
    for file in ENGINE_FILES[::8]:
        text = file.read_bytes()
        lines = text.decode().splitlines()
        finder = LineFinder(text)
        for name, table in tomllib.loads(text.decode()).items():
            for key in table if isinstance(table, dict) else ():
                line = lines[finder.find(f"{name}.{key}") - 1]
                assert line.startswith((key, f"[{name}", f"[[{name}.{key}]]"))
