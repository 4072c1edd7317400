"""The engines that are shipped as examples."""

from __future__ import annotations

import tomllib
from difflib import get_close_matches
from pathlib import Path

from ..errors import BalcliError

# In the installed package; in a checkout the repository's own folder, so that there is only one
# copy.
_PLACES = (Path(__file__).parents[1] / "engines", Path(__file__).parents[3] / "engines")


def names() -> dict[str, str]:
    """What each example is called in its file, by its short name."""
    return {
        path.stem: tomllib.loads(path.read_text(encoding="utf-8"))["name"]
        for path in sorted(folder().glob("*.toml"))
    }


def text(name: str) -> str:
    """The engine file of an example. BalcliError for an unknown name, with the nearest ones."""
    known = {path.stem: path for path in folder().glob("*.toml")}
    if name not in known:
        near = get_close_matches(name.lower()[:100], sorted(known), 3)
        hint = f" Did you mean {' or '.join(near)}?" if near else ""
        raise BalcliError(f'there is no example "{name[:60]}": balcli engines lists them.{hint}')
    return known[name].read_text(encoding="utf-8")


def folder() -> Path:
    """Where they are. BalcliError for an installation without them."""
    for place in _PLACES:
        if place.is_dir():
            return place
    raise BalcliError(
        f"the example engines are missing from this installation ({_PLACES[0]}): install balcli "
        "again"
    )
