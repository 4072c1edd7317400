"""Measure `balcli bench` and write its tables into docs/accuracy.md.

Usage: python tools/accuracy_page.py
"""

import re
import sys
from pathlib import Path

from balcli.bench.records import Bench
from balcli.bench.show import RENDERER
from balcli.bench.tasks import measure
from balcli.show.formats import Format, render
from balcli.show.units import SYSTEMS

PAGE = Path(__file__).resolve().parents[1] / "docs" / "accuracy.md"
START = "<!-- tables -->\n"
END = "<!-- end of tables -->\n"


def write_tables(result: Bench) -> str:
    """Return the tables of the page: those of the command, without its ratios and its title."""
    text = render([result], RENDERER, Format.MARKDOWN, SYSTEMS["si"])
    tables = text.partition("\n")[2].partition("Ratios of run times")[0]
    return re.sub(r"\n#+ *$", "\n", tables.rstrip()) + "\n"


def main() -> None:
    """Write the page."""
    page = PAGE.read_text(encoding="utf-8")
    before, _, rest = page.partition(START)
    _, found, after = rest.partition(END)
    if not found:
        sys.exit(f"{PAGE}: has no {END.strip()}")
    tables = write_tables(measure())
    PAGE.write_text(f"{before}{START}\n{tables.strip()}\n\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
