"""`balcli schema`"""

from __future__ import annotations

import json

from .options import Output
from .output import emit


def schema(output: Output = None) -> None:
    """Print the JSON Schema of the engine file, for editors."""
    from ..enginefile.schema import schema as describe  # pydantic

    emit(json.dumps(describe(), indent=2, ensure_ascii=False), output)
