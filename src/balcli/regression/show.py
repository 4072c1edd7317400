"""Show the result of `balcli check` as lines.

Lines are grouped by cause: a set of changed inputs, or another reason why figures changed. A cause
takes at most three lines, however many figures and engines it changes: the cause, the figures that
follow from it, and the figure that changed most.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from ..file.fields import counted, printable, shorten
from ..show.sheet import given
from ..version import __version__
from .records import BrokenLimit, ChangedInput, CheckedEngine, Difference, Fault, Mistake

_MOST_NAMED = 3  # number of inputs, or of engines with one cause, that a line names
_LEAST_DIGITS = 4  # significant digits of a changed figure
_MOST_DIGITS = 17  # with these, any two different numbers differ
_COMPONENTS = ("x", "y", "cos", "sin")  # last keys of figures that are parts of a vector's size
_MOST_PERCENT = 1000  # larger changes are not written in percent


# ------------------------------------------------------------------ words for one fact
def describe_input(changed: ChangedInput) -> str:
    """Return a changed input in words: `crank.stroke: 86 -> 88 mm`."""
    key = printable(changed.key)
    before = changed.recorded
    after = changed.now
    if _is_file(before) and _is_file(after) and before["file"] == after["file"]:
        return f'{key}: the content of "{after["file"]}" changed'
    unit_before = changed.unit if after is None else ""
    values = f"{_write_input(before, unit_before)} -> {_write_input(after, changed.unit)}"
    return f"{key}: {values}"


def _is_file(value: object) -> bool:
    return isinstance(value, dict) and "file" in value


def _write_input(value: Any, unit: str = "") -> str:
    if value is None:
        return "left out"
    return _with_unit(shorten(value["file"] if _is_file(value) else value), unit)


def _with_unit(text: str, unit: str) -> str:
    return f"{text} {unit}" if unit else text


def describe_difference(difference: Difference) -> str:
    """Return a changed figure in words: `order 2 force major: 9817 -> 10052 N (+2.4 %)`."""
    if difference.cause is None:
        return difference.figure
    before = difference.recorded
    after = difference.now
    if not (isinstance(before, float) and isinstance(after, float)):
        values = f"{_write_value(before)} -> {_write_value(after)}"
        return _with_unit(f"{difference.figure}: {values}", difference.unit)
    values = _write_numbers(before, after)
    text = _with_unit(f"{difference.figure}: {values}", difference.unit)
    if difference.share is None or before == 0:
        return text
    percent = 100 * (after - before) / abs(before)
    return f"{text} ({percent:+.2g} %)" if abs(percent) < _MOST_PERCENT else text


def _write_numbers(before: float, after: float) -> str:
    """Return two different numbers, with enough digits to tell them apart."""
    for digits in range(_LEAST_DIGITS, _MOST_DIGITS + 1):
        texts = given(before, digits), given(after, digits)
        if texts[0] != texts[1]:
            break
    return " -> ".join(texts)


def _write_value(value: object) -> str:
    if value is None:
        return "none"
    return given(value) if isinstance(value, float) else shorten(value)


def describe_limit(broken: BrokenLimit) -> str:
    """Return a quantity and the limit that it breaks: `moment.1.major is 523 N·m; limit: below 500
    N·m`.
    """
    limits = []
    if broken.above is not None:
        limits.append(f"above {given(broken.above)}")
    if broken.below is not None:
        limits.append(f"below {given(broken.below)}")
    wanted = _with_unit(" and ".join(limits), broken.unit)
    if broken.value is None:
        return f"{broken.quantity} has no value; limit: {wanted}"
    value = _with_unit(given(broken.value), broken.unit)
    return f"{broken.quantity} is {value}; limit: {wanted}"


def describe_mistakes(engine: str, mistakes: Sequence[Mistake], more: int) -> str:
    """Return the mistakes of an engine file in words.

    Args:
        engine: Path of the file.
        mistakes: Mistakes with their lines.
        more: Number of further mistakes.
    """
    texts = [f"{each.key}: {each.message}" if each.key else each.message for each in mistakes]
    if len(mistakes) == 1:
        return f"{_place(engine, mistakes[0].line)}: {texts[0]}"
    lines = [f"{engine}: {len(mistakes) + more} mistakes"]
    for each, text in zip(mistakes, texts, strict=True):
        lines.append(f"  {text}" if each.line is None else f"  line {each.line}: {text}")
    if more:
        lines.append(f"  and {more} more")
    return "\n".join(lines)


def _place(engine: str, line: int | None) -> str:
    """Return the path of an engine file, with a line if it is known: `i4.toml:6`."""
    return engine if line is None else f"{engine}:{line}"


# ------------------------------------------------------------------ causes
class Cause(NamedTuple):
    """Why figures of an engine differ from its record.

    Attributes:
        fault: Why the engine could not be compared; None if it was compared.
        reason: Reason in words if it could not be compared, and only for faults of one record.
        inputs: Changed inputs, without their lines; None if the record has no inputs.
        recorded_with: Version of balcli that made the record, if no input changed.
    """

    fault: Fault | None = None
    reason: str = ""
    inputs: tuple[ChangedInput, ...] | None = None
    recorded_with: str | None = None


def find_cause(checked: CheckedEngine) -> Cause:
    """Return the cause of the differences of an engine."""
    if checked.fault is Fault.MISSING:
        return Cause(checked.fault)
    if checked.fault is not None:
        return Cause(checked.fault, checked.differences[0].figure)
    if not checked.changed_inputs:
        return Cause(inputs=checked.changed_inputs, recorded_with=checked.recorded_with)
    return Cause(inputs=tuple(each._replace(line=None) for each in checked.changed_inputs))


def describe_cause(cause: Cause) -> str:
    """Return a cause in words."""
    if cause.fault is Fault.MISSING:
        return "no result is recorded; check --update records it"
    if cause.fault is not None:
        return cause.reason
    if cause.inputs is None:
        return "figures changed; the record has no inputs that could tell why (check --update)"
    if not cause.inputs:
        return f"no input changed, but figures did: {_suspect(cause.recorded_with)}"
    listed = "; ".join(map(describe_input, cause.inputs[:_MOST_NAMED]))
    further = len(cause.inputs) - _MOST_NAMED
    return f"{listed}; and {further} more" if further > 0 else listed


def _suspect(recorded_with: str | None) -> str:
    """Return what may have changed figures if no input changed."""
    if recorded_with is None or recorded_with == __version__:
        return "was the record edited?"
    return f"recorded with balcli {printable(recorded_with)}, this is {__version__}"


def find_line(checked: CheckedEngine) -> int | None:
    """Return the line of the first changed input of an engine."""
    lines = [each.line for each in checked.changed_inputs or () if each.line is not None]
    return lines[0] if lines else None


def _locate(checked: CheckedEngine) -> str:
    """Return the file of an engine, with the line of the first changed input."""
    return _place(checked.engine, find_line(checked))


# ------------------------------------------------------------------ lines
def list_lines(checked: Sequence[CheckedEngine], *, every_figure: bool = False) -> Iterator[str]:
    """Yield the lines about causes, then those about broken limits.

    Args:
        checked: Engines.
        every_figure: Whether to list each engine alone, with every figure that changed.
    """
    different = [each for each in checked if each.differences]
    if every_figure:
        for file in different:
            yield f"{_locate(file)}: {describe_cause(find_cause(file))}"
            yield from (f"  {line}" for line in describe_differences(file))
    else:
        for cause, engines in _group(different):
            yield from _list_cause(cause, engines)
    for file in checked:
        for broken in file.broken_limits:
            yield f"{_place(file.engine, broken.line)}: {describe_limit(broken)}"


def describe_differences(checked: CheckedEngine) -> list[str]:
    """Return a line for each changed figure of an engine that was compared."""
    return [describe_difference(each) for each in checked.differences if checked.fault is None]


def _group(engines: Iterable[CheckedEngine]) -> list[tuple[Cause, list[CheckedEngine]]]:
    """Return the different causes, each with its engines."""
    groups: list[tuple[Cause, list[CheckedEngine]]] = []
    for engine in engines:
        cause = find_cause(engine)
        for other, members in groups:
            if other == cause:
                members.append(engine)
                break
        else:
            groups.append((cause, [engine]))
    return groups


def _list_cause(cause: Cause, engines: Sequence[CheckedEngine]) -> Iterator[str]:
    """Yield at most three lines about a cause."""
    text = describe_cause(cause)
    if len(engines) == 1:
        yield f"{_locate(engines[0])}: {text}"
        yield from (f"  {line}" for line in summarize(engines[0]))
        return
    named = ", ".join(map(_locate, engines[:_MOST_NAMED]))
    further = len(engines) - _MOST_NAMED
    names = f"{named} and {further} more" if further > 0 else named
    yield f"{text}, in {counted(len(engines), 'engine')}"
    if cause.fault is not None:
        yield f"  {names}"
        return
    every = [difference for engine in engines for difference in engine.differences]
    yield f"  {names}: {_count(every)}"
    worst = max(engines, key=_rank_largest)  # the first of several
    yield f"  most: {worst.engine}: {describe_difference(_find_largest(worst))}"


def _find_largest(checked: CheckedEngine) -> Difference:
    """Return the largest difference of an engine; the first of several."""
    return max(checked.differences, key=_rank)


def _rank_largest(checked: CheckedEngine) -> tuple[bool, float]:
    return _rank(_find_largest(checked))


def summarize(checked: CheckedEngine) -> list[str]:
    """Return up to two lines about the changed figures of an engine."""
    if checked.fault is not None:
        return []
    most = _find_largest(checked)
    if len(checked.differences) == 1:
        return [describe_difference(most)]
    return [_count(checked.differences), f"most: {describe_difference(most)}"]


def _count(differences: Sequence[Difference]) -> str:
    """Return the number of changed figures, and their quantities."""
    quantities = dict.fromkeys(each.cause for each in differences if each.cause is not None)
    return f"{counted(len(differences), 'figure')} of {', '.join(quantities)}"


def _rank(difference: Difference) -> tuple[bool, float]:
    """Return the key by which the figure with the largest change is found. Sizes come before the
    components of vectors, and both before angles and texts.
    """
    if difference.share is None:
        return False, -1.0
    return difference.path[-1] not in _COMPONENTS, difference.share


def count_engines(checked: Sequence[CheckedEngine]) -> str:
    """Return the last line of a check: how many engines are as recorded, and how many are not."""
    engines = _list_read(checked)
    changed = [each for each in engines if each.differences]
    missing = sum(each.fault is Fault.MISSING for each in changed)
    total = counted(len(engines), "engine")
    others = {
        "changed": len(changed) - missing,
        "without a record": missing,
        **_count_troubles(checked),
    }
    if not any(others.values()):
        return f"{total}, all as recorded" if len(engines) > 1 else f"{total}, as recorded"
    counts = {"as recorded": len(engines) - len(changed)} | others
    advice = "; check --update records what is wanted" if others["changed"] else ""
    return f"{total}: {_join_counts(counts)}{advice}"


def count_recorded(checked: Sequence[CheckedEngine]) -> str:
    """Return the last line of `check --update`: how many records were written."""
    engines = _list_read(checked)
    written = sum(each.written for each in engines)
    others = {"as recorded before": len(engines) - written, **_count_troubles(checked)}
    listed = _join_counts(others)
    first = f"{counted(written, 'engine')} recorded"
    return f"{first}, {listed}" if listed else first


def _list_read(checked: Sequence[CheckedEngine]) -> list[CheckedEngine]:
    """Return the engines whose files could be read, with or without a record."""
    return [each for each in checked if each.error is None and each.fault != Fault.ABANDONED]


def _count_troubles(checked: Sequence[CheckedEngine]) -> dict[str, int]:
    return {
        "beyond a limit": sum(bool(each.broken_limits) for each in checked),
        "without an engine file": sum(each.fault is Fault.ABANDONED for each in checked),
        "not read": sum(each.error is not None for each in checked),
    }


def _join_counts(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{count} {state}" for state, count in counts.items() if count)
