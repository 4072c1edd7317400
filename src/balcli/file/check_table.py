"""The table [check] of an engine file: changes that `balcli check` tolerates, and limits of
quantities. Other commands ignore it.

The names of quantities are not checked here, because only studies know them. This module is
imported only for files that have this table (`names.CHAPTERS`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BeforeValidator

from ..core.records import Node
from .fields import AnyFigure, shorten
from .table import FileTable

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
    from pydantic_core import CoreSchema

EVERY_QUANTITY = "all"  # name of a tolerance that holds for every quantity


class _ByQuantity:
    """A table with one value for each of some quantities.

    TOML takes a name without quotes, such as `moment.1.major`, for tables within tables. They are
    joined here to one table, so that names need no quotes.
    """

    def read(self, value: object) -> object:
        """Return the table with full names of quantities; return any other value unchanged."""
        return dict(self._join_names(value)) if isinstance(value, Mapping) else value

    def _join_names(self, table: Mapping[str, Any]) -> Iterator[tuple[str, object]]:
        for key, value in table.items():
            if self.is_further_table(value):
                yield from ((f"{key}.{rest}", inner) for rest, inner in self._join_names(value))
            else:
                yield key, value

    def is_further_table(self, value: object) -> bool:
        """Return whether a value is a table of quantities whose names begin with its key."""
        raise NotImplementedError

    def __get_pydantic_core_schema__(
        self, source: object, handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        from pydantic_core import core_schema

        return core_schema.no_info_before_validator_function(self.read, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> Node:
        node = handler(schema)
        value = node["additionalProperties"]
        return node | {"additionalProperties": {"anyOf": [value, {"type": "object"}]}}


class _Tolerances(_ByQuantity):
    """Tolerances by quantity. A figure instead of a table is the tolerance of every quantity."""

    def read(self, value: object) -> object:
        return super().read(value if isinstance(value, Mapping) else {EVERY_QUANTITY: value})

    def is_further_table(self, value: object) -> bool:
        return isinstance(value, Mapping)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> Node:
        node = super().__get_pydantic_json_schema__(schema, handler)
        return {"anyOf": [*AnyFigure().json()["anyOf"], node]}


class _Limits(_ByQuantity):
    """Limits by quantity. A limit is an empty table, or a table with a key of `Limit`."""

    def is_further_table(self, value: object) -> bool:
        return isinstance(value, Mapping) and bool(value) and value.keys().isdisjoint(Limit.keys())


def _require_table(value: object) -> object:
    """Return a limit unchanged; raise ValueError if it is not a table."""
    if isinstance(value, Mapping):
        return value
    raise ValueError(f"{shorten(value)} is not a limit; write {{ below = … }} or {{ above = … }}")


class Limit(FileTable):
    """Limits of a quantity. Bare numbers are in the unit that `balcli numbers` lists for it."""

    below: Annotated[float | str, AnyFigure()] | None = None
    """The quantity has to be below this figure. Example: 500"""
    above: Annotated[float | str, AnyFigure()] | None = None
    """The quantity has to be above this figure. Example: '1.2 kN'"""

    def _check_given(self) -> Iterator[str]:
        if not self.given:
            yield "gives no limit; write { below = … } or { above = … }"


class Check(FileTable):
    """Tolerances and limits for `balcli check`, by quantity as in `balcli numbers`; other commands
    ignore them.
    """

    tolerance: Annotated[dict[str, Annotated[float | str, AnyFigure()]], _Tolerances()] = {}  # noqa: RUF012 - pydantic copies it
    """Allowed change of a quantity (force, force.2, mode.1.Hz; all for every quantity): a share of
    the largest figure of the quantity, or a figure with a unit. Example: { force = '0.1 %' }"""
    limits: Annotated[dict[str, Annotated[Limit, BeforeValidator(_require_table)]], _Limits()] = {}  # noqa: RUF012 - pydantic copies it
    """Limits of quantities; a quantity beyond its limit fails the check. Example:
    { 'moment.1.major' = { below = 500 } }"""
