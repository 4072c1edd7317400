"""`balcli.compare`"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from ..engine.build import Engine, check_engine
from ..errors import BalcliError, list_words, wrong_type
from ..results.comparison import Comparison, compare_engines


def compare(
    *engines: Engine,
    names: Sequence[str] | None = None,
    orders: Iterable[float] | None = None,
    only: str | Collection[str] | None = None,
) -> Comparison:
    """Engines side by side: free forces and moments by order, peaks, and their ratios to the first
    engine's.

    Args:
        engines: two or more, as `load` makes them.
        names: what to call them; default: as their files do, or by number where names are missing
            or stand for several.
        orders: which to show; default: all that are not negligible in one of them.
        only: any of force, moment, couple, torque, roll, peak, sizing, inner, guide, gas; default:
            all but sizing, inner and guide.

    Returns:
        Every figure in `result.figures`, with the values of all engines in SI units and their
        ratios.

    Raises:
        BalcliError: fewer than two engines; other than one name for each; an unknown quantity.
        TypeError: one that is no engine; names that are no texts.

    Example:
        >>> compare(load("i4.toml"), load("i6.toml")).to_pandas()
    """
    checked = [check_engine("compare", engine) for engine in engines]
    called = [engine.name for engine in checked] if names is None else _check_names(names)
    if names is None and ("" in called or len(set(called)) < len(called)):
        called = [f"engine {k}" for k in range(1, len(checked) + 1)]
    if len(called) != len(checked):
        raise BalcliError(f"{len(called)} names for {len(checked)} engines; give one for each")
    wanted = None if only is None else list_words("only", only)
    return compare_engines(checked, called, orders, wanted)


def _check_names(names: object) -> list[str]:
    if isinstance(names, Iterable) and not isinstance(names, str):
        listed = list(names)
        if all(isinstance(name, str) for name in listed):
            return listed
    raise wrong_type("names", names, 'give a text for each engine, such as ["before", "after"]')
