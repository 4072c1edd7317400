"""`frame.up`: results say vertical, horizontal, yawing and pitching with it, and never without."""

import numpy as np
import pytest
from support.cases import cases
from support.commands import ask, ask_csv, ask_json, refusal, run_here
from support.engines import build_text
from support.paths import write

from balcli.analysis.answer import analyze
from balcli.analysis.curves import columns, curves
from balcli.analysis.verdict import judge
from balcli.analysis.verdict_words import VerdictWords
from balcli.core.phasors import Phasors
from balcli.core.records import to_document
from balcli.engine.load import vary_engine
from balcli.forces.spectrum import Spectra
from balcli.report.live import describe_look
from balcli.report.page import scene
from balcli.report.pages import PageSubject, make_page
from balcli.report.study import Study
from balcli.show.units import SI
from balcli.sizing.residual import Scales

WORDS = ("vertical", "horizontal", "pitching", "yawing")
# The bank of a slanted twin, and a bank beside it: force and moment of every order in both senses.
LEANING = """\
crank = {{ stroke = 80, throws = [0, 100], spacing = 100, throw_mass = 0.4 }}
rod = {{ length = 140, mass = 0.5, cg = 40 }}
piston.mass = 0.4
layout.banks = [{first}, {second}]
operation.speed = 3000
shaft = [{{ ratio = -1, unbalance = 900, angle = {angle}, position = 40 }}]
"""
UP = "[frame]\nup = {up}\n"


def leaning(turn: float, up: float | None = None, spread: float = 70.0) -> str:
    """The engine turned about the crank, with the direction that points up if there is one."""
    text = LEANING.format(first=turn, second=turn + spread, angle=turn)
    return text if up is None else text + UP.format(up=up)


@pytest.mark.parametrize("up", [0, 90, -37.5, 170])
def test_components_by_up_are_those_along_x_of_the_engine_turned_back(up):
    upright = to_document(analyze(build_text(leaning(0))))["orders"]
    turned = to_document(analyze(build_text(leaning(up, up))))["orders"]
    for key, names in (("force_N", WORDS[:2]), ("moment_Nm", WORDS[:1:-1])):
        largest = max(order[key]["major"] for order in upright)
        for before, now in zip(upright, turned, strict=True):
            for axis, name in zip("xy", names, strict=True):
                a = before[key][axis]
                b = now[key][name]
                assert b.keys() == a.keys()
                assert _complex(b) == pytest.approx(_complex(a), abs=1e-13 * largest)


def _complex(component: dict) -> complex:
    return component["amplitude"] * np.exp(1j * np.radians(component["phase_deg"] or 0))


@pytest.mark.parametrize("up", [30, -12.7])
def test_what_is_upright_has_no_level_part(up):
    """Exactly 0, in orders and over the crank angle, whatever cosines are rounded to."""
    rods = {"rod.mass": 0.0, "crank.throw_mass": 0.0}  # pistons alone
    single = vary_engine(build_text(leaning(up, up, spread=0)), {**rods, "shaft.1.unbalance": 0.0})
    for order in to_document(analyze(single))["orders"]:
        assert order["force_N"]["horizontal"] == {"amplitude": 0.0, "phase_deg": None}
    found = curves(single, 30).curves
    assert not found["force_horizontal_N"].any()
    assert found["force_vertical_N"].any()


def test_curves_by_up_are_those_along_x_of_the_engine_turned_back():
    upright = curves(build_text(leaning(0)), 20)
    turned = curves(build_text(leaning(25, 25)), 20)
    for name, along in (
        ("force_vertical_N", "force_x_N"),
        ("force_horizontal_N", "force_y_N"),
        ("moment_yawing_Nm", "moment_x_Nm"),
        ("moment_pitching_Nm", "moment_y_Nm"),
    ):
        size = np.abs(upright.curves[along]).max()
        assert turned.curves[name] == pytest.approx(upright.curves[along], abs=1e-12 * size)


def test_unknown_moments_have_no_curves_by_up():
    twin = build_text(leaning(0, 0).replace("spacing = 100, ", ""))
    assert not [name for name in columns(curves(twin, 90)).values if "moment" in name]


