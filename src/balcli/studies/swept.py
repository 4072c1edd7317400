"""The variants of a sweep, computed and kept: figures on a grid."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..core.phasors import Array
from ..errors import BalcliError
from ..limits import MOST_KEPT_FIGURES
from ..result import Result
from .sweep import Sweep, evaluate_chunks, join_chunks


@dataclass(frozen=True, eq=False, repr=False)
class Swept(Result):
    """What `sweep` answers.

    Attributes:
        sweep: what was asked: file, parameters with their values, quantities.
        values: each quantity on the whole grid, SI or degrees, shape (values of the first
            parameter, of the second, ...).
    """

    sweep: Sweep
    values: tuple[Array, ...]

    @property
    def summary(self) -> str:
        """Of what, over what."""
        sweep = self.sweep
        over = ", ".join(f"{p.path} ({len(p)})" for p in sweep.parameters)
        what = ", ".join(q.name for q in sweep.quantities)
        return f"of {sweep.file.name or 'an engine'} over {over}: {what}"

    def __iter__(self) -> Iterator[str]:
        """Names of the parameters, then of the quantities."""
        yield from (p.path for p in self.sweep.parameters)
        yield from (q.name for q in self.sweep.quantities)

    def __getitem__(self, name: str) -> Array:
        """A quantity on the whole grid, or the values of a parameter, by its name.

        Raises:
            KeyError: it has none of this name.
        """
        named = dict(zip((q.name for q in self.sweep.quantities), self.values, strict=True))
        named |= {p.path: p.values for p in self.sweep.parameters}
        if name not in named:
            raise KeyError(f"{name}; there are {', '.join(named)}")
        return named[name]


def compute_sweep(sweep: Sweep, threads: int) -> Swept:
    """All variants of a sweep.

    Raises:
        BalcliError: they are too many to keep.
        InputError: one of them cannot be.
    """
    count = sweep.variants * len(sweep.quantities)
    if count > MOST_KEPT_FIGURES:
        raise BalcliError(
            f"{count} figures are too many to keep ({MOST_KEPT_FIGURES} are allowed): balcli sweep "
            "-o FILE.parquet writes them as they are computed"
        )
    return Swept(sweep, tuple(join_chunks(sweep, evaluate_chunks(sweep, threads))))
