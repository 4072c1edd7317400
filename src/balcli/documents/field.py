"""`balcli.field/1`."""

from __future__ import annotations

from typing import Literal, NotRequired

from typing_extensions import TypedDict

from .figures import Document


class Reading(TypedDict):
    """Where and at which speed is read."""

    sensor: str
    speed_rpm: float | None


class Vibration(TypedDict):
    """In the unit of the readings; no phase where there is none."""

    amplitude: float | None
    phase_deg: float | None


class Weight(TypedDict):
    """In the unit of weights."""

    weight: float | None
    angle_deg: float | None


class Piece(Weight):
    """A part of a correction: at a place, or a drill hole."""

    place: NotRequired[int | str]
    depth_mm: NotRequired[float | None]


class Correction(Weight):
    """What is to be set in a plane; add: to what is there; wanted: where a limit keeps it lower."""

    plane: str
    add: NotRequired[Weight]
    unbalance_g_mm: NotRequired[float | None]
    own_effect: float | None
    at_limit: bool
    wanted: NotRequired[Weight]
    pieces: list[Piece]


class PermittedInPlane(TypedDict):
    """Of ISO 21940-11, in one plane."""

    plane: str
    permitted_g_mm: float | None
    present_g_mm: float | None
    reached: bool
    after_g_mm: float | None


class Permitted(TypedDict):
    """Of ISO 21940-11."""

    specific_mm: float | None
    unbalance_g_mm: float | None
    planes: list[PermittedInPlane]
    reached: bool


class Field(Document):
    """Weights that balance a rotor on the machine."""

    format: Literal["balcli.field/1"]
    name: str | None
    unit: str | None
    weight_unit: str
    phases: str
    weights: str
    minimise: str
    readings: list[Reading]
    influence: list[list[Vibration]]
    corrections: list[Correction]
    before: list[Vibration]
    residual: list[Vibration]
    largest: float | None
    rms: float | None
    condition: float | None
    bound: NotRequired[float | None]
    trimmed: NotRequired[int | str]
    permitted: NotRequired[Permitted]
