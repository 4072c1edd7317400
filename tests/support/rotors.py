"""Files of runs written from a planted unbalance and known influence coefficients."""

import numpy as np


def polar(value: complex) -> str:
    """A complex number as files say it."""
    return f"{abs(value):.17g} @ {np.degrees(np.angle(value)):.17g}"


def table(values) -> str:
    return "[" + ", ".join(f'"{polar(value)}"' for value in values) + "]"


def run(readings, weights=(), extra: str = "") -> str:
    """One [[run]]; weights are (plane, complex)."""
    on = ", ".join(f'{plane} = "{polar(weight)}"' for plane, weight in weights)
    return f"[[run]]\nreadings = {table(readings)}\nweights = {{ {on} }}\n{extra}\n"


def random_rotor(seed: int, readings: int, planes: int):
    """Influence coefficients (readings, planes), and the weights that the rotor has in excess."""
    rng = np.random.default_rng(seed)
    parts = rng.normal(size=(2, readings + 1, planes))
    whole = parts[0] + 1j * parts[1]
    return whole[:-1], whole[-1]


def names(count: int) -> list[str]:
    return [f"p{k}" for k in range(1, count + 1)]


def head(planes: int, extra: str = "") -> str:
    listed = ", ".join(f'"{name}"' for name in names(planes))
    return f"planes = [{listed}]\n{extra}\n"


def three_runs(extra: str = "", last: str = "") -> str:
    """A rotor in two planes, front and rear, with two sensors."""
    return f"""
planes = ["front", "rear"]
{extra}
[[run]]
readings = ["170 @ 112", "53 @ 78"]
[[run]]
weights = {{ front = "1.15 @ 0" }}
readings = ["235 @ 94", "58 @ 68"]
[[run]]
weights = {{ rear = "1.15 @ 0" }}
readings = ["185 @ 115", "77 @ 104"]
{last}
"""
