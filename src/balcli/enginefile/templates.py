"""Starting files: commented ones that work as they stand, of every common kind of engine, of runs
of a rotor and of a chain of shafts.
"""

from __future__ import annotations

import re
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

# what people call the kinds
_CALLED = {
    r"v|v-?\d+|v-?twin|vee-?\w*": "vee",
    r"[il]-?\d+|r\d+|straight-?\w+|in-?line-?\w+|line|(parallel-?)?twin|four|six": "inline",
    r"h?flat-?\w*|boxer-?\w+|b\d+|[fh]\d+": "boxer",
    r"w-?\d+": "w",
    r"one|thumper|mono|1": "single",
    r"star|radial-?\w+": "radial",
    r"chain|shafts?|holzer": "torsion",
    r"rotor|fan|runs": "field",
}


def _known_as(kind: str) -> str:
    """What a layout such as v8 or i4 is called here, and where there is one that is finished."""
    called = next((name for pattern, name in _CALLED.items() if re.fullmatch(pattern, kind)), None)
    hint = f" That is {called}: balcli new {called}." if called else ""
    if kind in examples.names():
        return f"{hint} A finished one is among the examples: balcli engines {kind}."
    return hint and f"{hint} A finished one may be among the examples: balcli engines."


def template(kind: str) -> str:
    """The starting file of a kind as TOML text. BalcliError for an unknown kind, with the nearest
    one and all of them.
    """
    if kind not in KINDS:
        near = nearest(kind, KINDS)
        hint = _known_as(kind.lower()) or (f" Did you mean {near}?" if near else "")
        raise BalcliError(
            f'"{kind[:60]}" is no kind of file to start from; there are {", ".join(KINDS)}.{hint}'
        )
    if kind in ENGINE_KINDS:
        return SCHEMA + _read(kind) + _read("optional")
    return _read(kind)


def _read(name: str) -> str:
    return (_FOLDER / f"{name}.toml").read_text(encoding="utf-8")
