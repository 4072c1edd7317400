"""An engine file with a body on mounts, or of these alone: read, checked, every mistake told."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from ..engine.assembly import Assembly
from ..engine.build import Engine
from ..engine.load import build_named
from ..engine.rules import find_contradictions
from ..enginefile.model import EngineFile
from ..enginefile.read import REQUIRED, read_tables
from ..enginefile.toml_text import name_file, read_bytes
from .build import find_mounting_faults


class MountedFile(NamedTuple):
    """A file with [body] and [[mount]], and its engine, if it has one."""

    model: EngineFile
    engine: Engine | None


def read_mounted(path: str | Path) -> MountedFile:
    """The file at a path, or on standard input for "-".

    Raises:
        BalcliError: there is nothing to read.
        InputError: every mistake that it has.
    """
    text, name = read_bytes(path), name_file(path)
    draft = read_tables(text, name, bare=True)
    faults = list(find_mounting_faults(draft.model, draft.legible))
    has_engine = any(key in draft.model.model_fields_set for key in REQUIRED)
    if draft.has_mistakes or faults:
        whole = Assembly(draft.model, legible=draft.legible)
        contradictions = find_contradictions(whole) if has_engine and draft.has_mistakes else []
        raise draft.refusal([*contradictions, *faults], name)
    engine = build_named(draft.model, path) if has_engine else None
    return MountedFile(draft.model, engine)
