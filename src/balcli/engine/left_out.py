"""List the values that are used for keys which a file leaves out, if results depend on them."""

from __future__ import annotations

from collections.abc import Container, Iterator
from typing import TYPE_CHECKING

from ..core.phases import TURN
from ..file.assumed import DEVICES, Assumed, assume
from ..file.doubts import list_keys_between_throws
from ..file.firing_order import NamedOrder
from ..file.model import EngineFile, RodKeys, Shaft
from ..file.table import FileTable
from ..file.units import INERTIA
from .firing.fits import count_throws_from_first, list_gaps
from .firing.letters import describe_letters
from .firing.together import list_together
from .firing.usual import list_numbers
from .layout import TOLERANCE_DEG, are_places_known, bank_angles, find_row_angle
from .parts import Parts

if TYPE_CHECKING:
    from ..file.gas_tables import Gas
    from ..file.torsion_tables import Torsion

# Largest bank angle of a vee with one head, whose cylinder axes pass beside the crank axis.
NARROW_DEG = 30.0
# Decimals of computed angles (deg), and significant digits of other computed values; further digits
# are rounding errors.
_DECIMALS = 9
_DIGITS = 12


def list_inferred(parts: Parts) -> Iterator[Assumed]:
    """Yield the values used for keys that a file leaves out: firing, crank, rods, piston offset,
    gas, and the defaults of torsion and mounts. Variants of an engine have none.
    """
    if parts.rank:
        return
    yield from _list_firing(parts)
    yield from _list_crank_defaults(parts)
    yield from _list_rod_defaults(parts)
    if _is_narrow_vee(parts) and not _has_offset(parts.model):
        piston = parts.model.piston
        yield assume("piston.offset", piston, piston.offset)
    if parts.model.gas is not None:
        yield from _list_gas_defaults(parts, parts.model.gas)
    yield from _list_device_defaults(parts.model)
    yield from list_chapter_defaults(parts.model)


def _list_firing(parts: Parts) -> Iterator[Assumed]:
    """Yield numbering, throws, intervals and strokes that the file does not give."""
    if parts.order is None:
        return
    crank = parts.model.crank
    layout = parts.model.layout
    has_gas = parts.model.gas is not None
    throws_inferred = not parts.throws_given
    counts = throws_inferred or has_gas
    order = layout.firing_order
    lettered = isinstance(order, NamedOrder)
    if parts.plan.banks > 1 and not layout.has("numbering") and (counts or lettered):
        yield assume("layout.numbering", layout, list_numbers(parts.plan))
    if isinstance(order, NamedOrder):
        yield assume("layout.firing_order", layout, describe_letters(order))
    if throws_inferred:
        yield assume("crank.throws", crank, tuple(count_throws_from_first(parts)))
    gaps = tuple(round(gap, _DECIMALS) for gap in list_gaps(parts))
    # The crank does not determine in which of its turns a cylinder of a four-stroke fires.
    open_turn = has_gas and len(gaps) > 1 and max(gaps) > TURN + TOLERANCE_DEG
    inferred = throws_inferred or open_turn or list_together(parts)
    if layout.firing_intervals is None and inferred:
        yield assume("layout.firing_intervals", layout, gaps)
    if not layout.has("strokes") and counts:
        yield assume("layout.strokes", layout, layout.strokes)


def _list_crank_defaults(parts: Parts) -> Iterator[Assumed]:
    """Yield speed, throws, positions, masses and inertias that the file does not give."""
    model = parts.model
    throws = parts.plan.throws
    crank = model.crank
    layout = model.layout
    running = model.operation
    if not running.has("speed"):
        yield assume("operation.speed", running, running.speed)
    if crank.throws is None and parts.order is None and throws == 2:
        yield assume("crank.throws", crank, (0.0, 180.0))
    if list_keys_between_throws(model):
        yield assume("crank.throws", crank, (0.0,))
    if layout.rows is not None and layout.row_angle is None:
        turn = find_row_angle(layout, throws, parts.figures)
        yield assume("layout.row_angle", layout, float(turn))
    if not are_places_known(model, parts.plan):
        yield assume("crank.spacing", crank, 0.0)
    if parts.plan.rods_on_throw > 1 and model.articulation is None and not layout.has("stagger"):
        yield assume("layout.stagger", layout, layout.stagger)
    if not (crank.has("throw_mass") or layout.rotary or model.web):
        yield assume("crank.throw_mass", crank, 0.0)
    weighed = any(one.inertia or one.sector for one in model.counterweight)
    is_uneven = model.flywheel is not None or running.speed_ripple
    if crank.inertia is None and is_uneven and not (weighed or model.web):
        yield assume("crank.inertia", crank, 0.0)
    if crank.inertia is not None and model.flywheel is None:
        yield Assumed("flywheel.inertia", 0.0, INERTIA.unit)


def _list_rod_defaults(parts: Parts) -> Iterator[Assumed]:
    """Yield mass, centre of mass and inertia of the rods that the file does not give. The inertia
    of a rod is that of two masses at its ends.
    """
    rod = parts.model.rod
    hinged = parts.model.articulation
    if rod.mass is None and rod.small_end is None:
        yield assume("rod.mass", rod, 0.0)
    if rod.mass and rod.cg is None:
        yield assume("rod.cg", rod, 0.0)
    rods: dict[str, RodKeys] = {"rod": rod}
    if hinged is not None:
        rods["articulation.rod"] = hinged.rod
    for path, table in rods.items():
        gear = parts.weigh_gear(parts.find_rod(0, table is not rod))
        of_two_masses = float(f"{1e6 * float(gear.spin):.{_DIGITS}g}")
        if of_two_masses > 0 and table.inertia is None and table.pendulum is None:
            yield assume(f"{path}.inertia", table, of_two_masses)


