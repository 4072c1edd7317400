"""Units, format and digits where a command says none: from the environment, or from a `balcli.toml`
or the table `[tool.balcli]` of a pyproject.toml in this folder or the nearest one above.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import BalcliError, InputError, Problem
from ..limits import LARGEST_FILE_BYTES, LONGEST_SHOWN, MOST_DIGITS
from ..render.formats import Format, Units

SHORT = {"md": "markdown", "txt": "table", "text": "table"}
_VARIABLES = {"units": "BALCLI_UNITS", "format": "BALCLI_FORMAT", "digits": "BALCLI_DIGITS"}
_FILE = "BALCLI_CONFIG"  # to be read instead of one that is looked for; empty: none
_MARK = b"balcli"  # without it, a pyproject.toml is not worth reading


class Defaults(NamedTuple):
    """What is taken where no option says it; None: what balcli takes by itself."""

    units: Units | None = None
    format: Format | None = None
    digits: int | None = None


usual = Defaults()  # of the command that runs
origins: list[str] = []  # where each of them comes from


def load_defaults() -> Defaults:
    """Read them for the command that runs: the environment comes before the file.

    Raises:
        BalcliError: a value that cannot be, with the variable or the file and the key.
        InputError: all mistakes of the file.
    """
    global usual
    usual = Defaults()  # should it fail
    origins.clear()
    usual = usual._replace(**_read_file() | _read_environment())
    return usual


def _read_environment() -> dict[str, Any]:
    found = {}
    for key, variable in _VARIABLES.items():
        if text := os.environ.get(variable):
            is_number = key == "digits" and text.isdecimal() and len(text) <= LONGEST_SHOWN
            value: object = int(text) if is_number else text
            try:
                found[key] = _read_value(key, value)
            except ValueError as error:
                raise BalcliError(f"{variable}: {error}") from None
            origins.append(f"{variable}: {key} = {text}")
    return found


def _read_file() -> dict[str, Any]:
    place = _find_file()
    if place is None:
        return {}
    file, prefix, table = place
    problems, found = [], {}
    for key, value in table.items():
        try:
            found[key] = _read_value(key, value)
        except ValueError as error:
            problems.append(Problem(prefix + key[:LONGEST_SHOWN], str(error)))
        else:
            origins.append(f"{file}: {prefix}{key} = {value}")
    if problems:
        raise InputError(problems, str(file))
    return found


def _find_file() -> tuple[Path, str, Mapping[str, Any]] | None:
    """The nearest file that says something, where in it the keys stand, and these."""
    named = os.environ.get(_FILE)
    if named is not None:
        return _open(Path(named)) if named else None
    for path in _list_candidates():
        if os.path.isfile(path) and (found := _open(path)):
            return found
    return None


def _list_candidates() -> Iterator[Path]:
    try:
        here = Path.cwd()
    except OSError:  # it has been removed
        return
    for folder in (here, *here.parents):
        yield folder / "balcli.toml"
        yield folder / "pyproject.toml"


def _open(path: Path) -> tuple[Path, str, Mapping[str, Any]] | None:
    """None of a pyproject.toml that says nothing of balcli."""
    try:
        with path.open("rb") as stream:
            data = stream.read(LARGEST_FILE_BYTES + 1)
    except OSError as error:
        raise BalcliError(f"{path}: cannot be read ({error.strerror or error})") from None
    of_project = path.name == "pyproject.toml"
    if of_project and _MARK not in data:
        return None
    from ..enginefile.toml_text import parse_toml  # most start without such a file

    content = parse_toml(data, str(path))
    if not of_project:
        return path, "", content
    tools = content.get("tool")
    table = tools.get("balcli") if isinstance(tools, dict) else None
    if table is None:
        return None
    if not isinstance(table, dict):
        told = f"{_shown(table)} stands where a table belongs; write [tool.balcli] and its keys"
        raise InputError([Problem("tool.balcli", f"{told} below it")], str(path))
    return path, "tool.balcli.", table


def _read_value(key: str, value: object) -> Units | Format | int:
    """ValueError with what would be right."""
    if key == "digits":
        if isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= MOST_DIGITS:
            return value
        raise ValueError(f"{_shown(value)}: give a whole number from 1 to {MOST_DIGITS}")
    kinds: dict[str, type[Units | Format]] = {"units": Units, "format": Format}
    if key not in kinds:
        from difflib import get_close_matches

        near = get_close_matches(key, _VARIABLES, 1)
        hint = f"did you mean {near[0]}?" if near else f"there are {', '.join(_VARIABLES)}"
        raise ValueError(f"unknown key; {hint}")
    small = value.lower() if isinstance(value, str) else ""
    name = SHORT.get(small, small) if key == "format" else small
    if name in [*kinds[key]]:
        return kinds[key](name)
    raise ValueError(f"{_shown(value)}: choose from {', '.join(kinds[key])}")


def _shown(value: object) -> str:
    return f'"{value}"'[:LONGEST_SHOWN] if isinstance(value, str) else repr(value)[:LONGEST_SHOWN]
