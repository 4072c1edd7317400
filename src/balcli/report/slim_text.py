"""Make scripts and style sheets of a page shorter without another effect: no comments, and no
spaces and line breaks that only people need.

The scripts follow two rules, by which their parts are told apart without a parser: a division has
a space behind its slash, a regular expression has none; and a template within a template contains
no further one.
"""

from __future__ import annotations

import re

_STRING = r""""(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'"""
_INNER_TEMPLATE = r"`(?:\\.|[^`\\])*`"
_HOLE = rf"\$\{{(?:[^{{}}`]|{_INNER_TEMPLATE}|\{{[^{{}}`]*\}})*\}}"
_TEMPLATE = rf"`(?:\\.|{_HOLE}|[^`\\])*`"
_PATTERN = r"/(?![/* =])(?:\\.|\[(?:\\.|[^\]\\\n])*\]|[^/\\\[\n])+/[a-z]*"
_KEPT = re.compile(rf"(//[^\n]*)|{_STRING}|{_TEMPLATE}|{_PATTERN}")
_PLACE = "\0"  # where a string, template or regular expression stands
_GAPS = (  # what is replaced in a script whose strings are set aside, one after the other
    (re.compile(r"(?<=[;,{(\[=&|?:<>])\s+"), ""),  # the line goes on, or its statement is over
    (re.compile(r"\s+(?=[)\]},;?:&|=.<>])"), ""),
    (re.compile(r"\s*\n\s*"), "\n"),
    (re.compile(r"(?<![\w$+-]) +|(?<=[+-]) +(?![+-])"), ""),  # a - -b is no a--b
    (re.compile(r" +(?![\w$+-])|(?<![+-]) +(?=[+-])"), ""),
)


def slim_script(script: str) -> str:
    """Return a script (JavaScript) with fewer letters."""
    kept: list[str] = []

    def set_aside(found: re.Match[str]) -> str:
        if found[1]:  # a comment
            return ""
        kept.append(found[0])
        return _PLACE

    slim = _KEPT.sub(set_aside, script).strip()
    for gap, rest in _GAPS:
        slim = gap.sub(rest, slim)
    parts = iter(kept)
    return re.sub(_PLACE, lambda _: next(parts), slim)


def slim_style(style: str) -> str:
    """Return a style sheet (CSS) with fewer letters. Spaces stay where they mean something: between
    selectors and between values.
    """
    joined = " ".join(style.split())
    joined = re.sub(r" ?([{};,]) ?", r"\1", joined)
    return joined.replace(": ", ":").replace(";}", "}")
