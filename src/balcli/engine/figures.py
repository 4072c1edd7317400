"""Provide the figures of an engine file, some of them replaced by arrays of variants.

The model of a file is never changed. Every stage of `engine.build` asks `FileFigures` for a figure
by its dotted name (`crank.stroke`, `shaft.1.at.2`, `cylinder.3.rod_ratio`). `FileFigures` returns
the figure of the file, or the array of variants that replaces it, in the unit of the file. `column`
makes an array of the figures of all cylinders, with one row for each cylinder.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.phasors import Array, Complex, Figure
from ..errors import BalcliError
from ..file.model import EngineFile, Override, RodKeys
from ..file.table import FileTable

if TYPE_CHECKING:
    from ..file.gas_tables import Flywheel


class FileFigures:
    """Figures of a file, or of variants of it.

    Args:
        varied: Arrays that replace figures, by dotted name. Keys of the same table that give a
            varied figure in another way (`rod.length` if `rod.ratio` varies) count as not given
            ("displaced").
        model: Engine file; needed if a figure varies.

    Attributes:
        displaced: Names of figures, lists and tables of the file that count as not given.

    Raises:
        BalcliError: Two figures vary that exclude each other; or a varied figure lacks another one
            that belongs to it (a mass without a radius, because the file gives an unbalance).
    """

    def __init__(
        self, varied: Mapping[str, Figure] = MappingProxyType({}), model: EngineFile | None = None
    ) -> None:
        self._varied = varied
        self.displaced = set(self._find_displaced(model)) if varied and model else set[str]()

    def take(self, path: str, given: float) -> Figure:
        """Return a figure that the file always has.

        Args:
            path: Dotted name.
            given: Value in the file.
        """
        return self._varied.get(path, given)

    def take_optional(self, path: str, given: float | None) -> Figure | None:
        """Return a figure that the file may leave out; None if it is left out or displaced.

        Args:
            path: Dotted name of its key.
            given: Value in the file; None if it has none.
        """
        return None if path in self.displaced else self._varied.get(path, given)

    def take_each(self, path: str, given: Sequence[float]) -> tuple[Figure, ...]:
        """Return all members of a list, each of which may vary (`crank.throws.2`).

        Args:
            path: Dotted name of the list's key.
            given: Values in the file.
        """
        return tuple(self._varied.get(f"{path}.{k}", value) for k, value in enumerate(given, 1))

    def take_for_each(
        self, path: str, given: float | tuple[float, ...], count: int
    ) -> tuple[Figure, ...]:
        """Return the members of a list, or the single figure of the file repeated `count` times.

        Args:
            path: Dotted name of the key.
            given: Values in the file, or the single value.
            count: Number of figures to return.
        """
        if isinstance(given, tuple):
            return self.take_each(path, given)
        return (self.take(path, given),) * count

    def find_varied(self, *starts: str) -> list[str]:
        """Return the names of varied figures that begin with one of these words."""
        return [path for path in self._varied if path.startswith(starts)]

    def of_table(self, start: str) -> dict[str, Figure]:
        """Return the varied figures of the table with the dotted name `start`, by their keys."""
        return {
            path[len(start) + 1 :]: value
            for path, value in self._varied.items()
            if path.rpartition(".")[0] == start
        }

    def cylinder_tables(self, model: EngineFile) -> dict[int, Override]:
        """Return the tables of single cylinders. Cylinders whose figures vary, but that have no
        table in the file, get an empty one.
        """
        if not self._varied:
            return model.cylinder
        parts = [path.split(".") for path in self._varied]
        numbers = {int(part[1]) for part in parts if part[0] == "cylinder"}
        return dict.fromkeys(numbers, Override.model_construct()) | model.cylinder

    def _find_displaced(self, model: EngineFile) -> Iterator[str]:
        cylinders = self.cylinder_tables(model)
        tables = dict(model.tables()) | {f"cylinder.{n}": own for n, own in cylinders.items()}
        if model.articulation is not None:
            tables["articulation.rod"] = model.articulation.rod
        for path in self._varied:
            start, _, key = path.rpartition(".")
            if start in tables:
                yield from _find_rivals(start, key, tables[start], self._varied)


def _find_rivals(
    start: str, key: str, table: FileTable, varied: Mapping[str, Figure]
) -> Iterator[str]:
    """Yield the names of given keys in a table (at path `start`) that the varied `key` excludes.

    Raises:
        BalcliError: The errors of `FileFigures`.
    """
    for other in varied:
        if any(f"{other}.".startswith(f"{start}.{rival}.") for rival in table.rivals(key)):
            raise BalcliError(f"{start}.{key} and {other} give the same figure; vary one of them")
    given = [other for other, value in table if value is not None]
    for choice in table.choices:
        rivals = choice.rivals(key)
        displaced = [other for other in given if other in rivals]
        group = [other for group in choice.groups if key in group for other in group]
        if displaced and not {*group} <= {key, *given}:
            raise BalcliError(
                f"{start}.{key}: the file gives {' and '.join(displaced)} instead; vary that, or "
                f"give {' and '.join(group)} in the file"
            )
        yield from (f"{start}.{other}" for other in displaced)


def select_varied(varied: Mapping[str, Figure], number: int) -> Iterator[tuple[str, Figure]]:
    """Yield the varied figures of one geared engine (number from 1), by their names in the engine's
    own file. A varied speed holds for all engines; other figures of [operation] vary in the first.
    """
    start = f"engine.{number}."
    for path, value in varied.items():
        own = path.removeprefix(start)
        if own != path and "." in own and not own.startswith("at."):
            yield own, value
        elif path == "operation.speed" or (number == 1 and path.startswith("operation.")):
            yield path, value


AS_GIVEN = FileFigures()  # nothing varies


# ------------------------------------------------------------------ rods and single cylinders
class PendulumTest(NamedTuple):
    """Pendulum test of a rod: the bore about which the rod swings, and the period, s."""

    pivot: str
    period: Figure


class RodFigures(NamedTuple):
    """Figures of a rod by the keys of [rod], in m, kg, kg m2; None if the file gives none."""

    length: Figure | None = None
    ratio: Figure | None = None
    mass: Figure | None = None
    cg: Figure | None = None
    small_end: Figure | None = None
    big_end: Figure | None = None
    inertia: Figure | None = None
    pendulum: PendulumTest | None = None

    @property
    def given(self) -> dict[str, Figure | PendulumTest]:
        """Figures that the file gives, by key."""
        return {key: value for key, value in self._asdict().items() if value is not None}

    def length_for(self, radius: Figure) -> Figure:
        """Return the rod length, m: the given one, or the crank radius (m) divided by `ratio`.
        Return 1 if the file gives neither, as harmonic motion allows.
        """
        if self.length is None and self.ratio is None:
            return 1.0
        return self.length if self.length is not None else radius / cast(Figure, self.ratio)

    def with_own(self, own: RodFigures) -> RodFigures:
        """Return these figures, overridden by the figures `own` of one cylinder. Figures that an
        overriding figure excludes are left out.
        """
        if not (said := own.given):
            return self
        rivals = {rival for key in said for rival in _RIVALS[key]}
        return RodFigures(**(self._asdict() | dict.fromkeys(rivals) | said))


_RIVALS = {  # keys of [rod] that a key excludes
    key: [rival for choice in RodKeys.choices for rival in choice.rivals(key)]
    for key in RodFigures._fields
}
_SI = {"length": 1e3, "cg": 1e3, "inertia": 1e6}  # divisors that convert keys of [rod] to SI units


def value_or(own: Figure | None, general: Figure) -> Figure:
    """Return the figure of one cylinder, or else the figure for all.

    Args:
        own: Figure of the cylinder; None if the cylinder has none.
        general: Figure for all cylinders.
    """
    return general if own is None else own


def or_zero(figure: Figure | None) -> Figure:
    """Return a figure; 0 for None."""
    return 0.0 if figure is None else figure


def divide(figure: Figure | None, divisor: float) -> Figure | None:
    """Return a figure divided by a number; None for None.

    Args:
        figure: Figure, or None.
        divisor: Number, not 0.
    """
    return None if figure is None else figure / divisor


def rod_figures(
    figures: FileFigures, table: RodKeys | Override, path: str = "rod", prefix: str = ""
) -> RodFigures:
    """Return the figures of a rod from [rod], [articulation.rod] or the table of a single cylinder.

    Args:
        figures: Figures of the file.
        table: The table.
        path: Dotted name of the table.
        prefix: Prefix of its keys, `rod_` in tables of single cylinders.
    """

    def take(key: str) -> Figure | None:
        return figures.take_optional(f"{path}.{prefix}{key}", getattr(table, prefix + key))

    values = [divide(take(key), _SI.get(key, 1.0)) for key in RodFigures._fields[:-1]]
    pendulum = getattr(table, f"{prefix}pendulum")
    if pendulum is not None and f"{path}.{prefix}pendulum" not in figures.displaced:
        period = figures.take(f"{path}.{prefix}pendulum.period", pendulum.period)
        return RodFigures._make((*values, PendulumTest(pendulum.pivot, period)))
    return RodFigures._make((*values, None))


# ------------------------------------------------------------------ flywheel
def find_wheel(figures: FileFigures, table: Flywheel) -> Figure | None:
    """Return the moment of inertia of the flywheel, kg m2."""
    inertia, mass, radius = (
        figures.take_optional(f"flywheel.{key}", getattr(table, key))
        for key in ("inertia", "mass", "radius_of_gyration")
    )
    if mass is None or radius is None:
        return divide(inertia, 1e6)
    return mass * (radius * 1e-3) ** 2


# ------------------------------------------------------------------ arrays
_ROUNDING = 1e-9  # values that differ by less than this share of the largest are equal


def place_in_plane(x: Figure, y: Figure) -> complex | Complex:
    """Return x + iy.

    Args:
        x: Coordinate along x, m.
        y: Coordinate along y, m.
    """
    return cast("complex | Complex", x + 1j * y)


def column(values: Sequence[Figure], rank: int) -> Array:
    """Return an array with one row for each value, shape (len(values), *trailing).

    Args:
        values: Numbers or arrays, which broadcast against each other.
        rank: Number of trailing axes (of length 1) if all values are plain numbers.
    """
    if any(isinstance(value, np.ndarray) for value in values):
        rows: Array = np.stack(np.broadcast_arrays(*values)) + 0.0  # -0.0 becomes 0.0
    else:  # for plain numbers, which are frequent, this is quicker
        rows = np.array(values) + 0.0
    return rows.reshape(len(values), *rows.shape[1:] or (1,) * rank)


def shared_column(values: Sequence[Figure], rank: int) -> Array:
    """Return the `column` of values, or a single row, shape (1, *trailing), if all are equal.

    Args:
        values: One figure for each cylinder.
        rank: Number of trailing axes.
    """
    rows = column(values, rank)
    return rows[:1] if len(rows) > 1 and (rows == rows[:1]).all() else rows


def find_first_largest(values: ArrayLike) -> NDArray[np.intp]:
    """Return the row with the largest value, shape (...) for values of shape (rows, ...). If the
    largest values differ only by rounding, return the first of their rows.
    """
    columns = np.asarray(values, float)
    largest = columns.max(axis=0)
    return np.asarray((columns >= largest - _ROUNDING * np.abs(largest)).argmax(axis=0))


def ranked(values: ArrayLike) -> Array:
    """Return values of any shape, rounded to ten digits. As sort keys, rounded values are equal if
    the values differ only by rounding errors.
    """
    mantissa, exponent = np.frexp(np.asarray(values, float))
    return np.ldexp(np.round(mantissa, 10), exponent)
