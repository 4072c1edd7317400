"""The command `balcli field`: its options."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from ..errors import BalcliError, Exit
from ..file.toml import name_file, read_bytes
from ..shell.file_names import picture_form, text_format
from ..shell.inputs import warn_each
from ..shell.options import FormatOption, Output, UnitsOption
from ..shell.output import refuse_overwriting, show, write_figure
from ..shell.values import argument, optional
from ..show.formats import Units


def field(
    path: Annotated[str, argument("RUNS", "Readings of all runs (TOML); - reads standard input.")],
    minimise: Annotated[
        Literal["squares", "max"],
        typer.Option(help="Minimise the sum of squared readings, or (max) the largest reading."),
    ] = "squares",
    without: Annotated[
        list[str] | None, optional("PLANE", "Leave this plane out; repeat for more planes.")
    ] = None,
    plot: Annotated[
        Path | None, optional("FILE", "Draw readings and weights; .svg, .png or .pdf.")
    ] = None,
    check: Annotated[
        bool, typer.Option("--check", help="Exit status 1 unless all planes reach the grade.")
    ] = False,
    form: FormatOption = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Balance a rotor on its machine: from readings with trial weights, compute correction weights,
    places or drill holes, and the remaining readings.

    `balcli new field runs.toml` writes a file to start from: planes, a run as found, and a run with
    a trial weight for each plane. Weights and readings are printed in the units of the file.

    With an instrument that shows no phase, write readings as bare numbers (`readings = [6.2]`). One
    plane then needs four runs (as found, and a trial weight at three angles such as 0, 120 and 240
    deg), two planes need seven. `balcli new four-runs runs.toml` writes a file to start from. After
    three runs in one plane, two answers are printed.

    \b
    Examples:
      balcli field runs.toml
      balcli field runs.toml --plot weights.svg
    """
    refuse_overwriting(reads=[path], writes={"--output": output, "--plot": plot})
    form = text_format(output, form)
    drawn = picture_form(plot, "--plot") if plot is not None else None
    from . import answer, runs_file, show as pages

    name = name_file(path)
    file = runs_file.parse_runs(read_bytes(path), name)
    if check and (missing := answer.list_missing(file)):
        raise BalcliError(f"{name}: --check needs {', '.join(missing.values())}")
    result = answer.find_corrections(file, minimise, without or (), name)
    warn_each(result.doubts, name)
    if plot is not None and drawn is not None:
        write_figure(pages.make_field(result), drawn, plot)
    show([result], pages.RENDERER, form, output, units)
    permitted = result.permitted
    if check and (result.ambiguous or (permitted is not None and not permitted.reached)):
        raise typer.Exit(Exit.DIFFERENCE)
