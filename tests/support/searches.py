"""Searches as tests ask for them."""

from __future__ import annotations

from collections.abc import Sequence

from balcli.enginefile.model import EngineFile
from balcli.studies.search.objective import parse_objective
from balcli.studies.search.search import Search, search_arrangements


def search_least(
    model: EngineFile,
    over: str | Sequence[str],
    quantities: str,
    limits: Sequence[str] = (),
    *,
    count: int = 10,
    even_firing: bool = False,
) -> Search:
    """The arrangements with the least of these quantities, by name."""
    objective = parse_objective(quantities, limits)
    return search_arrangements(model, over, objective, count, even_firing)
