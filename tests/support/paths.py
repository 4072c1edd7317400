"""Where things stand in the repository, and files that tests write."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src"
PACKAGE = SOURCE / "balcli"
ENGINES = ROOT / "engines"
ENGINE_FILES = sorted(ENGINES.rglob("*.toml"))  # textbook layouts, and engines by class
DOCS = ROOT / "docs"


def write(path: Path, text: str) -> Path:
    """A file of this text; returns its path."""
    path.write_text(text, encoding="utf-8")
    return path
