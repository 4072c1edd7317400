"""Write the outlines of webs as DXF files (`balcli plot FILE web.dxf --what webs`)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ..analysis.parts import find_parts
from ..engine.engine import Engine, refuse_geared
from ..engine.webs.bodies import WebShape
from ..engine.webs.write_dxf import write_drawing
from ..errors import ArgumentError, BalcliError, warn
from ..file.toml import name_file
from ..shell.inputs import read_engine, warn_each
from ..shell.output import refuse_overwriting, write_file

_PAGE = ("webs",)


def write_outlines(path: str, target: Path, pages: Sequence[str], scheme: str | None) -> list[Path]:
    """Write the outline of each kind of web of an engine file; return the names of the files: the
    target, or for several [[web]] tables the target with the number of each (`web-2.dxf`).

    Args:
        path: Path of the engine file.
        target: DXF file to write.
        pages: Pages of `--what`; only webs can be written.
        scheme: Balance scheme; none can be drawn.

    Raises:
        BalcliError: The pages or the scheme do not suit, the file has no webs with an outline, or a
            file cannot be written.
    """
    if tuple(pages) != _PAGE:
        raise ArgumentError(
            "{file}: a .dxf file has the outlines of webs alone; give {what} webs", file=target
        )
    if scheme is not None:
        raise ArgumentError(
            "{what} webs shows the engine as it is: leave {scheme} and its options out"
        )
    name = name_file(path)
    engine = read_engine(path).engine
    outlines = _find_outlines(engine, name)
    assert engine.webs is not None
    files = [target]
    if len(engine.webs.kinds) > 1:
        files = [target.with_stem(f"{target.stem}-{table}") for table in outlines]
    names = (f"web.{table}" for table in outlines)
    refuse_overwriting(reads=[path], writes=dict(zip(names, files, strict=True)))
    warn_of_webs(engine, name)
    for file, shape in zip(files, outlines.values(), strict=True):
        write_file(write_drawing(shape), file)
    return files


def warn_of_webs(engine: Engine, name: str) -> None:
    """Warn of webs that come too near to a piston or the crankcase.

    Args:
        engine: Engine.
        name: Name of its file.
    """
    warn_each(find_parts(engine, (), ()).doubts, name)


def _find_outlines(engine: Engine, name: str) -> dict[int, WebShape]:
    """Return the outline of each [[web]] table that has one, by the number of the table.

    Args:
        engine: Engine.
        name: Name of its file, for messages.
    """
    refuse_geared(engine)
    if engine.webs is None:
        raise BalcliError(f"{name}: has no [[web]]; describe the webs of the crankshaft there")
    outlines = {}
    weighed = []
    for table, webs in engine.webs.kinds.items():
        if (shape := webs[0].body.shape) is None:
            weighed.append(f"web.{table}")
        else:
            outlines[table] = shape
    told = f"{name}: no outline is known for {', '.join(weighed)}, given by mass"
    if not outlines:
        raise BalcliError(f"{told}; give hub and boss, or profile")
    if weighed:
        warn(told)
    return outlines
