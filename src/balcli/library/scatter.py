"""`balcli.scatter`"""

from __future__ import annotations

from typing import Literal

from ..engine.build import Engine, check_engine, take_model
from ..errors import BalcliError, check_type
from ..studies.scatter import Drawing, Scatter, read_tolerances, scatter_engine
from .arguments import Words, check_count, join_names, tell_arguments


@tell_arguments(
    mass_scatter="mass",
    length_scatter="length",
    angle_scatter="angle_deg",
    stiffness_scatter="stiffness",
)
def scatter(
    engine: Engine,
    quantities: Words | None = None,
    *,
    mass: float | str = 0.005,
    length: float | str = 0.0,
    angle_deg: float | str = 0.0,
    stiffness: float | str | None = None,
    samples: int | None = None,
    seed: int | None = None,
    distribution: Literal["uniform", "normal"] = "uniform",
) -> Scatter:
    """How free forces and moments spread when masses, rod lengths and throw angles vary, and which
    tolerance matters most; or forces and modes of mounts, or of torsion, when their stiffness does.

    Args:
        engine: as `load` makes it.
        quantities: sizes of vectors (`force.1.major`, `couple.4.amplitude`), quantities of the
            cycle (`torque.max`, `fluctuation`, `guide.6.H`), of mounts (`mode.roll.Hz`,
            `mount.left.force`) or of torsion (`torsion.1.Hz`). Default: force and moment of orders
            1 and 2, as far as they are known.
        mass: tolerance of every piston, rod and throw mass, as a share (0.005) or a text ("0.5%").
        length: of every rod length, likewise; what else the file says of the rods stays.
        angle_deg: of every throw angle, a number or a text with its unit.
        stiffness: of every mount (default: 15 %) or shaft (5 %), a share or a text.
        samples: random engines; default: 100000, 500 of those computed one by one (of the
            cycle, mounts and torsion).
        seed: of the random numbers, to repeat them.
        distribution: within the tolerances, or with a third of them as standard deviation.

    Returns:
        For each quantity in `result.quantities` its nominal value, mean, percentiles, largest
        value, a bound, and the change that each tolerance makes, SI.

    Raises:
        BalcliError: quantities without a spread, no tolerance, too many samples.
        TypeError: what is no engine, no names.

    Example:
        >>> scatter(engine, "force.1.major", mass="1%", seed=1).quantities["force.1.major"].p95
    """
    model = take_model(check_engine("scatter", engine))
    names = join_names("scatter", quantities)
    count = None if samples is None else check_count("samples", samples)
    seed = None if seed is None else check_count("seed", seed, 0)
    check_type("distribution", distribution, str, 'give "uniform" or "normal"')
    if distribution not in ("uniform", "normal"):
        raise BalcliError(f'distribution {distribution!r}: choose "uniform" or "normal"')
    within = read_tolerances(mass, length, angle_deg, stiffness)
    return scatter_engine(model, names, within, Drawing(count, seed, distribution))
