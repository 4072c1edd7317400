"""The public engine: what can be asked of an engine, as methods.

A method is the public function itself, so that signature, types and documentation exist once:
`engine.balance("two-shaft")` is `balance(engine, "two-shaft")`. This module imports all chapters.
It is for users of Python; no command imports it.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from .analysis.answer import analyze
from .analysis.comparison import compare
from .analysis.curves import curves
from .analysis.piston import piston
from .analysis.two_engines import sum  # noqa: A004
from .balancing.all_schemes import compare_schemes
from .balancing.answer import balance
from .crank_torque.answer import torque
from .engine import engine as kernel
from .engine.build import build
from .engine.load import build_tables, vary_engine
from .engine.parse import read
from .errors import check_type
from .file.examples import locate
from .file.plain_tables import take_tables
from .locomotives.answer import locomotive
from .mounting.answer import mounts
from .report.plot import plot
from .show.notebook import show_engine
from .studies.scatter import scatter
from .studies.search.answer import search
from .studies.sweep import sweep
from .torsional_vibration.answer import torsion

if TYPE_CHECKING:
    from .report.page import Explorer


class Engine(kernel.Engine):
    """An engine, and the questions that can be asked of it."""

    analyze = analyze
    balance = balance
    compare = compare
    compare_schemes = compare_schemes
    sum = sum
    curves = curves
    piston = piston
    torque = torque
    torsion = torsion
    mounts = mounts
    locomotive = locomotive
    sweep = sweep
    search = search
    scatter = scatter
    plot = plot
    _repr_html_ = show_engine

    def vary(
        self, changes: Mapping[str, object] = MappingProxyType({}), /, **named: object
    ) -> Engine:
        """Return the engine of the same file with other values of some keys.

        Args:
            changes: Values by dotted names of the engine file (`layout.bank_angle`,
                `crank.throws.2`, `operation.speed`, `name`): numbers in the units of the file, or
                texts with a unit. None removes a key. A key that gives the same figure in another
                way (`rod.ratio` when `rod.length` changes) is removed, and so is a firing order
                that does not fit new throws.
            named: Further changes, as keyword arguments.

        Raises:
            InputError: The changed file has mistakes; the error lists all of them.
            BalcliError: No file describes this engine.
            TypeError: The changes are not a dict with names of keys.

        Example:
            >>> engine.vary({"layout.bank_angle": 60, "rod.length": "6 in"})
        """
        check_type("vary", changes, Mapping, 'give a dict, such as {"rod.length": 150}')
        return vary_engine(self, {**changes, **named})

    def explore(self) -> Explorer:
        """Return an interactive view of the engine for a notebook: it shows the engine in motion,
        and the user can change the engine's numbers.

        Raises:
            BalcliError: No file describes this engine.

        Example:
            >>> engine.explore()
        """
        from .report.page import explore  # imported here, because few users need the page

        return explore(self)


def load(source: str | Path | Mapping[str, object]) -> Engine:
    """Return the engine that a file, a text or a dict describes.

    Args:
        source: Path of an engine file, "-" for standard input; or its content: a text of several
            lines (TOML), or a dict of its tables, such as `{"crank": {"stroke": 90}, "rod":
            {"length": 150}, "piston": {"mass": 0.5}}`. Bare numbers are mm, kg, degrees, rpm; a
            text has its unit ("3.5 in"); None counts as not given.

    Raises:
        BalcliError: The file cannot be read.
        InputError: The file has mistakes; the error lists all of them.
        TypeError: The source is none of these.

    Example:
        >>> engine = load("v8.toml")
    """
    wanted = "give the path of an engine file, the text of one, or a dict of its tables"
    tables, name = take_tables("load", source, wanted)
    return Engine.of(build_tables(tables, name))


def load_example(name: str) -> Engine:
    """Return one of the example engines of balcli.

    Args:
        name: Name in the list of `balcli engines`, such as "i4", "v8_crossplane" or
            "radial7_articulated".

    Raises:
        BalcliError: There is no such example; the error lists the nearest names.
        TypeError: The name is not a text.

    Example:
        >>> engine = load_example("v8_crossplane")
    """
    check_type("load_example", name, str, 'give the name of an example, such as "i4"')
    return Engine.of(build(read(locate(name))))
