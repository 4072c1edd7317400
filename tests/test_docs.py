"""README.md and docs/**/*.md: what they show is what is printed, their links lead somewhere, and
every command is described.
"""

import re
import shutil
from functools import cache
from pathlib import Path

import docs_examples as guide
import engine_file_reference as reference
import pytest

from balcli.cli import COMMANDS

README = guide.ROOT / "README.md"
TOUR = guide.ROOT / "docs" / "tour.md"
PAGES = [guide.ROOT / f"{name}.md" for name in ("CONTRIBUTING", "SECURITY", "CODE_OF_CONDUCT", "CHANGELOG")]
RECIPES = sorted((guide.ROOT / "docs" / "recipes").glob("*.md"))


def name_document(path: Path) -> str:
    return path.relative_to(guide.ROOT).as_posix()


STRESSED = [pytest.param(path, marks=[pytest.mark.stress] * (path != README)) for path in guide.DOCUMENTS]


@pytest.mark.parametrize("document", STRESSED, ids=name_document)
def test_everything_shown_is_what_is_printed(document: Path, tmp_path: Path) -> None:
    text = document.read_text(encoding="utf-8")
    folder = guide.project(tmp_path)
    for name, content in guide.files(text).items():
        (folder / name).write_text(content, encoding="utf-8")
    wrong = [
        f"$ {one.command}\n" + "\n".join(found)
        for one in guide.shown(text)
        if not guide.agrees(one.expected, found := guide.printed(one, folder))
    ]
    assert not wrong, (
        f"{document.name} shows something else (python tools/docs_examples.py {name_document(document)} "
        "renews it):\n" + "\n\n".join(wrong)
    )


def test_every_python_example_of_the_tour_shows_what_it_prints() -> None:
    """So that it is run above, like the commands."""
    text = TOUR.read_text(encoding="utf-8")
    ran = ["\n".join(block.lines) for block in guide.blocks(text) if block.language == "python"]
    assert ran
    assert ran == [one.command for one in guide.shown(text) if one.python]


def test_comparison_sees_a_changed_figure_and_passes_over_what_is_left_out() -> None:
    found = ["force", "1  2.5", "2  0.5", "", "end"]
    same = ["force", "…", "2  0.5", "…"]
    other = ["force", "…", "2  0.6", "…"]
    assert all(guide.agrees(shown, found) for shown in (found, same))
    assert not any(guide.agrees(shown, found) for shown in (other, ["force", "1  2.5"], ["1  2.5", "…"]))
    assert guide.agrees(["0.12345678901,0.0"], ["0.12345678902,-1.23456789012e-16"])
    assert guide.agrees(["bound  0"], ["bound  4.5424e-16"])
    for shown, printed in (("0.12345678901", "0.12345679901"), ("bound  0", "bound  4.5424e-12")):
        assert not guide.agrees([shown], [printed])


def test_nothing_shown_is_rounding() -> None:
    for document in guide.DOCUMENTS:
        lines = [line for one in guide.shown(document.read_text(encoding="utf-8")) for line in one.expected]
        rounding = [line for line in lines if re.search(r"\de-(1[3-9]|[2-9]\d)\b", line)]
        assert rounding == [], name_document(document)


def test_front_page_begins_with_a_picture_and_a_result() -> None:
    text = (guide.ROOT / "docs" / "start.md").read_text(encoding="utf-8")
    parts = [text.index(part) for part in ("![", "```console", "## I want to …", "## Install")]
    assert parts == sorted(parts)


def test_a_recipe_is_a_page_of_one_task() -> None:
    overview = (guide.ROOT / "docs" / "recipes" / "index.md").read_text(encoding="utf-8")
    for recipe in RECIPES:
        text = recipe.read_text(encoding="utf-8")
        assert len(text.splitlines()) <= 75, recipe.name
        if recipe.name != "index.md":
            title = text.splitlines()[0].removeprefix("# ")
            assert f"[{title}]({recipe.name})" in overview, recipe.name
            assert "\nNext: " in text, recipe.name


