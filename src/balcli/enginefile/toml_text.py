"""A file of TOML, as it is read before anyone knows what it says: within limits, and whatever is
wrong becomes an error with the name of the file.
"""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path
from typing import Any

from ..errors import BalcliError, InputError, Problem
from ..limits import DEEPEST_KEY, LARGEST_FILE_BYTES, MOST_TOML_MARKS
from .fields import nearest

_KEY_PART = r"""(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+"""
_DEEP_KEY = re.compile(rf"""(?<![\w"'-])(?:{_KEY_PART}){{{DEEPEST_KEY}}}""")
_OTHER_KINDS = {
    b"PK\x03\x04": "a workbook or another packed file",
    b"\xd0\xcf\x11\xe0": "a workbook or document of an old kind",
    b"%PDF": "a PDF",
}
_MOST_DIGITS = 4300  # of a whole number that Python reads
_TOO_MANY_DIGITS = re.compile(rf"[0-9][0-9_]{{{_MOST_DIGITS},}}")


def read_bytes(source: str | Path) -> bytes:
    """The content of a file, or of standard input for "-", as far as it may be long.

    Raises:
        BalcliError: it cannot be read.
    """
    if not str(source):
        raise BalcliError('no file is named: ""')
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
    """The file or example that was probably meant, in words; empty if none comes to mind."""
    from .examples import is_example  # after a mistake alone

    with_ending, asked = f"{source}.toml", Path(source)
    if asked.suffix.lower() in (".svg", ".png", ".pdf"):
        return f"; balcli plot FILE {source} draws into it"
    if Path(with_ending).is_file():
        return f"; {with_ending} is there: did you mean it?"
    if asked.suffix in ("", ".toml") and is_example(asked.stem):
        return f"; {asked.stem} is an example: balcli engines {asked.stem} {asked.stem}.toml"
    beside = [file.name for file in asked.parent.glob("*.toml") if file.is_file()]
    is_toml = nearest(asked.suffix, [".toml"])  # not the .csv beside an engine file
    if is_toml and (near := nearest(asked.name, sorted(beside), cutoff=0.8)):
        return f"; {asked.with_name(near)} is there: did you mean it?"
    return ""


def name_file(source: str | Path) -> str:
    """What messages call a file; "-" is standard input."""
    return "standard input" if str(source) == "-" else str(source)


def parse_toml(text: str | bytes, file: str) -> dict[str, Any]:
    """TOML -> nested dicts; whatever tomllib raises becomes an InputError for this file."""
    if len(text) > LARGEST_FILE_BYTES:
        megabytes = LARGEST_FILE_BYTES // 1_000_000
        message = f"has more than {megabytes} MB; no engine file needs that"
        raise InputError([Problem("", message)], file)
    try:
        return _load_toml(text.decode("utf-8-sig") if isinstance(text, bytes) else text)
    except tomllib.TOMLDecodeError as error:
        message = f"is not valid TOML: {str(error)[:300]}{_explain(text, str(error))}"
    except OverflowError as error:
        message = str(error)
    except RecursionError:
        message = (
            "lists or tables are nested too deeply; an engine file needs no more than four levels"
        )
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        message = f"is not UTF-8 text (line {line}); save it as UTF-8"
        if kind := name_other_kind(error.object):
            message = f"is {kind}, no text; write TOML, as `balcli new` does"
    raise InputError([Problem("", message)], file)


def name_other_kind(content: bytes) -> str:
    """What a file is that people hand over for text, in words; empty if it is none of these."""
    kinds = (kind for start, kind in _OTHER_KINDS.items() if content.startswith(start))
    return next(kinds, "")


def _explain(text: str | bytes, error: str) -> str:
    """What is wrong with the line that an error of tomllib names, or else with the last."""
    from .toml_slips import explain  # after a mistake alone

    decoded = text.decode("utf-8-sig") if isinstance(text, bytes) else text
    place = re.search(r"\(at line (\d+), ", error)
    lines = decoded.split("\n")
    number = int(place[1]) if place else len(decoded.rstrip("\n").split("\n"))
    return explain(lines[number - 1])


def _load_toml(text: str) -> dict[str, Any]:
    """The text as nested dicts, unless tomllib would take too much memory for it.

    Raises:
        RecursionError: a key has too many parts.
        OverflowError: there are too many values.
    """
    if _DEEP_KEY.search(text):
        raise RecursionError
    if sum(map(text.count, "[{.,=")) > MOST_TOML_MARKS:
        raise OverflowError(
            f"has more than {MOST_TOML_MARKS} keys, lists and values; no engine file needs that"
        )
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except ValueError:  # too many digits: as many as can be are refused by the path of their key
        cut = _TOO_MANY_DIGITS.sub(lambda found: found[0][:_MOST_DIGITS].rstrip("_"), text)
        return tomllib.loads(cut)
