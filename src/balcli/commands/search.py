"""`balcli search`"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..enginefile.toml_text import name_file, read_bytes
from ..errors import naming_file
from ..limits import MOST_FOUND
from ..render.search import RENDERER
from .declare import optional
from .file_names import require_ending, text_format
from .options import EnginePath, FormatOption, Output
from .output import refuse_leaving_files, refuse_overwriting, show, write_file
from .progress import exit_if_cut_short, reporting, reporting_until_stopped

if TYPE_CHECKING:
    from ..enginefile.model import EngineFile


def search(
    path: EnginePath,
    over: Annotated[
        list[str],
        optional(
            "throws|firing_order|bank_angle|splay|NUMBER=FROM:TO",
            "What to arrange: the file's throw angles along the crank (or those of its firing "
            "order), the firing order, the angle of the vee, or of its split pins; or any number "
            "of the file in a range, such as mount.left.loss=0.05:0.3. Several numbers and angles "
            "are searched together.",
            "--over",
        ),
    ],
    minimise: Annotated[
        str | None,
        optional(
            "WHAT[=WEIGHT],...",
            "What should be small, such as moment.1.major,force.2.major=0.5; any quantity that "
            "sweep has, such as shaft.flywheel.torque.",
            "--minimise",
            "--minimize",
        ),
    ] = None,
    maximise: Annotated[
        str | None,
        optional(
            "WHAT[=WEIGHT],...",
            "What should be large, instead of --minimise.",
            "--maximise",
            "--maximize",
        ),
    ] = None,
    limit: Annotated[
        list[str] | None,
        optional(
            "WHAT<VALUE",
            "What must stay below a value (N, N·m, Hz, Pa), such as 'moment.2.major<100'.",
            "--limit",
        ),
    ] = None,
    require: Annotated[
        str,
        optional("even-firing", "even-firing: only what can fire at even intervals.", "--require"),
    ] = "",
    top: Annotated[
        int, typer.Option("--top", min=1, max=MOST_FOUND, help="How many to show.")
    ] = 10,
    form: FormatOption = None,
    output: Output = None,
    write: Annotated[
        Path | None, optional("OUT.toml", "Write the engine file with the best one.", "--write")
    ] = None,
) -> None:
    """The best crank, firing order, bank angle or splay, or values of any numbers; mirror images
    and rotations once.

    \b
    Example:
      balcli search v8.toml --over throws --minimise moment.1.major
    """
    refuse_overwriting(reads=[path], writes={"--output": output, "--write": write})
    form = text_format(output, form)
    require_ending(write, ".toml", "--write")
    from ..engine.parse import parse
    from ..studies.search.designs import write_design
    from ..studies.search.objective import parse_objective
    from ..studies.search.search import search_arrangements

    if require not in ("", "even-firing"):
        message = f'"{require}": only even-firing can be required'
        raise typer.BadParameter(message, param_hint="--require")
    text, name = read_bytes(path), name_file(path)
    model = parse(text, name)
    with naming_file(name):
        _doubt(model, over, name)
    if write is not None:
        refuse_leaving_files(text, path, write)
    with_gas = model.gas is not None
    goal = parse_objective(minimise, limit or (), maximise=maximise, with_gas=with_gas)
    watching = reporting if any("=" in one for one in over) else reporting_until_stopped
    with watching("arrangements") as progress, naming_file(name):
        found = search_arrangements(model, over, goal, top, bool(require), progress)
    show([found], RENDERER, form, output)
    if write is not None:
        write_file(write_design(text, found.results[0].design, name), write)
    exit_if_cut_short(progress, "these are the best of them")


def _doubt(model: EngineFile, over: list[str], name: str) -> None:
    """Warn of what is unlikely in the file, except of what is arranged or varies."""
    from ..engine.build import build
    from .inputs import warn_each

    varied = [text.partition("=")[0] for text in over]
    warn_each((d for d in build(model).unlikely if not any(one in d for one in varied)), name)