def _list_device_defaults(model: EngineFile) -> Iterator[Assumed]:
    """Yield angles and places of counterweights, shafts and sliders that the file does not give;
    one value stands for all devices of a kind. Shafts without a fixed phase to the crank are not
    among the forces of the engine.
    """
    for (kind, key), numbers in _find_lacking(model).items():
        table = getattr(model, kind)[numbers[0] - 1]
        yield assume(f"{kind}.{key}", table, getattr(table, key))


def list_varied_defaults(model: EngineFile, varied: Container[str]) -> Iterator[str]:
    """Yield the names of angles and places of devices that the file does not give, if all of them
    vary.

    Args:
        model: Engine file.
        varied: Names of the figures that vary.
    """
    for (kind, key), numbers in _find_lacking(model).items():
        if all(f"{kind}.{number}.{key}" in varied for number in numbers):
            yield f"{kind}.{key}"


def _find_lacking(model: EngineFile) -> dict[tuple[str, str], list[int]]:
    """Return the numbers of the devices that lack a key, by their kind and this key."""
    lacking: dict[tuple[str, str], list[int]] = {}
    for kind in DEVICES:
        for number, table in enumerate(getattr(model, kind), 1):
            drifts = isinstance(table, Shaft) and table.drifts
            for key in ("angle", "position", "at"):
                if _lacks(table, key) and not drifts:
                    lacking.setdefault((kind, key), []).append(number)
    return lacking


def _lacks(table: FileTable, key: str) -> bool:
    """Return whether a table has a key that the file leaves out."""
    return key in type(table).model_fields and not table.has(key)


def _is_narrow_vee(parts: Parts) -> bool:
    """Return whether the engine is a vee with one head, whose cylinder axes usually pass beside the
    crank axis.
    """
    angles = [float(angle) for angle in bank_angles(parts.model.layout, parts.figures)]
    if len(angles) != 2:
        return False
    vee = abs((angles[1] - angles[0] + 180) % TURN - 180)
    return 0 < vee < NARROW_DEG


def _has_offset(model: EngineFile) -> bool:
    """Return whether the file gives an offset for all pistons, or for at least one of them."""
    of_cylinders = (cylinder.piston_offset for cylinder in model.cylinder.values())
    return model.piston.has("offset") or any(offset is not None for offset in of_cylinders)


def _list_gas_defaults(parts: Parts, gas: Gas) -> Iterator[Assumed]:
    """Yield the defaults of [gas] that count for measured or computed pressures."""
    diagrams = sum(one.indicator is not None for one in parts.model.cylinder.values())
    measured = gas.has("indicator") or diagrams > 0
    computed = gas.cycle is not None and diagrams < len(parts.plan.cells)
    yield from gas.list_assumed(parts.model.layout.strokes, measured, computed)
    piston = parts.model.piston
    own_rods = (one.piston_rod_diameter is not None for one in parts.model.cylinder.values())
    if gas.has_crank_ends and not piston.has("rod_diameter") and not any(own_rods):
        yield assume("piston.rod_diameter", piston, piston.rod_diameter)


def list_chapter_defaults(model: EngineFile) -> Iterator[Assumed]:
    """Yield the defaults on which results of torsion and mounts depend. For lists, one value stands
    for all members: `mount.dynamic_factor`.
    """
    torsion = model.torsion
    body = model.body
    if torsion is not None:
        for end, parts in (("front", torsion.front), ("rear", torsion.rear)):
            of_steel = (part for part in parts if part.is_of_unnamed_steel)
            if part := next(of_steel, None):
                yield assume(f"torsion.{end}.shear_modulus", part, part.shear_modulus)
        if not (torsion.has("loss") or torsion.has("damping")):
            yield assume("torsion.loss", torsion, torsion.loss)
        yield from _list_rated_speeds(torsion, model.operation.speed)
    if body is not None and not body.has("gravity"):
        yield assume("body.gravity", body, body.gravity)
    if body is not None and model.has_gas and not body.has("carries_load"):
        yield assume("body.carries_load", body, body.carries_load)
    undamped = [mount for mount in model.mount if not (mount.has("loss") or mount.has("damping"))]
    if undamped:
        yield assume("mount.loss", undamped[0], undamped[0].loss)
    as_static = [mount for mount in model.mount if not mount.has("dynamic_factor")]
    if as_static:
        yield assume("mount.dynamic_factor", as_static[0], as_static[0].dynamic_factor)


def _list_rated_speeds(torsion: Torsion, speed_rpm: float) -> Iterator[Assumed]:
    """Yield the speed of the file as the rated speed of rules and laws that name none."""
    from ..file.torsion_tables import StressLimit  # loaded only for files with [torsion]

    for end, parts in (("front", torsion.front), ("rear", torsion.rear)):
        for part in parts:
            limit = part.limit
            if isinstance(limit, StressLimit) and limit.rule and limit.rated_speed is None:
                yield assume(f"torsion.{end}.limit.rated_speed", limit, speed_rpm)
                break
    for entry in torsion.excitation:
        if entry.law is not None and entry.rated_speed is None:
            yield assume("torsion.excitation.rated_speed", entry, speed_rpm)
            break
