"""`balcli.analyze_mounts`"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from types import NoneType
from typing import Any

from numpy.typing import ArrayLike

from ..engine.build import Engine, check_engine, take_model
from ..enginefile.model import EngineFile
from ..enginefile.plain_tables import take_tables
from ..enginefile.read import check_tables
from ..errors import check_type
from ..forces.orders import check_orders
from ..mounting.read import check_mounted
from ..mounting.records import MountReport
from ..mounting.report import report_mounts
from .arguments import check_mapping, check_speeds, tell_arguments


@tell_arguments(speeds="speeds_rpm")
def analyze_mounts(
    source: Engine | str | Path | Mapping[str, Any],
    speeds_rpm: ArrayLike | None = None,
    *,
    orders: Iterable[float] | None = None,
    scheme: str | None = None,
    others: Mapping[str, Engine] | None = None,
) -> MountReport:
    """What the frame feels of an engine on its mounts: natural modes, rest, forces of the mounts
    and motion of points over a range of speeds.

    Args:
        source: Engine whose file has [body] and [[mount]]; or the path of such a file, its text or
            a dict of its tables, which may also describe the body and mounts alone.
        speeds_rpm: Speeds in any order; default: from an eighth of the file's speed to this.
        orders: Orders of the load; default: all that are not negligible.
        scheme: Balance scheme; with its devices the response is `fitted`.
        others: Engines by name that are put on the same mounts.

    Returns:
        The document of `balcli mounts` as records: `modes` (`frequency_Hz`, `motion`, ...),
        `response` (`mounts` and `points`, with `peak_N` or `peak_mm` over `speeds_rpm` and the
        `worst` of the range; None without an engine), `fitted`, `others`.

    Raises:
        BalcliError: A mode without damping is driven within the range; the scheme cannot be fitted.
        InputError: The file has mistakes, or a motion is held by no mount.
        TypeError: The source or an argument has a wrong type.

    Example:
        >>> [mode.frequency_Hz for mode in analyze_mounts("i4_mounts.toml").modes]
    """
    speeds = check_speeds("analyze_mounts", speeds_rpm)
    beside = {} if others is None else check_mapping("analyze_mounts", others, '{"V8": engine}')
    engines = {str(name): check_engine("analyze_mounts", one) for name, one in beside.items()}
    check_type("scheme", scheme, (str, NoneType), 'give its name, such as "counterweights"')
    asked = None if orders is None else check_orders(orders).tolist()
    model, engine, name = _read(source)
    return report_mounts(model, engine, speeds, asked, scheme, list(engines.items()), name)


def _read(source: object) -> tuple[EngineFile, Engine | None, str]:
    """The file, its engine if it has one, and its name."""
    if isinstance(source, Engine):
        return take_model(source), source, ""
    wanted = "give an Engine, or the path, text or dict of a file with [body] and [[mount]]"
    tables, name = take_tables("analyze_mounts", source, wanted)
    found = check_mounted(check_tables(tables, Path(name).parent, name, bare=True), name)
    return found.model, found.engine, name
