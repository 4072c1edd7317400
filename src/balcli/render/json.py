"""A document as JSON."""

from __future__ import annotations

import json
from typing import Any


def json_text(document: Any) -> str:
    """One document on one line; a nan or infinity in it is a fault of ours and raises
    ValueError.
    """
    return json.dumps(document, ensure_ascii=False, allow_nan=False)
