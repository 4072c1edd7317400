"""Measure `balcli bench` and write its tables into docs/accuracy.md.

Usage: python tools/accuracy_page.py
"""

import sys
from pathlib import Path

from balcli.bench.records import Bench
from balcli.bench.show import sheet
from balcli.bench.tasks import measure
from balcli.show.formats import Format, lay_out
from balcli.show.units import SI

PAGE = Path(__file__).resolve().parents[1] / "docs" / "accuracy.md"
START = "<!-- tables -->\n"
END = "<!-- end of tables -->\n"


def write_tables(result: Bench) -> str:
    """Return the tables of the page: those of the command, without their title."""
    whole = sheet(result, SI)._replace(title="")
    _title, _, tables = lay_out([whole], Format.MARKDOWN, seen=False).partition("\n")
    return tables


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
