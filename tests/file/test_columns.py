"""Diagrams and torque curves as people have them, and files that are no engine files."""

import re
import tracemalloc

import numpy as np
import pytest
from support.cases import cases
from support.commands import run_here
from support.engines import GOOD, changed
from support.gas_engines import PETROL_FOUR
from support.paths import write

from balcli import load
from balcli.crank_torque.given_curve import read_curve
from balcli.errors import BalcliError
from balcli.file.toml import parse_toml

ANGLES = np.arange(0.0, 720.0, 5)
BAR = 1 + 60 * np.exp(-(((ANGLES - 370) / 40) ** 2))
ENGINE = PETROL_FOUR[: PETROL_FOUR.index("[gas]")] + '[gas]\nindicator = "p.csv"\nzero = "gas-exchange"\n'


def diagram(mark=",", heading=("angle_deg", "pressure_bar"), angles=ANGLES, values=BAR, point="."):
    rows = [heading, *((f"{a!r}", f"{b!r}") for a, b in zip(angles.tolist(), values.tolist(), strict=True))]
    return "\n".join(mark.join(cells).replace(".", point) for cells in rows) + "\n"


def torque_of(folder, text):
    write(folder / "p.csv", text)
    engine = load(write(folder / "engine.toml", ENGINE))
    return engine.gas.cylinders[0].torque.imep, engine.unlikely


@pytest.mark.parametrize(
    "form",
    [
        {"mark": " "},
        {"mark": "   ", "point": ","},
        {"mark": "\t"},
        {"mark": ";", "point": ","},
        {"heading": ("angle_deg", "pressure_MPa"), "values": BAR / 10},
        {"heading": ("Angle [deg]", "Pressure [kPa]"), "values": BAR * 100},
        {"mark": "  ", "heading": ("angle [deg]", "pressure (bar)")},
        {"heading": ("angle_rad", "pressure_bar"), "angles": np.radians(ANGLES)},
        {"heading": ("Crank angle [°CA]", "p_cyl [kg/cm2]"), "values": BAR / 0.980665},
        {"heading": ("θ/deg", "P_bar")},
        {"heading": ("angle,pressure\ndeg", "bar")},
        {"heading": ("angle,pressure\n(deg)", "[kg/cm2]"), "values": BAR / 0.980665},
        {"heading": ("angle_deg,pressure_bar\ndeg", "bar")},
    ],
)
def test_a_diagram_in_any_form_is_the_same(tmp_path, form):
    text = diagram(**form)
    assert torque_of(tmp_path, text)[0] == pytest.approx(torque_of(tmp_path, diagram())[0], rel=1e-9)


def test_exponents_may_be_those_of_fortran(tmp_path):
    text = "\n".join(["angle_deg,pressure_bar", *(f"{a:.9E},{b:.9E}" for a, b in zip(ANGLES, BAR, strict=True))])
    found = torque_of(tmp_path, text.replace("E+", "D+"))[0]
    assert found == pytest.approx(torque_of(tmp_path, diagram())[0], rel=1e-7)


def test_two_columns_that_may_both_be_meant_are_named(tmp_path):
    heading = ("CA [deg],p [bar]", "p_cyl [bar]")
    with pytest.raises(BalcliError, match=r'has the columns "p \[bar\]" and "p_cyl \[bar\]"; rename the right one'):
        torque_of(tmp_path, diagram(heading=heading))


@pytest.mark.parametrize("restarts", [True, False])
def test_of_several_cycles_the_mean_is_taken_and_said(tmp_path, restarts):
    every = [ANGLES + (0 if restarts else 720 * k) for k in range(3)]
    values = [BAR, BAR * 1.1, BAR * 0.9]
    found, doubts = torque_of(tmp_path, diagram(angles=np.concatenate(every), values=np.concatenate(values)))
    assert found == pytest.approx(torque_of(tmp_path, diagram())[0], rel=1e-12)
    assert "gas.indicator: p.csv: has 3 cycles; their mean is used" in map(str, doubts)


@cases("file/columns", "a_torque_has_the_unit_of_its_heading")
@pytest.mark.parametrize("mark", [",", ";", "\t", "  "])
def test_a_torque_has_the_unit_of_its_heading(tmp_path, head, size, mark):
    text = f"angle_deg{mark}{head}\n0{mark}25\n180{mark}5\n360{mark}25\n"
    assert read_curve(write(tmp_path / "torque.csv", text)).mean == pytest.approx(15 * size, rel=1e-14)


@cases("file/columns", "thousands_in_columns_are_no_decimals")
def test_thousands_in_columns_are_no_decimals(tmp_path, rows, answer):
    path = write(tmp_path / "torque.csv", f"angle_deg{rows[1]}torque_Nm\n{rows}")
    if isinstance(answer, str):
        with pytest.raises(BalcliError, match=re.escape(answer)):
            read_curve(path)
    else:
        assert read_curve(path).mean == pytest.approx(answer)


@pytest.mark.parametrize(
    "text",
    [
        *('{"crank": {"stroke": 86}}', "[1, 2]\n", '<?xml version="1.0"?>\n<engine stroke="86"/>\n'),
        *("a;b\n0;1\n", "# log\nangle_deg,torque_Nm\n" + "0.5,1\n" * 100_000, "stroke: 86\nrod: 144\n"),
    ],
)  # fmt: skip
def test_a_file_of_another_format_is_refused_in_one_line(text):
    with pytest.raises(BalcliError, match="balcli new") as caught:
        parse_toml(text, "file")
    assert str(caught.value).startswith("file: is not an engine file, which is TOML text with tables")
    assert "\n" not in str(caught.value)


def test_a_long_column_is_read_no_farther_than_the_limit(tmp_path):
    path = write(tmp_path / "torque.csv", "angle_deg,torque_Nm\n" + "10\n" * 1_000_000)
    tracemalloc.start()
    with pytest.raises(BalcliError, match="more than 20000 rows"):
        read_curve(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 30e6


def test_a_bore_is_shown_in_the_unit_of_the_file():
    text = PETROL_FOUR + '[torsion]\nthrow_stiffness = 1e6\n[[torsion.rear]]\nname = "w"\ninertia = 1e5\n'
    err = run_here("torsion", "-", stdin=text + 'diameter = "2 in"\nlength = 100\nbore = "6 cm"\n').err
    assert "bore = 6 cm: has to be below diameter = 2 in" in err


@pytest.mark.parametrize("splay", [0, 30])
def test_oil_of_a_pin_is_shared_by_its_rods(splay):
    layout = "[layout]\nbank_angle = 90\n"
    text = f"[crank]\nstroke = 90\nsplay = {splay}\n[rod]\nlength = 160\n[piston]\nmass = 0.5\n{layout}"
    text += '[bobweight]\noil_per_pin = "10 g"\n'
    assert [one.oil for one in load(text).weighed] == [0.01 if splay else 0.005] * 2
    with pytest.raises(BalcliError, match="has oil and oil_per_pin; give either"):
        load(text + "oil = 0.005\n")


def test_a_firing_order_may_be_of_strings():
    text = changed(("[1, 3, 4, 2]", '["1", "3", "4", "2"]'))
    assert load(text).weighed == load(GOOD).weighed
