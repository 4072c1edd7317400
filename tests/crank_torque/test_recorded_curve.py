"""A recorded curve of any quantity: known harmonics of a polyline, its head, and what needs a torque."""

import json
import math

import numpy as np
import pytest
from support.commands import run_here
from support.paths import write

STEP = 2  # degrees between the rows


def make_record(folder, head="crank angle [deg],tension (kN)", more=""):
    rows = [head + more]
    for angle in range(0, 361, STEP):
        value = 30 * math.cos(math.radians(2 * angle)) + 5 * math.sin(math.radians(3 * angle))
        rows.append(f"{angle},{value!r}" + (",1" if more else ""))
    return write(folder / "record.csv", "\n".join(rows) + "\n")


def run_json(*arguments):
    status, out, err = run_here("torque", "--curve", *map(str, arguments), "--format", "json")
    assert not status, err
    return json.loads(out)


def lose_between_rows(order):
    """Share of an order that straight lines between the rows keep: (sin x / x)^2 with x = n step/2."""
    return np.sinc(order * STEP / 360) ** 2


def test_orders_of_a_tension(tmp_path):
    """Liang, chapter 9: 30 cos 2t + 5 sin 3t."""
    found = run_json(make_record(tmp_path), "--orders", "1-4")
    assert (found["format"], found["quantity"]) == ("balcli.record/1", "tension (kN)")
    by_order = {entry["order"]: entry for entry in found["orders"]}
    assert by_order[2]["cos"] == pytest.approx(30 * lose_between_rows(2), rel=1e-12)
    assert by_order[3]["sin"] == pytest.approx(5 * lose_between_rows(3), rel=1e-12)
    assert [by_order[2]["sin"], by_order[3]["cos"], by_order[1]["amplitude"]] == [0, 0, 0]
    assert round(by_order[2]["amplitude"], 3) == 29.988
    assert round(by_order[3]["amplitude"], 4) == 4.9954


def test_table_has_the_head_of_the_column(tmp_path):
    status, out, _ = run_here("torque", "--curve", str(make_record(tmp_path)), "--orders", "2")
    assert not status
    assert out.startswith("record: tension (kN)\n")
    assert "29.988" in out


def test_torque_stays_a_torque(tmp_path):
    """A torque column is found beside others, by its usual head and by a short one."""
    for head in ("angle_deg,torque_Nm", "CA [deg],M [kN m]"):
        found = run_json(make_record(tmp_path, head, ",speed"))
        assert found["format"] == "balcli.torque/1"


@pytest.mark.parametrize("option", ["--speed=300", "--inertia=2000", "--fluctuation=2%", "--load=record.csv"])
def test_speed_and_flywheel_need_a_torque(tmp_path, monkeypatch, option):
    monkeypatch.chdir(tmp_path)
    make_record(tmp_path)
    status, _, err = run_here("torque", "--curve", "record.csv", option)
    assert status == 2
    assert f"{option.partition('=')[0]} needs a torque; record.csv has tension (kN)" in err


def test_one_of_several_columns_is_not_guessed(tmp_path):
    path = make_record(tmp_path, "angle_deg,front,rear"[:15], ",rear")
    status, _, err = run_here("torque", "--curve", str(path))
    assert status == 2
    assert "has the columns front and rear; keep one of them" in err


def test_angles_are_needed(tmp_path):
    path = write(tmp_path / "record.csv", "time,tension\n0,1\n1,2\n")
    status, _, err = run_here("torque", "--curve", str(path))
    assert status == 2
    assert "has no angle_deg" in err
