"""Pages of pictures as files."""

from __future__ import annotations

from balcli.render.plot.pages import PageSubject, make_page
from balcli.render.plot.style import Form, save_figure


def draw_page(subject: PageSubject, what: str, form: Form) -> bytes:
    """The content of a file with this page of `PAGES`."""
    return save_figure(make_page(subject, what), form)
