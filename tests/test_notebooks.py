"""The notebooks in docs/: they run as they stand, and show what is shown in them."""

import json
import re
from pathlib import Path

import docs_examples as guide
import pytest

nbformat = pytest.importorskip("nbformat")
import notebooks  # noqa: E402

LARGEST = 400_000  # bytes


@pytest.mark.stress  # a process of its own for each, and all that notebooks need
@pytest.mark.parametrize("path", notebooks.NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_shows_what_it_computes(path: Path, tmp_path: Path) -> None:
    for needed in ("nbclient", "ipykernel", "pandas"):  # imported for this test alone: they take half a second
        pytest.importorskip(needed)
    shown = nbformat.read(path, as_version=4)
    found = notebooks.run(path, tmp_path)
    wrong = [
        f"{cell.source}\n=> " + "\n".join(now)
        for cell, before, now in zip(found.cells, notebooks.texts(shown), notebooks.texts(found), strict=True)
        if not guide.agrees(before, now)
    ]
    assert not wrong, "python tools/notebooks.py renews:\n" + "\n\n".join(wrong)
    assert [kinds(cell) for cell in shown.cells] == [kinds(cell) for cell in found.cells]


def kinds(cell) -> list[list[str]]:
    """Of what kinds each output of a cell is: text, tables, pictures."""
    return [sorted(output.get("data", ["text"])) for output in cell.get("outputs", ())]


@pytest.mark.parametrize("path", notebooks.NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_holds_no_more_than_what_it_shows(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert len(text) < LARGEST
    assert json.loads(text)["metadata"] == {"kernelspec": notebooks.KERNEL, "language_info": {"name": "python"}}
    lines = [line for lines in notebooks.texts(nbformat.read(path, as_version=4)) for line in lines]
    assert [line for line in lines if re.search(r"\de-(1[3-9]|[2-9]\d)\b| at 0x|/(home|tmp)/", line)] == []


def test_there_are_notebooks() -> None:
    assert len(notebooks.NOTEBOOKS) >= 3
