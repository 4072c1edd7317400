"""What a reader may ask of a table beside its name."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Options:
    """Other columns (lambda) and rows (crank angle, degrees) than the printed ones; highest power
    of lambda.
    """

    lam: tuple[str, ...] | None = None
    angle: tuple[str, ...] | None = None
    power: int | None = None

    def given(self) -> tuple[str, ...]:
        """The options that are set, by their names on the command line."""
        named = {"lambda": self.lam, "angle": self.angle, "power": self.power}
        return tuple(name for name, value in named.items() if value is not None)
