"""What a shell may complete beyond commands, options and their choices: names that are known only
inside. Where they are known is imported when a shell asks.
"""

from __future__ import annotations

from collections.abc import Iterable


def complete_kinds(incomplete: str) -> list[str]:
    """Kinds of files, of `balcli new`."""
    from ..enginefile.templates import KINDS
    from ..field_balancing.starting_file import KIND as FIELD
    from ..torsion.starting_file import KIND as TORSION

    return _beginning_with(incomplete, (*KINDS, FIELD, TORSION))


def complete_schemes(incomplete: str) -> list[str]:
    """Schemes, of `--scheme`."""
    from ..sizing.schemes import NAMES

    return _beginning_with(incomplete, NAMES)


def complete_tables(incomplete: str) -> list[str]:
    """Printed tables, of `balcli tables`."""
    from ..printed_tables import registry

    return _beginning_with(incomplete, registry.NAMES)


def complete_documents(incomplete: str) -> list[str]:
    """Results that JSON has, of `balcli schema --of`."""
    from ..documents.names import DOCUMENTS

    return _beginning_with(incomplete, DOCUMENTS)


def complete_examples(incomplete: str) -> list[str]:
    """Example engines, of `balcli engines`."""
    from ..enginefile import examples

    return _beginning_with(incomplete, examples.names())


def complete_classes(incomplete: str) -> list[str]:
    """Classes of example engines, of `balcli engines --class`."""
    from ..enginefile import examples

    return _beginning_with(incomplete, examples.groups())


def _beginning_with(incomplete: str, known: Iterable[str]) -> list[str]:
    return [name for name in known if name.startswith(incomplete)]
