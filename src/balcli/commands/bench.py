"""`balcli bench`"""

from __future__ import annotations

from ..render.formats import Format
from .options import FormatOption, Output
from .output import show, write_file


def bench(form: FormatOption = Format.TABLE, output: Output = None) -> None:
    """Run time against error of every way to the same figures, on this machine; with -o X.svg also
    as a picture.
    """
    from ..bench.bench import bench as measure
    from ..render import bench as renderer

    found = measure()
    if output is not None and output.suffix == ".svg":
        write_file(renderer.draw(found), output)
        output = None
    show([found], renderer, form, output)
