"""What stands around the code: workflows run every check that there is, for the versions that are
promised; the package index, citations and hooks say what is so.
"""

import ast
import re
import struct
import tomllib
from html import unescape
from pathlib import Path
from types import SimpleNamespace

import docs_site
import mutants
import pytest
from pygments import highlight as pygmentize
from pygments.formatters import HtmlFormatter
from pygments.lexers import get_lexer_by_name
from support.paths import PACKAGE, ROOT

import balcli
from balcli.cli import COMMANDS

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
WORKFLOW = ".github/workflows/checks.yml"
MUTATIONS = mutants.read_mutations([])


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def test_index_links_of_the_readme_lead_into_the_repository():
    pytest.importorskip("hatchling", reason="hatchling, which builds the wheel, is not installed")
    from package_metadata import ProjectAddresses, link_absolutely

    config = {"repository": "https://example.org/x", "documentation": "https://example.org/docs"}
    metadata = {"version": "1.2"}
    ProjectAddresses(str(ROOT), config).update(metadata)
    readme = metadata["readme"]["text"]
    links = re.findall(r"\]\(([^)]+)\)", readme)
    assert "https://example.org/x/blob/v1.2/docs/theory.md" in links
    pictures = re.findall(r'(?:src|srcset)="([^"]+)"', readme)
    assert pictures == [f"https://example.org/x/raw/v1.2/docs/first_screen{dark}.png" for dark in ("_dark", "")]
    assert not [link for link in links if not link.startswith(("https://", "#"))]
    assert metadata["urls"]["Issues"] == "https://example.org/x/issues"
    stay = "[a](#b) [c](https://example.org/d) [e](mailto:f@g)"
    assert link_absolutely(stay, "https://example.org") == stay


def test_where_the_project_lives_is_said_in_one_place():
    addresses = PROJECT["tool"]["hatch"]["metadata"]["hooks"]["custom"]
    owner = re.match(r"https://[^/]+/[^/]+/", addresses["repository"])[0]
    written = filter(Path.is_file, [*ROOT.glob("*.*"), *ROOT.glob("docs/**/*.md"), *ROOT.glob(".github/**/*.*")])
    assert [file.name for file in written if owner in file.read_text("utf-8", "replace")] == ["pyproject.toml"]
    live = set(re.findall(r'https://[^/]+\.github\.io/[^")]*', text("README.md")))
    assert live == {f"{addresses['documentation']}/"}  # a reader of the README cannot follow a link to a made page


def test_the_workflow_tests_the_versions_that_are_promised():
    listed = re.search(r'python: \[("3.+)\]', text(WORKFLOW))[1]
    tested = re.findall(r'"(3\.\d+)"', listed)
    prefix = "Programming Language :: Python :: 3."
    promised = [c[len(prefix) - 2 :] for c in PROJECT["project"]["classifiers"] if prefix in c]
    assert tested == promised
    assert PROJECT["project"]["requires-python"] == f">={tested[0]}"


def test_the_workflow_runs_every_part_of_the_checks():
    parts = set(re.findall(r"^(\w+)\(\) \{", text(".ci/run"), re.MULTILINE))
    by_default = set(re.search(r"\$\{\*:-(.+)\}", text(".ci/run"))[1].split())
    called = re.search(r"part: \[(.+)\]", text(WORKFLOW))[1].split(", ")
    own_lines = re.findall(r"\.ci/run ([\w ]+)$", text(WORKFLOW), re.MULTILINE)
    run = {part for line in own_lines for part in line.split()}
    run |= {part.removeprefix("run ") for part in called if part != "oldest"}
    assert run == parts == by_default
    assert "oldest" in called


def test_site_shows_every_document():
    nav = text("mkdocs.yml").partition("\nnav:\n")[2]
    listed = re.findall(r"([\w/-]+\.md)$", nav, re.MULTILINE)
    assert len(set(listed)) == len(listed)
    written = {file.relative_to(ROOT / "docs").as_posix() for file in ROOT.glob("docs/**/*.md")}
    notebooks = {f"notebooks/{notebook.stem}.md" for notebook in docs_site.NOTEBOOKS}
    assert set(listed) == written | notebooks | {*docs_site.PAGES.values(), "api.md"}


