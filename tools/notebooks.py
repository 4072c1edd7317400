"""The notebooks in docs/notebooks: run, and what they show written into them.

`python tools/notebooks.py` runs all of them and keeps what each cell shows (text, tables,
pictures), without what differs from run to run: times, versions, numbers of cells. Tests run them
again and compare the text, as of docs/*.md; pictures are only drawn again.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest.mock import patch

ROOT = Path(__file__).resolve().parent.parent
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
KERNEL = {"name": "python3", "display_name": "Python 3", "language": "python"}
PATIENCE = 300  # seconds for a cell, however busy the machine


def run(path: Path, folder: Path) -> Any:
    """The notebook with what its cells show now; they work in this folder.

    Raises:
        CellExecutionError: a cell fails.
    """
    import nbformat
    from nbclient import NotebookClient  # the site does without it

    notebook = nbformat.read(path, as_version=4)
    # whatever the user's own settings are: none of them is read
    own = {"PYTHONPATH": str(ROOT / "src"), "IPYTHONDIR": str(folder / ".ipython")}
    own |= {"JUPYTER_RUNTIME_DIR": str(folder / ".jupyter"), "PYDEVD_DISABLE_FILE_VALIDATION": "1"}
    with patch.dict(os.environ, own):
        resources = {"metadata": {"path": str(folder)}}
        NotebookClient(notebook, timeout=PATIENCE, resources=resources).execute()
    return clean(notebook)


def clean(notebook: Any) -> Any:
    """Without what differs from run to run."""
    notebook.metadata = {"kernelspec": KERNEL, "language_info": {"name": "python"}}
    for number, cell in enumerate(notebook.cells, 1):
        cell.id = f"cell-{number}"
        cell.metadata = {}
        if cell.cell_type == "code":
            cell.execution_count = None
            for output in cell.outputs:
                if "metadata" in output:  # text printed has none
                    output.metadata = {}
                if output.output_type == "execute_result":
                    output.execution_count = None
    return notebook


def texts(notebook: Any) -> Iterator[list[str]]:
    """What each cell shows as lines of text: of tables the words in them, of pictures nothing."""
    for cell in notebook.cells:
        yield [line for output in cell.get("outputs", ()) for line in _lines(output)]


def _lines(output: Any) -> list[str]:
    if output.output_type == "stream":
        return output.text.splitlines()
    html = output.data.get("text/html")
    if html is None:
        return [] if "image/png" in output.data else output.data["text/plain"].splitlines()
    html = re.sub(r"<style.*?</style>", "", html, flags=re.S)
    found = [re.sub(r"<[^>]+>", " ", line).strip() for line in html.splitlines()]
    return [line for line in found if line]


def main() -> None:
    import nbformat

    for path in NOTEBOOKS:
        with TemporaryDirectory() as folder:
            nbformat.write(run(path, Path(folder)), path)
        print(f"{path.name}: {path.stat().st_size / 1e3:.0f} kB", file=sys.stderr)


if __name__ == "__main__":
    main()
