"""Quantities of torsion in sweeps: what the command itself says of each variant."""

import csv
import json
from io import StringIO

import pytest
from support.cases import cases
from support.commands import ask, refusal, run_here
from support.diesel import write_diesel
from support.paths import write

import balcli
from balcli.errors import BalcliError
from balcli.forces.quantity import TargetQuantity
from balcli.torsional_vibration.quantity import Variants

GAS = '[gas]\ncycle = "wiebe"\ncompression_ratio = 16\nimep = 15\n'


@pytest.fixture
def diesel(tmp_path):
    return write(tmp_path / "diesel.toml", write_diesel(extra=GAS))


def sweep(path, vary, quantities):
    out = ask("sweep", path, "--vary", vary, "--quantity", quantities)
    return [[float(x) for x in line] for line in list(csv.reader(StringIO(out)))[1:]]


def test_each_variant_is_what_the_command_says(diesel):
    quantities = "torsion.1.Hz,shaft.flywheel.torque,shaft.flywheel.stress,force.2.major"
    for stiffness, hertz, torque, stress, _ in sweep(diesel, "torsion.rear.1.stiffness=1.5e6,2.5e6", quantities):
        text = diesel.read_text().replace("stiffness = 1976000.0", f"stiffness = {stiffness}")
        said = json.loads(run_here("torsion", "-", "--speeds", "1000:3000:20", "--format", "json", stdin=text).out)
        assert said["modes"][0]["frequency_Hz"] == hertz
        worst = said["response"]["shafts"][-1]["worst"]
        assert worst["half_peak_to_peak_Nm"] == pytest.approx(torque, rel=1e-6), "between those speeds"
        assert worst["stress_Pa"] / worst["half_peak_to_peak_Nm"] == pytest.approx(stress / torque, rel=1e-12)


def test_figures_of_lists_and_dampers_vary(tmp_path):
    own = 'damper = { kind = "rubber", inertia = 20000, stiffness = 40000, loss = 0.1 }\n'
    path = write(tmp_path / "damped.toml", write_diesel().replace('name = "pulley"\n', f'name = "pulley"\n{own}'))
    (soft, low), (stiff, high) = sweep(path, "torsion.front.2.damper.stiffness=20000,60000", "torsion.1.Hz")
    assert (soft, stiff) == (20000, 60000)
    assert low < high
    (_, one), (_, two) = sweep(path, "torsion.throw_stiffness.3=1e6,2e6", "torsion.2.Hz")
    assert one < two


@cases("torsional_vibration/quantity", "a_figure_that_contradicts_its_table_is_refused")
def test_a_figure_that_contradicts_its_table_is_refused(figure, told, tmp_path):
    """A bore wider than its shaft had a stress below 0."""
    own = 'damper = { kind = "viscous", inertia = 20000, damping = 4 }\n'
    path = write(
        tmp_path / "damped.toml", write_diesel(extra=GAS).replace('name = "pulley"\n', f'name = "pulley"\n{own}')
    )
    options = ("--vary", figure.replace(" ", ""), "-q", "shaft.flywheel.stress")
    assert refusal("sweep", path, *options) == f"{path}: {figure}: {told}"


def test_without_gas_figures_of_the_engine_vary_too(tmp_path):
    path = write(tmp_path / "bare.toml", write_diesel())
    (_, light), (_, heavy) = sweep(path, "piston.mass=2,3", "shaft.flywheel.torque")
    assert 1.3 < heavy / light < 1.7, "inertia torque grows with the mass"


@cases("torsional_vibration/quantity", "what_is_no_quantity")
def test_what_is_no_quantity(diesel, quantity, message):
    told = refusal("sweep", diesel, "--vary", "torsion.loss=0.01,0.02", "-q", quantity)
    assert told == message.replace("FILE", str(diesel))


def test_files_without_torsion_have_none(tmp_path):
    path = write(tmp_path / "plain.toml", write_diesel().partition("[torsion]")[0])
    told = "torsion.1.Hz: has no [torsion]; write it with throw_stiffness"
    assert refusal("scatter", path, "-q", "torsion.1.Hz").startswith(told)
    asked = ("--vary", "rod.length=200,210", "-q", "torsion.1.Hz")
    assert refusal("sweep", path, *asked).startswith(f"{path}: {told}")


LAW = '[gas]\ncycle = "wiebe"\ncompression_ratio = 16\nat = [{ speed = 1000, imep = 8 }, { speed = 2000, imep = 15 }]\n'


@pytest.mark.parametrize("gas", [GAS, LAW, ""], ids=["gas", "gas by speed", "inertia alone"])
def test_variants_together_are_those_one_by_one(gas):
    """Impossible variants are left to the evaluation of each alone, which tells why."""
    model = balcli.load(write_diesel(extra=gas)).model
    names = ["shaft.flywheel.stress", "torsion.2.Hz", "shaft.throw 3-4.torque"]
    variants = Variants(model, [TargetQuantity(name) for name in names])
    figures = [{"torsion.loss": loss, "piston.mass": 2.0 + loss} for loss in (0.01, -1.0, 0.03, 0.05)]
    together = variants.evaluate_jointly(figures)
    assert list(together) == [0, 2, 3]
    for place, values in together.items():
        assert values == pytest.approx(variants.evaluate(figures[place]), rel=1e-12)
    assert together[0] != together[3]
    with pytest.raises(BalcliError):
        variants.evaluate(figures[1])
