"""The errors a user can cause, and the exit codes."""

from __future__ import annotations

import math
import os
import re
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from enum import IntEnum
from itertools import islice
from numbers import Real
from os import PathLike
from typing import NamedTuple, TypeVar

from .limits import MOST_LIST_VALUES

T = TypeVar("T")

# All but tabs and line ends; Unicode's own turn the direction of text, or end a paragraph.
CONTROL_CHARACTERS = (
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028\u2029\u202a-\u202e\u2066-\u2069]"
)


def legible(text: str) -> str:
    """Return a text for a terminal without control characters other than line ends and tabs, so
    that no file name can control the terminal.
    """
    return re.sub(CONTROL_CHARACTERS, "?", text)


def say(text: str) -> None:
    """Print a message on standard error, even if it has no reader."""
    with suppress(OSError):
        print(legible(text), file=sys.stderr, flush=True)


class Loudness(IntEnum):
    """How much balcli prints in addition to results and errors."""

    QUIET = 0  # nothing
    USUAL = 1  # warnings; on a terminal, how far a long computation is
    VERBOSE = 2  # also what was read and assumed, and how long it took


_loudness = Loudness.USUAL


def set_loudness(loudness: Loudness) -> None:
    """Set how much is printed in the rest of this process."""
    global _loudness
    _loudness = loudness


def is_quiet() -> bool:
    """Return whether warnings and progress are not wanted."""
    return _loudness == Loudness.QUIET


def is_verbose() -> bool:
    """Return whether notes are wanted."""
    return _loudness == Loudness.VERBOSE


def warn(text: str) -> None:
    """Print a warning on standard error, unless warnings are not wanted."""
    if not is_quiet():
        say(f"warning: {text}")


def note(text: str) -> None:
    """Print what was read, assumed or tried on standard error, if notes are wanted."""
    if is_verbose():
        say(f"note: {text}")


class Exit(IntEnum):
    """Exit statuses of every command."""

    DONE = 0
    DIFFERENCE = 1
    BAD_INPUT = 2
    INTERNAL = 70  # our fault; never 1
    INTERRUPTED = 130


class Problem(NamedTuple):
    """One mistake.

    Attributes:
        path: where in the file (`rod.length`, `shaft.2.ratio`; empty: the file).
        message: the mistake, and then the remedy.
        missing: paths of the missing keys that make it a mistake; empty: none.
        meant: path of the key that was probably meant by an unknown one, "" if none is near; None:
            the key is known.
    """

    path: str
    message: str
    missing: tuple[str, ...] = ()
    meant: str | None = None

    @classmethod
    def of_missing(cls, path: str, hint: str) -> Problem:
        """Return the problem of a missing key.

        Args:
            path: Dotted name of the key.
            hint: Why it is needed, or what to write.
        """
        return cls(path, f"is missing; {hint}", (path,))

    def __str__(self) -> str:
        return f"{self.path}: {self.message}" if self.path else self.message


class BalcliError(Exception):
    """A mistake that the user can correct; `cli.py` prints its text and exits with status 2."""


def tell_unwritable(target: str | PathLike[str], error: OSError) -> BalcliError:
    """Return the error of a file that cannot be written; it names a missing folder.

    Args:
        target: Path of the file.
        error: Error of the operating system.
    """
    folder = os.path.dirname(target)
    reason = error.strerror or str(error)
    if isinstance(error, FileNotFoundError) and folder and not os.path.exists(folder):
        reason = f"there is no folder {folder}"
    return BalcliError(f"{target}: cannot be written ({reason})")


class InputError(BalcliError):
    """All mistakes of one input file at once; `more` is the number of those not listed."""

    def __init__(self, problems: Iterable[Problem], file: str = "", more: int = 0) -> None:
        self.problems = tuple(problems)
        self.file = file
        self.more = more
        super().__init__(file, self.problems, more)

    def __str__(self) -> str:
        head = self.file or "engine"
        if len(self.problems) == 1:
            return f"{head}: {self.problems[0]}"
        last = [f"  and {self.more} more"] if self.more else []
        count = len(self.problems) + self.more
        return "\n".join([f"{head}: {count} mistakes", *(f"  {p}" for p in self.problems), *last])


