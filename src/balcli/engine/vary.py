"""An engine and other values of keys of its file -> the engine that the file then describes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..enginefile.plain_tables import change_tables
from ..errors import InputError, naming_file, wrong_type
from .build import Engine, build, take_model
from .load import parse_dict

# Changes that leave it out.
NO_FIRING_ORDER: dict[str, Any] = {"layout.firing_order": None, "layout.firing_intervals": None}


def vary_engine(engine: Engine, changes: Mapping[str, Any]) -> Engine:
    """The engine of the same file with other values of some keys, by dotted names; errors as of
    `Engine.vary`.
    """
    for path in changes:
        if not isinstance(path, str):
            raise wrong_type("vary", path, 'name a key of the engine file, such as "rod.length"')
    model = take_model(engine)
    changes = dict(changes)
    try:
        return _build(engine, changes)
    except InputError:
        kept = model.crank.throws is None or model.gas is not None
        if kept or model.layout.firing_order is None or NO_FIRING_ORDER.keys() & changes.keys():
            raise
        first = NO_FIRING_ORDER | changes
    try:
        return _build(engine, first)
    except InputError:
        return _build(engine, changes)  # with all that is wrong of it


def _build(engine: Engine, changes: Mapping[str, Any]) -> Engine:
    model = take_model(engine)
    name = f"{engine.name or 'engine'} with {', '.join(changes)}"
    with naming_file(name):
        return build(parse_dict(change_tables(model, changes), model.folder))