def test_glossary_has_every_term_in_four_languages() -> None:
    glossary = (guide.ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
    rows = [row.strip("| ").split(" | ") for row in re.findall(r"^\| .+", glossary, re.MULTILINE)]
    terms = [row for row in rows if row[0] != "English" and not row[0].startswith("---")]
    assert len({row[0] for row in terms}) == len(terms) > 50
    for _, meaning, chinese, russian, german in terms:
        assert meaning.endswith("."), meaning
        assert re.search("[\u4e00-\u9fff]", chinese), chinese
        assert re.search("[а-я]", russian), russian
        assert re.search("[A-Za-z]", german), german


def test_tour_describes_every_command() -> None:
    text = TOUR.read_text(encoding="utf-8")
    assert [name for name in COMMANDS if not re.search(rf"^\| `balcli {name}\b", text, re.MULTILINE)] == []


def test_readme_is_a_first_screen() -> None:
    lines = README.read_text(encoding="utf-8").splitlines()
    assert len(lines) <= 120
    assert max(map(len, lines)) <= 160


@pytest.mark.slow
def test_commands_of_the_readme_table_run(tmp_path: Path) -> None:
    table = re.findall(r"^\| .+", README.read_text(encoding="utf-8"), re.MULTILINE)
    commands = [one for row in table for one in re.findall(r"`(balcli [a-z].+?)`", row)]
    assert len(commands) > 12
    folder = guide.project(tmp_path)
    for example in folder.glob("engines/**/*.toml"):
        shutil.copy(example, folder)
    for command in commands:
        guide.printed(guide.Shown(command, [], 0, 0), folder)


def test_pictures_of_the_readme_are_small_and_there() -> None:
    text = README.read_text(encoding="utf-8")
    pictures = re.findall(r'(?:src|srcset)="(docs/[^"]+)"', text)
    assert len(pictures) == 2
    assert all((guide.ROOT / picture).stat().st_size <= 200_000 for picture in pictures)


def test_links_lead_to_files_and_headings_that_exist() -> None:
    broken = {name_document(document): list_broken_links(document) for document in (*guide.DOCUMENTS, *PAGES)}
    assert {name: links for name, links in broken.items() if links} == {}


def list_broken_links(document: Path) -> list[str]:
    """Links of a document that lead to no file, or to no heading of it."""
    broken = []
    for target in re.findall(r"\]\(([^)\s]+)\)", document.read_text(encoding="utf-8")):
        if target.startswith(("http", "mailto:")) or target == "index.html":  # which the site makes
            continue
        file, _, heading = target.partition("#")
        there = document.parent / file if file else document
        names_heading = heading and there.suffix == ".md"  # only-dark of a picture names none
        if not there.exists() or (names_heading and heading not in anchors(there)):
            broken.append(target)
    return broken


@cache
def anchors(document: Path) -> set[str]:
    """Names of the headings, as hosts of Markdown make them."""
    headings = re.findall(r"^#+ (.+)$", document.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_commands_md_has_the_help_of_every_command() -> None:
    """And that is what is printed, like all that documents show."""
    text = (guide.ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
    shown = [one.command for one in guide.shown(text)]
    assert shown == ["balcli --help", *(f"balcli {name} --help" for name in COMMANDS)]
    assert re.findall(r"^### (\w+)$", text, re.MULTILINE) == list(COMMANDS)


def test_engine_file_reference_is_up_to_date() -> None:
    assert reference.DOCUMENT.read_text(encoding="utf-8") == reference.document(), (
        "python tools/engine_file_reference.py writes it anew"
    )


def test_engine_file_reference_keeps_abbreviations() -> None:
    """A meaning begins with a small letter, but not CSV or IACS."""
    assert not re.findall(r"\| [a-z][A-Z]{2}\w* ", reference.document())


def test_every_json_format_is_described() -> None:
    source = "".join(file.read_text(encoding="utf-8") for file in (guide.ROOT / "src").rglob("*.py"))
    described = (guide.ROOT / "docs" / "json.md").read_text(encoding="utf-8")
    formats = set(re.findall(r"balcli\.[a-z]+/\d+", source))
    assert len(formats) > 5
    assert not {name for name in formats if f"`{name}`" not in described}
