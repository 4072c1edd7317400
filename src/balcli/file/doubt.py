"""Define doubts: warnings of figures that are allowed but unlikely, and figures with their usual
ranges, from which doubts are made.
"""

import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from ..errors import NameArgument, tell
from .fields import WrittenFigure, printable


class Doubt(NamedTuple):
    """A warning: a figure of a file, or of a result, is allowed but unlikely.

    Attributes:
        path: Dotted name of the doubted key or table; empty if no single key is doubted.
        message: The figure, its usual range and a remedy, as words that follow the path.
        also: Further keys of which one may be wrong instead.
        file: Name of the file of the key, if an engine consists of several files.
    """

    path: str
    message: str
    also: tuple[str, ...] = ()
    file: str = ""

    def __str__(self) -> str:
        return self.tell(str)

    def tell(self, name_argument: NameArgument) -> str:
        """Return file, path and message, with the names that `name_argument` returns for arguments
        that the message names.
        """
        message = tell(self.message, name_argument)
        return ": ".join(filter(None, (self.file, self.path, message)))

    def concerns(self, number: str) -> bool:
        """Return whether a number of the file is one of the doubted keys, or belongs to one of
        them as the member of a list or a key of a table.

        Args:
            number: Dotted name of the number, such as `crank.throws.2`.
        """
        keys = filter(None, (self.path, *self.also))
        return any(f"{number}.".startswith(f"{key}.") for key in keys)


def name_files(of_files: Iterable[tuple[str, Iterable[Doubt]]]) -> tuple[Doubt, ...]:
    """Return the doubts about several files, with the names of the files. A doubt about a file that
    is named several times appears once.

    Args:
        of_files: Name of each file, and the doubts about it.
    """
    named = [doubt._replace(file=file) for file, doubts in of_files for doubt in doubts]
    return tuple(dict.fromkeys(named))


class Figure(NamedTuple):
    """A figure of a file and its usual range.

    Attributes:
        path: Dotted name of the key that gives the figure.
        value: Value of the figure.
        least: Lower end of the usual range.
        most: Upper end of the usual range.
        unit: Unit of value and range, with a space before it; empty for a plain number.
        hint: Text about the probable mistake.
        subject: Name of the figure with a verb, such as "the mean piston speed is", if the figure
            is not the value of the key itself.
        also: Further keys on which the figure depends.
        digits: Number of digits of the value that are shown.
        basis: Figure of the file on which the usual range depends, such as "a bore of 75 mm".
    """

    path: str
    value: float
    least: float
    most: float
    unit: str
    hint: str
    subject: str = ""
    also: tuple[str, ...] = ()
    digits: int = 4
    basis: str = ""


def walk_figures(path: str, tables: Any) -> Iterator[tuple[str, Any, Any]]:
    """Yield path, key and value of each figure or text in tables, and in the tables and lists
    within them. Members of lists count from 1 in paths, and have their number as key.

    Args:
        path: Path of the tables; empty: they are a whole file.
        tables: Result of `plain_tables.list_tables`; None: there are no tables.
    """
    parts = tables.items() if isinstance(tables, dict) else enumerate(tables or (), 1)
    for key, value in parts:
        place = f"{path}.{key}".removeprefix(".")
        if isinstance(value, (dict, list)):
            yield from walk_figures(place, value)
        else:
            yield place, key, value


def doubt_figures(figures: Iterable[Figure]) -> Iterator[Doubt]:
    """Yield a warning for each figure outside its usual range."""
    for figure in figures:
        value = figure.value
        if figure.least <= value <= figure.most:
            continue
        written = f' ("{printable(value.text)}")' if isinstance(value, WrittenFigure) else ""
        shown = f"{float(f'{value:.{figure.digits}g}'):.12g}"
        said = f"{figure.subject} {shown}{figure.unit}{written}".lstrip()
        usual = f"{_tell_range(figure)} is usual"
        if figure.basis:
            usual = f"{usual} with {figure.basis}"
        yield Doubt(figure.path, f"{said}, where {usual}; {figure.hint}", figure.also)


def _tell_range(figure: Figure) -> str:
    """Return the usual range in words."""
    if figure.most == math.inf:
        return f"at least {_round(figure.least)}"
    if figure.least == -math.inf:
        return f"at most {_round(figure.most)}"
    if figure.least == 0 <= figure.value:
        return f"at most {_round(figure.most)}"
    return f"{_round(figure.least)} to {_round(figure.most)}"


def _round(value: float) -> str:
    """Return two significant digits, without an exponent if the number is not too long."""
    return f"{float(f'{value:.2g}'):.12g}"
