"""A document as JSON."""

from __future__ import annotations

import json
from typing import Any

from .. import __version__


def json_text(document: Any) -> str:
    """One document on one line; a nan or infinity in it is a fault of ours and raises
    ValueError.
    """
    return json.dumps(stamp(document), ensure_ascii=False, allow_nan=False)


def stamp(document: Any) -> Any:
    """A result with the version of the program that wrote it, after its format; anything else as it
    is.
    """
    if not isinstance(document, dict) or "format" not in document:
        return document
    return {"format": document["format"], "version": __version__} | document
