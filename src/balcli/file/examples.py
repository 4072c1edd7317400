"""Find the files that come with balcli: example engines, and starting files for new engines.

The folder of examples itself has textbook layouts, one of each kind. Engines that were built, or
could have been, are in its subfolders, one for each class. The first line of an example states in a
comment what the example shows. There is a commented, valid starting file for every common kind of
engine, for runs of a rotor, and for a chain of shafts.
"""

import os
import re
import tomllib
from pathlib import Path
from typing import NamedTuple

from ..errors import BalcliError
from .fields import nearest, suggest_nearest

# Folder of the examples in the installed package, and in a checkout of the repository.
_PLACES = (Path(__file__).parents[1] / "engines", Path(__file__).parents[3] / "engines")
_USUAL_TABLES = {"crank", "rod", "piston", "layout", "operation", "cylinder"}
LAYOUT = "layout"  # class of the files that are in the folder of examples itself


class ExamplePath(str):
    """Path of an example's file, as a command got it by the name of the example.

    Attributes:
        name: Name of the example, by which messages call the file.
    """

    name: str


class Example(NamedTuple):
    """An example engine that comes with balcli.

    Attributes:
        name: Short name: the name of its file without ending.
        group: Class of the engine: the name of its subfolder, or "layout".
        lesson: A sentence on what the engine shows.
        text: Content of the file.
    """

    name: str
    group: str
    lesson: str
    text: str

    def mentions(self, words: str) -> bool:
        """Return whether each of the words occurs in name, class, lesson, title or source, or in
        the name of a table of the file, such as gas. Case does not matter.
        """
        head, _, _ = self.text.partition("\n[")
        tables = {*re.findall(r"^\[+([a-z]+)", self.text, re.MULTILINE)} - _USUAL_TABLES
        searched = f"{self.name} {self.group} {head} {' '.join(tables)}".lower()
        return all(word in searched for word in words.lower().split())


def find(words: str = "") -> list[Example]:
    """Return the examples that mention all the words: layouts first, then by class and name.

    Args:
        words: Words with spaces between them.

    Raises:
        BalcliError: No example mentions the words.
    """
    matching = [
        example for example in map(_read, _find_paths().values()) if example.mentions(words)
    ]
    if not matching:
        raise BalcliError(f'no example mentions "{words[:60]}": balcli engines lists all examples')
    return matching


def names() -> list[str]:
    """Return the short names of all examples, layouts first, then by class."""
    return list(_find_paths())


def is_example(name: str) -> bool:
    """Return whether there is an example with this short name; false if the installation has no
    folder of examples.
    """
    return name in _list_installed()


def find_similar(name: str) -> str:
    """Return the example that was probably meant; empty if none is similar."""
    return nearest(name, _list_installed(), cutoff=0.8)


def _list_installed() -> list[str]:
    return [path.stem for place in _PLACES for path in sorted(place.rglob("*.toml"))]


def text(name: str) -> str:
    """Return the engine file of an example.

    Raises:
        BalcliError: No example has this name; the error lists the nearest ones.
    """
    return locate(name).read_text(encoding="utf-8")


def locate(name: str) -> Path:
    """Return the path of an example's file; errors as for `text`."""
    paths = _find_paths()
    if name in paths:
        return paths[name]
    hint = suggest_nearest(name, paths, "balcli engines lists all examples")
    raise BalcliError(f'there is no example "{name[:60]}": {hint}')


def find_by_name(typed: str) -> str:
    """Return the path of the example that was typed in place of a file, otherwise the typed text. A
    file of this name has precedence; a text with a folder or an ending is always a file.
    """
    is_name = typed == Path(typed).stem and not os.path.lexists(typed)
    if not is_name or not is_example(typed):
        return typed
    path = ExamplePath(locate(typed))
    path.name = typed
    return path


def list_engine_files(name: str) -> dict[str, str]:
    """Return the texts of the engine files that an example names in [[engine]], by file name."""
    named = tomllib.loads(text(name)).get("engine", ())
    place = locate(name).parent
    return {one["file"]: (place / one["file"]).read_text(encoding="utf-8") for one in named}


def folder() -> Path:
    """Return the folder of the examples.

    Raises:
        BalcliError: The installation has no such folder.
    """
    place = next(filter(Path.is_dir, _PLACES), None)
    if place is None:
        raise BalcliError(f"there is no folder of examples ({_PLACES[0]}): install balcli again")
    return place


def _find_paths() -> dict[str, Path]:
    """Return the files of the examples by short name, layouts first, then by class."""
    place = folder()
    every = [*sorted(place.glob("*.toml")), *sorted(place.glob("*/*.toml"))]
    return {path.stem: path for path in every}


def _read(path: Path) -> Example:
    content = path.read_text(encoding="utf-8")
    group = LAYOUT if path.parent in _PLACES else path.parent.name
    return Example(path.stem, group, content.partition("\n")[0].lstrip("# "), content)


ENGINE_KINDS = ("single", "inline", "vee", "boxer", "radial", "radial14", "w", "mounts")
KINDS = (*ENGINE_KINDS, "compressor", "locomotive", "field", "four-runs", "torsion")
SCHEMA = (
    "#:schema balcli.schema.json\n"
    "# TOML editors use that schema to check and complete what you type: "
    "`balcli schema -o balcli.schema.json` writes it\n\n"
)
_FOLDER = Path(__file__).with_name("starting_files")


def template(kind: str) -> str:
    """Return the starting file of a kind as TOML text.

    Raises:
        BalcliError: There is no such kind; the error lists all kinds and names the nearest.
    """
    if kind not in KINDS:
        hint = suggest_nearest(kind, KINDS, f"there are {', '.join(KINDS)}")
        raise BalcliError(f'"{kind[:60]}" is not a kind of file; {hint}')
    if kind in ENGINE_KINDS:
        return SCHEMA + _read_template(kind) + _read_template("optional")
    schema = SCHEMA if kind in ("compressor", "locomotive") else ""
    return schema + _read_template(kind)


def _read_template(name: str) -> str:
    return (_FOLDER / f"{name}.toml").read_text(encoding="utf-8")
