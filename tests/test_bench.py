"""The bench's errors against mpmath, what beats what, and the page that shows its tables."""

import re

import mpmath
import numpy as np
import pytest
from support.paths import DOCS

from balcli.bench.engine_tasks import list_engine_tasks
from balcli.bench.methods import find_exactly, list_methods
from balcli.bench.records import ROUNDING, Bench, Block, Measured, OrderError, Times, list_unbeaten
from balcli.bench.show import tell_unbeaten
from balcli.bench.tasks import ORDERS, RATIOS, measure_errors


def coefficient(order: int, lam: float) -> mpmath.mpf:
    """A_n by quadrature of the acceleration, 40 digits."""
    with mpmath.workdps(40):
        x = mpmath.mpf(lam)

        def acceleration(psi: mpmath.mpf) -> mpmath.mpf:
            cos_beta = mpmath.sqrt(1 - (x * mpmath.sin(psi)) ** 2)
            return mpmath.cos(psi) - x * mpmath.sin(psi) ** 2 / cos_beta + x * mpmath.cos(psi) ** 2 / cos_beta**3

        count = 1024 if lam > 0.9 else 256  # equal steps: exact for a periodic function but for terms below 1e-60
        psi = [2 * mpmath.pi * k / count for k in range(count)]
        return 2 * mpmath.fsum(acceleration(p) * mpmath.cos(order * p) for p in psi) / count


@pytest.mark.parametrize("lam", RATIOS)
def test_exact_values_are_exact(lam: float) -> None:
    for order in ORDERS:
        assert find_exactly(order, lam) == float(coefficient(order, lam))


def list_errors(lam: float) -> dict[str, dict[float | None, float]]:
    methods = list(list_methods(ORDERS))
    errors = measure_errors(methods, lam)
    return {method.name: dict(each) for method, each in zip(methods, errors, strict=True)}


def test_errors_are_those_of_the_methods() -> None:
    """Sixteen samples cannot tell order 2 from 14 and 18, nor find order 8; halving a time step quarters its error."""
    errors = list_errors(0.6)
    assert max(errors["closed form"].values()) < ROUNDING
    folded = (coefficient(14, 0.6) + coefficient(18, 0.6)) / coefficient(2, 0.6)
    assert errors["FFT of 16 points"][2] == pytest.approx(abs(float(folded)), rel=0.01)
    assert errors["FFT of 16 points"][8] == 1
    shallow = list_errors(0.25)
    assert shallow["series of two terms"][2] == pytest.approx(0.25**2 / 4, rel=0.05)  # the next term of the series
    assert shallow["series of two terms"][8] == 1
    steps = (shallow["time steps of 5 degrees"][2], shallow["time steps of 1 degree"][2])
    assert steps[0] / steps[1] == pytest.approx(25, rel=0.01)


def test_all_methods_take_variants_side_by_side() -> None:
    many = np.linspace(0.2, 0.3, 4001)  # more than are computed at once
    for method in list_methods(ORDERS):
        together = method.find(many)
        assert together.shape == (len(ORDERS), 4001)
        for k in (0, 2000, 4000):
            alone = method.find(many[k : k + 1])[:, 0]
            assert together[:, k] == pytest.approx(alone, rel=1e-9, abs=1e-14)


def test_what_balcli_does_is_exact_in_every_task() -> None:
    exact = {"largest force of a V8": 1e-14, "orders of gas torque": 1e-10, "vibratory torque of a shaft": 1e-10}
    tasks = list_engine_tasks()
    assert tasks.keys() == exact.keys()
    for task, cases in tasks.items():
        *others, ours = cases
        assert max(error for _, error in ours.errors) < exact[task]
        assert all(max(error for _, error in case.errors) > 1e-7 for case in others)


# ------------------------------------------------------------------ what no other method beats
def make(method: str, seconds: float, *errors: float) -> Measured:
    orders = [OrderError(k, error) for k, error in enumerate(errors)]
    return Measured(method, "samples", Times(seconds, seconds, seconds), tuple(orders))


def spread(measured: Measured, share: float) -> Measured:
    median = measured.seconds.median
    return measured._replace(seconds=Times(median * (1 - share), median, median * (1 + share)))


def find_unbeaten(*methods: Measured) -> list[str]:
    return [method.method for method in list_unbeaten(methods)]


