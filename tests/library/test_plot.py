"""Figures in Python: every answer that has a picture gives one, without pyplot and without a trace
in matplotlib's settings.
"""

from __future__ import annotations

import matplotlib
import pytest
from support.commands import run_python
from support.rotors import three_runs

import balcli
from balcli.render.plot.pages import PAGES

THREE, GAS = balcli.load_example("i3"), balcli.load_example("i4_wiebe")
VEE, DIESEL = balcli.load_example("v6_60"), balcli.load_example("i6_diesel")
SPEEDS = [1500, 2000]
SHOWN = {
    "engine": lambda: balcli.plot(THREE, "curves"),
    "engine with a scheme": lambda: balcli.plot(THREE, "polar", scheme="counterweights"),
    "analysis": lambda: balcli.plot(balcli.analyze(THREE), "polar"),
    "balance": lambda: balcli.plot(balcli.balance(THREE, "counterweights"), "spectrum"),
    "sweep": lambda: balcli.plot(balcli.sweep(VEE, {"layout.bank_angle": "0:180:20"})),
    "torque": lambda: balcli.plot(balcli.analyze_torque(GAS)),
    "torsion": lambda: balcli.plot(balcli.analyze_torsion(DIESEL, SPEEDS), "response"),
    "torsion of an engine": lambda: balcli.plot(DIESEL, "waterfall", speeds_rpm=SPEEDS, orders=[3]),
    "mounts": lambda: balcli.plot(balcli.analyze_mounts(balcli.load_example("i4_mounts"), SPEEDS)),
    "rotor": lambda: balcli.plot(balcli.balance_rotor(three_runs())),
}


@pytest.mark.stress
@pytest.mark.parametrize("name", SHOWN)
def test_an_answer_has_a_figure(name):
    before = dict(matplotlib.rcParams)
    figure = SHOWN[name]()
    assert isinstance(figure, matplotlib.figure.Figure)
    assert figure.axes
    shown = figure._repr_png_()
    assert shown.startswith(b"\x89PNG")
    assert dict(matplotlib.rcParams) == before


def test_a_figure_is_written_as_the_command_writes_it(tmp_path):
    from support.commands import run_here
    from support.paths import ENGINES

    run_here("plot", ENGINES / "i3.toml", "--what", "polar", "-o", tmp_path / "command.svg")
    balcli.plot(THREE, "polar").savefig(tmp_path / "figure.svg", metadata={"Date": None})
    texts = [(tmp_path / f"{name}.svg").read_text() for name in ("command", "figure")]
    words = [[line.strip() for line in text.splitlines() if "<text" in line] for text in texts]
    assert len(words[0]) > 10
    assert [len(each) for each in words] == [len(words[0])] * 2


def test_a_sweep_has_an_axis_and_a_unit_for_each_dimension():
    """All curves of an axis are in the unit it names, large or small."""
    sizes = {"N": 1, "kN": 1e3, "N·m": 1, "kN·m": 1e3}
    names = "moment.1.forward,moment.1.backward,moment.2.major,peak.force"
    swept = balcli.sweep(VEE, {"operation.speed": "3000:9000:1000"}, names)
    figure = balcli.plot(swept)
    found = {}
    for axes in figure.axes:
        size = sizes[axes.get_ylabel()]
        found |= {line.get_label(): (axes, size * line.get_ydata()) for line in axes.lines}
    assert list(found) == names.split(",")
    assert len({axes for axes, _ in found.values()}) == 2
    assert figure.axes[0].get_ylabel() == "kN·m"
    for (_, drawn), value in zip(found.values(), swept.values, strict=True):
        assert drawn == pytest.approx(value.ravel(), rel=1e-12)


@pytest.mark.stress
def test_neither_pyplot_nor_a_backend_is_needed():
    code = (
        "import sys, balcli\n"
        "balcli.plot(balcli.load_example('i3'), 'polar')._repr_png_()\n"
        "assert 'matplotlib.pyplot' not in sys.modules\n"
    )
    ended = run_python("-c", code, env={"MPLBACKEND": "tkagg"})
    assert ended.returncode == 0, ended.stderr


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        (lambda: balcli.plot(3), TypeError, "plot: 3 (int): give an Engine, or an answer of analyze, balance, sweep, "),
        (lambda: balcli.plot(balcli.tables("liu-3")), TypeError, "plot: <Table liu-3: "),
        (lambda: balcli.plot(THREE, "polr"), balcli.BalcliError, f"plot: there is no 'polr' of it; choose from {', '.join(PAGES)}, modes, campbell, response, waterfall; did you mean polar?"),
        (lambda: balcli.plot(balcli.balance(THREE), "inner"), balcli.BalcliError, "plot: there is no 'inner' of it; choose from all, polar, orders, spectrum, curves"),
        (lambda: balcli.plot(balcli.analyze_torsion(DIESEL), "response"), balcli.BalcliError, "plot: there is no 'response' of it; choose from all, modes, campbell"),
        (lambda: balcli.plot(balcli.analyze_torque(GAS), "polar"), balcli.BalcliError, "plot: there is no 'polar' of it; choose from torque, pressure, p-v, pin, main"),
        (lambda: balcli.plot(balcli.balance_rotor(three_runs()), "polar"), balcli.BalcliError, "plot: there is no 'polar' of it; choose from all"),
        (lambda: balcli.plot(THREE, orders=3), TypeError, "orders: 3 (int): give numbers, such as [1, 2, 4]"),
        (lambda: balcli.plot(DIESEL, "campbell", orders=3), TypeError, "orders: 3 (int): give numbers, such as [1, 2, 4]"),
        (lambda: balcli.plot(DIESEL, "campbell", orders=["a"]), TypeError, "orders: 'a' (str): give numbers, such as [1, 2, 4]"),
        (lambda: balcli.plot(THREE, "torque"), balcli.BalcliError, "in-line three: has no [gas]"),
        (lambda: balcli.plot(THREE, "modes"), balcli.BalcliError, "in-line three: has no [torsion]"),
    ],
)  # fmt: skip
def test_what_has_no_picture_is_told(call, kind, message):
    with pytest.raises(kind) as caught:
        call()
    assert str(caught.value).startswith(message)
