"""`balcli.search`"""

from __future__ import annotations

from collections.abc import Mapping

from ..engine.build import Engine, check_engine, take_model
from ..errors import check_type, wrong_type
from ..limits import MOST_FOUND
from ..studies.search.objective import parse_objective
from ..studies.search.search import Search, search_arrangements
from .arguments import Words, check_count, check_mapping, join_names, tell_arguments


@tell_arguments()
def search(
    engine: Engine,
    over: Words,
    minimise: Words | Mapping[str, float] | None = None,
    *,
    maximise: Words | Mapping[str, float] | None = None,
    limits: Mapping[str, float] | None = None,
    top: int = 10,
    even_firing: bool = False,
) -> Search:
    """The best crank, firing order, bank angle, splay or values of any numbers of an engine;
    mirror images and rotations once.

    Args:
        engine: as `load` makes it.
        over: what to arrange: the throw angles of the file along the crank ("throws"), its
            "firing_order", its "bank_angle" or the "splay" of its split pins; or any number of
            the file and its range ("mount.left.loss=0.05:0.3"). A list of angles and numbers is
            searched together.
        minimise: the quantity that should be small (`moment.1.major`), several, which are added
            up, or a dict of weights by quantity.
        maximise: the quantity that should be large, likewise; exactly one of both is given.
        limits: what quantities must stay below, N or N m.
        top: how many to list, at most 1000.
        even_firing: only what can fire at even intervals.

    Returns:
        The arrangements, best first: `result.results[0].design`, `.objective` and `.figures`;
        `result.engine(1)` is the engine with the first.

    Raises:
        BalcliError: there is nothing to arrange, or nothing keeps the limits; unknown quantities.
        TypeError: what is no engine, no names, no dict.

    Example:
        >>> search(engine, "throws", "moment.1.major").to_pandas()
    """
    model = take_model(check_engine("search", engine))
    if not isinstance(over, (str, list, tuple)):
        raise wrong_type("search", over, 'give what to arrange, such as "throws"')
    texts = (join_names("search", over) or "").split(",")
    given = {} if limits is None else limits
    bounds = check_mapping("search", given, '{"moment.2.major": 100}')
    check_type("even_firing", even_firing, bool, "give True or False")
    kept = [f"{name}<{bound!r}" for name, bound in _as_floats(bounds).items()]
    objective = parse_objective(
        _join_goal(minimise), kept, maximise=_join_goal(maximise), with_gas=model.gas is not None
    )
    return search_arrangements(
        model, texts, objective, check_count("top", top, most=MOST_FOUND), even_firing
    )


def _join_goal(goal: Words | Mapping[str, float] | None) -> str | None:
    """Return quantities with their weights as the command line has them; None as it is."""
    if isinstance(goal, Mapping):
        return ",".join(f"{name}={weight!r}" for name, weight in _as_floats(goal).items())
    return join_names("search", goal)


def _as_floats(figures: Mapping[str, float]) -> dict[str, object]:
    """Numbers of numpy as Python's, whose texts are digits."""
    return {name: float(v) if hasattr(v, "dtype") else v for name, v in figures.items()}
