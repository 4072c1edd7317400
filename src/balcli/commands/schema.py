"""`balcli schema`"""

from __future__ import annotations

from .options import Output


def schema(output: Output = None) -> None:
    """Print the JSON Schema of the engine file, for editors."""
    import json

    from ..enginefile.schema import schema as described
    from .output import emit

    emit(json.dumps(described(), indent=2, ensure_ascii=False), output)
