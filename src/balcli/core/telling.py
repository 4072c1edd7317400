"""What long computations are given to tell how far they are."""

from __future__ import annotations

from collections.abc import Callable

# Is told, time and again, how much is done: a share from 0 to 1, or a number where the function
# says so; True: that is enough, what can end early does so.
Tell = Callable[[float], bool]


def tell_nobody(done: float) -> bool:
    """For those who do not want to know."""
    return False
