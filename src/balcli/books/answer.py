"""Registry of the printed tables that balcli recomputes (`tables`), their errata, and the table of
common engine layouts.

The table of layouts lists free forces and moments of the example engines. Forces of order n are
multiples of one cylinder's force of this order, F_n = m r omega^2 A_n: m is the reciprocating mass,
r the crank radius, omega the crank speed, and A_n the coefficient of order n in the piston's
acceleration (A_1 = 1). Moments, about the middle of the crankshaft, are multiples of F_n times the
distance of neighbouring throws. Offsets of piston pins and all else that textbooks ignore are left
out (`forces.symmetry`).
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial
from itertools import pairwise
from types import NoneType
from typing import NamedTuple

import numpy as np

from ..core.mechanisms import closed_form, power_series, slidercrank
from ..engine.build import build
from ..engine.engine import Engine
from ..engine.parse import parse
from ..errors import Argument, ArgumentError, BalcliError, check_type
from ..file.examples import folder
from ..file.fields import suggest_nearest
from ..file.model import EngineFile
from ..forces.symmetry import find_textbook
from ..limits import HIGHEST_POWER
from ..shell.arguments import check_count
from . import liu_statements, schemes, series, tsinghua, worked_examples
from .recomputed import (
    Erratum,
    Print,
    Ranges,
    Row,
    Table,
    load_print,
    parse_crank_ratios,
    parse_range,
    tabulate_statements,
)
from .sources import SOURCES, Source, find_origin, find_source

ORDERS = (1, 2, 4, 6)


def tabulate_layouts(printed: Print, ranges: Ranges) -> Table:
    """Return a row for each engine. For each order, it has the semi-axes of two ellipses: that
    through which the force vector (F) turns, and that of the moment vector (M).
    """
    ends = [f"{letter}{n}_{axis}" for n in ORDERS for letter in "FM" for axis in ("major", "minor")]
    rows = [_row(name) for name in printed.column("engine")]
    return printed.compare(("engine", "layout", "cylinders", *ends), rows, stub=3)


def find_gaps(name: str) -> tuple[float, ...]:
    """Return the distinct intervals between firings of an example engine, deg, ascending; empty for
    an engine of several cylinders whose file gives no firing order.
    """
    _, engine = _load(name)
    several = len(engine.numbers) > 1  # a single cylinder needs no firing order
    fires = map(float, engine.fires_deg.values()) if several else [0.0]
    instants = [*fires, 180.0 * engine.strokes]
    return tuple(sorted({round(b - a, 1) for a, b in pairwise(instants)}))


def _load(name: str) -> tuple[EngineFile, Engine]:
    file = parse((folder() / f"{name}.toml").read_text(encoding="utf-8"), name)
    return file, build(file.with_table("piston", offset=0.0))


def _row(name: str) -> Row:
    file, engine = _load(name)
    textbook = find_textbook(engine, np.array(ORDERS, float), ("force", "moment"))
    vectors = textbook.reciprocating.vectors()
    axes = []
    for k, order in enumerate(ORDERS):
        for kind, phasors in vectors:
            unit = textbook.units.size(kind, order)
            for axis in (phasors.major[k], phasors.minor[k]):
                axes.append(float(axis / unit) if axis else 0.0)
    return (name, file.name, len(engine.numbers), *axes)


TABLES: dict[str, Callable[[Print, Ranges], Table]] = {
    "tsinghua-1-1": tsinghua.tabulate_engines,
    "tsinghua-1-2": partial(tsinghua.tabulate_by_angle, function=slidercrank.displacement),
    "tsinghua-1-3": partial(tsinghua.tabulate_by_angle, function=slidercrank.velocity),
    "tsinghua-1-4": tsinghua.tabulate_extremes,
    "tsinghua-1-5": tsinghua.tabulate_mean_speeds,
    "tsinghua-1-6": partial(tsinghua.tabulate_by_angle, function=slidercrank.acceleration),
    "tsinghua-two-terms": tsinghua.tabulate_two_terms,
    "liu-1": schemes.tabulate_paths,
    "liu-2": schemes.tabulate_vectors,
    "liu-3": schemes.tabulate_sliders,
    "liu-statements": liu_statements.tabulate_liu_statements,
    "wang-1": schemes.tabulate_optimum,
    "kvasnikov-1": partial(
        series.tabulate_coefficients, exact=closed_form.piston, terms=power_series.piston
    ),
    "kvasnikov-2": partial(
        series.tabulate_coefficients, exact=closed_form.rod, terms=power_series.rod
    ),
    "kvasnikov-statements": series.tabulate_kvasnikov_statements,
    "liang-examples": worked_examples.tabulate_liang_examples,
    "published": worked_examples.tabulate_published,
    "series": series.tabulate_series,
    "statements": tabulate_statements,
    "layouts": tabulate_layouts,
}
NAMES = tuple(TABLES)
TAKES = {  # argument that gives another range: tables that accept it
    "lambda_": (
        *(f"tsinghua-1-{k}" for k in (2, 3, 4, 6)),
        *("tsinghua-two-terms", "wang-1", "kvasnikov-1", "kvasnikov-2"),
    ),
    "angle": ("tsinghua-1-2", "tsinghua-1-3", "tsinghua-1-6", "liu-1", "liu-2", "liu-3"),
    "power": ("series",),
}


def select_tables(
    name: str | None, lambda_: str | None = None, angle: str | None = None, power: int | None = None
) -> list[Table]:
    """Return the table of this name, or all tables.

    Args:
        name: Name; None: all tables.
        lambda_: Range of crank ratios as text, `0.20:0.40:0.01`.
        angle: Range of crank or bank angles as text, deg.
        power: Highest power of the crank ratio.

    Raises:
        BalcliError: There is no such table, a range cannot be read, or a range is given without the
            name of a table that takes this range.
    """
    lams = parse_crank_ratios(lambda_) if lambda_ is not None else None
    angles = parse_range("angle", angle) if angle is not None else None
    ranges = Ranges(lams, angles, power)
    if name is not None and name not in TABLES:
        raise BalcliError(f"no table {name!r}; {_tell_nearest(name)}")
    names = NAMES if name is None else (name,)
    for (argument, takers), value in zip(TAKES.items(), ranges, strict=True):
        if value is not None and (name is None or names[0] not in takers):
            raise ArgumentError(
                "{argument}: name a table that takes it: {takers}",
                argument=Argument(argument),
                takers=", ".join(takers),
            )
    return [_recompute(each, ranges) for each in names]


@lru_cache(maxsize=64)
def _recompute(name: str, ranges: Ranges) -> Table:
    """Return a table; the list of tables, a source and the errata show many of them again."""
    return TABLES[name](load_print(name), ranges)


def _tell_nearest(name: str) -> str:
    """Return the nearest name of a table or source, or all names."""
    source = find_source(name)
    if source is not None:
        return f"{source.key} is a source with the tables {', '.join(list_tables_of(source))}"
    names = (*NAMES, *(source.key for source in SOURCES))
    return suggest_nearest(name, names, f"there are {', '.join(names)}")


# ------------------------------------------------------------------ sources
class SourceTables(NamedTuple):
    """All that balcli has from one book or paper.

    Attributes:
        source: Book or paper.
        tables: Its tables, recomputed.
        statements: Its equations and sentences that are wrong.
    """

    source: Source
    tables: tuple[Table, ...]
    statements: tuple[Erratum, ...]


def list_tables_of(source: Source) -> tuple[str, ...]:
    """Return the names of a source's tables."""
    return tuple(name for name in NAMES if find_origin(name) == source)


