"""`balcli scatter`"""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from functools import partial
from typing import TYPE_CHECKING, Annotated

import typer

from ..enginefile.toml_text import name_file
from ..errors import BalcliError
from ..forces.kinds import DEFAULT_QUANTITIES
from ..render import tolerances as renderer
from .file_names import text_format
from .options import EnginePath, FormatOption, Output
from .output import refuse_overwriting, show
from .progress import exit_if_cut_short, reporting_until_stopped

if TYPE_CHECKING:
    from ..engine.build import Engine
    from ..enginefile.model import EngineFile
    from ..forces.quantity import Quantity
    from ..studies.deviations import Tolerances
    from ..studies.quantities import Scattered
    from ..studies.tolerances import Drawing, Scatter


class Distribution(StrEnum):
    """How figures deviate within their tolerances."""

    UNIFORM = "uniform"
    NORMAL = "normal"


def scatter(
    path: EnginePath,
    mass: Annotated[
        str,
        typer.Option(
            "--mass-scatter",
            metavar="PERCENT",
            help="Tolerance of every piston, rod and throw mass, and of inertias for torsion.",
        ),
    ] = "0.5%",
    length: Annotated[
        str,
        typer.Option(
            "--length-scatter",
            metavar="PERCENT",
            help="Tolerance of every rod length; what else the file says of the rods stays.",
        ),
    ] = "0%",
    angle: Annotated[
        str,
        typer.Option(
            "--angle-scatter", metavar="ANGLE", help="Tolerance of every throw angle, as 0.2 deg."
        ),
    ] = "0",
    stiffness: Annotated[
        str | None,
        typer.Option(
            "--stiffness-scatter",
            metavar="PERCENT",
            show_default="15% of mounts, 5% of shafts",
            help="Tolerance of the stiffness of every mount, or shaft, for their quantities.",
        ),
    ] = None,
    samples: Annotated[
        int | None,
        typer.Option(
            "--samples",
            help="Number of random engines, 100000; of those computed one by one (torque over the "
            "cycle, guides, mounts, torsion), 500.",
            show_default=False,
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            "--seed", min=0, help="Of the random numbers, to repeat them.", show_default=False
        ),
    ] = None,
    distribution: Annotated[
        Distribution,
        typer.Option(
            "--distribution",
            help=(
                "uniform within the tolerances, or normal with a third of them as standard "
                "deviation."
            ),
        ),
    ] = Distribution.UNIFORM,
    quantity: Annotated[
        str | None,
        typer.Option(
            "--quantity",
            "-q",
            metavar="WHAT,...",
            show_default=DEFAULT_QUANTITIES,
            help="As force.1.major, couple.4.amplitude; of the cycle, as torque.max, fluctuation, "
            "guide.6.H; of mounts, as mode.roll.Hz, mount.left.force; or of torsion, as "
            "torsion.1.Hz, shaft.flywheel.torque.",
        ),
    ] = None,
    form: FormatOption = None,
    output: Output = None,
) -> None:
    """How free forces and moments spread when masses (rod lengths, throw angles) vary, and which
    tolerance matters most.

    \b
    Example:
      balcli scatter i4.toml --mass-scatter 0.5% --seed 1
    """
    refuse_overwriting(reads=[path], writes={"--output": output})
    form = text_format(output, form)
    from ..studies.quantities import parse_quantities, sort_scattered
    from ..studies.stated_tolerances import parse_percentage, parse_tolerances
    from ..studies.tolerances import Drawing
    from .inputs import read_engine

    within = parse_tolerances(mass, length, angle)
    share = None if stiffness is None else parse_percentage(stiffness, "--stiffness-scatter")
    _, model, engine = read_engine(path, asked=())
    names = DEFAULT_QUANTITIES if quantity is None else quantity
    asked = sort_scattered(parse_quantities(names, with_gas=model.gas is not None))
    if share is not None and not asked.of_parts:
        raise BalcliError(
            "--stiffness-scatter: is of mounts and shafts, and none of these quantities asks"
        )
    if quantity is None:
        known = _leave_out_unknown(engine, asked.by_order, name_file(path))
        asked = asked._replace(by_order=known)
    draw, usual = _choose_way(model, within, share, asked)
    count = usual if samples is None else samples
    with reporting_until_stopped("samples", count) as progress:
        found = draw(Drawing(count, seed, distribution.value, progress))
    show([found], renderer, form, output)
    exit_if_cut_short(progress, "the figures are of these")


def _choose_way(
    model: EngineFile, within: Tolerances, stiffness: float | None, asked: Scattered
) -> tuple[Callable[[Drawing], Scatter], int]:
    """What draws the samples, and their usual number."""
    from ..studies import cycle_scatter, part_scatter, tolerances
    from ..studies.spread_one_by_one import RANDOM_SINGLES

    if asked.of_cycle:
        return partial(cycle_scatter.scatter_cycles, model, within, asked.of_cycle), RANDOM_SINGLES
    if asked.of_parts:
        draw = partial(part_scatter.scatter_parts, model, stiffness, within.mass, asked.of_parts)
        return draw, RANDOM_SINGLES
    draw = partial(tolerances.scatter_engine, model, within, asked.by_order)
    return draw, tolerances.RANDOM_ENGINES


def _leave_out_unknown(
    engine: Engine, quantities: tuple[Quantity, ...], name: str
) -> tuple[Quantity, ...]:
    """The quantities without moments, with a warning, where those are not known."""
    if engine.places_known:
        return quantities
    from ..forces.quantity import leave_out_unknown
    from .inputs import warn_of_unknown_moments

    warn_of_unknown_moments(name)
    return leave_out_unknown(engine, quantities)
