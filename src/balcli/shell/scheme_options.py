"""Options of a balance scheme, for `balance` and for commands that show an engine with and without
devices.
"""

from __future__ import annotations

import re
from typing import Annotated

from ..errors import BalcliError, warn
from ..limits import LARGEST_FACTOR, MOST_FACTORS
from ..show.formats import Units
from ..sizing.options import NAMES, SchemeOptions
from .options import parse_small
from .values import SCALES, optional, read_figure, read_lengths, read_share


def complete_schemes(incomplete: str) -> list[str]:
    """Return the names of balance schemes that begin with this text."""
    return [name for name in NAMES if name.startswith(incomplete)]


Scheme = Annotated[
    str | None,
    optional(
        "NAME",
        "Also show the engine with the devices of a scheme, such as auto.",
        autocompletion=complete_schemes,
    ),
]
Order = Annotated[int | None, optional("N", "Order to balance; default: lowest suitable order.")]
At = Annotated[
    list[str] | None,
    optional("X,Y", "Shaft position, mm; once for each shaft, first those against the crank."),
]
Position = Annotated[
    str | None,
    optional("Z|Z,Z", "Axial position of new devices, mm; two for pairs of them."),
]
Planes = Annotated[
    str | None,
    optional(
        "ends|throws|webs|Z,Z...",
        "Planes of the weights: at the end throws, at every throw or web, or at z in mm.",
    ),
]
Factor = Annotated[
    str | None,
    optional("K|K:K:STEP", "Balance factor, such as 51% or 50%:54%:1%."),
]
Measured = Annotated[str | None, optional("MASS", 'Mass that balances a bare pin: "812 g".')]
Roll = Annotated[str | None, optional("zero", "Place two shafts so that they cancel roll.")]


def parse_scheme_options(
    order: int | None,
    at: list[str] | None,
    position: str | None,
    planes: str | None,
    factor: str | None,
    measured: str | None,
    roll: str | None,
    units: Units,
    small: str | None = None,
) -> SchemeOptions:
    """Return the options of a balance scheme in SI units; each argument is an option as typed, or
    None.

    Args:
        order: Order to balance.
        at: Positions of shafts, each as `x,y`.
        position: Axial position of new devices.
        planes: "ends", "throws", "webs", or axial positions of new weights.
        factor: Share of the reciprocating mass, or a range of shares.
        measured: Mass that, on a bare crank pin, balances the crankshaft.
        roll: "zero" to cancel the roll of inertia.
        units: System of units of bare numbers.
        small: Share of one cylinder's first order below which orders are ignored.

    Raises:
        BalcliError: A text cannot be read.
    """
    one = "one place along z in mm, such as 40"
    pair = "x,y of a shaft in mm, such as -40,60"
    along = () if position is None else read_lengths("position", position, one, units=units)
    weighed = None if measured is None else read_figure("measured", measured, SCALES, units)
    options = SchemeOptions(order=order, roll=roll)
    if at:
        places = tuple(complex(*read_lengths("at", text, pair, 2, units)) for text in at)
        options = options._replace(at=places)
    if along:
        options = options._replace(position=along[0] if len(along) == 1 else along)
    if planes is not None:
        options = options._replace(planes=_parse_planes(planes, units))
    if factor is not None:
        options = options._replace(factor=parse_factors(factor))
    if weighed is not None:
        options = options._replace(measured=weighed / 1e3)
    if small is not None:
        options = options._replace(small=parse_small(small))
    return options


def choose_scheme(asked: str | None, options: SchemeOptions, usual: str = "auto") -> str:
    """Return the given scheme. If none is given, return `factor` if a factor or measured mass is
    given, otherwise `usual`.

    Args:
        asked: Value of `--scheme`; None: not given.
        options: Options of the scheme.
        usual: Scheme if no scheme, factor or measured mass is given.
    """
    if asked is not None:
        return asked
    by_factor = options.factor is not None or options.measured is not None
    return "factor" if by_factor else usual


def choose_beside(asked: str | None, options: SchemeOptions) -> str | None:
    """Return the scheme whose devices are shown in addition to the engine as it is; None if neither
    a scheme nor options of a scheme are given.

    Args:
        asked: Value of `--scheme`; None: not given.
        options: Options of the scheme.
    """
    if asked is None and options._replace(small=None) == SchemeOptions():
        return None
    return choose_scheme(asked, options)


def _parse_planes(text: str, units: Units) -> str | tuple[float, ...]:
    if text in ("ends", "throws", "webs"):
        return text
    wanted = "ends, throws, webs, or places along z in mm, such as -200,200"
    places = read_lengths("planes", text, wanted, units=units)
    if len(places) > 2 and len(set(places)) < len(places):
        warn(f'--planes "{text[:60]}": names a place twice; decimals take a point, not a comma')
    return places


def parse_factors(text: str) -> tuple[float, ...]:
    """Return the factors in `0.5`, `51%`, `0.4,0.5` or `0:1:0.1` (both ends are included)."""
    wanted = "a share of the reciprocating mass such as 51% or 0.51, or a range such as 50%:54%:1%"
    parts = [read_share("factor", part, wanted) for part in re.split("[:,]", text)]
    if ":" not in text:
        if max(parts) > LARGEST_FACTOR and "," in text:
            raise BalcliError(f'--factor "{text}": decimals take a point, not a comma')
        return tuple(parts)
    first, last, step = parts if len(parts) == 3 else (1, 0, 1)
    if not (step > 0 and last >= first and (last - first) / step <= MOST_FACTORS):
        raise BalcliError(f'--factor "{text}": give up to {MOST_FACTORS} steps such as 50%:54%:1%')
    steps = int((last - first) / step + 1e-9)
    return tuple(round(first + k * step, 12) for k in range(steps + 1))
