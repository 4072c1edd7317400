"""Starting files: a commented engine of every common kind, which analyses as it stands and teaches
the keys.
"""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path

from ..errors import BalcliError

KINDS = ("single", "inline", "vee", "boxer", "radial", "w", "mounts")
SCHEMA = """\
#:schema balcli.schema.json
# Editors that know TOML check and complete what you type, with that file here: `balcli schema -o balcli.schema.json`

"""
_FOLDER = Path(__file__).with_name("starting_files")


def template(kind: str) -> str:
    """The engine file of a kind as TOML text. BalcliError for an unknown kind, with the nearest one
    and all of them.
    """
    if kind not in KINDS:
        near = get_close_matches(kind.lower()[:100], KINDS, 1)
        hint = f" Did you mean {near[0]}?" if near else ""
        raise BalcliError(
            f'"{kind[:60]}" is no kind of engine; there are {", ".join(KINDS)}.{hint}'
        )
    parts = (_FOLDER / f"{name}.toml" for name in (kind, "optional"))
    return SCHEMA + "".join(part.read_text(encoding="utf-8") for part in parts)
