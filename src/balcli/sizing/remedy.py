"""Define `Remedy`: the devices that a scheme fits to an engine, with the reasons."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from ..core.cylinders import Device
from ..engine.engine import Engine
from ..engine.placed import build_fitted
from ..file.model import Counterweight, EngineFile, Shaft, Slider
from .planes import KINDS, DeviceTable, name_kind, round_figures

if TYPE_CHECKING:
    from ..file.web_tables import Web
    from .bobweights import Bobweight, FactorPeaks, PlaneNeed


class MomentLeft(NamedTuple):
    """The moment that one eccentric leaves, because it cancels only a force.

    Attributes:
        ratio: Speed ratio of its shaft.
        moment_Nm: The moment, which turns with the shaft.
    """

    ratio: int
    moment_Nm: float


class PartsBeyond(NamedTuple):
    """Parts for which an engine file has no table.

    Attributes:
        number: Number of the parts.
        mass_kg: Their mass, each at its radius.
    """

    number: int
    mass_kg: float


class WebCure(NamedTuple):
    """A way to make the unbalance for which a counterweight of a web has no room. What does not
    apply is left out.

    Attributes:
        remedy: "pin bore": a bore through the pin and both webs of the throw. "lightening": mass to
            take from the web at the crank radius. "outer radius": that of the counterweight. "heavy
            metal": a tungsten slug through the counterweight, 3 mm inside its rim.
        diameter_m: Diameter of the bore or slug; left out if no slug is large enough.
        mass_kg: Mass to take away, or mass of the slug.
        radius_m: Outer radius.
        enough: Whether pin, room or counterweight have room for it; left out if that is not known.
    """

    remedy: str
    diameter_m: float | None = None
    mass_kg: float | None = None
    radius_m: float | None = None
    enough: bool | None = None


class FittedWeb(NamedTuple):
    """A web whose counterweight is fitted, SI units.

    Attributes:
        web: Number of the web, from the free end.
        key: Key of its table that is fitted: "opening", "outer_radius" or "thickness".
        wanted: Unbalance that the web is to have, in its own axes.
        of_counterweight: Unbalance that its counterweight alone is to have.
        room: Unbalance of the largest counterweight that fits; None if the wanted one fits.
        cures: Ways to make what does not fit.
    """

    web: int
    key: str
    wanted: complex
    of_counterweight: float
    room: float | None = None
    cures: tuple[WebCure, ...] = ()

    @property
    def missing(self) -> float | None:
        """Unbalance that does not fit; None if the counterweight fits."""
        return None if self.room is None else self.of_counterweight - self.room


class FittedTable(NamedTuple):
    """A table [[web]] with figures in place of "fit".

    Attributes:
        number: Number of the table in the file, from 1.
        tables: Tables in its place: several if its webs come out unequal.
    """

    number: int
    tables: tuple[Web, ...]


class Remedy(NamedTuple):
    """New devices as tables of the engine file, with reasons and notes.

    Attributes:
        scheme: Name of the scheme.
        order: Order that is balanced, if the scheme balances only one.
        devices: Counterweights, shafts and sliders, in this order.
        reasons: Reason for each device, in the order of `devices`; without devices, reasons for
            other changes.
        details: Further figures of the scheme in the form of JSON: keys end in the unit; figures of
            one order may be in a dict of their own.
        note: Further information, such as why nothing is fitted.
        card: Bobweights of all crank pins (scheme factor).
        needs: Unbalance that each plane needs, has and lacks, if the file has counterweights
            (scheme factor).
        sweep: Largest values for each of several factors (scheme factor).
        knuckle_angles_deg: New `articulation.knuckle_angles` (scheme knuckles).
        beyond: Devices that no engine file can describe, in SI units: one for each order.
        parts_beyond: The parts of which `beyond` are the orders; None: there are no such parts.
        start: Engine to which the devices are fitted, if it is not the engine of the file.
        step: Name of the step of the ladder whose row is fitted (scheme step).
        steps: Names of the steps of the ladder whose devices are fitted (scheme auto, and scheme
            step with several steps); None for other schemes.
        moments_left: Moments that shafts with one eccentric leave (schemes auto, step and
            complete with a position).
        webs: Webs whose counterweights are fitted, from the free end.
        web_tables: Their tables with the fitted figures.
        web_reason: Reason for their counterweights; empty without such webs.
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
    parts_beyond: PartsBeyond | None = None
    start: Engine | None = None
    step: str = ""
    steps: tuple[str, ...] | None = None
    moments_left: tuple[MomentLeft, ...] = ()
    webs: tuple[FittedWeb, ...] = ()
    web_tables: tuple[FittedTable, ...] = ()
    web_reason: str = ""

    @property
    def every_reason(self) -> tuple[str, ...]:
        """Reasons for fitted webs and for the devices."""
        return (self.web_reason, *self.reasons) if self.web_reason else self.reasons

    @property
    def counterweights(self) -> tuple[Counterweight, ...]:
        """Counterweights among the devices."""
        return tuple(device for device in self.devices if isinstance(device, Counterweight))

    @property
    def shafts(self) -> tuple[Shaft, ...]:
        """Eccentrics of balancer shafts among the devices."""
        return tuple(device for device in self.devices if isinstance(device, Shaft))

    @property
    def sliders(self) -> tuple[Slider, ...]:
        """Sliders among the devices."""
        return tuple(device for device in self.devices if isinstance(device, Slider))

    def add_devices(self, added: Iterable[DeviceTable], reason: str) -> Remedy:
        """Return the remedy with further devices, all for the same reason. Their figures have the
        digits that a file has, so that a written file has exactly these devices.
        """
        return self._add_pairs((round_figures(device), reason) for device in added)

    def _add_pairs(self, added: Iterable[tuple[DeviceTable, str]]) -> Remedy:
        """Return the remedy with further devices, each with its reason."""
        pairs = [*zip(self.devices, self.reasons, strict=True), *added]
        pairs.sort(key=lambda pair: KINDS.index(type(pair[0])))
        devices = tuple(device for device, _ in pairs)
        return self._replace(devices=devices, reasons=tuple(reason for _, reason in pairs))

    def add_details(self, group: str = "", /, **figures: object) -> Remedy:
        """Return the remedy with further details.

        Args:
            group: Name of the dict in `details` that takes the further details, such as `order_2`;
                empty: they are added to `details` itself.
            figures: Details by their keys.
        """
        if group:
            figures = {group: {**self.details.get(group, {}), **figures}}
        return self._replace(details={**self.details, **figures})


