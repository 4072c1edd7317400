"""Read TOML files of any kind, within limits on size and depth. Errors name the file."""

from __future__ import annotations

import os
import re
import sys
import tomllib
from pathlib import Path

from ..core.records import Node
from ..errors import BalcliError, InputError, Problem
from ..limits import DEEPEST_KEY, LARGEST_FILE_BYTES, MOST_TOML_MARKS
from .examples import ExamplePath, find_similar, is_example
from .fields import nearest, shorten

ENGINE_FILE = (
    "not an engine file, which is TOML text with tables such as [crank], [rod] and [piston]: "
    "`balcli new` writes one"
)
_KEY_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+"""
_DEEP_KEY = re.compile(rf"""(?<![\w"'-])(?:{_KEY_PART}){{{DEEPEST_KEY}}}""")
_TOO_DEEP = "lists or tables are nested too deeply; an engine file needs no more than four levels"
_LONGEST_LINE = 80  # largest number of characters of a line in a message
_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)"
_DASHED = r"\d+(?:-\d+)+"  # a firing order, 1-3-4-2
# Patterns of values without quotes, and the remedy; the first that matches is used.
_NO_DIGIT_BEFORE = r"(?<![\w.])\.(?=\d)"
_NO_DIGIT_BEHIND = r"(?<=\d)\.(?![\d.])"
_HINTS = (
    (rf"[^\"']*(?:{_NO_DIGIT_BEFORE}|{_NO_DIGIT_BEHIND})[^\"']*", "write {whole}"),
    (rf"{_NUMBER},\d+", "write a decimal point, not a comma"),
    (rf"{_NUMBER}[dD][+-]?\d+", "an exponent is written with e, as in 1.5e3"),
    (
        rf"{_NUMBER}(?:[\s,;]+{_NUMBER})+|{_DASHED}|\[[^\[\]]*\d\s*[\s;]\s*[-+.\d][^\[\]]*\]",
        "a list needs brackets and commas: {key} = [{numbers}]",
    ),
    (
        rf"{_NUMBER}(?:/\d+)?\s*[A-Za-z°%\"″'].*",
        'a value with a unit needs quotes: {key} = "{value}"',
    ),
)


def read_bytes(source: str | Path) -> bytes:
    """Return the content of a file ("-": standard input). Of a file that is too large, return one
    byte more than LARGEST_FILE_BYTES.

    Raises:
        BalcliError: The file cannot be read.
    """
    if not str(source):
        raise BalcliError('a file name is missing: ""')
    try:
        if str(source) == "-":
            return sys.stdin.buffer.read(LARGEST_FILE_BYTES + 1)
        with Path(source).open("rb") as stream:
            return stream.read(LARGEST_FILE_BYTES + 1)
    except IsADirectoryError:
        raise BalcliError(f"{source}: is a folder; name a file in it") from None
    except FileNotFoundError:
        raise BalcliError(f"{source}: no such file{find_near_file(source)}") from None
    except (OSError, ValueError) as error:  # ValueError: a zero byte in the name
        reason = (isinstance(error, OSError) and error.strerror) or error
        name = "standard input" if str(source) == "-" else repr(str(source)[:200])
        raise BalcliError(f"{name}: cannot be read ({reason})") from None


def find_near_file(source: str | Path) -> str:
    """Return the end of a message, with the file or example that was probably meant; empty if no
    name is similar.
    """
    with_ending = f"{source}.toml"
    asked = Path(source)
    if Path(with_ending).is_file():
        return f"; {with_ending} is there: did you mean it?"
    if asked.suffix in ("", ".toml") and is_example(asked.stem):
        return f"; {asked.stem} is an example: balcli engines {asked.stem} {asked.stem}.toml"
    there = sorted(file.name for file in asked.parent.glob("*.toml") if file.is_file())
    near = nearest(asked.name, there, cutoff=0.8)
    if near and nearest(asked.suffix, [".toml"]):  # not a .csv next to an engine file
        return f"; {asked.with_name(near)} is there: did you mean it?"
    similar = find_similar(str(source))
    return f"; did you mean the example {similar}?" if similar else ""


def locate_beside(folder: Path, name: str) -> Path:
    """Return the path of a file that an engine file names.

    Args:
        folder: Folder of the engine file, which the path may not leave.
        name: Name in the engine file.

    Raises:
        BalcliError: The path leaves the folder, no file can have that name, or it is a named pipe
            or a device, from which balcli would read without end.
    """
    try:
        home = folder.resolve()
        place = (folder / name).resolve()
    except ValueError as error:  # a letter that this system's file names lack (LC_ALL=C)
        raise BalcliError(f"{shorten(name)}: cannot be read ({error})") from None
    if not place.is_relative_to(home):
        raise BalcliError(f"{shorten(name)} is outside the folder of the engine file; put it there")
    if os.path.exists(place) and not (os.path.isfile(place) or os.path.isdir(place)):
        raise BalcliError(f"{shorten(name)} is a named pipe or a device; give a regular file")
    return folder / name


