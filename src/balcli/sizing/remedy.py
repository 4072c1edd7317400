"""Remedy: the devices that a scheme fits to an engine, and the reasons."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from ..core.cylinders import Device, DeviceKind
from ..engine.engine import Engine, build_fitted
from ..file.model import Counterweight, EngineFile, Shaft, Slider
from .planes import KINDS, DeviceTable, find_free, name_kind

if TYPE_CHECKING:
    from .bobweights import Bobweight, FactorPeaks, PlaneNeed


class Remedy(NamedTuple):
    """New devices as tables of the engine file, with reasons and notes.

    Attributes:
        order: the order that is balanced, where the scheme has one.
        devices: counterweights, shafts and sliders, in this order.
        reasons: why each device is fitted, in the order of `devices`; of a remedy without devices,
            the other changes and their reasons.
        details: further figures of the scheme, as JSON has them: keys end in the unit, those of
            one order stand in a dict of their own.
        note: further information, such as why nothing is fitted.
        card: bobweights of all crank pins (scheme factor).
        needs: unbalance that each plane has and lacks, where the file has counterweights (scheme
            factor).
        sweep: largest values by factor, for several factors (scheme factor).
        knuckle_angles_deg: new `articulation.knuckle_angles` (scheme knuckles).
        beyond: devices that no engine file can describe, SI.
        start: engine to which the devices are fitted, where it is not the one of the file.
        step: name of the step of the ladder (schemes auto and step).
    """

    scheme: str
    order: int | None = None
    devices: tuple[DeviceTable, ...] = ()
    reasons: tuple[str, ...] = ()
    details: Mapping[str, Any] = {}
    note: str = ""
    card: tuple[Bobweight, ...] = ()
    needs: tuple[PlaneNeed, ...] = ()
    sweep: tuple[FactorPeaks, ...] = ()
    knuckle_angles_deg: tuple[float, ...] = ()
    beyond: tuple[Device, ...] = ()
    start: Engine | None = None
    step: str = ""

    @property
    def counterweights(self) -> tuple[Counterweight, ...]:
        """Devices on the crankshaft."""
        return tuple(device for device in self.devices if isinstance(device, Counterweight))

    @property
    def shafts(self) -> tuple[Shaft, ...]:
        """Eccentrics of balancer shafts."""
        return tuple(device for device in self.devices if isinstance(device, Shaft))

    @property
    def sliders(self) -> tuple[Slider, ...]:
        """Devices that go to and fro."""
        return tuple(device for device in self.devices if isinstance(device, Slider))

    @property
    def free(self) -> tuple[bool, ...]:
        """For each of `devices`, whether it may stand anywhere (`planes.find_free`)."""
        return find_free(self.devices)

    def add_devices(self, added: Iterable[DeviceTable], reason: str) -> Remedy:
        """Return the remedy with further devices, all for the same reason."""
        pairs = list(zip(self.devices, self.reasons, strict=True))
        pairs += [(device, reason) for device in added]
        pairs.sort(key=lambda pair: KINDS.index(type(pair[0])))
        return self._replace(
            devices=tuple(device for device, _ in pairs), reasons=tuple(why for _, why in pairs)
        )

    def add_details(self, group: str = "", /, **figures: object) -> Remedy:
        """Return the remedy with further details.

        Args:
            group: Name of the dict in which they stand, such as `order_2`; empty: in none.
            figures: Details by their keys.
        """
        if group:
            figures = {group: {**self.details.get(group, {}), **figures}}
        return self._replace(details={**self.details, **figures})


def fit_devices(engine: Engine, remedy: Remedy) -> Engine:
    """Return the engine with the devices of a remedy added, in the order of its file's tables."""
    new = (build_fitted(table, engine) for table in remedy.devices)
    everything = (*engine.devices, *new, *remedy.beyond)
    devices = tuple(sorted(everything, key=lambda device: device.kind))
    return replace(engine, devices=devices, model=_fit_model(engine.model, remedy))


def remove_counterweights(engine: Engine) -> Engine:
    """Return the engine without the counterweights of its file."""
    devices = tuple(d for d in engine.devices if d.kind is not DeviceKind.COUNTERWEIGHT)
    model = engine.model and engine.model.model_copy(update={"counterweight": ()})
    return replace(engine, devices=devices, model=model)


def _fit_model(model: EngineFile | None, remedy: Remedy) -> EngineFile | None:
    """Return the file with the devices of a remedy; None if no file can describe them."""
    if model is None or remedy.beyond:
        return None
    added: dict[str, tuple[DeviceTable, ...]] = {}
    for device in remedy.devices:
        kind = name_kind(device)
        added[kind] = (*added.get(kind, getattr(model, kind)), device)
    return model.model_copy(update=added)
