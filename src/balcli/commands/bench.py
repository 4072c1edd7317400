"""`balcli bench`"""

from __future__ import annotations

from ..render.formats import Format
from .options import FormatOption, Output


def bench(
    format: FormatOption = Format.TABLE,  # noqa: A002 (the option's name)
    output: Output = None,
) -> None:
    """Run time against error of every way to the same figures, on this machine; with -o X.svg also
    as a picture.
    """
    from ..bench.bench import bench as measured
    from ..render import bench as rendered
    from ..render.formats import render
    from .output import emit, write

    found = measured()
    if output is not None and output.suffix == ".svg":
        write(rendered.draw(found), output)
        output = None
    emit(
        render(
            format,
            sheets=lambda: [rendered.sheet(found)],
            documents=lambda: [rendered.document(found)],
            rows=lambda: rendered.rows(found),
            into_file=output is not None,
        ),
        output,
    )