def join_remedies(scheme: str, remedies: Iterable[Remedy]) -> Remedy:
    """Return one remedy with the devices, reasons and details of several.

    Args:
        scheme: Name of the scheme.
        remedies: Remedies that change nothing but devices.
    """
    joined = Remedy(scheme)
    pairs: list[tuple[DeviceTable, str]] = []
    for remedy in remedies:
        pairs += zip(remedy.devices, remedy.reasons, strict=True)
        joined = joined.add_details(**remedy.details)
    return joined._add_pairs(pairs)


def fit_devices(engine: Engine, remedy: Remedy) -> Engine:
    """Return the engine with the devices of a remedy added, in the order of an engine file."""
    new = (build_fitted(table, engine) for table in remedy.devices)
    everything = (*engine.devices, *new, *remedy.beyond)
    devices = tuple(sorted(everything, key=lambda device: device.kind))
    return replace(engine, devices=devices, model=_fit_model(engine.model, remedy))


def remove_weights_beside_webs(engine: Engine) -> Engine:
    """Return the engine without the tables [[counterweight]] of its file; webs remain."""
    devices = [device for device in engine.devices if device.web or not device.is_counterweight]
    model = engine.model and engine.model.model_copy(update={"counterweight": ()})
    return replace(engine, devices=tuple(devices), model=model)


def remove_counterweights(engine: Engine) -> Engine:
    """Return the engine without the counterweights of its file; coupling rods remain."""
    devices = tuple(device for device in engine.devices if not device.is_counterweight)
    model = engine.model and engine.model.model_copy(update={"counterweight": ()})
    return replace(engine, devices=devices, model=model)


def _fit_model(model: EngineFile | None, remedy: Remedy) -> EngineFile | None:
    """Return the file with the devices of a remedy; None if no file can describe them."""
    if model is None or remedy.beyond:
        return None
    added: dict[str, list[DeviceTable]] = {}
    for device in remedy.devices:
        added.setdefault(name_kind(device), []).append(device)
    tables = {kind: (*getattr(model, kind), *devices) for kind, devices in added.items()}
    return model.model_copy(update=tables)
