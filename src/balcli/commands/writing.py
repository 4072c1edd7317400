"""`--write`: the engine with its devices, as a new file."""
from __future__ import annotations

from pathlib import Path

from ..enginefile import name_of
from ..fit import fit, fit_knuckles
from ..schemes import KNUCKLES
from ..sizing import Remedy
from .output import write


def write_fitted(source: str, text: bytes, remedy: Remedy, target: Path) -> None:
    """Write the engine file with these devices.

    Raises:
        BalcliError: the target cannot be written, or the devices cannot be described.
    """
    if remedy.scheme == KNUCKLES:
        write(fit_knuckles(text, tuple(remedy.details["knuckle_angles_deg"]), name_of(source)), target)
    else:
        write(fit(text, remedy, name_of(source)), target)
