"""Which balance factor is best, and for what: against peaks of engines with the weights of single factors."""

import pytest
from support.cases import cases
from support.commands import ask
from support.engines import GOOD, build_text, changed
from support.paths import ENGINES

from balcli.core.peaks import find_peak
from balcli.forces.crankshaft import find_crank_loads
from balcli.sizing.factor import find_curve
from balcli.sizing.options import SchemeOptions
from balcli.sizing.remedy import fit_devices
from balcli.sizing.sizing import size

CROSS = changed(("throws = [0, 180, 180, 0]", "throws = [0, 90, 270, 180]"), ("firing_order = [1, 3, 4, 2]", ""))
THREE = changed(("throws = [0, 180, 180, 0]", "throws = [0, 240, 120]"), ("firing_order = [1, 3, 4, 2]", ""))
VEE = changed(("throws = [0, 180, 180, 0]", "throws = [0]"), ("firing_order = [1, 3, 4, 2]", "bank_angle = 45"))


def measure(text: str, factor: float, what: str) -> float:
    """What an engine balanced by one factor leaves."""
    engine = build_text(text)
    after = fit_devices(engine, size(engine, "factor", SchemeOptions(factor=(factor,))))
    return find_crank_loads(after).main_N if what == "main_bearing" else find_peak(find_curve(after, what)).value


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "what"),
    [(GOOD, ["main_bearing"]), (VEE, ["force"]), *((text, ["moment", "main_bearing"]) for text in (THREE, CROSS))],
)
def test_no_factor_is_better_than_the_best(text, what):
    """In an in-line four a factor changes no free force and moment, and is best for the bearings alone."""
    best = size(build_text(text), "factor", SchemeOptions(factor=(0.3,))).details["best"]
    assert list(best) == what
    for name, one in best.items():
        factor, least = one.values()
        assert measure(text, factor, name) == pytest.approx(least, rel=1e-9)
        others = [measure(text, other, name) for other in (0, 0.25, 0.5, 0.75, 1, factor - 0.01, factor + 0.01)]
        assert least <= min(others) * (1 + 1e-9)
        assert least < max(others) * (1 - 1e-3)


def test_the_best_of_a_range_lies_in_it_and_another_one_is_fitted():
    """The fitted factor is one of those asked for."""
    remedy = size(build_text(VEE), "factor", SchemeOptions(factor=(0.5, 0.6)))
    assert remedy.details["factor"] in (0.5, 0.6)
    assert 0.5 < remedy.details["best"]["force"]["factor"] < 0.6
    low = size(build_text(VEE), "factor", SchemeOptions(factor=(0.1, 0.2))).details
    assert low["best"]["force"]["factor"] == pytest.approx(0.2, abs=1e-6)


@cases("sizing/balance_factor", "best_factors")
def test_a_sentence_names_the_best_factors(name, factor, told):
    assert told in " ".join(ask("balance", ENGINES / f"{name}.toml", "--factor", factor).split())
