"""Completion of names for the shell; each list is imported when the shell asks for it."""

from __future__ import annotations


def complete_schemes(incomplete: str) -> list[str]:
    """Return the balance schemes that begin with this text."""
    from ..sizing.schemes import NAMES

    return [name for name in NAMES if name.startswith(incomplete)]


def complete_tables(incomplete: str) -> list[str]:
    """Return the printed tables that begin with this text."""
    from ..printed_tables import registry

    return [name for name in registry.NAMES if name.startswith(incomplete)]


def complete_examples(incomplete: str) -> list[str]:
    """Return the example engines that begin with this text."""
    from ..enginefile import examples

    return [name for name in examples.names() if name.startswith(incomplete)]
