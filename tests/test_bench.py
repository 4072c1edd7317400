"""The bench's errors against mpmath, and the page that shows them."""

import mpmath
import pytest
from support.paths import DOCS

from balcli.bench import find_exactly, list_cases

LAM = 0.28  # of the cylinder and the V8
ROUNDING = 1e-13  # of the first order: errors below it are rounding, and differ from machine to machine
SECOND = "one cylinder, order 2"
EIGHTH = "one cylinder, order 8"
ORDERS = {SECOND: 2, EIGHTH: 8, "one V8, force and moment": 8}  # the smallest of each task


def coefficient(order: int, lam: float) -> mpmath.mpf:
    """A_n by quadrature of the acceleration, 40 digits."""
    with mpmath.workdps(40):
        x = mpmath.mpf(lam)

        def acceleration(psi: mpmath.mpf) -> mpmath.mpf:
            cos_beta = mpmath.sqrt(1 - (x * mpmath.sin(psi)) ** 2)
            return mpmath.cos(psi) - x * mpmath.sin(psi) ** 2 / cos_beta + x * mpmath.cos(psi) ** 2 / cos_beta**3

        count = 256  # equal steps: exact for a periodic function but for terms below 1e-60
        psi = [2 * mpmath.pi * k / count for k in range(count)]
        return 2 * mpmath.fsum(acceleration(p) * mpmath.cos(order * p) for p in psi) / count


@pytest.mark.parametrize("order", [1, 2, 4, 6, 8])
def test_exact_values_are_exact(order: int) -> None:
    assert find_exactly([order], LAM)[0] == float(coefficient(order, LAM))


def errors() -> dict[tuple[str, str], float]:
    return {(case.task, case.method): case.error for case in list_cases()}


def rounding(task: str) -> float:
    """What an order's rounding may come to: that of the first order, grown by what is divided by."""
    return ROUNDING / abs(float(coefficient(ORDERS[task], LAM)))


def test_closed_form_is_exact_where_sampling_is_not() -> None:
    """Sixteen samples cannot tell order 2 from 14 and 18; more are good to the rounding of the
    first order, not of their own.
    """
    found = errors()
    for task in ORDERS:
        assert found[task, "closed form"] < 1e-14
    folded = (coefficient(14, LAM) + coefficient(18, LAM)) / coefficient(2, LAM)
    assert found[SECOND, "FFT, 16 points"] == pytest.approx(float(folded), rel=0.01)
    assert found[EIGHTH, "FFT, 64 points"] < rounding(EIGHTH)
    assert found[SECOND, "two-term formula"] == pytest.approx(LAM**2 / 4, rel=0.05)  # the next term of the series
    coarse, fine = (found[SECOND, f"time stepping, {count} steps"] for count in (360, 720))
    assert coarse / fine == pytest.approx(4, rel=0.01)


# ------------------------------------------------------------------ docs/accuracy.md
PAGE = DOCS / "accuracy.md"


def shown() -> dict[tuple[str, str], str]:
    """Errors on the page, by task (heading) and method (first cell of a row; the last one is the error)."""
    rows = {}
    task = ""
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            task = line[3:].strip()
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("|") and len(cells) == 3 and cells[0] not in ("method", "---"):
            rows[task, cells[0]] = cells[2]
    return rows


@pytest.mark.stress
def test_the_page_shows_every_row_and_its_true_error() -> None:
    page = shown()
    found = errors()
    told = {key: "rounding" if error < rounding(key[0]) else f"{error:.1e}" for key, error in found.items()}
    assert page == told
