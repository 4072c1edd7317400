"""An engine file with a body on mounts, or of these alone: read, checked, every mistake told."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from ..engine.assembly import Assembly
from ..engine.build import Engine
from ..engine.load import build_named
from ..engine.rules import find_contradictions
from ..enginefile.model import EngineFile
from ..enginefile.mounting_tables import Mount, Point
from ..enginefile.read import REQUIRED, Draft, read_tables
from ..enginefile.suspicious import NO_DISTANCE, doubt_losses
from ..enginefile.table_reader import refuse
from ..enginefile.toml_text import name_file, read_bytes
from ..enginefile.units import STANDARD_GRAVITY, ask_unit
from .build import find_mounting_faults

SAG_LEAST, SAG_MOST = 0.02, 200.0  # mm; rubber gives way by 1 to 20
NEAR_THE_ORIGIN = 2.0  # mm; no mount stands within the crankshaft
SMALL_BODY = 0.01  # radius of gyration over the distance of a mount; engines have 0.2 to 1


class MountedFile(NamedTuple):
    """A file with [body] and [[mount]], its engine if it has one, and what is doubted of it."""

    model: EngineFile
    engine: Engine | None
    doubts: tuple[str, ...]


def read_mounted(path: str | Path) -> MountedFile:
    """The file at a path, or on standard input for "-".

    Raises:
        BalcliError: there is nothing to read.
        InputError: every mistake that it has.
    """
    name = name_file(path)
    return check_mounted(read_tables(read_bytes(path), name, bare=True), name)


def check_mounted(draft: Draft, name: str) -> MountedFile:
    """The same of what could be read of a file; `name` is that of the file, for messages."""
    faults = list(find_mounting_faults(draft.model, draft.legible))
    has_engine = any(key in draft.model.model_fields_set for key in REQUIRED)
    if draft.problems or faults:
        whole = Assembly(draft.model, legible=draft.legible)
        contradictions = find_contradictions(whole) if has_engine and draft.problems else []
        raise refuse([*draft.problems, *contradictions, *faults], name)
    engine = build_named(draft.model, name) if has_engine else None
    doubts = () if engine is None else engine.unlikely
    return MountedFile(draft.model, engine, (*doubts, *_find_doubts(draft.model)))


def _find_doubts(model: EngineFile) -> Iterator[str]:
    """Yield what no body and no mounts have: most likely a figure in another unit."""
    body, mounts = model.body, model.mount
    if body is None:
        return
    moments = dict(zip(("xx", "yy", "zz"), body.inertia, strict=False))
    for name, value in moments.items():
        first, second = (other for other in moments if other != name)
        together = moments[first] + moments[second]
        if value > together:
            yield (
                f"body.inertia: {name} of {value:g} is more than {first} and {second} together "
                f"({together:g}), which no body has; are the axes right? z is the crankshaft's"
            )
    largest = max(moments.values())
    across = math.sqrt(largest / body.mass)
    farthest = max(math.dist(mount.at, body.cg) for mount in mounts)
    if across < SMALL_BODY * farthest:
        yield (
            f"body.inertia: {largest:g} kg mm^2 is that of {body.mass:g} kg within {across:.2g} "
            f"mm, and a mount stands {farthest:.3g} mm away; "
            f"{ask_unit('kg mm^2', f'{largest:g} kg m^2')}"
        )
    sag = STANDARD_GRAVITY * body.mass / sum(sum(mount.stiffness) / 3 for mount in mounts)
    if not SAG_LEAST <= sag <= SAG_MOST:
        yield (
            f"mount.stiffness: under its weight the body would sink by about {sag:.2g} mm, where "
            f"{SAG_LEAST:g} to {SAG_MOST:g} mm is usual; {ask_unit('N/mm', '250 kN/m')}"
        )
    lists: dict[str, Sequence[Mount | Point]] = {"mount": mounts, "point": model.point}
    for key, tables in lists.items():
        for number, each in enumerate(tables, 1):
            away = max(map(abs, each.at))
            if NO_DISTANCE < away < NEAR_THE_ORIGIN:
                yield (
                    f"{key}.{number}.at of '{each.name}' is within {away:.3g} mm of the origin; "
                    f"{ask_unit('mm', f'{away:.3g} m')}"
                )
    yield from doubt_losses((f"mount.{k}.loss", mount.loss) for k, mount in enumerate(mounts, 1))
