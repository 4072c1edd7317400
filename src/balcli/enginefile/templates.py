"""Starting files: commented ones that work as they stand, of every common kind of engine, of runs
of a rotor and of a chain of shafts.
"""

from __future__ import annotations

from pathlib import Path

from ..errors import BalcliError
from . import examples
from .fields import nearest

ENGINE_KINDS = ("single", "inline", "vee", "boxer", "radial", "w", "mounts")
KINDS = (*ENGINE_KINDS, "field", "torsion")
SCHEMA = """\
#:schema balcli.schema.json
# Editors that know TOML check and complete what you type, with that file here: `balcli schema -o balcli.schema.json`

"""
_FOLDER = Path(__file__).with_name("starting_files")


def template(kind: str) -> str:
    """Return the starting file of a kind as TOML text.

    Raises:
        BalcliError: there is no such kind; with the nearest one and all of them.
    """
    if kind not in KINDS:
        near = nearest(kind, KINDS)
        hint = f" Did you mean {near}?" if near else ""
        if kind in examples.names():
            hint = f" A finished one is among the examples: balcli engines {kind}."
        raise BalcliError(
            f'"{kind[:60]}" is no kind of file to start from; there are {", ".join(KINDS)}.{hint}'
        )
    if kind in ENGINE_KINDS:
        return SCHEMA + _read(kind) + _read("optional")
    return _read(kind)


def _read(name: str) -> str:
    return (_FOLDER / f"{name}.toml").read_text(encoding="utf-8")
