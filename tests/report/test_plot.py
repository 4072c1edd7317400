"""Figures in Python: every answer that has a picture gives one, without pyplot and without a trace
in matplotlib's settings.
"""

import matplotlib
import pytest
from support.commands import run_here
from support.paths import ENGINES
from support.rotors import three_runs

import balcli

THREE = balcli.load_example("i3")
GAS = balcli.load_example("i4_wiebe")
VEE = balcli.load_example("v6_60")
DIESEL = balcli.load_example("i6_diesel")
SPEEDS = [1500, 2000]
SHOWN = {
    "engine": lambda: balcli.plot(THREE, "curves"),
    "engine with a scheme": lambda: balcli.plot(THREE, "polar", scheme="counterweights"),
    "analysis": lambda: balcli.plot(balcli.analyze(THREE), "polar"),
    "balance": lambda: balcli.plot(balcli.balance(THREE, "counterweights"), "spectrum"),
    "sweep": lambda: balcli.plot(balcli.sweep(VEE, {"layout.bank_angle": "0:180:20"})),
    "torque": lambda: balcli.plot(balcli.torque(GAS)),
    "torsion": lambda: balcli.plot(balcli.torsion(DIESEL, SPEEDS), "response"),
    "torsion of an engine": lambda: balcli.plot(DIESEL, "waterfall", speeds=SPEEDS, orders=[3]),
    "mounts": lambda: balcli.plot(balcli.mounts(balcli.load_example("i4_mounts"), SPEEDS)),
    "rotor": lambda: balcli.plot(balcli.field(three_runs())),
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


def test_the_title_says_which_devices_are_fitted():
    """A page with them was titled as the engine without."""

    def title(figure):
        return figure.get_suptitle()

    alone = title(balcli.plot(THREE, "polar"))
    assert alone == "in-line three, 6000 rpm"
    fitted = balcli.plot(THREE, "orders", scheme="couple-shaft")
    assert title(fitted) == f"{alone}\nwith scheme couple-shaft, order 1"
    shares = balcli.SchemeOptions(factor=(0.4,))
    factor = balcli.balance(balcli.load_example("vtwin45"), "factor", shares)
    assert title(balcli.plot(factor, "polar")).endswith("\nwith scheme factor 40 %, order 1")


@pytest.mark.parametrize("name", ["sweep", "torsion", "mounts"])
def test_curves_of_one_axis_are_told_apart_without_colour(name):
    """As on paper printed in black and white: the first three of each legend are dashed, dotted or of another width."""
    legends = [ax.get_legend() for ax in SHOWN[name]().axes if ax.get_legend()]
    looks = [[(line.get_linestyle(), line.get_linewidth()) for line in each.get_lines()[:3]] for each in legends]
    assert max(map(len, looks)) > 1
    assert all(len({*each}) == len(each) for each in looks)
