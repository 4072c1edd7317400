"""`balcli.balance_rotor`"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, Literal

from ..enginefile.plain_tables import take_tables
from ..errors import BalcliError, check_type
from ..field_balancing.balance import FieldBalance, find_corrections
from ..field_balancing.read import check_runs
from .arguments import tell_arguments

_UNNAMED = "file of runs"  # in messages, a text or dict


@tell_arguments()
def balance_rotor(
    runs: str | Path | Mapping[str, Any],
    minimise: Literal["squares", "max"] = "squares",
    *,
    without: str | Collection[str] = (),
) -> FieldBalance:
    """Balance a rotor on the machine or in its bearings.

    Args:
        runs: Path of a file of runs, its text (TOML), or a dict of its tables: `planes`, and under
            `run` one dict for each run with its `readings` and `weights`, such as "5 @ 30"
            (amplitude and angle in degrees).
        minimise: "squares", the least sum of squared readings, or "max", the smallest largest one.
        without: Names of planes that get no weight.

    Returns:
        `corrections`, each with its `weight` (complex, in the file's unit) and `pieces`;
        `residual`, the predicted readings, shape (readings,).

    Raises:
        BalcliError: The file cannot be read; `without` names no plane, or all of them.
        InputError: The runs have mistakes, or do not separate the effects of the planes.
        TypeError: An argument has a wrong type.

    Example:
        >>> balance_rotor("fan.toml", "max").to_pandas()
    """
    check_type("minimise", minimise, str, 'give "squares" or "max"')
    if minimise not in ("squares", "max"):
        raise BalcliError(f'minimise {minimise!r}: choose "squares" or "max"')
    without = [without] if isinstance(without, str) else without
    hint = 'give names of planes, such as ["front"]'
    check_type("without", without, Collection, hint)
    for plane in without:
        check_type("without", plane, str, hint)
    wanted = "give the path, text or dict of a file of runs"
    tables, name = take_tables("balance_rotor", runs, wanted)
    return find_corrections(check_runs(tables, name), minimise, without, name or _UNNAMED)
