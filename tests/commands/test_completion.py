"""What a shell offers when one presses Tab: asked as bash asks it, in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from balcli.cli import COMMANDS

SOURCE = str(Path(__file__).resolve().parents[2] / "src")
CASES = [
    ("", set(COMMANDS)),
    ("ana", {"analyze"}),
    ("analyze --form", {"--format"}),
    ("analyze --format m", {"markdown"}),
    ("new ra", {"radial"}),
    ("balance --scheme t", {"two-shaft"}),
    ("balance --scheme k", {"knuckles"}),
    ("tables liu-", {"liu-1", "liu-2", "liu-3"}),
    ("engines vtwin", {"vtwin45", "vtwin90"}),
]


@pytest.mark.parametrize(
    ("typed", "offered"), CASES, ids=[typed or "nothing" for typed, _ in CASES]
)
def test_tab_offers(typed: str, offered: set[str]) -> None:
    asking = {
        "_BALCLI_COMPLETE": "complete_bash",
        "COMP_WORDS": f"balcli {typed}",
        "COMP_CWORD": str(typed.count(" ") + 1),
    }
    done = subprocess.run(
        [sys.executable, "-c", "from balcli.cli import main; main()"],
        env=os.environ | asking | {"PYTHONPATH": SOURCE},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert (set(done.stdout.split()), done.stderr) == (offered, "")
