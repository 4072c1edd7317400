"""What the keys of a table say against each other, as far as its broken keys let it be said."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from pydantic import ValidationError

from ..errors import Problem
from .messages import join_path
from .model import FileTable


def read_without(
    table: type[FileTable], value: Mapping[str, Any], broken: set[str]
) -> FileTable | None:
    """The table without its broken keys, with examples of those that have to be there; None where
    that is none, either.
    """
    known = {key: part for key, part in value.items() if key not in broken}
    needed = {key: field for key, field in table.keys().items() if field.is_required()}
    examples = {key: (field.examples or [None])[0] for key, field in needed.items()}
    try:
        draft = table.model_validate(examples | known, context=broken)
    except ValidationError:
        return None
    draft.model_fields_set.update(broken & value.keys())  # these are given, too
    return draft


def find_conflicts(
    path: str,
    table: type[FileTable],
    value: Mapping[str, Any],
    broken: set[str],
    draft: FileTable | None,
) -> Iterator[Problem]:
    """What the keys of a table say against each other, and their values, as far as that can be said
    without the broken ones, which `draft` lacks.
    """

    def tell(mistakes: Iterable[str], keys: Iterable[str]) -> Iterator[Problem]:
        missing = tuple(join_path(path, [key]) for key in keys if key not in value)
        return (Problem(path, mistake, missing) for mistake in mistakes)

    for choice in table.choices:
        yield from tell(choice.mistakes(value), choice.find_missing(value))
    for rule in table.rules if draft is not None else ():
        if rule.needs.isdisjoint(broken):
            yield from tell(rule.check(draft), {*rule.needs, *rule.wants})
