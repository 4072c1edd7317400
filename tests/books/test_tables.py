"""The registry of printed tables: form, the rule for errata, ranges, and the command."""

import csv
import io
import json
from decimal import ROUND_HALF_UP, Decimal
from fractions import Fraction
from math import comb

import numpy as np
import pytest
from support.cases import cases
from support.commands import refusal, run_here

from balcli.books.answer import NAMES, select_tables, tables as recompute
from balcli.books.recomputed import (
    CLASSES,
    Explanation,
    Print,
    deviates,
    load_print,
    parse_crank_ratios,
    parse_range,
)
from balcli.books.sources import SOURCES
from balcli.core.mechanisms import slidercrank as sc
from balcli.errors import BalcliError

WRONG = load_print("published").column("verdict").count("wrong")
ERRATA = dict(  # printed figures that are not the exact ones rounded; each of the statements is one
    zip(NAMES, [1, 6, 6, 6, 0, 10, 0, 4, 0, 58, 0, 19, 2, 3, 8, 4, WRONG, 3, 55, 0], strict=True)
)


def run(*arguments):
    return run_here("tables", *arguments)


def document(*arguments):
    return json.loads(run(*arguments, "--format", "json").out)


# ---------------------------------------------------------------- form
def test_rows_and_print_have_one_shape():
    tables = select_tables(None)
    assert {table.name: len(table.errata) for table in tables} == ERRATA
    for table in tables:
        assert len(set(table.columns)) == len(table.columns)
        assert {len(row) for row in (*table.exact, *table.printed)} == {len(table.columns)}
        assert len(table.exact) == len(table.printed)
        assert table.source
        assert table.title


@pytest.mark.parametrize("name", [n for n in NAMES if n not in ("series", "statements", "published", "layouts")])
def test_errata_are_the_figures_that_rounding_does_not_give(name):
    """The rule once more, from the values and texts alone."""
    table = recompute(name)
    wrong = set()
    for i, (row, words) in enumerate(zip(table.exact, table.printed, strict=True)):
        for column, value, text in zip(table.columns, row, words, strict=True):
            if isinstance(value, float) and text is not None and "/" not in text:
                digits = Decimal(1).scaleb(Decimal(text).as_tuple().exponent)
                if Decimal(repr(value)).quantize(digits, ROUND_HALF_UP) != Decimal(text):
                    wrong.add((i, column))
    assert {(e.row, e.column) for e in table.errata} == wrong


# ---------------------------------------------------------------- the rule
@cases("books/tables", "when_a_printed_figure_deviates")
def test_when_a_printed_figure_deviates(value, text, wrong):
    assert deviates(value, text) is wrong


def kinds(exact, text, *explanations):
    print_ = Print("t", "", "", ("a", "b"), (("row", text),))
    return [e.kind for e in print_.compare(("a", "b"), [("row", exact)], explanations=explanations).errata]


@cases("books/tables", "kinds")
def test_kinds(exact, text, kind):
    """An explanation counts only where it leads to the printed figure, and not if it is the exact one."""
    assert kinds(exact, text, Explanation("doubled by mistake", ((None, 2 * exact),))) == [kind]
    assert kinds(0.7071, "0.706", Explanation("nothing", ((None, 0.7071),))) == ["last digit"]


# ---------------------------------------------------------------- other ranges
def test_ranges_include_both_ends():
    assert parse_range("angle", "0.20:0.40:0.1") == ("0.2", "0.3", "0.4")
    assert parse_range("angle", "0:180:60") == ("0", "60", "120", "180")
    assert parse_range("angle", "0.24,1/3,0.24") == ("0.24", "1/3")
    assert len(parse_crank_ratios("0.20:0.40:0.01")) == 21


@pytest.mark.parametrize(
    "text",
    ["", "1:2:3:4", "a:b", "0:1:0", "1:0:0.1", "0:1e9:1e-9", "nan", "1/0", "0:1:", "1e400", "1e999999999", "3e9"],
)
def test_bad_ranges(text):
    with pytest.raises(BalcliError, match=r"^angle '.*' is no range: give START:STOP:STEP \(0.20:0.40:0.01\) or"):
        parse_range("angle", text)


@pytest.mark.parametrize(
    ("name", "function"),
    [("tsinghua-1-2", sc.displacement), ("tsinghua-1-3", sc.velocity), ("tsinghua-1-6", sc.acceleration)],
)
def test_other_angles_and_ratios(name, function):
    """The print stands beside the exact values wherever it has the angle and the ratio, and only there."""
    table = recompute(name, lambda_="0.3,0.35", angle="70,71.5")
    place = table.columns.index("0.35")
    assert table.exact[1][place] == pytest.approx(float(function(np.radians(71.5), 0.35)), rel=1e-14)
    assert table.printed[0][place - 1] is not None
    assert table.printed[0][place] is table.printed[1][place - 1] is None


