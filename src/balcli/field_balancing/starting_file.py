"""A commented file of runs to start from, which balances as it stands and teaches the keys."""

from __future__ import annotations

from pathlib import Path

KIND = "field"  # what `balcli new` and `balcli schema` call such a file


def read_starting_file() -> str:
    """Its text, TOML."""
    return Path(__file__).with_suffix(".toml").read_text(encoding="utf-8")