class OtherKindError(InputError):
    """A file of one kind where another is wanted."""


@contextmanager
def naming_file(file: str) -> Iterator[None]:
    """Add the name of a file to the mistakes that are found within this context."""
    try:
        yield
    except InputError as error:
        raise type(error)(error.problems, file, error.more) from None


def check_type(function: str, value: object, kind: type | tuple[type, ...], wanted: str) -> None:
    """Raise an error if an argument of the library is not of this kind.

    Args:
        function: Name of the function or argument.
        value: Value to check.
        kind: Allowed types.
        wanted: A right value, in words.

    Raises:
        TypeError: It is not.
    """
    if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
        raise wrong_type(function, value, wanted)


def check_number(name: str, value: object, wanted: str) -> float:
    """Return an argument of the library as a number; hundreds of digits count as infinite.

    Args:
        name: Name of the argument.
        value: Value to check.
        wanted: A right value, in words.

    Raises:
        TypeError: It is no number.
    """
    check_type(name, value, Real, wanted)
    try:
        return float(value)  # type: ignore[arg-type]
    except OverflowError:
        return math.inf


def refuse_more(name: str, values: object, most: int) -> None:
    """Raise BalcliError if a list, a range or an array has more values than `most`, or the first
    member of a list has; none is copied.

    Args:
        name: Name of the argument.
        values: Argument; what has no length passes.
        most: Largest number of values.

    Raises:
        BalcliError: It has more.
    """
    size = getattr(values, "size", None)
    try:
        count = size if isinstance(size, int) else len(values)  # type: ignore[arg-type]
    except TypeError:
        return
    except OverflowError:  # a range longer than memory
        count = most + 1
    if count > most:
        raise BalcliError(f"{name}: has more than {most} values; give at most {most}")
    if count and isinstance(values, (list, tuple)):
        refuse_more(name, values[0], most)


def list_values(name: str, values: Iterable[T], most: int = MOST_LIST_VALUES) -> list[T]:
    """Return an argument of the library as a list, however many values it would yield.

    Raises:
        BalcliError: it has more than `most`.
    """
    refuse_more(name, values, most)
    listed = list(islice(values, most + 1))
    refuse_more(name, listed, most)
    return listed


def list_words(
    name: str, words: str | Iterable[str], example: str = '["force", "moment"]'
) -> list[str]:
    """Return an argument of the library, a list of words or a text with commas, as a list.

    Args:
        name: Name of the argument.
        words: Value to check.
        example: A right value, as it is typed.

    Raises:
        TypeError: They are no words.
    """
    if isinstance(words, str):
        return [word.strip() for word in words.split(",")]
    check_type(name, words, Iterable, f"give words, such as {example}")
    listed = list_values(name, words)
    for word in listed:
        check_type(name, word, str, f"give words, such as {example}")
    return listed


def wrong_type(function: str, value: object, wanted: str) -> TypeError:
    """Return the error for an argument of the library, with the value and a right one.

    Args:
        function: Name of the function or argument.
        value: Rejected value.
        wanted: A right value, in words.
    """
    try:
        text = repr(value)
    except ValueError:  # Python writes no number of thousands of digits
        text = "a number of thousands of digits"
    shown = text if len(text) <= 60 and "\n" not in text else f"{text[:57].splitlines()[0]}..."
    return TypeError(f"{function}: {legible(shown)} ({type(value).__name__}): {wanted}")


# What a file lacks, for whoever asks for it.
NO_GAS = (
    'has no [gas]; give a diagram, a cycle or harmonics, such as cycle = "wiebe", '
    "compression_ratio = 10.5, imep = 10"
)
MOMENTS_UNKNOWN = (
    "moments are not known, because crank.spacing is missing: give it (or crank.positions); 0 says "
    "that all throws stand in one plane"
)