def test_the_acceleration_goes_on_to_180_degrees():
    table = recompute("tsinghua-1-6", angle="0:180:5")
    assert len(table.exact) == 37
    assert len(table.errata) == ERRATA["tsinghua-1-6"]
    assert table.exact[-1][table.columns.index("0.32")] == pytest.approx(-(1 - 0.32), rel=1e-14)
    assert table.printed[-1] == (None,) * len(table.columns)


@pytest.mark.parametrize("angles", ["17.5,45,131.81", "0:180:20"])
def test_tables_of_liu_at_other_bank_angles(angles):
    """From the force of both banks sampled over a turn; path lengths as sums of small steps."""
    paths, vectors, sliders = (recompute(f"liu-{n}", angle=angles) for n in (1, 2, 3))
    gammas = [float(heading) for heading in paths.columns[1:]]
    assert [*paths.columns[1:]] == [*vectors.columns[1:]]
    theta = np.radians(np.arange(0, 360, 5))
    for column, gamma in enumerate(gammas, 1):
        half = np.radians(gamma) / 2
        banks = sum(np.exp(1j * way) * np.cos(2 * (theta - way)) for way in (half, -half))
        ahead, against = (np.mean(banks * np.exp(way * 2j * theta)).real for way in (-1, 1))
        assert [row[column] for row in vectors.exact] == pytest.approx([ahead, against], abs=1e-14)
        assert [row[column] for row in paths.exact][:2] == pytest.approx([-against, ahead], abs=1e-14)
        steps = np.radians(np.linspace(0, gamma, 10001)) / 2
        lengths = [np.abs(np.diff(np.cos(times * steps))).sum() for times in (3, 1)]
        assert [row[column] for row in paths.exact][6:] == pytest.approx(lengths, abs=1e-6)
        found = {row[0]: row[2:] for row in sliders.exact if row[1] == gamma}
        alpha = np.radians(22.5 * np.arange(9))
        force = sum(np.exp(1j * way) * np.cos(2 * (alpha - way)) for way in (half, -half))
        assert found["Zy"] == pytest.approx(force.real.tolist(), abs=1e-14)
        assert found["Zx"] == pytest.approx((-force.imag).tolist(), abs=1e-14)


def test_the_optimum_of_wang_at_other_crank_ratios():
    """Between the printed ratios; what is not printed has no followed choice."""
    table = recompute("wang-1", lambda_="0.25,0.28")
    theta = np.linspace(0, 2 * np.pi, 7201)
    force = np.cos(theta) + 0.28 * np.cos(2 * theta)
    peaks = [np.abs(force - k * np.exp(1j * theta)).max() for k in np.arange(0.55, 0.65, 1e-4)]
    assert table.exact[1][1] == pytest.approx(min(peaks), abs=1e-4)
    assert table.exact[1][-2:] == (None, None)
    assert table.printed[0][1] == "0.6601"
    assert table.printed[1] == (None,) * len(table.columns)


def test_errors_of_two_terms():
    """From the exact formulas of a crank of 1 and a rod of 4, differentiated in steps."""
    psi = np.linspace(0, np.pi, 20001)[1:-1]
    place = 5 - np.cos(psi) - np.sqrt(16 - np.sin(psi) ** 2)
    two = 1 + 1 / 16 - np.cos(psi) - np.cos(2 * psi) / 16
    wanted = []
    for _ in range(3):
        error = np.abs(two - place)
        wanted += [error.max(), 100 * error.max() / np.abs(place).max()]
        place = np.gradient(place, psi, edge_order=2)
        two = np.gradient(two, psi, edge_order=2)
    found = [row[1] for row in recompute("tsinghua-two-terms", lambda_="0.25").exact]
    assert [found[n] for n in (0, 1, 4, 5, 8, 9)] == pytest.approx(wanted, rel=1e-3)
    assert found[9] == pytest.approx(0.66, abs=0.005)


def test_series():
    """133 printed coefficients are compared. Leading coefficient of A_16: binomial series, 16^2 (-1)^9 binom(16, 8)/(15
    2^31).
    """
    assert sum(words[3] is not None for words in recompute("series").printed) == 133
    table = recompute("series", power=15)
    leading = [row[3] for row in table.exact if row[:3] == ("acceleration A_n (r w^2)", 16, 15)]
    assert leading == [str(Fraction(-(16**2) * comb(16, 8), 15 * 2**31))]


# ---------------------------------------------------------------- the command
def test_list_of_tables():
    listed = run().out
    assert {t["name"]: t["errata"] for t in document()} == ERRATA
    assert max(map(len, listed.splitlines())) <= 80
    printed = [(t["name"], t["title"]) for t in document()]
    printed += [(source.key, source.citation) for source in SOURCES]
    words = {word for texts in printed for text in texts for word in text.split()}
    assert words <= set(listed.split())


@pytest.mark.parametrize("name", NAMES)
def test_every_table_in_every_format(name):
    for form in ("table", "json", "csv", "markdown"):
        result = run(name, "--format", form)
        assert result.status == 0
        assert result.out.strip()
        assert "nan" not in result.out.split()


