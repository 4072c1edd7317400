"""`balcli.analyze_torsion`"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from types import NoneType
from typing import Any, Literal

from numpy.typing import ArrayLike

from ..core.phasors import Array
from ..engine.build import Engine, take_model
from ..engine.load import build_tables
from ..enginefile.plain_tables import take_tables
from ..errors import BalcliError, check_type
from ..torsion.analysis import TorsionAnalysis, answer_question, ask
from ..torsion.load import Source, make_chain_source, make_source
from ..torsion.read_chain import describes_chain, read_chain_tables
from .arguments import check_inertia, check_speeds, check_torsion_orders, tell_arguments

KINDS_OF_DAMPERS = ("viscous", "rubber", "pendulum")
_UNNAMED = "chain file"  # in messages, a text or dict


@tell_arguments(speeds="speeds_rpm")
def analyze_torsion(
    source: Engine | str | Path | Mapping[str, Any],
    speeds_rpm: ArrayLike | None = None,
    *,
    orders: Iterable[float] | None = None,
    damper: Literal["viscous", "rubber", "pendulum"] | None = None,
    damper_at: str | None = None,
    damper_inertia: float | None = None,
) -> TorsionAnalysis:
    """Torsional vibration of a crankshaft, or of any shafts: natural modes, critical speeds, and
    vibratory torque and stress over a range of speeds.

    Args:
        source: an Engine whose file has [torsion]; or a chain of inertias and shafts: its path, its
            text or a dict of its tables (or those of such an engine).
        speeds_rpm: at which the forced vibration is wanted; default: modes and criticals alone.
        orders: which of those that excite, multiples of 1/2; default: all of a chain, to 12 of an
            engine.
        damper: sized to make the largest stress over `speeds_rpm`, which have to be given, least;
            the answer is then that with it.
        damper_at: name of what carries it; default: the foremost part.
        damper_inertia: of its ring, or of its pendulums about the axis, kg m2; default: that in the
            file, or a usual share.

    Returns:
        `modes` (`frequency_Hz`, `shape`), `criticals` (`speed_rpm`, `order`, `mode`), `response`
        (`shafts`, each with `half_peak_to_peak_Nm` and `stress_Pa` by speed, and `worst`, the
        largest of the range), and `barred_rpm`: the attributes are the keys of the JSON.

    Raises:
        BalcliError: no [torsion]; orders or an inertia that cannot be; a response without
            excitation or through an undamped resonance; a damper that nothing can carry.
        InputError: every mistake of the file.
        TypeError: the source is none of these; what is no number.

    Example:
        >>> analyze_torsion(load("i6_diesel.toml"), range(1000, 2501, 25)).barred_rpm
    """
    check_type("damper", damper, (str, NoneType), 'give a kind of damper, such as "viscous"')
    if damper not in (None, *KINDS_OF_DAMPERS):
        raise BalcliError(f"damper {damper!r}: choose from {', '.join(KINDS_OF_DAMPERS)}")
    asked = check_torsion_orders(orders)
    inertia = check_inertia("damper_inertia", damper_inertia)
    check_type("damper_at", damper_at, (str, NoneType), 'give the name of a part, such as "hub"')
    speeds = check_speeds("analyze_torsion", speeds_rpm)
    question = ask(speeds, asked, (), damper, damper_at, inertia)
    return answer_question(_read_source(source, asked), question)


def _read_source(source: Any, orders: Array | None) -> Source:
    if isinstance(source, Engine):
        return make_source(take_model(source), source, source.name, orders)
    wanted = "give an Engine, or the path, text or dict of a chain of inertias and shafts"
    tables, name = take_tables("analyze_torsion", source, wanted)
    if describes_chain(tables):
        name = name or _UNNAMED
        return make_chain_source(read_chain_tables(tables, name), name)
    engine = build_tables(tables, name)
    return make_source(take_model(engine), engine, name or engine.name, orders)
