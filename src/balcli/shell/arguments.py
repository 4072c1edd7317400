"""Check and convert arguments of public functions; errors name the argument and the remedy."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from functools import partial, wraps
from inspect import signature
from itertools import islice
from typing import ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from ..core.phasors import Array
from ..errors import (
    Argument,
    ArgumentError,
    BalcliError,
    InputError,
    check_number,
    list_words,
    refuse_more,
    wrong_type,
)
from ..file.fields import shorten
from ..forces.spectrum import check_orders
from ..limits import HIGHEST_TORSION_ORDER, LARGEST_INERTIA, MOST_SPEEDS, SMALLEST_POSITIVE

Words = str | Iterable[str]  # names, or one text with names separated by commas
_MOST_GIVEN = 1_000_000  # largest number of given speeds, including equal ones


_OPTION = re.compile(r"`[^`]*`|(?<![\w-])--([a-z]+(?:-[a-z]+)*)")
P = ParamSpec("P")
Answer = TypeVar("Answer")


def tell_arguments(**others: str) -> Callable[[Callable[P, Answer]], Callable[P, Answer]]:
    """Decorate a function so that its errors name arguments in place of command-line options:
    `damper_inertia` in place of `--damper-inertia`.

    Args:
        others: Names of arguments whose option has another name; the keys are the options
            (`speeds="speeds_rpm"`).
    """

    def decorate(function: Callable[P, Answer]) -> Callable[P, Answer]:
        names = {**{name: name for name in signature(function).parameters}, **others}

        def name_argument(option: re.Match[str]) -> str:
            name = (option[1] or "").replace("-", "_")  # empty for a command in backquotes
            return names.get(name, option[0])

        name_all = partial(_OPTION.sub, name_argument)

        @wraps(function)
        def call(*args: P.args, **kwargs: P.kwargs) -> Answer:
            try:
                return function(*args, **kwargs)
            except ArgumentError:
                raise
            except InputError as error:
                problems = [p._replace(message=name_all(p.message)) for p in error.problems]
                raise InputError(problems, error.file, error.more) from None
            except BalcliError as error:
                raise BalcliError(name_all(str(error))) from None

        return call

    return decorate


def join_names(function: str, words: Words | None) -> str | None:
    """Return names as one text, separated by commas as on the command line; None without names.

    Args:
        function: Name of the public function, for messages.
        words: Names, or a text with commas.

    Raises:
        TypeError: The values are not names.
    """
    if words is None or isinstance(words, str):
        return words
    return ",".join(list_words(function, words, '["force.2.major", "moment.1.backward"]'))


def check_speeds(function: str, speeds: ArrayLike | None) -> Array | None:
    """Return speeds as a rising array without repetition, rpm; None if no speeds are given.

    Args:
        function: Name of the public function, for messages.
        speeds: Speeds, rpm, shape () or (speeds,).

    Raises:
        ArgumentError: A speed is not above 0, there are too many speeds, or the array has more than
            one axis.
        TypeError: The values are not numbers.
    """
    if speeds is None:
        return None
    refuse_more("speeds", speeds, MOST_SPEEDS if isinstance(speeds, range) else _MOST_GIVEN)
    try:
        given = np.asarray(speeds)
        if given.dtype.kind not in "iufO":  # numpy would convert texts to numbers
            raise TypeError
        rising = np.unique(given.astype(float).ravel())
    except (TypeError, ValueError):
        raise wrong_type(function, speeds, "give speeds in rpm, such as [1500, 2000]") from None
    except OverflowError:  # an integer with hundreds of digits
        rising = np.array([math.inf])
    if given.ndim > 1:
        raise ArgumentError(
            "{speeds}: has the shape {shape}; give speeds along one axis", shape=given.shape
        )
    if rising.size > MOST_SPEEDS:
        raise ArgumentError(
            "{speeds}: {count} speeds; at most {most} are computed",
            count=rising.size,
            most=MOST_SPEEDS,
        )
    if not rising.size or not np.all((rising >= SMALLEST_POSITIVE) & (rising < 1e9)):
        raise ArgumentError("{speeds}: give crank speeds above 0 in rpm, such as [1500, 2000]")
    return rising


def check_torsion_orders(orders: Iterable[float] | None) -> Array | None:
    """Return orders of a torsional excitation, ascending and without repetition; None if no orders
    are given.

    Raises:
        ArgumentError: There are no orders, or one is not a multiple of 1/2, not above 0, or too
            high.
        TypeError: The values are not numbers.
    """
    if orders is None:
        return None
    checked = check_orders(orders)
    if not 0 < checked[0] <= checked[-1] <= HIGHEST_TORSION_ORDER:
        raise ArgumentError(
            "{orders}: give orders above 0, to {highest} at most", highest=HIGHEST_TORSION_ORDER
        )
    return checked


def check_inertia(name: str, value: object) -> float | None:
    """Return a moment of inertia, kg m2; None if the value is None.

    Args:
        name: Name of the argument, for messages.
        value: Value to check.

    Raises:
        ArgumentError: The value is not above 0, or too large to compute with.
        TypeError: The value is not a number.
    """
    if value is None:
        return None
    number = check_number(name, value, "give a moment of inertia in kg m2, such as 0.1")
    if not 0 < number < LARGEST_INERTIA:
        raise ArgumentError(
            "{argument}: {value}; give a moment of inertia in kg m2, above 0",
            argument=Argument(name),
            value=shorten(value),
        )
    return number


def check_count(name: str, value: object, least: int = 1, most: int | None = None) -> int:
    """Return an argument that must be a whole number.

    Args:
        name: Name of the argument, for messages.
        value: Value to check.
        least: Smallest allowed number.
        most: Largest allowed number; None: no limit.

    Raises:
        ArgumentError: The value is too small or too large.
        TypeError: The value is not a whole number.
    """
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
        raise wrong_type(name, value, f"give a whole number from {least}")
    if value < least:
        raise ArgumentError(
            "{argument}: {value} is less than {least}",
            argument=Argument(name),
            value=shorten(value),
            least=least,
        )
    if most is not None and value > most:
        raise ArgumentError("{argument}: give {most} at most", argument=Argument(name), most=most)
    return int(value)


def read_position(name: str, value: object) -> tuple[float, float, float]:
    """Return an argument that must be a position: x, y and z, m.

    Args:
        name: Name of the argument, for messages.
        value: Value to check.

    Raises:
        TypeError: The value is not three numbers.
    """
    wanted = "give x, y and z in m, such as (0.3, 0, 0)"
    if not isinstance(value, Iterable) or len(numbers := list(islice(value, 4))) != 3:
        raise wrong_type(name, value, wanted)
    x, y, z = (check_number(name, number, wanted) for number in numbers)
    return x, y, z
