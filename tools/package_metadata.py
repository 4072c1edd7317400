"""What the package index is told of the project's place on the web, as a hook of hatchling.

All of it follows from the two addresses in pyproject.toml, [tool.hatch.metadata.hooks.custom]: the
links on the index, and those of the README, which lead into the repository as it was at that
version.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from hatchling.metadata.plugin.interface import MetadataHookInterface


class ProjectAddresses(MetadataHookInterface):
    """Fills in `readme` and `urls` of the metadata, which pyproject.toml calls dynamic."""

    def update(self, metadata: dict[str, Any]) -> None:
        """Hatchling's: metadata with a version in, readme and urls added."""
        repository = self.config["repository"]
        documentation = self.config["documentation"]
        readme = (Path(self.root) / "README.md").read_text(encoding="utf-8")
        metadata["urls"] = {
            "Documentation": documentation,
            "Source": repository,
            "Changelog": f"{repository}/blob/main/CHANGELOG.md",
            "Issues": f"{repository}/issues",
        }
        metadata["readme"] = {
            "content-type": "text/markdown",
            "text": link_absolutely(readme, f"{repository}/blob/v{metadata['version']}"),
        }


def link_absolutely(text: str, base: str) -> str:
    """Return the Markdown `text` with absolute links to files of the repository.

    Links begin with the address `base`, those of pictures with its raw form, since the page of a
    file is no picture. Links within the page and to other places stay.
    """
    raw = base.replace("/blob/", "/raw/")
    text = re.sub(r"(!\[[^\]]*\])\((?![a-z]+:)([^)\s]+)\)", rf"\1({raw}/\2)", text)
    text = re.sub(r'\b(src|srcset)="(?![a-z]+:)([^"]+)"', rf'\1="{raw}/\2"', text)
    return re.sub(r"\]\((?!#|[a-z]+:)([^)\s]+)\)", rf"]({base}/\1)", text)
