"""What a shell may complete beyond commands, options and their choices: names that are known only
inside.
"""

from __future__ import annotations

from collections.abc import Iterable


def kinds(incomplete: str) -> list[str]:
    """Of `balcli new`."""
    from ..enginefile.templates import KINDS

    return _beginning(incomplete, KINDS)


def schemes(incomplete: str) -> list[str]:
    """Of `--scheme`."""
    from ..sizing.schemes import NAMES

    return _beginning(incomplete, NAMES)


def tables(incomplete: str) -> list[str]:
    """Of `balcli tables`."""
    from ..tables.registry import NAMES

    return _beginning(incomplete, NAMES)


def examples(incomplete: str) -> list[str]:
    """Of `balcli engines`."""
    from ..enginefile import examples as shipped

    return _beginning(incomplete, shipped.names())


def _beginning(incomplete: str, known: Iterable[str]) -> list[str]:
    return [name for name in known if name.startswith(incomplete)]
