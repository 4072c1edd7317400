"""Where things stand in the repository, and files that tests write."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src"
PACKAGE = SOURCE / "balcli"
ENGINES = ROOT / "engines"
_FILES = sorted(ENGINES.rglob("*.toml"))  # textbook layouts, and engines by class
GEARED_FILES = [file for file in _FILES if "[[engine]]" in file.read_text("utf-8")]
ENGINE_FILES = [file for file in _FILES if file not in GEARED_FILES]
DOCS = ROOT / "docs"


def write(path: Path, text: str) -> Path:
    """A file of this text; returns its path."""
    path.write_text(text, encoding="utf-8")
    return path
