"""Keys of a table of which only some may be given together."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Iterator
from typing import NamedTuple


class Choice(NamedTuple):
    """Groups of keys that exclude each other."""

    groups: tuple[tuple[str, ...], ...]
    required: bool = False  # one group must be given
    complete: bool = False  # a group that is begun must be finished

    def mistakes(self, given: Collection[str]) -> Iterator[str]:
        """What is wrong with these keys, in words that a table's name can stand before."""
        begun = [(group, [key for key in group if key in given]) for group in self.groups]
        chosen = [(group, keys) for group, keys in begun if keys]
        if len(chosen) > 1:
            yield f"has {words([key for _, keys in chosen for key in keys])}; {self._wanted()}"
        elif not chosen and self.required:
            yield f"has neither {' nor '.join(map(words, self.groups))}; {self._wanted()}"
        elif chosen and self.complete and len(chosen[0][1]) < len(chosen[0][0]):
            group, keys = chosen[0]
            yield (
                f"has {words(keys)} without {words([key for key in group if key not in keys])}; "
                f"{self._wanted()}"
            )

    def _wanted(self) -> str:
        return f"give either {' or '.join(map(words, self.groups))}"


def words(keys: Collection[str]) -> str:
    """a, b and c"""
    *front, last = keys
    return f"{', '.join(front)} and {last}" if front else last


def repeated(numbers: Iterable[int]) -> str:
    """The numbers that occur more than once, in words (the first five); empty if none does."""
    twice = [str(number) for number, times in Counter(numbers).items() if times > 1]
    return words(twice[:5]) if twice else ""
