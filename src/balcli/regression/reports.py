"""Write the result of `balcli check` for continuous integration: annotations of GitHub, and reports
in JUnit's format.

Annotations follow the workflow commands of GitHub Actions: `::error file=…,line=…,title=…::text`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from ..errors import legible
from .records import CheckedEngine
from .show import (
    count_engines,
    describe_cause,
    describe_differences,
    describe_limit,
    find_cause,
    find_line,
    summarize,
)

# Characters with a meaning in annotations, and their spelling: of texts, and also of properties.
_IN_TEXT = str.maketrans({"%": "%25", "\r": "%0D", "\n": "%0A"})
_IN_PROPERTIES = _IN_TEXT | str.maketrans({":": "%3A", ",": "%2C"})
_NOT_IN_XML = "[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]"


# ------------------------------------------------------------------ GitHub
def list_annotations(checked: Sequence[CheckedEngine]) -> Iterator[str]:
    """Yield an annotation for each cause, limit and mistake of each engine, then the counts."""
    for file in checked:
        for mistake in file.mistakes:
            text = f"{mistake.key}: {mistake.message}" if mistake.key else mistake.message
            yield _annotate(file.engine, mistake.line, "mistake in the engine file", text)
        if file.error is not None and not file.mistakes:
            yield _annotate(file.engine, None, "engine file not read", file.error)
        if file.differences:
            text = "\n".join([describe_cause(find_cause(file)), *summarize(file)])
            yield _annotate(file.engine, find_line(file), "not as recorded", text)
        for broken in file.broken_limits:
            yield _annotate(file.engine, broken.line, "limit exceeded", describe_limit(broken))
    yield count_engines(checked)


def _annotate(file: str, line: int | None, title: str, text: str) -> str:
    """Return an annotation of GitHub.

    Args:
        file: Path of the file.
        line: Line in the file; None: not known.
        title: Title.
        text: Text; line ends are kept.
    """
    properties = {"file": file, "line": line, "title": title}
    listed = [
        f"{name}={legible(str(value)).translate(_IN_PROPERTIES)}"
        for name, value in properties.items()
        if value is not None
    ]
    return f"::error {','.join(listed)}::{legible(text).translate(_IN_TEXT)}"


# ------------------------------------------------------------------ JUnit
def write_junit(checked: Sequence[CheckedEngine]) -> str:
    """Return an XML report in JUnit's format, with a test case for each engine."""
    failed = [each for each in checked if each.differences or each.broken_limits]
    suite = Element("testsuite", name="balcli check", tests=str(len(checked)))
    suite.set("failures", str(len(failed)))
    suite.set("errors", str(sum(each.error is not None for each in checked)))
    for file in checked:
        case = SubElement(suite, "testcase", classname="balcli", name=_clean(file.engine))
        if file.error is not None:
            first_line = file.error.partition("\n")[0]
            SubElement(case, "error", message=_clean(first_line)).text = _clean(file.error)
        lines = _list_failures(file)
        if lines:
            SubElement(case, "failure", message=_clean(lines[0])).text = _clean("\n".join(lines))
    indent(suite)
    return tostring(suite, encoding="utf-8", xml_declaration=True).decode()


def _list_failures(checked: CheckedEngine) -> list[str]:
    """Return the cause of an engine's differences, all changed figures, and broken limits."""
    lines: list[str] = []
    if checked.differences:
        lines.append(describe_cause(find_cause(checked)))
        lines += describe_differences(checked)
    return lines + [describe_limit(broken) for broken in checked.broken_limits]


def _clean(text: str) -> str:
    """Return a text with "?" in place of every character that XML or a terminal cannot hold."""
    return re.sub(_NOT_IN_XML, "?", legible(text))
