"""`balcli bench`"""

from __future__ import annotations

from ..render.formats import Format
from .file_names import TEXTS, format_of
from .options import FormatOption, Output
from .output import show, write_file


def bench(form: FormatOption = None, output: Output = None) -> None:
    """Run time against error of every way to the same figures, on this machine; with -o X.svg also
    as a picture.

    \b
    Example:
      balcli bench -o bench.svg
    """
    from ..bench import measure
    from ..render.bench import RENDERER, draw_bench

    chosen = format_of(output, form, {**TEXTS, ".svg": "svg"}, "table")
    found = measure()
    if output is not None and chosen == "svg":
        write_file(draw_bench(found), output)
        chosen, output = "table", None
    show([found], RENDERER, Format(chosen), output)