def select_source(source: Source) -> SourceTables:
    """Return the tables of a source, and its wrong statements."""
    (statements,) = select_tables("statements")
    place = statements.columns.index("source")
    wrong = [e for e in statements.errata if statements.exact[e.row][place] == source.key]
    recomputed = [select_tables(name)[0] for name in list_tables_of(source)]
    return SourceTables(source, tuple(recomputed), tuple(wrong))


# Errata of published problems are not those of the five sources: they are listed by this name only.
PUBLISHED = "published"


def select_errata(
    name: str | None, lambda_: str | None = None, angle: str | None = None, power: int | None = None
) -> list[tuple[str, Erratum]]:
    """Return the errata of a table or source, each with its table's name.

    Args:
        name: Name of a table or source; None: errata of all tables but those of published problems.
        lambda_: As in `select_tables`, as are `angle` and `power`.
        angle: See there.
        power: See there.

    Raises:
        BalcliError: As `select_tables` raises it.
    """
    source = find_source(name) if name else None
    if source is not None and not (lambda_ or angle or power):
        of_source = select_source(source)
        of_tables = [(table.name, e) for table in of_source.tables for e in table.errata]
        return of_tables + [("statements", e) for e in of_source.statements]
    chosen = select_tables(name, lambda_, angle, power)
    if name is None:
        chosen = [table for table in chosen if table.name != PUBLISHED]
    return [(table.name, e) for table in chosen for e in table.errata]


def tables(
    name: str, *, lambda_: str | None = None, angle: str | None = None, power: int | None = None
) -> Table:
    """Return a printed coefficient table with the recomputed figures.

    Args:
        name: Name of the table, such as "tsinghua-1-2" or "series"; `balcli tables` lists all.
        lambda_: Crank ratios (crank radius over rod length) in place of the printed ones, for
            tables by crank ratio, such as "0.20:0.40:0.01" or "0.25,1/3".
        angle: Angles in place of the printed ones, deg, in the same form: crank angles, or bank
            angles in the tables of liu.
        power: Highest power of the crank ratio in "series", 0 to 200.

    Returns:
        The table, with `columns`, `exact` cells, `printed` texts, and `errata`: every printed
        figure that differs from the rounded exact one.

    Raises:
        BalcliError: There is no such table (the error names the nearest), or it does not take this
            range.
        TypeError: The name or a range is not a text, or the power is not a whole number.

    Example:
        >>> tables("tsinghua-1-2").errata
    """
    check_type("tables", name, str, f"give the name of a table, such as {NAMES[1]!r}")
    check_type("lambda_", lambda_, (str, NoneType), 'give a text, such as "0.20:0.40:0.01"')
    check_type("angle", angle, (str, NoneType), 'give a text, such as "0:180:5"')
    highest = None if power is None else check_count("power", power, 0, HIGHEST_POWER)
    return select_tables(name, lambda_, angle, highest)[0]
