"""`balcli scatter`"""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from ..enginefile.toml_text import name_file
from ..forces.kinds import DEFAULT_QUANTITIES
from ..render import tolerances as renderer
from .file_names import text_format
from .options import EnginePath, FormatOption, Output
from .output import show
from .overwrite_guard import refuse_overwriting

_ENGINES, _SETS_OF_MOUNTS = 100_000, 500


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
            help="Tolerance of every piston, rod and throw mass.",
        ),
    ] = "0.5%",
    length: Annotated[
        str,
        typer.Option("--length-scatter", metavar="PERCENT", help="Tolerance of every rod length."),
    ] = "0%",
    angle: Annotated[
        str,
        typer.Option(
            "--angle-scatter", metavar="ANGLE", help="Tolerance of every throw angle, as 0.2 deg."
        ),
    ] = "0",
    stiffness: Annotated[
        str,
        typer.Option(
            "--stiffness-scatter",
            metavar="PERCENT",
            help="Tolerance of the stiffness of every mount, for quantities on mounts.",
        ),
    ] = "15%",
    samples: Annotated[
        int | None,
        typer.Option(
            "--samples",
            help="Number of random engines, 100000; of random mounts, 500.",
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
            help="As force.1.major, couple.4.amplitude; or on mounts, as mode.roll.Hz, "
            "mount.left.force.",
        ),
    ] = None,
    form: FormatOption = None,
    output: Output = None,
) -> None:
    """How free forces and moments spread when masses (rod lengths, throw angles) vary, and which
    tolerance matters most.
    """
    refuse_overwriting(reads=[path], writes={"--output": output})
    form = text_format(output, form)
    from ..forces.quantity import leave_out_unknown
    from ..studies.quantities import parse_quantities, part_quantities
    from ..studies.tolerances import parse_percentage, parse_tolerances, scatter_engine
    from .inputs import read_engine, warn_of_unknown_moments

    tolerances = parse_tolerances(mass, length, angle)
    share = parse_percentage(stiffness, "--stiffness-scatter")
    _, model, engine = read_engine(path, asked=())
    names = DEFAULT_QUANTITIES if quantity is None else quantity
    asked, on_mounts = part_quantities(parse_quantities(names, with_gas=model.gas is not None))
    if quantity is None and not engine.places_known:
        asked = leave_out_unknown(engine, asked)
        warn_of_unknown_moments(name_file(path))
    count = samples if samples is not None else _SETS_OF_MOUNTS if on_mounts else _ENGINES
    if on_mounts:
        from ..studies.mount_scatter import scatter_mounts

        found = scatter_mounts(model, share, on_mounts, count, seed, distribution.value)
    else:
        found = scatter_engine(model, tolerances, asked, count, seed, distribution.value)
    show([found], renderer, form, output)
