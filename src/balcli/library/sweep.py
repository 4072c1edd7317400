"""`balcli.sweep`"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..engine.build import Engine, check_engine, take_model
from ..errors import BalcliError
from ..limits import MOST_THREADS
from ..process import count_cores
from ..studies.parameters import choose_values
from ..studies.sweep import Swept, compute_sweep, plan_sweep
from .arguments import Words, check_count, check_mapping, join_names, tell_arguments


@tell_arguments(quantity="quantities", jobs="threads")
def sweep(
    engine: Engine,
    vary: Mapping[str, Any],
    quantities: Words | None = None,
    threads: int | None = None,
) -> Swept:
    """Figures of many variants of an engine: numbers of its file over ranges, the full grid,
    evaluated as arrays.

    Args:
        engine: as `load` makes it.
        vary: by dotted name of a number of the engine file (`rod.ratio`, `crank.throws.2`,
            `layout.bank_angle`), its values in the unit of the file (mm, kg, deg, rpm): an array
            or list of one axis, texts with units of their own, or a range with both ends
            ("0:180:1"). Several names span a grid.
        quantities: names such as `force.2.major` (minor, forward, backward, axis, x, y),
            `moment.1.backward`, `couple.4.amplitude`, `peak.force`; of engines with mounts,
            torsion or gas also `mode.3.Hz`, `mount.left.force`, `torsion.1.Hz`, `torque.mean`.
            Default: force and moment of orders 1 and 2, as far as they are known.
        threads: that compute what takes more than a second; at most 64; default: one
            a core.

    Returns:
        The grid: `result["force.2.major"]` has one axis a name in `vary`, in SI units or degrees;
        `result.to_pandas()` one row a variant, the last name fastest.

    Raises:
        BalcliError: an unknown name, with the nearest one; values out of bounds.
        InputError: one of the variants cannot be, and why.
        TypeError: what is no engine, no dict, no names.

    Example:
        >>> sweep(engine, {"layout.bank_angle": range(0, 181)}, ["force.1.major"]).to_pandas()
    """
    model = take_model(check_engine("sweep", engine))
    example = '{"rod.ratio": [0.24, 0.28, 0.32]}'
    parameters = tuple(
        choose_values(str(path), values, model)
        for path, values in check_mapping("sweep", vary, example).items()
    )
    if not parameters:
        raise BalcliError(f"sweep: nothing varies; give numbers and values, such as {example}")
    wanted = min(count_cores(), MOST_THREADS) if threads is None else threads
    count = check_count("threads", wanted, most=MOST_THREADS)
    asked = join_names("sweep", quantities)
    plan = plan_sweep(model, parameters, asked, engine.name or "engine")
    return compute_sweep(plan, count)
