"""Make each mistake of mutations.toml in a copy of the source, and list those that no test notices.

    python tools/mutants.py            # all, about twenty minutes
    python tools/mutants.py forces     # the mistakes in files whose path contains "forces"

A mistake is a file, a text that stands in it once, what replaces it, and the tests that have to
notice: files or folders of which the tests run that `pytest` runs without -m. Mistakes in the
scripts of the page (report/assets) survive where no Chromium is installed. The exit status is 1 if
a mistake survives, or if its text is no longer in the file.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
PATIENCE = 900  # seconds; a test that runs longer hangs, and has noticed the mistake


class Mutation(NamedTuple):
    """A mistake; `file` is relative to src/balcli, `tests` are paths below tests/."""

    file: str
    old: str
    new: str
    tests: str


def read_mutations(words: list[str]) -> list[Mutation]:
    """Return the mutations whose file contains one of the words; all without words."""
    text = Path(__file__).with_name("mutations.toml").read_text(encoding="utf-8")
    found = [Mutation(*each) for each in tomllib.loads(text)["mutations"]]
    return [m for m in found if not words or any(word in m.file for word in words)]


def judge(mutation: Mutation, folder: Path) -> str:
    """Return "noticed", "SURVIVED" or "NOT FOUND" for a mutation of `src` in a folder."""
    path = folder / "src" / "balcli" / mutation.file
    text = path.read_text(encoding="utf-8") if path.exists() else ""
    if text.count(mutation.old) != 1:
        return "NOT FOUND"
    path.write_text(text.replace(mutation.old, mutation.new), encoding="utf-8")
    tests = [f"tests/{each}" for each in mutation.tests.split()]
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-x",
        "-n",
        "0",
        "-p",
        "no:cacheprovider",
        *tests,
    ]
    environment = {**os.environ, "PYTHONPATH": str(folder / "src"), "PYTHONDONTWRITEBYTECODE": "1"}
    try:
        ended = subprocess.run(
            command, cwd=ROOT, env=environment, capture_output=True, timeout=PATIENCE
        )
    except subprocess.TimeoutExpired:
        return "noticed"
    finally:
        path.write_text(text, encoding="utf-8")
    return "noticed" if ended.returncode in (1, 2) else "SURVIVED"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("words", nargs="*", metavar="WORD", help="part of the path of a file")
    failed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copytree(ROOT / "src", folder / "src")
        (folder / "engines").symlink_to(ROOT / "engines")  # where the source looks for examples
        for mutation in read_mutations(parser.parse_args().words):
            result = judge(mutation, folder)
            failed += result != "noticed"
            print(f"{result:9}  {mutation.file}: {mutation.old}  ->  {mutation.new}", flush=True)
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