def test_copy_buttons_of_console_blocks_copy_commands_alone():
    shown = highlight("$ balcli engines i3 'i3 a.toml'\n$ balcli analyze <i3>\nin-line three\n", "console")
    html = docs_site.on_page_content(f"<p>x</p>{shown}{highlight('a = 1', 'toml')}")
    (copied,) = re.findall(r'data-copy="([^"]*)"', html)
    assert unescape(copied) == "balcli engines i3 'i3 a.toml'\nbalcli analyze <i3>"
    assert html.replace(f' data-copy="{copied}"', "") == f"<p>x</p>{shown}{highlight('a = 1', 'toml')}"


def highlight(text, language):
    lines = HtmlFormatter(nowrap=True)
    return f'<div class="highlight"><pre><span></span><code>{pygmentize(text, get_lexer_by_name(language), lines)}</code></pre></div>'


def test_the_reference_must_have_every_public_name():
    entries = [f'<h2 id="balcli.{name}">' for name in balcli.__all__]
    assert docs_site.find_missing_names("".join(entries)) == []
    assert docs_site.find_missing_names("".join(entries[1:])) == [balcli.__all__[0]]


def test_the_public_names_are_a_literal_list():
    """The tool that writes the reference reads the source, and does not run it."""
    tree = ast.parse(text("src/balcli/__init__.py"))
    (names,) = (node.value for node in tree.body if isinstance(node, ast.Assign) and node.targets[0].id == "__all__")
    assert ast.literal_eval(names) == balcli.__all__


def test_the_former_place_of_the_live_page_forwards_with_its_address():
    assert 'location.replace("index.html" + location.search + location.hash)' in docs_site.FORWARD


def test_other_sites_show_a_picture_and_words_beside_a_link():
    config = SimpleNamespace(
        site_url="https://example.org/docs/",
        site_name="balcli",
        site_description="About.",
        extra={"repository": "https://example.org/x"},
    )
    site = docs_site.describe_site(config)
    assert dict(site.tags)["og:image"] == "https://example.org/docs/first_screen_card.png"
    assert [word for word, _ in site.links] == ["Docs", "Install", "Source"]
    theme = text("tools/site_theme/main.html")
    assert all(f'property="{name}"' in theme for name, _ in site.tags)
    assert (ROOT / "docs" / "first_screen_card.png").read_bytes()[16:24] == struct.pack(">2I", 1200, 630)


def test_gallery_shows_what_its_commands_write():
    gallery = text("docs/gallery.md")
    commands = re.findall(r"^balcli .+", gallery, re.MULTILINE)
    shown = docs_site.on_page_markdown(gallery, SimpleNamespace(file=SimpleNamespace(src_uri="gallery.md")))
    pictures = re.findall(r"!\[.+\]\(gallery/(.+\.svg)\)", shown)
    assert len(pictures) == len(set(pictures)) == len(commands) > 10
    for picture, command in zip(pictures, commands, strict=True):
        assert picture in command


def test_hook_for_engine_repositories_checks_the_folder_if_something_in_it_changes():
    """An engine, its diagram or its record; an edited record is as suspicious as an edited engine."""
    hook = text(".pre-commit-hooks.yaml")
    assert re.search(r"entry: balcli (\w+)", hook)[1] in COMMANDS
    assert "args: [engines]\n" in hook
    assert "pass_filenames: false\n" in hook
    inside = ["engines/i4.toml", "engines/car/i4.toml", "engines/p.csv", "engines/expected/i4.json"]
    outside = ["pyproject.toml", "ours/engines/i4.toml", "engines/README.md"]
    pattern = re.search(r"files: (.+)", hook)[1]
    assert [file for file in (*inside, *outside) if re.search(pattern, file)] == inside


def test_citation_and_conda_recipe_have_our_version_and_dependencies():
    assert f"\nversion: {balcli.__version__}\n" in text("CITATION.cff")
    recipe = text("tools/conda/recipe.yaml").replace("matplotlib-base", "matplotlib")
    needed = re.findall(r"    - (\S+ >=\S+)", recipe.partition("  run:\n")[2].partition("\ntests:")[0])
    assert [each.replace(" ", "") for each in needed] == [
        f"python{PROJECT['project']['requires-python']}",
        *PROJECT["project"]["dependencies"],
    ]
    assert f'version: "{balcli.__version__}"' in recipe


def test_every_mistake_of_the_mutations_can_be_made():
    """Its text stands once in its file, where it is changed, and its tests are there."""
    source = {file: (PACKAGE / file).read_text(encoding="utf-8") for file in {each.file for each in MUTATIONS}}
    for each in MUTATIONS:
        assert source[each.file].count(each.old) == 1, each
        assert each.new != each.old, each
        for tests in each.tests.split():
            assert (ROOT / "tests" / tests).exists(), each
