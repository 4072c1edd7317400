"""What every answer can do besides holding figures: tell in a line what it is, be shown in a
notebook, become a dict, rows, a DataFrame, a Dataset or a Parquet file.

How answers are shown is the business of `render`, which stands above them; it is imported when one
is asked for.
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas


class Result:
    """An answer, which can be kept, shown and handed on."""

    @property
    def summary(self) -> str:
        """What it is, in a few words."""
        return ""

    @property
    def doubts(self) -> tuple[str, ...]:
        """What it has that can be and yet is unlikely, in words, as the commands say it on standard
        error; of what a file says, its engine tells.
        """
        return ()

    def __repr__(self) -> str:
        return f"<{' '.join(filter(None, (type(self).__name__, self.summary)))}>"

    def _repr_html_(self) -> str:
        """What the command prints, for a notebook."""
        return import_module("balcli.render.notebook").show_in_notebook(self)

    def to_dict(self) -> dict[str, Any]:
        """The document that the command writes as JSON (docs/json.md): its keys name SI units."""
        return import_module("balcli.render.exchange").describe(self)

    def rows(self) -> list[dict[str, Any]]:
        """One dict a row, all with the same keys: a DataFrame of any library takes them as they
        are. What has no value is None.
        """
        return import_module("balcli.render.exchange").list_rows(self)

    def to_pandas(self) -> pandas.DataFrame:
        """The rows as a DataFrame; units of columns are its `attrs["units"]`, as far as neither
        their names nor a column `unit` tell them.

        Raises:
            BalcliError: pandas is not installed.
        """
        return import_module("balcli.render.exchange").make_frame(self)

    def to_parquet(self, path: str | Path) -> None:
        """Write the rows into a Parquet file; each column has its unit in the metadata.

        Raises:
            BalcliError: pyarrow is not installed; the file cannot be written.
        """
        import_module("balcli.render.exchange").write_parquet(self, path)
