"""Where things stand in the repository."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src"
PACKAGE = SOURCE / "balcli"
ENGINES = ROOT / "engines"
ENGINE_FILES = sorted(ENGINES.rglob("*.toml"))  # textbook layouts, and engines by class
DOCS = ROOT / "docs"
