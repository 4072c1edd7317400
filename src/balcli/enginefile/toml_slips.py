"""What people write where TOML wants something else, and what is meant."""

from __future__ import annotations

import re
import tomllib
import unicodedata
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress

_LONGEST_LINE = 80  # that is shown
_BARE = r"[+-]?\d+(?:\.\d+)?"  # a number as TOML writes one
# As people write one: .5, 5., 007, 1 000.
_NUMBER = r"[+-]?(?:\d{1,3}(?: \d{3})+\.?\d*|\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?"
_HEAD = r"\s*(\[\[?)\s*([\w.-]{1,60})\s*\]\]?\s*(?:#.*)?"  # of a table
_OPEN_HEAD = r"\s*(?:([\w.-]{1,40})\s*:|\[([\w.-]{1,40}))\s*(?:#.*)?"
_WITHOUT_EQUALS = r"\s*([\w.-]{1,40})\s*(?::=?|==)\s*([^:=#]{1,60}?)\s*(?:#.*)?"
_WITHOUT_QUOTES = r"[^#\"'\[\]{}]{1,60}?|\[[\d.+\s;,°-]{1,60}\]"
_WITH_INCH_MARK = r"[\d./ -]{1,30}(?:\"|'')"
_ASSIGNED = rf"\s*([\w.-]{{1,40}})\s*=\s*({_WITHOUT_QUOTES}|{_WITH_INCH_MARK})\s*(?:#.*)?"


def explain(line: str, error: str, above: Sequence[str] = ()) -> str:
    """A line that TOML does not understand, and what is meant, where that can be guessed, in words
    that follow tomllib's; empty where nothing can be said.

    Args:
        above: the lines before it.
    """
    if strange := _name_strange_letter(line, error):
        return strange
    head = re.fullmatch(_HEAD, line)
    if head and (told := _tell_other_brackets(head, above)):
        return told
    twice = re.match(r"\s*([\w.-]{1,60})\s*=", line)
    if twice and error.startswith("Cannot overwrite"):
        return f": {twice[1]} is given twice; write it once"
    if head and error.startswith("Cannot declare"):
        return f": [{head[2]}] stands twice; put all its keys below the first one"
    value = "" if head else line.rpartition("=")[2]
    if error.startswith("Unclosed array") and "]" not in value:
        return f": {'this list' if '[' in value else 'a list above'} has no ] at its end"
    over_lines = re.search(r"\{\s*(?:#.*)?$|,\s*\}", line)
    if error.startswith("Invalid initial character for a key part") and over_lines:
        return ": a table in braces stands on one line, without a comma at its end"
    if misfit := re.fullmatch(_WITHOUT_EQUALS, line):
        return f": a key and its value have = between them: {misfit[1]} = {misfit[2]}"
    if table := re.fullmatch(_OPEN_HEAD, line):
        return f": the head of a table stands in brackets: [{table[1] or table[2]}]"
    assigned = re.fullmatch(_ASSIGNED, line)
    if assigned is None or not assigned[2].strip() or not assigned[2].isprintable():
        shown = line.strip() if "(at line " in error else ""
        return f": {shown}" if shown.isprintable() and 0 < len(shown) <= _LONGEST_LINE else ""
    key, value = assigned[1], assigned[2]
    with suppress(tomllib.TOMLDecodeError):
        tomllib.loads(f"value = {value}")
        return ""  # it is something before it that is wrong
    hint = guess(key, value)
    return f": {key} = {value}: {hint}" if hint else f": {key} = {value}"


def _name_strange_letter(line: str, error: str) -> str:
    """The letter at which tomllib stops where a key or a head is wanted, if it is none of those
    that these have, such as a blank of another kind; else empty.
    """
    place = re.search(r"column (\d+)\)", error)
    if place is None or error.startswith(("Invalid value", "Unclosed array")):
        return ""
    before, letter = line[: int(place[1]) - 1], line[int(place[1]) - 1 :][:1]
    if "=" in before or not letter or letter in "\t\r" or " " <= letter <= "~":
        return ""
    if letter == "\0":
        return ": there are zero bytes, as in UTF-16; save it as UTF-8"
    name = unicodedata.name(letter, "")
    named = f" ({name})" if name else ""
    return f": keys have plain letters, not U+{ord(letter):04X}{named}"


def _tell_other_brackets(head: re.Match[str], above: Iterable[str]) -> str:
    """A head in single brackets after the same in double ones, or the other way round; empty if
    there is none.
    """
    brackets, name = head[1], head[2]
    other = "[" if brackets == "[[" else "[["
    heads = filter(None, (re.fullmatch(_HEAD, line) for line in above))
    if not any(one[1] == other and one[2] == name for one in heads):
        return ""
    return (
        f": {name} stands above in {'double' if other == '[[' else 'single'} brackets; what there "
        "may be several of has double ones each time, all else single ones, once"
    )


def guess(key: str, value: str) -> str:
    """What is meant by a value without quotes, or a list of such, that TOML does not take; empty
    where it could be anything.
    """
    found = ((re.fullmatch(pattern, value), tell) for pattern, tell in _SLIPS)
    return next((tell(key, match) for match, tell in found if match), "")


