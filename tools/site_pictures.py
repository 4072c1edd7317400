"""Write the pictures of the live page's first screen, which need a Chromium.

- docs/first_screen.png and docs/first_screen_dark.png, of README.md and of the documentation;
- docs/first_screen_card.png, which other sites show beside a link to this one.
"""

from __future__ import annotations

import base64
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from docs_examples import ROOT
from docs_site import make_play_page
from PIL import Image
from support.browser import Browser

LARGEST = 200_000  # bytes of a picture in the README
COLOURS = 128
SETTLED = "new Promise((done) => setTimeout(done, 1500))"


class Screen(NamedTuple):
    """A picture of the page: its file, its size in pixels, and whether it is dark."""

    file: str
    width: int
    height: int
    dark: bool


SCREENS = (
    Screen("first_screen.png", 1400, 706, dark=False),
    Screen("first_screen_dark.png", 1400, 706, dark=True),
    Screen("first_screen_card.png", 1200, 630, dark=False),
)


def main() -> None:
    with TemporaryDirectory() as folder:
        page = Path(folder) / "index.html"
        page.write_text(make_play_page(), encoding="utf-8")
        browser = Browser(Path(folder) / "profile")
        for screen in SCREENS:
            browser.open(page, width=screen.width, height=screen.height, dark=screen.dark)
            browser.run(SETTLED)
            taken = browser.call("Page.captureScreenshot", format="png")["data"]
            write_picture(base64.b64decode(taken), ROOT / "docs" / screen.file)
        browser.close()


def write_picture(taken: bytes, file: Path) -> None:
    """Write a picture with few colours, which the page has anyway."""
    picture = Image.open(BytesIO(taken)).convert("RGB")
    few = picture.quantize(COLOURS, dither=Image.Dither.NONE)
    few.save(file, optimize=True)
    if file.stat().st_size > LARGEST:
        raise ValueError(f"{file} has {file.stat().st_size} bytes, more than {LARGEST}")


if __name__ == "__main__":
    main()
