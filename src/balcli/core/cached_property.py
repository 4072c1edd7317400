"""Attributes that are computed when first asked for, and kept."""

from __future__ import annotations

import sys

if sys.version_info >= (3, 12):
    from functools import cached_property
else:
    import functools
    from typing import Any, TypeVar

    T = TypeVar("T")

    class cached_property(functools.cached_property[T]):  # noqa: N801 (its name in functools)
        """As from Python 3.12 on: while one thread computes it for one object, others do so for
        theirs. (In Python 3.11 they wait, and the threads of a sweep work one after the other.)
        """

        def __get__(self, instance: Any, owner: type | None = None) -> Any:
            if instance is None:
                return self
            name = self.func.__name__
            vars(instance)[name] = value = self.func(instance)  # found there without us from now on
            return value


__all__ = ["cached_property"]
