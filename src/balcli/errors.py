"""Define the errors that a user can cause, the exit codes, and messages on standard error."""

from __future__ import annotations

import math
import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from enum import IntEnum
from functools import partial
from itertools import islice
from numbers import Real
from os import PathLike
from typing import Any, NamedTuple, Self, TextIO, TypeVar

from .limits import MOST_LIST_VALUES

T = TypeVar("T")

# All control characters except tab and line feed. The Unicode ones reverse the direction of text,
# or end a line or paragraph.
CONTROL_CHARACTERS = (
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028\u2029\u202a-\u202e\u2066-\u2069]"
)


def legible(text: str) -> str:
    """Return a text with "?" in place of every control character except line ends and tabs, so that
    no file name can control the terminal.
    """
    return re.sub(CONTROL_CHARACTERS, "?", text)


def say(text: str) -> None:
    """Print a message on standard error; if standard error is closed, do nothing."""
    with suppress(OSError):
        print(legible(text), file=sys.stderr, flush=True)


def say_error(text: str) -> None:
    """Print a message on standard error that begins with the name of the program; on a terminal,
    the name is red.
    """
    name = "\x1b[31mbalcli:\x1b[0m" if is_coloured(sys.stderr) else "balcli:"
    with suppress(OSError):
        print(name, legible(text), file=sys.stderr, flush=True)


def is_coloured(stream: TextIO | None) -> bool:
    """Return whether a stream is a terminal whose user does not refuse colours."""
    refused = os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb"
    return stream is not None and stream.isatty() and not refused


class Loudness(IntEnum):
    """How much balcli prints in addition to results and errors."""

    QUIET = 0  # nothing
    USUAL = 1  # warnings; on a terminal, the progress of a long computation
    VERBOSE = 2  # also notes on files, assumed values and run time


_loudness = Loudness.USUAL


def set_loudness(loudness: Loudness) -> None:
    """Set how much is printed in the rest of this process."""
    global _loudness
    _loudness = loudness


def is_quiet() -> bool:
    """Return whether the user wants neither warnings nor progress."""
    return _loudness == Loudness.QUIET


def is_verbose() -> bool:
    """Return whether the user wants notes."""
    return _loudness == Loudness.VERBOSE


def warn(text: str) -> None:
    """Print a warning on standard error, unless balcli is quiet."""
    if not is_quiet():
        say(f"warning: {text}")


def note(text: str) -> None:
    """Print a note (what was read, assumed or tried) on standard error, if balcli is verbose."""
    if is_verbose():
        say(f"note: {text}")


class Exit(IntEnum):
    """Exit statuses of every command."""

    DONE = 0
    DIFFERENCE = 1
    BAD_INPUT = 2
    INTERNAL = 70  # a fault of balcli
    INTERRUPTED = 130


class Problem(NamedTuple):
    """One mistake.

    Attributes:
        path: Place in the file (`rod.length`, `shaft.2.ratio`); empty for the file as a whole.
        message: The mistake, then the remedy.
        missing: Paths of the missing keys that cause the mistake.
        meant: For an unknown key, the path of the key that was probably meant, "" if no key is
            similar; None if the key is known.
        line: Line in the file, for mistakes in the syntax; None if it is not known.
    """

    path: str
    message: str
    missing: tuple[str, ...] = ()
    meant: str | None = None
    line: int | None = None

    @classmethod
    def of_missing(cls, path: str, hint: str) -> Problem:
        """Return the problem of a missing key.

        Args:
            path: Dotted name of the key.
            hint: Reason why the key is needed, or an example of a value.
        """
        return cls(path, f"is missing; {hint}", (path,))

    def __str__(self) -> str:
        return self.tell(str)

    def tell(self, name_argument: NameArgument) -> str:
        """Return path and message, with the names that `name_argument` returns for arguments."""
        message = tell(self.message, name_argument)
        return f"{self.path}: {message}" if self.path else message


# ------------------------------------------------------------------ texts that name arguments
NameArgument = Callable[[str], str]  # returns how an argument is shown: --damper-at for damper_at


def name_option(argument: str) -> str:
    """Return the option of a command for an argument: `--damper-at` for `damper_at`. As usual in
    Python, an argument whose name would be a keyword ends with an underscore: `lambda_`.
    """
    return f"--{argument.rstrip('_').replace('_', '-')}"


