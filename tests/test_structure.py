"""Who imports whom, also by name."""

import ast
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.commands import run_python
from support.paths import PACKAGE, ROOT
from support.trees import list_nodes

import balcli
from balcli import names

# The modules of each table of names, except those of RENDERERS.
TABLES = {
    "PUBLIC": {*names.PUBLIC.values()},
    "DOCUMENTS": {place.partition(":")[0] for place in names.DOCUMENTS.values()},
    "CHAPTERS": {*names.CHAPTERS.values()},
    "CHAPTER_LISTS": {*names.CHAPTER_LISTS.values()},
    "QUANTITIES": {*names.QUANTITIES.values()},
}


def test_the_import_contract_is_kept() -> None:
    """One way through the floors, no circle, and a core of numpy alone: `[tool.importlinter]` of pyproject.toml."""
    pytest.importorskip("importlinter")
    run = [sys.executable, "-c", "from importlinter.cli import lint_imports; raise SystemExit(lint_imports())"]
    done = subprocess.run(run, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("table", TABLES)
def test_no_import_by_name_leads_upward(table: str) -> None:
    """A module by name is in the layer of whoever asks for it, or below."""
    lowest = min(find_layer(name_module(path)) for path in find_users(table))
    assert {module for module in TABLES[table] if find_layer(module) > lowest} == set()


def test_a_result_and_what_shows_it_are_in_one_folder() -> None:
    for result, module in names.RENDERERS.items():
        assert module.partition(".")[0] == names.PUBLIC[result].partition(".")[0]


def test_every_table_of_names_is_checked_here() -> None:
    tables = {name for name, value in vars(names).items() if name.isupper() and isinstance(value, dict)}
    assert {name for name in tables if not name.startswith("_")} == {*TABLES, "RENDERERS"}


def test_public_names_are_there() -> None:
    """The library's door: what it promises can be had, and is offered for completion."""
    assert sorted(balcli.__all__) == sorted(["__version__", *names.PUBLIC])
    assert dir(balcli) == balcli.__all__
    assert [name for name in balcli.__all__ if getattr(balcli, name) is None] == []
    with pytest.raises(AttributeError, match="module 'balcli' has no attribute 'frobnicate'"):
        _ = balcli.frobnicate


def test_type_checkers_see_the_public_names() -> None:
    """They read the imports and the list, but not the table of names."""
    tree = ast.parse((PACKAGE / "__init__.py").read_text(encoding="utf-8"))
    imports = {
        each.name: node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) for each in node.names
    }
    assert names.PUBLIC.items() <= imports.items()
    (listed,) = [each.value for each in tree.body if isinstance(each, ast.Assign) and each.targets[0].id == "__all__"]
    assert ast.literal_eval(listed) == balcli.__all__


def test_no_folder_hides_a_function() -> None:
    """`balcli.torque` would be a folder of this name as soon as anything in it is imported."""
    assert {path.stem for path in PACKAGE.iterdir()}.isdisjoint(names.PUBLIC)
    done = run_python("-c", IN_ALL_ORDERS)
    assert (done.returncode, done.stdout) == (0, ""), done.stderr


IN_ALL_ORDERS = """
import pkgutil
from importlib import import_module
from types import ModuleType

import balcli
from balcli.names import PUBLIC

def report_modules():
    for name in PUBLIC:
        if isinstance(getattr(balcli, name), ModuleType):
            print(name)

report_modules()
for module in pkgutil.walk_packages(balcli.__path__, "balcli."):
    if not module.name.endswith("__main__"):
        import_module(module.name)
report_modules()
"""


SLOW = {"numpy", "pydantic", "rich", "typer", "matplotlib", "typing"}


def test_importing_the_library_is_quick() -> None:
    """Modules and libraries are imported when a name is used."""
    done = run_python("-c", "import sys; before = {*sys.modules}; import balcli; print(*{*sys.modules} - before)")
    imported = set(done.stdout.split())
    assert imported.isdisjoint(SLOW), done.stderr
    assert {name for name in imported if name.startswith("balcli.")} == {"balcli.names", "balcli.version"}


def test_every_name_leads_to_what_it_says() -> None:
    """Public names, renderers, documents, tables and quantities of chapters."""
    places = [
        *(f"{module}:{name}" for name, module in names.PUBLIC.items()),
        *(f"{module}:RENDERER" for module in names.RENDERERS.values()),
        *(f"{module}:{key.capitalize()}" for key, module in (names.CHAPTERS | names.CHAPTER_LISTS).items()),
        *names.DOCUMENTS.values(),
        *names.QUANTITIES.values(),
    ]
    assert [place for place in places if names.import_name(place) is None] == []


def find_layer(module: str) -> int:
    """The number of a module's layer in the import contract, from the lowest up. The package itself is above all."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    (contract,) = [each for each in settings["tool"]["importlinter"]["contracts"] if each["type"] == "layers"]
    folder = module.partition(".")[0]
    layers = [layer.split(" | ") for layer in reversed(contract["layers"])]
    return next((k for k, layer in enumerate(layers) if folder in layer), len(layers))


def find_users(table: str) -> Iterator[Path]:
    """The modules that import a table of names."""
    for path, nodes in list_nodes():
        for node in nodes:
            if (
                isinstance(node, ast.ImportFrom)
                and node.module == "names"
                and table in {each.name for each in node.names}
            ):
                yield path


def name_module(path: Path) -> str:
    return ".".join(path.relative_to(PACKAGE).with_suffix("").parts)