COMMANDS = (
    "analyze FILE --all",
    "analyze FILE --by cylinder --why -f json",
    "balance FILE -f json",
    "compare FILE FILE",
    "sum FILE FILE --phase 90 -f json",
    "curves FILE --step 90 -f csv",
)


def test_without_up_no_word_of_it(tmp_path):
    path = write(tmp_path / "e.toml", leaning(0))
    for command in COMMANDS:
        done = run_here(*[path if word == "FILE" else word for word in command.split()])
        assert done.status == 0
        assert not [word for word in WORDS if word in (done.out + done.err).lower()], command


@pytest.mark.parametrize("form", ["json", "csv", "markdown"])
def test_with_up_every_form_has_the_words(form, tmp_path):
    path = write(tmp_path / "e.toml", leaning(0, 20))
    said = ask("analyze", path, "--all", "--format", form).lower()
    assert [word for word in WORDS if word not in said] == []


def test_two_engines_are_named_by_the_up_of_the_first(tmp_path):
    first = write(tmp_path / "first.toml", leaning(0, 90))
    second = write(tmp_path / "second.toml", leaning(0))
    force = ask_json("sum", first, second)["orders"][0]["force_N"]
    assert _complex(force["vertical"]) == pytest.approx(_complex(force["y"]))
    assert "vertical" not in ask("sum", second, first, "--format", "json")


def test_csv_names_components_like_json():
    rows = ask_csv("analyze", "-", "--only", "force,moment", "--orders", "1", stdin=leaning(0, 0))
    found = {(row["quantity"], row["figure"]): row["value"] for row in rows}
    assert found["force", "vertical_amplitude"] == found["force", "x_amplitude"]
    assert found["moment", "pitching_phase_deg"] == found["moment", "y_phase_deg"]
    assert refusal("analyze", "-", stdin=leaning(0, 0).replace("up = 0", 'up = "up"')).startswith(
        "standard input: frame.up:"
    )


@cases("analysis/verdict", "the_verdict_names_the_direction")
def test_the_verdict_names_the_direction(kind, axis_deg, up, words):
    side = 2 * np.exp(1j * np.radians([float(axis_deg)]))
    phasors = Phasors.of(np.array([2.0]), side, side, np.zeros(1))
    found = Spectra(np.array([2.0]), up, {kind: phasors})
    scales = Scales(0.0, 0.0, 0.0)
    (told,) = VerdictWords(found, scales, SI).write(judge(found, scales))
    assert words in told


def test_the_page_of_a_report_stands_upright():
    """All that is drawn of an engine that is turned as a whole is drawn as before."""
    each = [analyze(build_text(leaning(turn, turn))) for turn in (0.0, 30.0)]
    upright, turned = (scene(one.engine)["cylinders"] for one in each)
    for a, b in zip(upright, turned, strict=True):
        assert _numbers(b) == pytest.approx(_numbers(a), abs=1e-9)
    assert describe_look(each[1].engine)["axes"] == ("vertical", "horizontal")
    assert describe_look(each[1].engine)["up"] == 30
    assert describe_look(build_text(leaning(0)))["axes"] == ("x", "y")


def _numbers(entry: object) -> list[float]:
    """All numbers within dicts and lists."""
    if isinstance(entry, dict):
        return [v for part in entry.values() for v in _numbers(part)]
    if isinstance(entry, (list, tuple)):
        return [v for part in entry for v in _numbers(part)]
    return [float(entry)] if isinstance(entry, (int, float)) else []


@pytest.mark.slow
def test_pictures_have_up_at_their_top():
    """The locus of the turned engine is that of the upright one, with the words at its axes."""
    pages = [make_page(PageSubject(Study(analyze(build_text(leaning(t, t))))), "polar") for t in (0, 30)]
    for upright, turned, labels in zip(
        *(page.axes for page in pages),
        (("horizontal force, kN", "vertical force, kN"), ("pitching moment, N·m", "yawing moment, N·m")),
        strict=True,
    ):
        assert (turned.get_xlabel(), turned.get_ylabel()) == labels
        longest = max(upright.lines, key=lambda line: len(line.get_xdata()))
        same = max(turned.lines, key=lambda line: len(line.get_xdata()))
        assert same.get_xydata() == pytest.approx(longest.get_xydata(), abs=1e-9)
