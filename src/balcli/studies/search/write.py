"""The engine file with a design that was found."""

from __future__ import annotations

from ...engine.build import build
from ...engine.load import parse
from ...enginefile.edit import set_keys
from ...errors import BalcliError, InputError
from .designs import TABLES, Design

NOTE = "found by balcli"


def write_design(text: bytes, design: Design, name: str = "") -> str:
    """The text of an engine file (its name: where the files beside it are), comments and all, with
    a design; a firing order that no longer fits is left out.

    Raises:
        BalcliError: the engine needs one.
    """
    if design.number is not None:
        path, best = design.number
        raise BalcliError(
            f"--write takes throws, firing orders and angles; write {path} = {best:.9g} by hand"
        )
    new = text.decode("utf-8-sig")
    for key, value in design.given().items():
        new = set_keys(new, TABLES[key], {key: value}, NOTE)
    if design.firing_order is not None:
        new = set_keys(new, "layout", {"firing_intervals": None}, NOTE)
    if not _is_engine(new, name):
        new = set_keys(new, "layout", {"firing_order": None, "firing_intervals": None}, NOTE)
        if not _is_engine(new, name):
            raise BalcliError(
                "--write: the firing order of the file does not fit what was found, and [gas] "
                "needs one: look for it by --over firing_order, or leave [gas] out"
            )
    return new


def _is_engine(text: str, name: str) -> bool:
    try:
        build(parse(text, name))
    except InputError:
        return False
    return True
