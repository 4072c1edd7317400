"""Types of the JSON document of tables, which is not a record yet."""

from __future__ import annotations

from typing import Literal

from typing_extensions import TypedDict

Cell = float | int | str | None


class Erratum(TypedDict):
    """A printed figure that is not the exact one rounded."""

    row: int
    column: str
    printed: str
    exact: Cell
    kind: str


class Table(TypedDict):
    """A printed table, recomputed."""

    version: str
    format: Literal["balcli.table/1"]
    name: str
    title: str
    source: str
    columns: list[str]
    rows: list[list[Cell]]
    printed: list[list[str | None]]
    errata: list[Erratum]
