"""What is unlikely of an engine file of which figures vary."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress

from ..engine.load import parse_dict
from ..engine.numbering import doubt_firing
from ..enginefile.model import EngineFile
from ..enginefile.plain_tables import change_tables
from ..enginefile.suspicious import find_suspicious
from ..errors import InputError
from .parameters import Parameter

Doubt = Callable[[EngineFile], Iterable[str]]


def doubt_but_for_gas(model: EngineFile) -> list[str]:
    """What is unlikely of a file, in words; no gas is computed for it.

    Raises:
        InputError: a firing order that does not fit the crank.
    """
    return [*find_suspicious(model), *doubt_firing(model)]


def doubt_unvaried(
    model: EngineFile, parameters: Sequence[Parameter], doubt: Doubt = doubt_but_for_gas
) -> list[str]:
    """What is unlikely of a file whatever its varying figures are, in words: what is said of the
    file, of its first and of its last variant alike, as far as these can be.

    Raises:
        InputError: what does not fit together in the file.
    """
    doubts = list(doubt(model))
    for end in (0, -1) if doubts else ():
        figures = {p.path: float(p.values[end]) for p in parameters}
        with suppress(InputError):
            variant = list(doubt(parse_dict(change_tables(model, figures), model.folder)))
            doubts = [each for each in doubts if each in variant]
    return doubts
