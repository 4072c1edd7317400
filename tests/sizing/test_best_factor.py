"""Which balance factor is best, and for what: against peaks of engines with the weights of single factors."""

import pytest
from support.commands import ask
from support.engines import GOOD, build_text, changed
from support.paths import ENGINES

from balcli.balancing.answer import balance_engine
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
    [
        (GOOD, ["main_bearing"]),
        (THREE, ["moment", "main_bearing"]),
        (VEE, ["force"]),
        (CROSS, ["moment", "main_bearing"]),
    ],
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
    remedy = balance_engine(build_text(VEE), "factor", SchemeOptions(factor=(0.5, 0.6))).remedy
    assert remedy.details["factor"] in (0.5, 0.6)
    assert 0.5 < remedy.details["best"]["force"]["factor"] < 0.6
    remedy = balance_engine(build_text(VEE), "factor", SchemeOptions(factor=(0.1, 0.2))).remedy
    assert remedy.details["best"]["force"]["factor"] == pytest.approx(0.2, abs=1e-6)


@pytest.mark.parametrize(
    ("name", "factor", "told"),
    [
        ("single", "50%", "Between 0 % and 100 % the factor 60.35 % leaves the smallest peak force (8.009 kN)."),
        ("i3", "0:1:0.5", "smallest peak moment (672.7 N·m), and 60.29 % the smallest main bearing load (2271 N)."),
        (
            "v8_crossplane",
            "50%",
            "smallest peak moment (5.819 N·m), and also the smallest main bearing load (7.092 kN).",
        ),
        ("v8_crossplane", "48%:49%:1%", "Between 48 % and 49 % the factor 49 % leaves the smallest peak moment"),
    ],
)
def test_a_sentence_names_the_best_factors(name, factor, told):
    assert told in " ".join(ask("balance", ENGINES / f"{name}.toml", "--factor", factor).split())
