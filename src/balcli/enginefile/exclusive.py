"""Keys of a table of which only some may be given together."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import NamedTuple


class Choice(NamedTuple):
    """Groups of keys that exclude each other.

    Attributes:
        groups: of these one may be given.
        required: one must be given.
        complete: a group that is begun must be finished: every one, or the one that is named.
    """

    groups: tuple[tuple[str, ...], ...]
    required: bool = False
    complete: bool | tuple[str, ...] = False

    def mistakes(self, given: Collection[str]) -> Iterator[str]:
        """Yield what is wrong with the given keys, in words that follow the name of the table."""
        begun = [[key for key in group if key in given] for group in self.groups]
        keys, missing = [key for some in begun for key in some], self.find_missing(given)
        if sum(map(bool, begun)) > 1:
            yield f"has {join_words(keys)}; {self._wanted()}"
        elif missing and not keys:
            yield f"has neither {' nor '.join(map(join_words, self.groups))}; {self._wanted()}"
        elif missing:
            yield f"has {join_words(keys)} without {join_words(missing)}; {self._wanted()}"

    def find_missing(self, given: Collection[str]) -> tuple[str, ...]:
        """Return missing keys of which one is needed, or all."""
        begun = [group for group in self.groups if any(key in given for key in group)]
        if not begun and self.required:
            return tuple(key for group in self.groups for key in group)
        if len(begun) == 1 and self.complete in (True, begun[0]):
            return tuple(key for key in begun[0] if key not in given)
        return ()

    def rivals(self, key: str) -> tuple[str, ...]:
        """Return the keys that exclude this one; none for a key of no group."""
        if not any(key in group for group in self.groups):
            return ()
        return tuple(other for group in self.groups if key not in group for other in group)

    def for_overrides(self, prefix: str) -> Choice:
        """Return this choice among keys with a prefix, none of which must be given."""
        return Choice(tuple(tuple(prefix + key for key in group) for group in self.groups))

    def _wanted(self) -> str:
        return f"give either {' or '.join(map(join_words, self.groups))}"


def join_words(words: Collection[str]) -> str:
    """Return words as a sentence lists them: `a, b and c`."""
    *front, last = words
    return f"{', '.join(front)} and {last}" if front else last
