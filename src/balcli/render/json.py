"""A document as JSON."""

from __future__ import annotations

import json
from typing import Any

from ..version import __version__


def json_text(document: Any) -> str:
    """One document on one line; ValueError for a nan or infinity in it, a fault of ours."""
    return json.dumps(stamp(document), ensure_ascii=False, allow_nan=False)


def stamp(document: Any) -> Any:
    """A result with the version that wrote it, after its format; anything else as it is."""
    if not isinstance(document, dict) or "format" not in document:
        return document
    return {"format": document["format"], "version": __version__} | document
