"""Tolerances as users state them: `0.5%`, `0.2 deg`."""

from __future__ import annotations

import re

from ..enginefile.fields import Number
from ..enginefile.units import ANGLE, BARE_FIGURE
from ..errors import BalcliError
from .deviations import Tolerances

DEGREES = Number(ANGLE, least=0, most=90)  # how a tolerance of angles is read


def parse_tolerances(mass: str, length: str, angle: str) -> Tolerances:
    """From texts such as `0.5%`, `0.05%` and `0.2 deg`.

    Raises:
        BalcliError: what is neither, negative or absurdly large.
    """
    masses = parse_percentage(mass, "--mass-scatter")
    lengths = parse_percentage(length, "--length-scatter")
    try:
        angles = DEGREES.read(float(angle) if _is_bare(angle) else angle)
    except ValueError as error:
        raise BalcliError(f"--angle-scatter {error}") from None
    return Tolerances(masses, lengths, angles)


def parse_percentage(text: str, option: str) -> float:
    """The share that a percentage is."""
    number = text.strip().removesuffix("%")
    percentage = number != text.strip() and _is_bare(number)
    if not percentage or not 0 <= float(number) < 100:
        raise BalcliError(f'{option} "{text}": give a percentage of 0 to 100, such as 0.5%')
    return float(number) / 100


def _is_bare(text: str) -> bool:
    """Whether it is a number without a unit."""
    return re.fullmatch(BARE_FIGURE, text.strip(), re.ASCII) is not None
