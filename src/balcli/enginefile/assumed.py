"""What an engine file leaves out, and what is taken for it."""

from __future__ import annotations

from collections.abc import Iterator

from .fields import Number
from .model import EngineFile

_TABLES = ("crank", "rod", "piston", "layout", "operation", "frame")
_TOLD = "left out: "  # in the description of a key: what follows is taken


def list_assumed(model: EngineFile) -> Iterator[str]:
    """Such as "operation.speed = 1000 rpm", or "rod.inertia: two masses at the ends"."""
    for name in _TABLES:
        table = getattr(model, name)
        for key, field in table.keys().items():
            if key in table.model_fields_set or f"{name}_{key}" in _not_needed(model):
                continue
            unit = next((m.dimension.unit for m in field.metadata if isinstance(m, Number)), "")
            if _TOLD in (field.description or ""):
                yield f"{name}.{key}: {(field.description or '').partition(_TOLD)[2]}"
            elif isinstance(field.default, int | float | str) and field.default is not False:
                yield f"{name}.{key} = {_plain(field.default)} {unit}".rstrip()
    if model.rod.mass is None and model.rod.small_end is None:
        yield "rod.mass: a rod without mass"


def _not_needed(model: EngineFile) -> set[str]:
    """Keys in whose place others stand, or that say nothing of this engine."""
    found = {"rod_inertia"} if model.rod.pendulum is not None else set()
    layout = model.layout
    one_throw = len(model.crank.throws or (0,)) == 1 and layout.firing_order is None
    one_bank = layout.bank_angle is None and layout.banks is None and layout.radial is None
    if one_bank:
        found |= {"crank_splay", "layout_rods", "layout_stagger"}
    if one_throw and one_bank:
        found |= {"layout_firing_intervals"}
    return found


def _plain(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:g}"
