"""`balcli.combine`"""

from __future__ import annotations

from collections.abc import Iterable

from ..engine.build import Engine, check_engine
from ..errors import check_number, check_type
from ..results.two_engines import Arrangement, Combined, Load, combine_engines
from .arguments import read_position, tell_arguments


@tell_arguments(phase="phase_deg", at="at_m", turn="turn_deg")
def combine(
    first: Engine,
    second: Engine,
    *,
    phase_deg: float = 0.0,
    at_m: Iterable[float] = (0.0, 0.0, 0.0),
    turn_deg: float = 0.0,
    reverse: bool = False,
    load: Load = "first",
    orders: Iterable[float] | None = None,
) -> Combined:
    """Two engines on one frame, geared one to one: H, U and opposed-piston engines.

    Args:
        first: as `load` makes it; both run at its speed.
        second: likewise.
        phase_deg: crank angle by which the second engine leads, in its own sense of rotation; with
            gas in four strokes over two revolutions.
        at_m: x, y, z of its origin in the first one's axes, m.
        turn_deg: how far it is turned about z.
        reverse: whether its crank turns against the first one's.
        load: "first", "second" or "both": with `reverse`, the crank that has flywheel and load.
        orders: which to show; default: 1, 2 and all that are not negligible.

    Returns:
        `spectra` of both together about the first one's point of reference (N, N m), as of
        `analyze`, and the peaks `force` and `moment`.

    Raises:
        BalcliError: something infinite or too far, an unknown load, or one that makes no
            difference.
        TypeError: what is no engine, no number, no place.

    Example:
        >>> combine(load("i4.toml"), load("i4.toml"), phase_deg=90, at_m=(0.3, 0, 0)).force.value
    """
    checked = check_engine("combine", first), check_engine("combine", second)
    phase = check_number("phase_deg", phase_deg, "give an angle in degrees")
    turn = check_number("turn_deg", turn_deg, "give an angle in degrees")
    check_type("reverse", reverse, bool, "give True or False")
    check_type("load", load, str, "give first, second or both")
    place = read_position("at_m", at_m)
    return combine_engines(*checked, Arrangement(phase, place, turn, reverse, load), orders)
