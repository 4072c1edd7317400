"""`balcli torsion`"""

from __future__ import annotations

from typing import Annotated

import typer

from .file_names import text_format
from .options import FormatOption, Output
from .output import show
from .overwrite_guard import refuse_overwriting


def torsion(
    path: Annotated[
        str,
        typer.Argument(
            metavar="FILE",
            help="A chain of inertias and shafts (TOML); - reads standard input.",
            show_default=False,
        ),
    ],
    speeds: Annotated[
        str | None,
        typer.Option(
            metavar="A:B:STEP",
            show_default=False,
            help="Forced vibration at these speeds, rpm; or a list such as 1500,2000.",
        ),
    ] = None,
    orders: Annotated[
        str | None,
        typer.Option(
            metavar="0.5-12|1,2.5",
            show_default=False,
            help="Orders that excite, 0.5-8 with halves, 1-8 whole ones; default: all.",
        ),
    ] = None,
    holzer: Annotated[
        list[str] | None,
        typer.Option(
            metavar="MODE|FREQUENCY",
            show_default=False,
            help='Holzer\'s table of a mode, or at "20 rad/s", "12 Hz"; may be given again.',
        ),
    ] = None,
    form: FormatOption = None,
    output: Output = None,
) -> None:
    """Torsional vibration of shafts: natural modes, critical speeds, Holzer tables, and vibratory
    torque and stress over a range of speeds.

    `balcli new torsion chain.toml` writes a file to start from: nodes, shafts, gears, torques.
    """
    refuse_overwriting(reads=[path], writes={"--output": output})
    form = text_format(output, form)
    from ..render import torsion as renderer
    from ..torsion.analysis import Question, analyze_torsion
    from ..torsion.load import load_system
    from .torsion_options import parse_half_orders, parse_holzer, parse_speeds

    question = Question(parse_speeds(speeds), parse_half_orders(orders), parse_holzer(holzer))
    show([analyze_torsion(load_system(path), question)], renderer, form, output)
