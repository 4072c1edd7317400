"""`balcli layouts`: free forces and moments of common engines at a glance."""

from __future__ import annotations

from ..render.layouts import RENDERER
from .file_names import text_format
from .options import FormatOption, Output
from .output import show


def layouts(form: FormatOption = None, output: Output = None) -> None:
    """Free forces and moments of common engines at a glance, as multiples of one cylinder's.

    \b
    Examples:
      balcli layouts
      balcli layouts --format markdown
    """
    form = text_format(output, form)
    from ..printed_tables.layouts import add_firing
    from ..printed_tables.registry import recompute

    show([add_firing(recompute("layouts"))], RENDERER, form, output)