def _tell_number(key: str, match: re.Match[str]) -> str:
    """Blanks part the thousands of a number, unless it begins with 0; those of a list as well."""
    parts = match[0].split()
    if len(parts) > 1 and parts[0] == "0":
        return _tell_blanks(key, match)
    told = f"TOML writes this number {key} = {_write_number(match[0])}"
    thousands = len(parts) < 3 or any(part.startswith("0") for part in parts)
    return told if thousands else f"{told}, a list {key} = {_write_list(parts)}"


def _tell_blanks(key: str, match: re.Match[str]) -> str:
    listed = _write_list(match[0].split())
    return f"a list stands in brackets, with commas: {key} = {listed}"


def _tell_round_brackets(key: str, match: re.Match[str]) -> str:
    listed = _write_list(re.findall(_BARE, match[0]))
    return f"a list stands in square brackets: {key} = {listed}"


def _tell_fraction(key: str, match: re.Match[str]) -> str:
    sign, whole, above, below = match.groups()
    size = int(whole or 0) + int(above) / int(below)
    return f"TOML knows no fractions; write {key} = {sign.strip('+')}{size:.6g}"


def _tell_semicolons(key: str, match: re.Match[str]) -> str:
    listed = _write_list(re.findall(r"[^\s;,]+", match[0].strip("[]")))
    return f"commas stand between the values of a list: {key} = {listed}"


def _tell_degrees(key: str, match: re.Match[str]) -> str:
    return f"degrees are bare numbers: {key} = {match[0].replace('°', '')}"


def _tell_numbers(key: str, match: re.Match[str]) -> str:
    listed = _write_list(map(_write_number, re.findall(_NUMBER, match[0])))
    return f"TOML writes these numbers {key} = {listed}"


def _write_number(text: str) -> str:
    return f"{float(text.replace(' ', '')):.15g}"


def _write_list(numbers: Iterable[str]) -> str:
    return f"[{', '.join(numbers)}]"


# The first that the whole value is like tells what is meant.
_SLIPS: tuple[tuple[str, Callable[[str, re.Match[str]], str]], ...] = (
    (_NUMBER, _tell_number),
    (rf"{_BARE}(?:\s+{_BARE})+", _tell_blanks),
    (rf"\(\s*{_BARE}(?:[\s,;]+{_BARE})*\s*\)", _tell_round_brackets),
    (r"\[.*°.*\]", _tell_degrees),
    (
        r"[+-]?\d+,\d+",
        lambda key, match: (
            f"write a decimal point, not a comma; a list stands in brackets, such as [{match[0]}]"
        ),
    ),
    (
        r"[+-]?[\d.]+(\s*,\s*[+-]?[\d.]+)+,?",
        lambda key, match: f"a list stands in brackets: {key} = [{match[0]}]",
    ),
    (
        rf"({_BARE})\s*[;,]+",
        lambda key, match: f"nothing stands behind a value: {key} = {match[1]}",
    ),
    (
        r"(?:0|[1-9]\d*)(?:-(?:0|[1-9]\d*)){2,}",
        lambda key, match: f"a list stands in brackets: {key} = {_write_list(match[0].split('-'))}",
    ),
    (
        r"[\d.()\s/*+-]*\d[)\s]*[*+][\d.()\s/*+-]*",
        lambda key, match: f"TOML does not calculate; write {key} as one number",
    ),
    (
        "(?i)true|false|yes|no|on|off",
        lambda key, match: f"write {key} = true, or {key} = false",
    ),
    (
        r"(?i)[+-]?(?:nan|inf|infinity)|null|none|nil",
        lambda key, match: f"leave {key} out where it is not known",
    ),
    (r"([+-]?)(?:(\d{1,9})[ -])?(\d{1,9})\s*/\s*([1-9]\d{0,8})", _tell_fraction),
    (
        r"""(.*\d\.?)\s*(?:"|''|[″”])""",
        lambda key, match: f'inches are written {key} = "{match[1]} in"',
    ),
    (rf"[−–]({_BARE})", lambda key, match: f"a minus sign is a hyphen: {key} = -{match[1]}"),
    (
        rf"({_BARE})\s*(?://|/\*|[%;(]|--)\s*(.*[A-Za-z].*)",
        lambda key, match: (
            f"a comment begins with #: {key} = {match[1]}  # {match[2].strip('*/) ')}"
        ),
    ),
    (
        r"[+-]?[\d./]+\s*[A-Za-z°%].*",
        lambda key, match: f'a value with a unit stands in quotes: {key} = "{match[0]}"',
    ),
    (r"\[.*\d[\s;]+[\d.+-].*", _tell_semicolons),
    (rf"\[\s*{_NUMBER}(\s*,\s*{_NUMBER})*,?\s*\]", _tell_numbers),
    (
        "[“”„«»‘’](.+)[“”«»‘’]",
        lambda key, match: f'quotes are straight: {key} = "{match[1]}"',
    ),
    (r"[A-Za-z].*", lambda key, match: f'words stand in quotes: {key} = "{match[0]}"'),
)
