"""A browser for the tests of pages, and the pages that several of them look at."""

from functools import cache

import pytest
from docs_site import make_play_page
from support.browser import Browser
from support.commands import ask
from support.paths import write
from support.pictures import without_pictures


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    it = Browser(tmp_path_factory.mktemp("profile"))
    yield it
    it.close()


@pytest.fixture(scope="session")
def play(tmp_path_factory):
    """The file with the page of all examples."""
    return write(tmp_path_factory.mktemp("site") / "play.html", make_play_page())


@pytest.fixture(scope="session")
def report(tmp_path_factory):
    """The file with the page of an engine, without pictures, written once: a function of the engine file's text and
    name, and of options.
    """

    @cache
    def write_page(text: str, *options: str, name: str = "engine.toml"):
        folder = tmp_path_factory.mktemp("page")
        with without_pictures():
            ask("-q", "report", write(folder / name, text), *options, "-o", folder / "page.html")
        return folder / "page.html"

    return write_page
