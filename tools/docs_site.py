"""What the documentation site has beyond docs/, as a hook of MkDocs (mkdocs.yml).

- the addresses of the project, from pyproject.toml;
- the live page as its root, to which play.html, its former place, forwards;
- the pages at the root of the repository, with their links turned to the site's;
- the pictures of docs/gallery.md, made by the commands that it shows;
- the notebooks of docs/notebooks as pages, as they were run last;
- the commands of a console block alone for its copy button;
- formulas (`$$` … `$$`) as MathML, which browsers show by themselves: no script, no network.
"""

from __future__ import annotations

import re
import tomllib
from html import escape, unescape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from docs_examples import ROOT, Shown, blocks, printed, project

import balcli
from balcli.engine.build import build
from balcli.engine.parse import parse
from balcli.file import examples
from balcli.report.live import describe_engine, explain_still, make_book
from balcli.report.page import FOLDER as ASSETS, Site, find_answers, page
from balcli.show.units import SI
from balcli.sizing.options import SchemeOptions

PAGES = {  # of the repository's root, by their names on the site
    "CHANGELOG.md": "changelog.md",
    "CONTRIBUTING.md": "contributing.md",
    "SECURITY.md": "security.md",
}
FORWARD = """<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>balcli: the page has moved</title>
<script>location.replace("index.html" + location.search + location.hash);</script>
<p>The page is <a href="index.html">here</a>.</p>
</html>
"""
FIRST = "i3"  # engine that the page of all examples shows at first
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))
# what wants a space behind it, and primes, which browsers would raise and make small twice
FUNCTION = r"(<mi>(?:sin|cos|tan)</mi>|<msup><mi>(?:sin|cos|tan)</mi><mn>\d</mn></msup>)"
PRIME = r"(\\[a-z]+|[A-Za-z])('+)"
API = """# Python, name by name

What `import balcli` promises. Everything inside is SI, angles are radians;
[in Python](in-python.md) shows how it is used.

::: balcli
"""


