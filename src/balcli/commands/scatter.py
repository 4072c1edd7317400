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
    samples: Annotated[int, typer.Option("--samples", help="Number of random engines.")] = 100_000,
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
            help="As force.1.major, couple.4.amplitude.",
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
    from ..forces.quantity import leave_out_unknown, parse_quantity_list
    from ..studies.tolerances import parse_tolerances, scatter_engine
    from .inputs import read_engine, warn_of_unknown_moments

    tolerances = parse_tolerances(mass, length, angle)
    _, model, engine = read_engine(path, asked=())
    asked = parse_quantity_list(DEFAULT_QUANTITIES if quantity is None else quantity)
    if quantity is None and not engine.places_known:
        asked = leave_out_unknown(engine, asked)
        warn_of_unknown_moments(name_file(path))
    found = scatter_engine(model, tolerances, asked, samples, seed, distribution.value)
    show([found], renderer, form, output)
