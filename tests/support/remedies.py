"""What tests ask of a remedy."""

from __future__ import annotations

from typing import Any

from balcli.sizing.remedy import Remedy


def figures(remedy: Remedy, group: str = "") -> dict[str, Any]:
    """The details of a group by their labels, SI."""
    return {detail.label: detail.value for detail in remedy.details if detail.group == group}
