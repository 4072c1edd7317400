"""List the defaults that count where an engine file leaves keys out."""

from __future__ import annotations

from collections.abc import Iterator

from .fields import Number
from .model import EngineFile

_TABLES = ("crank", "rod", "piston", "layout", "operation", "frame")
_TOLD = "left out: "  # in the description of a key: what follows is taken


def list_assumed(model: EngineFile) -> Iterator[str]:
    """Yield each default in words, such as "operation.speed = 1000 rpm", or "rod.inertia: two
    masses at the ends".
    """
    idle = _list_idle(model)
    for name in _TABLES:
        table = getattr(model, name)
        for key, field in table.keys().items():
            path = f"{name}.{key}"
            if key in table.model_fields_set or path in idle:
                continue
            _, told, taken = (field.description or "").partition(_TOLD)
            unit = next((m.dimension.unit for m in field.metadata if isinstance(m, Number)), "")
            if told:
                yield f"{path}: {taken}"
            elif isinstance(field.default, str):
                yield f"{path} = {field.default}"
            elif isinstance(field.default, int | float) and field.default is not False:
                yield f"{path} = {field.default:g} {unit}".rstrip()
    if model.rod.mass is None and model.rod.small_end is None:
        yield "rod.mass: a rod without mass"


def _list_idle(model: EngineFile) -> set[str]:
    """Return keys in whose place others stand, or that have no effect in this engine."""
    found = {"rod.inertia"} if model.rod.pendulum is not None else set()
    layout = model.layout
    one_throw = len(model.crank.throws or (0,)) == 1 and layout.firing_order is None
    one_bank = layout.bank_angle is None and layout.banks is None and layout.radial is None
    if one_bank:
        found |= {"crank.splay", "layout.rods", "layout.stagger"}
    if one_throw and one_bank:
        found |= {"layout.firing_intervals"}
    return found
