"""`balcli compare`"""

from __future__ import annotations

import shlex
from collections.abc import Sequence

from ..errors import BalcliError
from ..render.formats import Units
from .file_names import text_format
from .options import (
    PARTS,
    EnginePaths,
    FormatOption,
    Only,
    Orders,
    Output,
    Speed,
    UnitsOption,
    Whole,
    parse_only,
    parse_orders,
    parse_speed,
)
from .output import refuse_overwriting, show


def compare(
    paths: EnginePaths,
    form: FormatOption = None,
    speed: Speed = None,
    orders: Orders = None,
    only: Only = None,
    whole: Whole = False,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Engines side by side: free forces and moments by order, peaks, and their ratios to the first
    engine's.

    \b
    Example:
      balcli compare i4.toml v8.toml --only force,moment
    """
    refuse_overwriting(reads=paths, writes={"--output": output})
    form = text_format(output, form)
    from ..render.comparison import RENDERER
    from ..results.comparison import compare_engines
    from .inputs import name_engines, read_engine

    rpm, asked, chosen = parse_speed(speed), parse_orders(orders), parse_only(only)
    _refuse_parts(chosen or (), paths)
    engines = [read_engine(path, rpm, chosen).engine for path in paths]
    names = name_engines([engine.name for engine in engines], paths)
    found = compare_engines(engines, names, asked, chosen, whole)
    show([found], RENDERER, form, output, units)


def _refuse_parts(words: Sequence[str], paths: Sequence[str]) -> None:
    """Parts of `analyze` that say something of one engine, and cannot stand side by side.

    Raises:
        BalcliError: with the command that shows them.
    """
    if of_one := [word for word in words if word in PARTS]:
        command = shlex.join(["balcli", "analyze", *paths, "--only", of_one[0]])
        raise BalcliError(f"--only {of_one[0]}: is of one engine; {command} shows each")
