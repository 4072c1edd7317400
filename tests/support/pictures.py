"""Pages of pictures as files."""

from contextlib import ExitStack
from unittest.mock import patch

from balcli.report.pages import PageSubject, make_page
from balcli.show.plot_style import Form, save_figure


def draw_page(subject: PageSubject, what: str, form: Form) -> bytes:
    """The content of a file with this page of `PAGES`."""
    return save_figure(make_page(subject, what), form)


def without_pictures() -> ExitStack:
    """A context in which reports have empty pictures: drawing them takes most of their time."""
    stack = ExitStack()
    stack.enter_context(patch("balcli.report.page.inline_svg", lambda *_: "<svg></svg>"))
    for name in ("balcli.report.page.save_figure", "balcli.torsional_vibration.plot.make_torsion"):
        stack.enter_context(patch(name, lambda *_, **__: b""))
    return stack