def name_file(source: str | Path) -> str:
    """Return the name of a file in messages; "-" is standard input."""
    if isinstance(source, ExamplePath):
        return source.name
    return "standard input" if str(source) == "-" else str(source)


def parse_toml(text: str | bytes, file: str, right: str = ENGINE_FILE) -> Node:
    """Return TOML as nested dicts.

    Args:
        text: Text of the file.
        file: Name of the file, for messages.
        right: Words that follow "is" in the message for a text of another format.

    Raises:
        InputError: The text is not TOML, or exceeds a limit.
    """
    decoded, message = _decode(text, right)
    line: int | None = None
    if not message:
        try:
            return tomllib.loads(decoded)
        except tomllib.TOMLDecodeError as error:
            line = _find_line(decoded, str(error))
            message = f"is not valid TOML: {str(error)[:300]}{_explain(decoded, line)}"
        except RecursionError:
            decoded = ""
            message = _TOO_DEEP
        except ValueError:  # Python limits the number of digits
            decoded = ""
            message = "has a number with thousands of digits"
    # A text without any key or heading was not meant as TOML, unless it is empty.
    key = r"""^(?:[\w."' \t-]++=|[ \t]*+\[{1,2}[\w. \t-]*(?:\]|$))"""
    if re.search(r"^[ \t]*[^\s#]", decoded, re.M) and not re.search(key, decoded, re.M):
        message = f"is {right}"
    raise InputError([Problem("", message, line=line)], file)


def _decode(text: str | bytes, right: str) -> tuple[str, str]:
    """Return the text of a file, and the reason why tomllib must not read it (empty if there is no
    reason). The text is empty if this reason is reported even for a text that is no TOML at all.
    """
    if len(text) > LARGEST_FILE_BYTES:
        decoded = text if isinstance(text, str) else text.decode("utf-8-sig", "replace")
        most = f"{LARGEST_FILE_BYTES // 1_000_000} MB"
        return decoded, f"has more than {most}; no engine file needs that"
    try:
        decoded = text.decode("utf-8-sig") if isinstance(text, bytes) else text
    except UnicodeDecodeError as error:
        start = error.object[:1000]
        if b"\0" in start and start[:2] not in (b"\xff\xfe", b"\xfe\xff"):
            return "", f"is not a text, and {right}"
        line = error.object[: error.start].count(b"\n") + 1
        return "", f"is not UTF-8 text (line {line}); save it as UTF-8"
    if _DEEP_KEY.search(decoded):
        return "", _TOO_DEEP
    if sum(map(decoded.count, "[{.,=")) > MOST_TOML_MARKS:
        most = f"{MOST_TOML_MARKS} keys, lists and values"
        return decoded, f"has more than {most}; no engine file needs that"
    return decoded, ""


def _find_line(text: str, error: str) -> int:
    """Return the line that an error of tomllib names; if it names none, the last line."""
    last = text.rstrip("\n").count("\n") + 1
    place = re.search(r"\(at line (\d+), ", error)
    return last if place is None else min(int(place[1]), last)


def _explain(text: str, line: int) -> str:
    """Return a line that is not valid, and the remedy for some slips: units without quotes, lists
    without brackets, a decimal comma, a point without a digit before or behind it.
    """
    shown = text.split("\n")[line - 1].strip()
    if not 0 < len(shown) <= _LONGEST_LINE or not shown.isprintable():
        return ""
    assigned = re.fullmatch(r"([\w.-]+)\s*=\s*([^#]+?)\s*(?:#.*)?", shown)
    if assigned is None:
        return f": {shown}"
    key, value = assigned.groups()
    hint = next((f": {hint}" for pattern, hint in _HINTS if re.fullmatch(pattern, value)), "")
    in_inches = re.sub("''|[\"″]", " in", value)
    listed = value.replace("-", " ") if re.fullmatch(_DASHED, value) else value
    numbers = ", ".join(re.findall(_NUMBER, listed))
    whole = re.sub(_NO_DIGIT_BEHIND, ".0", re.sub(_NO_DIGIT_BEFORE, "0.", value))
    remedy = hint.format(key=key, value=in_inches, numbers=numbers, whole=whole)
    return f": {key} = {value}{remedy}"
