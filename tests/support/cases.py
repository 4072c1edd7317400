"""Cases of tests as data: `tests/cases/FOLDER/NAME.toml` has a table for each test, with the names of its arguments and a
row for each case.
"""

import tomllib
from functools import cache, reduce
from typing import Any

import pytest

from .engines import changed
from .paths import ROOT


def cases(file: str, table: str, **names: Any) -> pytest.MarkDecorator:
    """Parametrize a test by a table.

    Args:
        file: path of the file below `tests/cases`, without its ending.
        table: name of the table in it.
        names: objects of the test that rows name in braces: "{NAME}" alone is the object, within a text it is its text.
    """
    content = _read(file)[table]
    arguments = content["arguments"]
    objects = {"None": None, **names}
    rows = [_fill(row, objects) for row in content["rows"]]
    return pytest.mark.parametrize(arguments[0] if len(arguments) == 1 else arguments, rows)


@cache
def _read(file: str) -> dict[str, Any]:
    """The tables of a file, which nobody changes."""
    return tomllib.loads((ROOT / "tests" / "cases" / f"{file}.toml").read_text(encoding="utf-8"))


def _fill_member(value: Any, objects: dict[str, Any]) -> list[Any]:
    """A member of a list; of "*{NAME}" all members of that list."""
    if isinstance(value, str) and value[:2] == "*{" and value[2:-1] in objects:
        return list(objects[value[2:-1]])
    return [_fill(value, objects)]


def _fill(value: Any, objects: dict[str, Any]) -> Any:
    if isinstance(value, list):
        return [each for one in value for each in _fill_member(one, objects)]
    if isinstance(value, dict) and value.keys() == {"changed"}:  # GOOD with these texts replaced
        return changed(*_fill(value["changed"], objects))
    if isinstance(value, dict) and {"of", "changed"} <= value.keys():  # another text with these replaced, and more
        pairs, text = _fill([value["changed"], value["of"]], objects)
        return reduce(lambda text, pair: text.replace(*pair), pairs, text) + _fill(value.get("more", ""), objects)
    if isinstance(value, dict):
        return {key: _fill(each, objects) for key, each in value.items()}
    return _fill_text(value, objects) if isinstance(value, str) else value


def _fill_text(text: str, objects: dict[str, Any]) -> Any:
    """The object that the whole text names, or the text with the names in it replaced."""
    if text[:1] == "{" and text[1:-1] in objects:
        return objects[text[1:-1]]
    for name, found in objects.items():
        text = text.replace(f"{{{name}}}", str(found))
    return text


def slow(*arguments: object) -> list[object]:
    """Values of a parameter that only the slow tests take."""
    return [pytest.param(each, marks=pytest.mark.slow) for each in arguments]
