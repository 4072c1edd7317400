"""`balcli scatter`"""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from ..enginefile.toml_text import name_file
from ..forces.kinds import DEFAULT_QUANTITIES
from ..render.scatter import RENDERER
from .file_names import text_format
from .options import EnginePath, FormatOption, Output
from .output import refuse_overwriting, show
from .progress import exit_if_cut_short, reporting_until_stopped


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
    from ..studies.scatter import Drawing, Variants, read_tolerances
    from .inputs import read_engine, warn_of_unknown_moments

    within = read_tolerances(mass, length, angle, stiffness)
    _, model, engine = read_engine(path, asked=())
    if quantity is None and not engine.places_known:
        warn_of_unknown_moments(name_file(path))
    variants = Variants(model, quantity, within)
    count = variants.usual if samples is None else samples
    with reporting_until_stopped("samples", count) as progress:
        found = variants.draw(Drawing(count, seed, distribution.value, progress))
    show([found], RENDERER, form, output)
    exit_if_cut_short(progress, "the figures are of these")