class Message(str):
    """A text that names arguments. As a string, it has their names in Python: `damper_at`; a
    command prints the names of its options (`tell`): `--damper-at`.

    Args:
        text: Text with fields in braces. A field whose name is none of `values` is the name of an
            argument.
        values: Values of the other fields. Braces in them have no effect. Messages and errors
            among them are told like the text itself.

    Example:
        >>> str(Message("{damper_at} {node!r}: choose from {nodes}", node="hub", nodes="a, b"))
        "damper_at 'hub': choose from a, b"
    """

    text: str
    values: dict[str, object]

    def __new__(cls, text: str, /, **values: object) -> Self:
        message = super().__new__(cls, _fill(text, values, str))
        message.text = text
        message.values = values
        return message

    def __getnewargs_ex__(self) -> tuple[tuple[str], dict[str, Any]]:  # for pickle and copy
        return (self.text,), self.values

    def tell(self, name_argument: NameArgument) -> str:
        """Return the text with the names that `name_argument` returns for arguments."""
        return _fill(self.text, self.values, name_argument)


class Argument(Message):
    """Name of an argument, as a value of a message."""

    def __new__(cls, name: str) -> Self:
        return super().__new__(cls, f"{{{name}}}")

    def __getnewargs_ex__(self) -> tuple[tuple[str], dict[str, Any]]:
        return (str(self),), {}


def join_messages(messages: Sequence[Message]) -> Message:
    """Return one message with commas between the given ones."""
    joined, *others = messages
    for other in others:
        joined = Message("{joined}, {other}", joined=joined, other=other)
    return joined


def tell(text: str, name_argument: NameArgument) -> str:
    """Return a text; if it is a `Message`, with the names that `name_argument` returns."""
    return text.tell(name_argument) if isinstance(text, Message) else text


class _Fields(dict[str, object]):
    """Values of the fields of a text; a field without a value is an argument."""

    name_argument: NameArgument

    def __missing__(self, name: str) -> str:
        return self.name_argument(name)


def _fill(text: str, values: dict[str, object], name_argument: NameArgument) -> str:
    """Return a text with its fields filled; see `Message`."""
    fields = _Fields(values)
    fields.name_argument = name_argument
    for name, value in values.items():
        if isinstance(value, (Message, BalcliError)):
            fields[name] = value.tell(name_argument)
    return text.format_map(fields)


# ------------------------------------------------------------------ errors
class BalcliError(Exception):
    """A mistake that the user can correct; `cli.py` prints its text and exits with status 2."""

    def tell(self, name_argument: NameArgument) -> str:
        """Return the text, with the names that `name_argument` returns for arguments."""
        return str(self)

    def within(self, name: str) -> BalcliError:
        """Return the error with a name in front of its text, such as that of an engine; the error
        itself if the name is empty.
        """
        return BalcliError(f"{name}: {self}") if name else self


class ArgumentError(BalcliError):
    """A wrong argument of a function, or a wrong option of a command.

    Args:
        text: Text that names arguments in braces; see `Message`.
        values: Values of the other fields of the text.

    Example:
        >>> raise ArgumentError("{factor} {value:g}: leave {hammer_blow} out", value=0.5)
    """

    def __init__(self, text: str, /, **values: object) -> None:
        self.message = Message(text, **values)
        super().__init__(self.message)

    def __reduce__(self) -> tuple[Callable[[], ArgumentError], tuple[()]]:  # for pickle and copy
        return partial(type(self), self.message.text, **self.message.values), ()

    def tell(self, name_argument: NameArgument) -> str:
        return self.message.tell(name_argument)

    def within(self, name: str) -> ArgumentError:
        if not name:
            return self
        return ArgumentError("{name}: {error}", name=name, error=self.message)