def test_figures_are_marked_counted_and_rounded():
    rows = list(csv.reader(io.StringIO(run("tsinghua-1-2", "--format", "csv").out)))
    assert float(rows[4][rows[0].index("0.29")]) == sc.displacement(np.radians(15), 0.29), "in full precision"
    text = run("tsinghua-1-2").out
    assert ".4313 ≠ .4312" in text
    assert "6 of 370 printed figures deviate (exact ≠ printed)" in text
    first = next(line for line in text.splitlines() if line.startswith("0 "))
    assert first.split() == ["0", *[".0000"] * 9, "360"]


@pytest.mark.parametrize("given", ["0,25", "3.5", "0.9:1.1:0.1"])
def test_a_lambda_that_cannot_be_is_told_what_it_would_be(given):
    message = refusal("tables", "tsinghua-1-2", "--lambda", given)
    assert message.endswith("turns only with 0 < lambda < 1; give crank radius over rod length, such as 0.25 or 1/3.5")


def test_errata_by_class():
    """22 printed figures of 130 in the five sources are misprints; each class is explained under the errata."""
    every = document("--errata")
    assert len(every) == sum(ERRATA.values()) - WRONG, "those of published problems are not among them"
    assert len(document("--errata", "published")) == WRONG
    of_figures = [e["class"] for e in every if e["name"] != "statements"]
    assert len(of_figures) == 130
    assert of_figures.count("misprint") == 22
    assert {e["class"] for e in every} == set(CLASSES)
    assert document("--kind", "error") == [e for e in every if e["class"] == "error"]
    words = " ".join(run("--errata").out.split())
    assert all(word in words for meaning in CLASSES.values() for word in meaning.split())
    assert run("--kind", "typo").status == 2


def test_errata_as_text():
    """They name their rows, a crank angle and not the number of the row, and fit into 80 columns."""
    assert [e["name"] for e in document("kvasnikov-1", "--errata")] == ["kvasnikov-1"] * 2
    assert "cos 45° taken as 0.706" in run("liu-3", "--errata").out
    for asked in (("--errata",), ("statements",), ("published",)):
        assert max(map(len, run(*asked).out.splitlines())) <= 80
    first = document("tsinghua-1-2", "--errata")[0]
    assert (first["row"], first["label"], first["class"]) == (10, "50", "rounding")


# ---------------------------------------------------------------- sources
@pytest.mark.parametrize("source", SOURCES, ids=lambda source: source.key)
def test_a_source_has_its_tables_and_statements(source):
    found = document(source.key)
    assert found["citation"] == source.citation
    assert [t["name"] for t in found["tables"]] == [n for n in NAMES if n.startswith(f"{source.key}-")]
    places = load_print("statements").column("source")
    assert len(found["statements"]) == places.count(source.key)
    for name in source.names:
        assert document(name.upper()) == found
    text = run(source.key).out
    assert max(map(len, text.splitlines())) <= 80
    assert all(table["name"] in text for table in found["tables"])


def test_errata_of_one_source():
    found = document("--errata", "Liu Xianzhi")
    assert {e["name"] for e in found} == {"liu-1", "liu-3", "statements"}
    assert len([e for e in found if e["name"] != "statements"]) == ERRATA["liu-1"] + ERRATA["liu-3"]
    assert all(e["label"].startswith("liu, ") for e in found if e["name"] == "statements")


def test_digits_are_those_of_the_request_where_no_print_rules():
    """A_2 at 0.3 is not printed: series of its definition, 0.3 + 0.3^3/4 + 15/128 0.3^5 + ..."""
    shown = run("kvasnikov-1", "--lambda", "0.3", "--digits", "10").out
    assert "0.3070506591" in shown
    assert run_here("--digits", "10", "tables", "kvasnikov-1", "--lambda", "0.3").out == shown
    assert "0.307051" in run("kvasnikov-1", "--lambda", "0.3").out
    assert run("tsinghua-1-2", "--digits", "10").out == run("tsinghua-1-2").out, "as printed"


@cases("books/tables", "wrong_names_and_options_are_refused")
def test_wrong_names_and_options_are_refused(arguments, message):
    assert refusal("tables", *arguments).startswith(message)


def test_layouts_at_a_glance():
    """The same by either command; figures are the handbook's."""
    out = run_here("layouts").out
    assert out == run("layouts").out
    wanted = {
        "in-line five": ["0", "0", "0.449", "4.98", "144"],
        "90-degree V-twin": ["1", "1.414", "0", "0", "270/450"],
        "in-line four, cross": ["90/180/270"],  # Yamaha's fires after 270, 180, 90 and 180 degrees
        "single": ["720"],  # every other turn, and in no order
    }
    for name, cells in wanted.items():
        line = next(line for line in out.splitlines() if line.startswith(name))
        assert line.split()[-len(cells) :] == cells
    assert run_here("layouts", "--format", "json").out == run("layouts", "--format", "json").out
