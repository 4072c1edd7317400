"""What is probably meant by a line that TOML does not understand."""

from __future__ import annotations

import re

_LONGEST_LINE = 80  # that is shown
_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)"
_DASHED = r"\d+(?:-\d+)+"  # a firing order, 1-3-4-2
# A key, =, and a value without quotes that may be ... The first that fits tells what is meant.
_HINTS = (
    (rf"{_NUMBER},\d+", "write a decimal point, not a comma"),
    (
        rf"{_NUMBER}(?:[\s,;]+{_NUMBER})+|{_DASHED}|\[[^\[\]]*\d\s*[\s;]\s*[-+.\d][^\[\]]*\]",
        "a list stands in brackets, with commas: {key} = [{numbers}]",
    ),
    (
        rf"{_NUMBER}(?:/\d+)?\s*[A-Za-z°%\"″'].*",
        'a value with a unit stands in quotes: {key} = "{value}"',
    ),
)


def explain(line: str) -> str:
    """Return the line, and what would be right where one of three slips is recognized: units
    without quotes, lists without brackets, a decimal comma.

    Args:
        line: as the file has it.
    """
    shown = line.strip()
    if not 0 < len(shown) <= _LONGEST_LINE or not shown.isprintable():
        return ""
    assigned = re.fullmatch(r"([\w.-]+)\s*=\s*([^#]+?)\s*(?:#.*)?", shown)
    if assigned is None:
        return f": {shown}"
    key, value = assigned.groups()
    hint = next((hint for pattern, hint in _HINTS if re.fullmatch(pattern, value)), "")
    unit = value.replace("''", " in").replace('"', " in").replace("″", " in")
    listed = value.replace("-", " ") if re.fullmatch(_DASHED, value) else value
    numbers = ", ".join(re.findall(_NUMBER, listed))
    told = hint.format(key=key, value=unit, numbers=numbers)
    return f": {key} = {value}" + (f": {told}" if told else "")
