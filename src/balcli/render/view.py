"""How much of an analysis people are shown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, NamedTuple, TypeVar

if TYPE_CHECKING:
    from ..enginefile.model import EngineFile


VISIBLE = 1e-3  # share of the largest, below which an order is too small for a picture


R = TypeVar("R")


class View(NamedTuple):
    """What of an analysis a sheet shows.

    Attributes:
        whole: every table and every order; else what most people want, orders that matter.
        parts: words of `--only`, such as `force`, `xy`, `verdict`; empty: the usual ones.
        every_order: whether orders that are negligible are shown, too.
        hints: whether commands and options that show more are named.
    """

    whole: bool = False
    parts: frozenset[str] = frozenset()
    every_order: bool = False
    hints: bool = True


IN_BRIEF = View()
ON_A_PAGE = View(hints=False)


class NamedResult(NamedTuple, Generic[R]):
    """What was found of one of several engines.

    Attributes:
        name: of the engine, by which its rows are told from those of the others.
        view: what of it a sheet shows.
    """

    name: str
    result: R
    view: View


def tell_assumed_speed(model: EngineFile | None) -> str:
    """A sentence, where there is a file that gives no speed."""
    if model is None or "speed" in model.operation.model_fields_set:
        return ""
    return f"The file gives no speed: figures are those at {model.operation.speed:g} rpm."
