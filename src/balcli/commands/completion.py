"""What a shell may complete beyond commands, options and their choices: names that are known only
inside. Where they are known is imported when a shell asks.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from ..errors import BalcliError

if TYPE_CHECKING:
    from ..studies.numbers import NamedNumbers


def complete_kinds(incomplete: str) -> list[str]:
    """Kinds of files, of `balcli new`."""
    from ..enginefile.templates import KINDS

    return _beginning_with(incomplete, KINDS)


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


def complete_numbers(incomplete: str) -> list[str]:
    """Numbers of the engine file, of `--vary`, as far as the file is typed already."""
    found = [] if "=" in incomplete else _ask_file()
    return _beginning_with(incomplete, (f"{n.path}=" for each in found for n in each.numbers))


def complete_quantities(incomplete: str) -> list[str]:
    """Quantities of `--quantity` and `--minimise`: of the file that is typed already, or of every
    one; the last word of those with commas between them.
    """
    from ..studies.quantity_names import CHAPTERS

    before, comma, last = incomplete.rpartition(",")
    usual = [form for chapter in CHAPTERS for form in chapter.forms if not form.table]
    forms = next((found.quantities for found in _ask_file()), usual)
    names = (name for form in forms for name in _spell_out(form.pattern, form.words, last))
    return [f"{before}{comma}{name}" for name in _beginning_with(last, names)]


def _spell_out(pattern: str, words: str, typed: str) -> Iterator[str]:
    """Names of a pattern: with the order that is typed, or with usual ones, and every part."""
    own = typed.split(".")[1] if typed.count(".") > 1 else ""
    orders = [own] if own.isdecimal() else ["1", "2", "4"]
    parts = words.partition(": ")[2].removesuffix(" (deg)").split(", ")
    names = [pattern.replace(".N.", f".{n}.") for n in orders] if ".N." in pattern else [pattern]
    for name in names:
        if name.endswith(".PART"):
            yield from (name.removesuffix("PART") + part for part in parts)
        else:
            yield name


def complete_searches(incomplete: str) -> list[str]:
    """What can be arranged, of `--over`."""
    return _beginning_with(incomplete, ("throws", "firing_order", "bank_angle", "splay"))


def _ask_file() -> list[NamedNumbers]:
    """What the engine file says that has been typed; nothing, where there is none or it is bad:
    that is told when the command is run. Shells say what has been typed in one of two variables; a
    command whose last option lacks its value cannot be parsed.
    """
    from ..engine.load import read
    from ..studies.numbers import name_numbers

    typed = os.environ.get("COMP_WORDS") or os.environ.get("_TYPER_COMPLETE_ARGS", "")
    files = [word for word in typed.split() if word.endswith(".toml") and os.path.isfile(word)]
    try:
        return [name_numbers(read(path)) for path in files[:1]]
    except BalcliError:
        return []


def _beginning_with(incomplete: str, known: Iterable[str]) -> list[str]:
    return [name for name in known if name.startswith(incomplete)]
