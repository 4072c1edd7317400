"""The page of an engine that has [torsion] shows how its crankshaft twists."""

from __future__ import annotations

import re

import pytest
from support.commands import ask
from support.diesel import write_diesel


@pytest.mark.stress
def test_the_page_shows_torsion(tmp_path):
    engine, page = tmp_path / "six.toml", tmp_path / "six.html"
    engine.write_text(write_diesel("limit = 20"), encoding="utf-8")
    ask("report", engine, "-o", page)
    text = page.read_text(encoding="utf-8")
    section = text[text.index('<section id="torsion">') :]
    section = section[: section.index("</section>")]
    for what in ("modes", "campbell", "response", "waterfall"):
        assert f'id="torsion-{what}-' in section
    for title in ("Natural modes", "Critical speeds", "Vibratory torque, 1000 to 3000 rpm", "Limits"):
        assert title in section
    ids = re.findall(r' id="([^"]+)"', text)
    assert len(ids) == len(set(ids))
