"""What a shell offers when one presses Tab: asked as bash asks it, in a process of its own."""

from __future__ import annotations

import shutil

import pytest
from support.commands import run_python
from support.paths import ENGINES

from balcli.cli import COMMANDS

CASES = [
    ("", set(COMMANDS)),
    ("ana", {"analyze"}),
    ("analyze --form", {"--format"}),
    ("analyze --format m", {"markdown", "marine"}),
    ("new ra", {"radial"}),
    ("balance --scheme t", {"two-shaft"}),
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


FILE = "v8.toml"
OF_FILES = [
    (f"sweep {FILE} --vary crank.s", {"crank.stroke=", "crank.spacing=", "crank.splay="}),
    (f"sweep {FILE} --vary crank.throws.1=", set()),
    ("sweep nowhere.toml --vary crank.s", set()),
    (f"sweep {FILE} --quantity couple.3.", {f"couple.3.{p}" for p in ("amplitude", "cos", "sin")}),
    (f"sweep {FILE} --quantity peak.force,flu", {"peak.force,fluctuation"}),
    ("sweep nowhere.toml --quantity flu", set()),
    (f"scatter {FILE} --quantity force.2.ma", {"force.2.major"}),
    (f"search {FILE} --minimise peak.m", {"peak.moment"}),
    (f"search {FILE} --over b", {"bank_angle"}),
    ("analyze --only s", {"sizing"}),
    ("analyze --only force,moment,mo", set()),
    ("compare --only force,m", {"force,moment"}),
    ("schema --of sea", {"search"}),
]


@pytest.mark.stress
@pytest.mark.parametrize(("typed", "offered"), OF_FILES, ids=[typed for typed, _ in OF_FILES])
def test_tab_offers_what_the_file_has(typed, offered, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(ENGINES / "v8_wiebe.toml", FILE)
    test_tab_offers(typed, offered)
