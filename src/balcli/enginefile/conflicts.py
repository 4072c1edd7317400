"""What is wrong with a table that pydantic refuses: in its keys one by one, and what these say
against each other as far as the broken ones let it be said.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from pydantic import ValidationError

from ..errors import Problem
from .messages import join_path
from .model import FileTable

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails


class RefusedTable(NamedTuple):
    """A table that pydantic refuses.

    Attributes:
        findings: pydantic's, each in a key.
        broken: the keys that have some.
        draft: the table without these, with examples of those that have to be there; None where
            that is none, either.
        conflicts: what the keys, and the values of the others, say against each other.
    """

    findings: tuple[ErrorDetails, ...]
    broken: set[str]
    draft: FileTable | None
    conflicts: tuple[Problem, ...]


def examine_refused(
    path: str, table: type[FileTable], value: Mapping[str, Any], error: ValidationError
) -> RefusedTable:
    """What is wrong with the value of a table with this path, which pydantic refused so."""
    findings = [found for found in error.errors(include_url=False) if found["loc"]]
    broken = {str(finding["loc"][0]) for finding in findings}
    draft = _read_without(table, value, broken)
    conflicts = tuple(_find_conflicts(path, table, value, broken, draft))
    counted = tuple(finding for finding in findings if not _is_miscounted(finding))
    return RefusedTable(counted, broken, draft, conflicts)


def _is_miscounted(finding: ErrorDetails) -> bool:
    """Whether a list is called too short only because members of it, which have findings of their
    own, were not counted.
    """
    return finding["type"] == "too_short" and len(finding["input"]) >= finding["ctx"]["min_length"]


def _read_without(
    table: type[FileTable], value: Mapping[str, Any], broken: set[str]
) -> FileTable | None:
    """`RefusedTable.draft`."""
    known = {key: part for key, part in value.items() if key not in broken}
    needed = {key: field for key, field in table.keys().items() if field.is_required()}
    examples = {key: (field.examples or [None])[0] for key, field in needed.items()}
    try:
        draft = table.model_validate(examples | known, context=broken)
    except ValidationError:
        return None
    draft.model_fields_set.update(broken & value.keys())  # these are given, too
    return draft


def _find_conflicts(
    path: str,
    table: type[FileTable],
    value: Mapping[str, Any],
    broken: set[str],
    draft: FileTable | None,
) -> Iterator[Problem]:
    """`RefusedTable.conflicts`."""

    def tell(mistakes: Iterable[str], keys: Iterable[str]) -> Iterator[Problem]:
        missing = tuple(join_path(path, [key]) for key in keys if key not in value)
        return (Problem(path, mistake, missing) for mistake in mistakes)

    for choice in table.choices:
        yield from tell(choice.mistakes(value), choice.find_missing(value))
    for rule in table.rules if draft is not None else ():
        if rule.needs.isdisjoint(broken):
            yield from tell(rule.check(draft), {*rule.needs, *rule.wants})
