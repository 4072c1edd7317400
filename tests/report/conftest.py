"""A browser for the tests of pages."""

import pytest
from support.browser import Browser


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    it = Browser(tmp_path_factory.mktemp("profile"))
    yield it
    it.close()
