"""`balcli.curves`"""

from __future__ import annotations

from ..engine.build import Engine, check_engine
from ..errors import check_number
from ..forces.curves import Curves, divide_revolution
from ..studies.curves import compute_curves
from .arguments import check_count, tell_arguments


@tell_arguments(step="step_deg")
def curves(engine: Engine, step_deg: float = 1.0, *, cylinder: int | None = None) -> Curves:
    """Force, moment, couple, torque and roll over the crank angle, or the motion of one piston.

    Args:
        engine: as `load` makes it.
        step_deg: of the crank angle, which begins at 0; with gas it runs over the whole cycle.
        cylinder: number of the one whose piston's travel, speed, acceleration and rod angle are
            wanted, with its pressure if there is gas; default: the whole engine.

    Returns:
        `crank_deg` and, by name with unit (`force_x_N`), `values` of the same shape (angles,).
        Those of a cylinder count along it, outward, and across it, to the side to which the crank
        pin moves after top dead centre; travel towards the crank (docs/json.md).

    Raises:
        BalcliError: a step that is too small or too large; no such cylinder.
        TypeError: what is no engine.

    Example:
        >>> curves(load("i4.toml"), 10).to_pandas()
    """
    engine = check_engine("curves", engine)
    step = check_number("step_deg", step_deg, "give a step in degrees")
    number = None if cylinder is None else check_count("cylinder", cylinder)
    return compute_curves(engine, number, divide_revolution(step, engine.cycle_revolutions))
