"""What a shell offers when one presses Tab: asked as bash asks it, in a process of its own."""

import pytest
from support.commands import run_python

from balcli.cli import COMMANDS

CASES = [
    ("", set(COMMANDS)),
    ("ana", {"analyze"}),
    ("balance --scheme k", {"knuckles"}),
    ("tables liu-", {"liu-1", "liu-2", "liu-3"}),
    ("engines vtwin", {"vtwin45", "vtwin90"}),
]


@pytest.mark.parametrize(("typed", "offered"), CASES, ids=[typed or "nothing" for typed, _ in CASES])
def test_tab_offers(typed: str, offered: set[str]) -> None:
    asking = {
        "_BALCLI_COMPLETE": "complete_bash",
        "COMP_WORDS": f"balcli {typed}",
        "COMP_CWORD": str(typed.count(" ") + 1),
    }
    done = run_python("-m", "balcli", env=asking)
    assert (set(done.stdout.split()), done.stderr) == (offered, "")
