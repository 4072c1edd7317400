"""The bench's errors against mpmath, and the page that shows them."""

from __future__ import annotations

import mpmath
import pytest
from support.paths import DOCS

from balcli.bench import methods
from balcli.bench.bench import LAM, cases

ROUNDING = 1e-13  # errors below it are rounding, and differ from machine to machine


def coefficient(order: int, lam: float) -> mpmath.mpf:
    """A_n by quadrature of the acceleration, 40 digits."""
    with mpmath.workdps(40):
        x = mpmath.mpf(lam)

        def acceleration(psi: mpmath.mpf) -> mpmath.mpf:
            cos_beta = mpmath.sqrt(1 - (x * mpmath.sin(psi)) ** 2)
            return (
                mpmath.cos(psi)
                - x * mpmath.sin(psi) ** 2 / cos_beta
                + x * mpmath.cos(psi) ** 2 / cos_beta**3
            )

        count = 256  # equal steps: exact for a periodic function but for terms below 1e-60
        psi = [2 * mpmath.pi * k / count for k in range(count)]
        return 2 * mpmath.fsum(acceleration(p) * mpmath.cos(order * p) for p in psi) / count


@pytest.mark.parametrize("order", [1, 2, 4, 6, 8])
def test_exact_values_are_exact(order: int) -> None:
    assert methods.exact([order], LAM)[0] == float(coefficient(order, LAM))


def errors() -> dict[tuple[str, str], float | None]:
    return {(case.task, case.method): case.error for case in cases()}


def test_closed_form_is_exact_where_sampling_is_not() -> None:
    found = errors()
    for task in ("A_2", "A_8", "one V8, force and moment"):
        assert found[task, "closed form"] is not None
        assert found[task, "closed form"] < 1e-14
    assert 1e-13 < found["A_8", "FFT, 64 points"] < 1e-10
    assert found["A_2", "two-term formula"] == pytest.approx(
        LAM**2 / 4, rel=0.05
    )  # the next term of the series
    assert found["A_2", "time stepping, 360 steps"] / found[
        "A_2", "time stepping, 720 steps"
    ] == pytest.approx(4, rel=0.01)


# ------------------------------------------------------------------ docs/accuracy.md
PAGE = DOCS / "accuracy.md"


def shown() -> dict[tuple[str, str], str]:
    """Errors on the page, by task (heading) and method (first cell of a row; the last one is the
    error).
    """
    rows, task = {}, ""
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            task = line[3:].strip()
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("|") and len(cells) == 3 and cells[0] not in ("method", "---"):
            rows[task, cells[0]] = cells[2]
    return rows


def test_the_page_shows_every_row_and_its_true_error() -> None:
    page, found = shown(), errors()
    assert page.keys() == found.keys()
    for key, error in found.items():
        if error is None:
            assert page[key] == "–", key
        elif error < ROUNDING:
            assert page[key] == "rounding", key
        elif (
            error < 1e-9
        ):  # rounding, grown by what is divided by: the power of ten is all that can be told
            assert 0.1 < float(page[key]) / error < 10, key
        else:
            assert page[key] == f"{error:.1e}", key
