"""Documents of many variants, of several engines, over the crank angle, and of tables."""

from __future__ import annotations

from typing import Literal, NotRequired

from pydantic import ConfigDict, with_config
from typing_extensions import TypedDict

from .figures import Assumed, Document, NamedEngine

Cell = float | int | str | None


class Sweep(Document):
    """Variants of an engine, a row each: the figures that vary, in the units of the file, then the
    quantities, in those of `balcli numbers`; null: what has no value, such as the axis of a circle.
    """

    format: Literal["balcli.sweep/1"]
    engine: NamedEngine
    columns: list[str]
    rows: list[list[float | None]]


@with_config(ConfigDict(extra="allow"))
class Arranged(TypedDict):
    """One arrangement: one of the first four says it, or a key that is called as `over`."""

    throws: NotRequired[list[float]]
    firing_order: NotRequired[list[int]]
    bank_angle: NotRequired[float]
    splay: NotRequired[float]
    objective: float
    quantities: dict[str, float]


class Search(Document):
    """Best arrangements, best first; over: throws, firing_order, bank_angle, splay, or the dotted
    name of a number.
    """

    format: Literal["balcli.search/1"]
    engine: NamedEngine
    over: str
    results: list[Arranged]


class Curves(Document):
    """Quantities over the crank angle; null: what has no value there."""

    format: Literal["balcli.curves/1"]
    engine: str
    speed_rpm: float
    crank_deg: list[float]
    curves: dict[str, list[float | None]]
    assumed: NotRequired[Assumed]


class Erratum(TypedDict):
    """A printed figure that is not the exact one rounded."""

    row: int
    column: str
    printed: str
    exact: Cell
    kind: str


class Table(Document):
    """A printed table, recomputed."""

    format: Literal["balcli.table/1"]
    name: str
    title: str
    source: str
    columns: list[str]
    rows: list[list[Cell]]
    printed: list[list[str | None]]
    errata: list[Erratum]
