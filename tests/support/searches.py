"""Searches as tests ask for them."""

from collections.abc import Sequence

from balcli.file.model import EngineFile
from balcli.studies.search.answer import Search, search_arrangements
from balcli.studies.search.designs import parse_objective


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
