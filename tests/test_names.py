"""What is imported by name is there: public names, renderers, documents, tables and quantities of chapters."""

import pytest

import balcli
from balcli import names


def test_public_names_are_there() -> None:
    """The library's door: what it promises can be had, and is offered for completion."""
    assert dir(balcli) == sorted(balcli.__all__)
    assert [name for name in balcli.__all__ if getattr(balcli, name) is None] == []
    with pytest.raises(AttributeError, match="module 'balcli' has no attribute 'frobnicate'"):
        _ = balcli.frobnicate


def test_every_name_leads_to_what_it_says() -> None:
    places = [
        *(f"{module}:{name}" for name, module in names.PUBLIC.items()),
        *(f"{module}:RENDERER" for module in names.RENDERERS.values()),
        *(f"{module}:{key.capitalize()}" for key, module in (names.CHAPTERS | names.CHAPTER_LISTS).items()),
        *names.DOCUMENTS.values(),
        *names.QUANTITIES.values(),
        names.NOTEBOOK,
    ]
    assert [place for place in places if names.import_name(place) is None] == []
