"""How options are declared: one that may be left out is a line."""

from __future__ import annotations

from typing import Any

import typer


def optional(metavar: str, text: str, *names: str, **more: Any) -> Any:
    """An option that says nothing of a default, as it is left out unless it is asked for.

    Args:
        metavar: what stands for its value in help.
        text: its help.
        names: as typed, such as --scheme; by default that of the parameter.
        more: of `typer.Option`.
    """
    return typer.Option(*names, metavar=metavar, show_default=False, help=text, **more)
