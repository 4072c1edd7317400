"""What a user may ask of a scheme."""

from __future__ import annotations

import cmath
from collections.abc import Collection
from numbers import Complex, Integral, Real
from typing import Any, NamedTuple

from ..enginefile.fields import nearest
from ..errors import BalcliError, wrong_type
from ..limits import FARTHEST_DEVICE_M, HIGHEST_SHAFT_ORDER
from .schemes import KNUCKLES, NAMES, SCHEMES

_EXAMPLES = {
    "order": "a whole number, such as 2",
    "at": "places x + iy in m, such as (-0.04 + 0.06j,)",
    "position": "a place z in m, such as 0.1",
    "planes": '"ends", "throws", or places z in m, such as (-0.1, 0.1)',
    "factor": "shares, such as (0.5,)",
    "measured": "a mass in kg, such as 0.812",
}


class SchemeOptions(NamedTuple):
    """Options of the schemes, lengths in m; None is an option that was not given. `balcli balance
    --schemes` says which scheme takes which.

    Attributes:
        order: the order to balance; default: the lowest that has what the scheme takes.
        at: places x + iy of shafts or sliders; of a pair, first that of the shaft turning against
            the crank.
        position: z of new devices.
        planes: "ends", "throws", or places z of new devices.
        factor: shares of the reciprocating mass, of which the best is fitted; default: 0.5.
        measured: mass that balances the crank when it hangs on a bare pin, kg, instead of a factor.
        roll: "zero": two shafts are placed such that the roll of inertia of this order
            vanishes, too.
    """

    order: int | None = None
    at: tuple[complex, ...] | None = None
    position: float | None = None
    planes: str | tuple[float, ...] | None = None
    factor: tuple[float, ...] | None = None
    measured: float | None = None
    roll: str | None = None

    def check(self, scheme: str) -> None:
        """Refuse what the scheme does not know.

        Raises BalcliError for an unknown scheme, an option that the scheme does not take, and an
        order or a roll that no scheme takes.
        """
        self._check_types()
        taken = find_taken(scheme)
        given = [name for name, value in self._asdict().items() if value is not None]
        if strangers := [name for name in given if name not in taken]:
            if scheme == "auto" and (others := _find_schemes_taking(given)):
                raise BalcliError(
                    f"scheme auto has no --{strangers[0]}; add --scheme with {others}"
                )
            names = ", ".join(f"--{name}" for name in taken)
            has = f"it takes {names}" if taken else "it takes no options"
            raise BalcliError(f"scheme {scheme} has no --{strangers[0]}; {has}")
        if self.order is not None and not 1 <= self.order <= HIGHEST_SHAFT_ORDER:
            raise BalcliError(
                f"--order {self.order}: the order must be a whole number from 1 to "
                f"{HIGHEST_SHAFT_ORDER}"
            )
        if isinstance(self.planes, str) and self.planes not in ("ends", "throws"):
            raise BalcliError(
                f'--planes "{self.planes[:60]}": give ends, throws, or places along z'
            )
        self._refuse_far_places()
        if self.roll not in (None, "zero"):
            raise BalcliError(f'--roll "{self.roll}": only "zero" can be asked for')

    def _check_types(self) -> None:
        sound = {
            "order": _are((self.order,), Integral),
            "at": _are_finite(self.at, Complex),
            "position": _are_finite((self.position,), Real),
            "planes": isinstance(self.planes, str) or _are_finite(self.planes, Real),
            "factor": _are(self.factor, Real),
            "measured": _are_finite((self.measured,), Real),
        }
        for name, right in sound.items():
            value = getattr(self, name)
            if value is not None and not right:
                raise wrong_type(f"SchemeOptions: {name}", value, f"give {_EXAMPLES[name]}")

    def _refuse_far_places(self) -> None:
        planes = self.planes if isinstance(self.planes, tuple) else ()
        position = () if self.position is None else (self.position,)
        for name, places in (("at", self.at or ()), ("position", position), ("planes", planes)):
            farthest = max(map(abs, places), default=0.0)
            if farthest > FARTHEST_DEVICE_M:
                raise BalcliError(
                    f"--{name}: {1e3 * farthest:g} mm from the origin is farther than any engine "
                    f"reaches; at most {FARTHEST_DEVICE_M:g} m"
                )

    def read_place(self) -> complex:
        """The one place asked for, or else 0, the crank axis; BalcliError if there are more."""
        at = self.at or (0j,)
        if len(at) > 1:
            raise BalcliError("--at: this scheme has one place; give it once")
        return at[0]


def _are(values: object, kind: type) -> bool:
    """Whether they are numbers of a kind, one at least, none with hundreds of digits."""
    return (
        isinstance(values, tuple)
        and values != ()
        and all(isinstance(value, kind) and _fits_float(value) for value in values)
    )


def _fits_float(value: Any) -> bool:
    try:
        complex(value)
    except OverflowError:
        return False
    return True


def _are_finite(values: Any, kind: type) -> bool:
    return _are(values, kind) and all(map(cmath.isfinite, values))


def _find_schemes_taking(given: Collection[str]) -> str:
    """The schemes that take all of these options, in words."""
    return " or ".join(name for name, taken in SCHEMES.items() if set(given) <= set(taken))


def find_taken(scheme: str) -> tuple[str, ...]:
    """The options that a scheme takes.

    Raises BalcliError, with the nearest name, if there is no such scheme or it sizes no devices.
    """
    if scheme in SCHEMES:
        return SCHEMES[scheme]
    if scheme == KNUCKLES:
        raise BalcliError(
            "scheme knuckles sizes no devices but changes the engine file: `balcli balance "
            "--scheme knuckles` does so"
        )
    near = nearest(scheme, NAMES)
    meant = f"did you mean {near}? " if near else ""
    raise BalcliError(f"there is no scheme {scheme[:60]!r}: {meant}choose from {', '.join(NAMES)}")