def test_a_method_is_beaten_by_one_that_is_as_good_in_all_and_better_in_one() -> None:
    best = make("best", 1.0, 1e-9, 1e-6)
    assert find_unbeaten(best, make("slow", 1.2, 1e-9, 1e-6)) == ["best"]
    assert find_unbeaten(best, make("coarse", 1.0, 1e-9, 5e-6)) == ["best"]
    assert find_unbeaten(best, make("other", 1.2, 1e-9, 1e-7)) == ["other", "best"]  # the most exact first
    assert find_unbeaten(best, make("quick", 0.5, 1e-3, 1e-3)) == ["best", "quick"]


def test_of_methods_without_a_clear_difference_the_quickest_is_left() -> None:
    one = make("one", 1.0, 1e-9)
    assert find_unbeaten(one, make("other", 1.05, 1e-9)) == ["one"]
    assert find_unbeaten(one, make("other", 0.95, 3e-9)) == ["other"]
    assert find_unbeaten(one, make("other", 0.95, 5e-9)) == ["one"]  # a tenth of the time makes up for no error
    quick = make("other", 0.9, 5e-9)
    assert find_unbeaten(one, quick) == ["one", "other"]
    assert find_unbeaten(spread(one, 0.1), spread(quick, 0.1)) == ["one"]  # their run times overlap
    assert find_unbeaten(spread(one, 0.05), spread(quick, 0.05)) == ["one", "other"]
    assert find_unbeaten(make("one", 1.0, 3e-15), make("other", 2.0, 1e-17)) == ["one"]  # both are rounding


def test_the_sentence_of_a_block_has_the_error_of_the_worst_order() -> None:
    exact = make("exact", 9.0, 1e-16, 1e-15)
    coarse = make("coarse", 3.0, 1e-16, 2e-5)
    folded = make("folded", 1.0, 1e-16, 1.0)
    expected = "No other method is both as quick and as exact as exact (rounding), coarse (error up to 2e-05) or folded (not every order)."
    assert tell_unbeaten(Block("orders", (folded, coarse, exact), 1, 0.25)) == expected


def test_rows_are_those_of_the_blocks() -> None:
    block = Block("orders", (make("a", 2.0, 0.1, 0.2), make("b", 1.0, 0.3, 0.9)), 7, 0.25)
    result = Bench.of([block], [])
    assert [(r.method, r.order, r.error, r.seconds) for r in result.rows] == [
        ("a", 0, 0.1, 2.0),
        ("a", 1, 0.2, 2.0),
        ("b", 0, 0.3, 1.0),
        ("b", 1, 0.9, 1.0),
    ]
    assert {(r.task, r.variants, r.rod_ratio) for r in result.rows} == {("orders", 7, 0.25)}
    assert result.unbeaten[0].methods == ("a", "b")


# ------------------------------------------------------------------ docs/accuracy.md
def read_page() -> dict[str, dict[str, list[str]]]:
    """Return the errors of each method on the page, by heading."""
    tables: dict[str, dict[str, list[str]]] = {}
    page = (DOCS / "accuracy.md").read_text(encoding="utf-8")
    shown = page.partition("<!-- tables -->")[2].partition("<!-- end of tables -->")[0]
    heading = ""
    for line in shown.splitlines():
        if line.startswith("## "):
            heading = line[3:]
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("|") and cells[0] not in ("method", "---"):
            tables.setdefault(heading, {})[cells[0]] = cells[3:]
    return tables


def test_the_page_has_the_errors_of_the_program() -> None:
    """Errors near rounding differ from machine to machine, and are not compared."""
    page = read_page()
    assert len(page) == 2 * len(RATIOS) + 3 + 1  # orders of a cylinder, tasks of engines, cold starts
    compared = 0
    for heading, methods in page.items():
        ratio = re.search(r"λ = ([\d.]+),", heading)
        if ratio is None:
            continue
        errors = list_errors(float(ratio[1]))
        assert list(methods) == list(errors)
        for name, cells in methods.items():
            for cell, error in zip(cells, errors[name].values(), strict=True):
                if cell == "not found":
                    assert error > 0.5
                elif cell != "rounding" and float(cell) > 1e-3:
                    assert error == pytest.approx(float(cell), rel=0.5)
                    compared += 1
                else:
                    assert error < 1e-3
    assert compared > 20
