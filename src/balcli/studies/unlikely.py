"""Doubts of an engine file of which figures vary."""

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
    """Return the doubts of a file, in words; gas is not computed.

    Raises:
        InputError: a firing order that does not fit the crank.
    """
    return [*find_suspicious(model), *doubt_firing(model)]


def doubt_unvaried(
    model: EngineFile, parameters: Sequence[Parameter], doubt: Doubt = doubt_but_for_gas
) -> list[str]:
    """Return the doubts of a file that do not depend on its varying figures: those of the file, its
    first and its last variant, as far as these can be.

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