def tell_unwritable(target: str | PathLike[str], error: OSError) -> BalcliError:
    """Return the error for a file that cannot be written; it says if the folder is missing.

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
    """All mistakes of one input file; `more` is the number of mistakes that are not listed."""

    def __init__(self, problems: Iterable[Problem], file: str = "", more: int = 0) -> None:
        self.problems = tuple(problems)
        self.file = file
        self.more = more
        super().__init__(file, self.problems, more)

    def __str__(self) -> str:
        return self.tell(str)

    def tell(self, name_argument: NameArgument) -> str:
        head = self.file or "engine"
        problems = [problem.tell(name_argument) for problem in self.problems]
        if len(problems) == 1:
            return f"{head}: {problems[0]}"
        last = [f"  and {self.more} more"] if self.more else []
        count = len(problems) + self.more
        return "\n".join([f"{head}: {count} mistakes", *(f"  {p}" for p in problems), *last])

    def within(self, name: str) -> InputError:
        names = [part for part in (name, self.file) if part]
        return type(self)(self.problems, ": ".join(names), self.more)


class NotComputedError(BalcliError, AttributeError):
    """An attribute of a result that was not asked for; the text says how to ask for it."""


class OtherKindError(InputError):
    """A file of one kind where another kind is needed."""


@contextmanager
def naming_file(file: str) -> Iterator[None]:
    """Add the name of a file to the mistakes that are found within this context."""
    try:
        yield
    except InputError as error:
        raise type(error)(error.problems, file, error.more) from None


def check_type(function: str, value: object, kind: type | tuple[type, ...], wanted: str) -> None:
    """Raise an error if an argument of a public function has a wrong type.

    Args:
        function: Name of the function or argument.
        value: Value to check.
        kind: Allowed types.
        wanted: Instruction for the message, such as "give words".

    Raises:
        TypeError: The value has another type.
    """
    if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
        raise wrong_type(function, value, wanted)


def check_number(name: str, value: object, wanted: str) -> float:
    """Return an argument of a public function as a float; an integer too large for a
    float becomes infinite.

    Args:
        name: Name of the argument.
        value: Value to check.
        wanted: Instruction for the message, such as "give a share".

    Raises:
        TypeError: The value is not a number.
    """
    check_type(name, value, Real, wanted)
    try:
        return float(value)  # type: ignore[arg-type]
    except OverflowError:
        return math.inf


def refuse_more(name: str, values: object, most: int) -> None:
    """Raise an error if a list, range or array has more than `most` values. In a list of lists,
    the first inner list is checked as well. Nothing is copied.

    Args:
        name: Name of the argument.
        values: Value of the argument; a value without a length passes.
        most: Largest number of values.

    Raises:
        BalcliError: There are more than `most` values.
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
    """Return an iterable argument as a list; reading ends after `most` + 1 values.

    Raises:
        BalcliError: There are more than `most` values.
    """
    refuse_more(name, values, most)
    listed = list(islice(values, most + 1))
    refuse_more(name, listed, most)
    return listed


def list_words(
    name: str, words: str | Iterable[str], example: str = '["force", "moment"]'
) -> list[str]:
    """Return an argument (a list of words, or words with commas between them) as a list.

    Args:
        name: Name of the argument.
        words: Value to check.
        example: A valid value, as a user types it.

    Raises:
        TypeError: A member is not a word.
    """
    if isinstance(words, str):
        return [word.strip() for word in words.split(",")]
    check_type(name, words, Iterable, f"give words, such as {example}")
    listed = list_values(name, words)
    for word in listed:
        check_type(name, word, str, f"give words, such as {example}")
    return listed


def wrong_type(function: str, value: object, wanted: str) -> TypeError:
    """Return the error for an argument of a wrong type; its text has the value and `wanted`.

    Args:
        function: Name of the function or argument.
        value: Rejected value.
        wanted: Instruction for the message, such as "give words".
    """
    try:
        text = repr(value)
    except ValueError:  # Python refuses to write such long numbers
        text = "a number of thousands of digits"
    shown = text if len(text) <= 60 and "\n" not in text else f"{text[:57].splitlines()[0]}..."
    return TypeError(f"{function}: {legible(shown)} ({type(value).__name__}): {wanted}")


# Messages for results that need more than the file gives.
NO_GAS = (
    'has no [gas]; give a diagram, a cycle or harmonics, such as cycle = "wiebe", '
    "compression_ratio = 10.5, imep = 10"
)
MOMENTS_UNKNOWN = (
    "moments are not known, because crank.spacing is missing: give it (or crank.positions); 0 "
    "means that all throws are in one plane"
)