def on_config(config: Any) -> Any:
    """MkDocs asks for its settings: where the project lives."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    addresses = settings["tool"]["hatch"]["metadata"]["hooks"]["custom"]
    config.site_url = addresses["documentation"]
    repository = addresses["repository"]
    # not as repo_url, for which the theme would ask the host for stars at every visit
    config.extra["repository"] = repository
    config.extra["social"] = [{"icon": "material/git", "link": repository, "name": "Source"}]
    return config


def on_files(files: Any, config: Any) -> Any:
    """MkDocs has listed docs/: what is made is added."""
    from mkdocs.structure.files import File  # tests of the rest do without it

    made: dict[str, str | bytes] = {"api.md": API}
    for source, target in PAGES.items():
        text = (ROOT / source).read_text(encoding="utf-8")
        made[target] = link_here(text, config.extra["repository"])
    made["index.html"] = make_play_page(describe_site(config))
    made["play.html"] = FORWARD
    made["icon.svg"] = (ASSETS / "icon.svg").read_bytes()
    for notebook in NOTEBOOKS:
        made |= _convert_notebook(notebook)
    with TemporaryDirectory() as folder:
        for picture in _draw_gallery(Path(folder)):
            made[f"gallery/{picture.name}"] = picture.read_bytes()
    for name, content in made.items():
        files.append(File.generated(config, name, content=content))
    return files


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """MkDocs has read a page: pictures below their commands, formulas for browsers."""
    if page.file.src_uri == "gallery.md":
        markdown = re.sub(r"^```sh\n(.*?)^```$", _show_pictures, markdown, flags=re.M | re.S)
    return re.sub(r"^\$\$\n(.*?)^\$\$$", _write_formula, markdown, flags=re.M | re.S)


def on_page_content(html: str, **_: Any) -> str:
    """MkDocs has made a page: what the copy buttons of its console blocks copy."""
    return re.sub(r'<div class="highlight">(<pre>.*?</pre>)', _add_commands, html, flags=re.S)


def on_post_build(config: Any) -> None:
    """MkDocs has written the site: the reference must have every public name."""
    reference = (Path(config.site_dir) / "api.html").read_text(encoding="utf-8")
    missing = find_missing_names(reference)
    if missing:
        raise ValueError(f"api.html does not have {', '.join(missing)}")


def find_missing_names(reference: str) -> list[str]:
    """Return the public names without an entry in a page of the reference."""
    return [name for name in balcli.__all__ if f'id="balcli.{name}"' not in reference]


def _add_commands(found: re.Match[str]) -> str:
    block = found[1]
    text = unescape(re.sub(r"<[^>]+>", "", block))
    commands = [line.removeprefix("$ ") for line in text.splitlines() if line.startswith("$ ")]
    if 'class="gp"' not in block or not commands:
        return found[0]
    return f'<div class="highlight" data-copy="{escape(chr(10).join(commands))}">{block}'


def link_here(text: str, repository: str) -> str:
    """Links of a page at the root: to the pages of the site; what is none, to the repository."""

    def target(found: re.Match[str]) -> str:
        path = found[1]
        heading = found[2] or ""
        if path.startswith("docs/"):
            return f"]({path.removeprefix('docs/').replace('.ipynb', '.md')}{heading})"
        if path in PAGES or path == "README.md":
            return f"]({PAGES.get(path, 'start.md')}{heading})"
        return f"]({repository}/blob/main/{path}{heading})"

    return re.sub(r"\]\((?!#|[a-z]+:)([^)\s#]+)(#[^)\s]*)?\)", target, text)


def _convert_notebook(notebook: Path) -> dict[str, str | bytes]:
    """The page that a notebook becomes, and its pictures, by their names on the site."""
    from nbconvert import MarkdownExporter  # tests of the rest do without it

    page, extra = MarkdownExporter().from_filename(str(notebook), {"unique_key": notebook.stem})
    own = f"\n\nAs a notebook: [{notebook.name}]({notebook.name})\n"
    pictures = {f"notebooks/{name}": content for name, content in extra["outputs"].items()}
    return {f"notebooks/{notebook.stem}.md": page + own, **pictures}


def _draw_gallery(folder: Path) -> list[Path]:
    """Run the commands of docs/gallery.md; the pictures that they write."""
    text = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
    project(folder)
    commands = [line for block in blocks(text) if block.language == "sh" for line in block.lines]
    for command in commands:
        printed(Shown(command, [], 0, 0), folder)
    return [folder / name for command in commands for name in _pictures(command)]


def _pictures(command: str) -> list[str]:
    return re.findall(r"\S+\.svg", command)


def _show_pictures(found: re.Match[str]) -> str:
    names = _pictures(found[1])
    return "\n\n".join([found[0], *(f"![{name}](gallery/{name})" for name in names)])


def _write_formula(found: re.Match[str]) -> str:
    from latex2mathml.converter import convert  # tests of the rest do without it

    latex = found[1].strip().replace("{aligned}", "{align*}")
    latex = re.sub(PRIME, lambda one: f"{{{one[1]}\\text{{{'′' * len(one[2])}}}}}", latex)
    formula = re.sub(FUNCTION, r'\1<mspace width="0.17em" />', convert(latex, display="block"))
    return f'<div class="formula">{formula}</div>'


# ------------------------------------------------------------------ the page of all examples
ALONE = Site("start.html")


def describe_site(config: Any) -> Site:
    """Return what the live page has as the root of the site."""
    address = config.site_url.removesuffix("/")
    tags = {
        "og:type": "website",
        "og:site_name": config.site_name,
        "og:title": "balcli: change an engine and see what balances it",
        "og:description": config.site_description,
        "og:image": f"{address}/first_screen_card.png",
        "og:image:width": "1200",
        "og:image:height": "630",
    }
    links = {
        "Docs": "start.html",
        "Install": "start.html#install",
        "Source": config.extra["repository"],
    }
    return Site("start.html", tuple(links.items()), tuple(tags.items()))


def make_play_page(site: Site = ALONE) -> str:
    """Return a page on which the reader chooses an example engine and changes its numbers.

    Args:
        site: Links and tags of the page.
    """
    engines = {}
    engines_of_files = {}
    for name in examples.names():
        text = examples.text(name)
        model = parse(text, str(examples.locate(name)))
        engine = build(model)
        engines_of_files[name] = model
        if not explain_still(engine):
            engines[name] = describe_engine(model, engine, text)
    model = engines_of_files[FIRST]
    first = build(model)
    found = find_answers(model, first, None, "auto", SchemeOptions(), FIRST)
    return page(found, SI, make_book(engines, choice=FIRST), f"{FIRST}.toml", site=site)
