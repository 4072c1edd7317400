"""Sweeps: variants as arrays are what each engine gives alone."""

import json
import math
from functools import partial
from itertools import product
from threading import Thread

import numpy as np
import pytest
from support.cases import cases
from support.engines import GOOD, VEE, changed

from balcli.core.phasors import Array
from balcli.engine.build import build
from balcli.engine.parse import parse as load
from balcli.errors import BalcliError, InputError
from balcli.forces.quantity import evaluate_quantities
from balcli.studies.parameters import parse_parameter
from balcli.studies.quantities import parse_quantities
from balcli.studies.sweep import (
    Sweep,
    build_corners,
    count_at_once,
    divide_grid,
    evaluate_chunks,
    evaluate_sweep,
    join_chunks,
    share_among_threads,
    split_columns,
)
from balcli.studies.sweep_show import sweep_csv, sweep_json

SAME = 1e-12  # of the largest value of a column
EVERYTHING = parse_quantities(
    "force.1.major,force.2.minor,moment.1.backward,moment.4.x,"
    "couple.3.amplitude,torque.2.amplitude,roll.4.amplitude,peak.force"
)


def asked(engine: str, *vary: str, of: str = "") -> Sweep:
    file = load(engine)
    return Sweep(file, tuple(parse_parameter(v, file) for v in vary), parse_quantities(of) if of else EVERYTHING)


@cases("studies/sweep", "every_variant_is_the_engine_alone", VEE=VEE)
def test_every_variant_is_the_engine_alone(engine: str, vary: list[str]) -> None:
    sweep = asked(engine, *vary)
    found = join_chunks(sweep, evaluate_chunks(sweep))
    paths = [p.path for p in sweep.parameters]
    variants = [
        dict(zip(paths, values, strict=True)) for values in product(*(p.values.tolist() for p in sweep.parameters))
    ]
    alone = [[float(v) for v in evaluate_quantities(build(sweep.file, one), EVERYTHING)] for one in variants]
    for quantity, values, expected in zip(EVERYTHING, found, np.array(alone).T, strict=True):
        assert values.ravel() == pytest.approx(expected, abs=SAME * max(np.abs(expected).max(), 1e-9)), quantity.name


@pytest.mark.parametrize("vary", ["counterweight.1.mass=0,0.3", "counterweight.1.radius=0,40"])
def test_an_unbalance_of_mass_and_radius_varies_by_either(vary: str) -> None:
    """0 and 0.3 kg at 40 mm (or 0 and 40 mm of 0.3 kg), opposite the first pin of a balanced crank: U omega^2."""
    sweep = asked(GOOD + "[[counterweight]]\nmass = 0.3\nradius = 40\n", vary, of="force.1.forward")
    (found,) = evaluate_quantities(sweep.engine(), sweep.quantities)
    assert found == pytest.approx([0, 0.3 * 0.040 * (3000 * math.pi / 30) ** 2], rel=1e-14)


def test_a_rod_weighed_at_one_end_only_is_refused() -> None:
    light = changed(("mass = 0.6\ncg = 45\n", ""))
    with pytest.raises(InputError, match=r"rod\.big_end: needs small_end as well: weigh the rod at both ends"):
        build_corners(asked(light, "rod.big_end=0.1,0.2"))


def test_what_does_not_vary_is_not_computed_again() -> None:
    sweep = asked(VEE, "layout.bank_angle=0:180:45", "rod.ratio=0.2,0.3,0.31")
    engine = sweep.engine()
    assert engine.cylinders.axis_deg.shape == (2, 5, 1)
    assert engine.cylinders.lam.shape == (1, 1, 3)
    assert engine.cylinders.z.shape == (8, 1, 1)


@pytest.mark.parametrize("shape", [(1,), (7,), (100,), (3, 5), (2, 3, 4), (1, 50, 2), (5, 1, 1)])
@pytest.mark.parametrize("most", [1, 4, 10, 1000])
def test_boxes_cover_the_grid_in_the_order_of_rows(shape: tuple[int, ...], most: int) -> None:
    numbers = np.arange(math.prod(shape)).reshape(shape)
    parts = [numbers[box].ravel() for box in divide_grid(shape, most)]
    assert np.concatenate(parts).tolist() == list(range(numbers.size))
    assert max(map(len, parts)) <= most


@cases("studies/sweep", "boxes_are_the_smaller_the_more_each_variant_needs")
def test_boxes_are_the_smaller_the_more_each_variant_needs(vary: str, of: str, most: int) -> None:
    """Orders, and samples near the lock: a box takes a fraction of a second, and little memory."""
    assert count_at_once(asked(VEE, vary, of=of)) <= most


def test_chunks_do_not_change_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    sweep = asked(VEE, "layout.bank_angle=0:179:1", "rod.ratio=0.2:0.399:0.001", of="force.2.major,moment.1.backward")
    whole = join_chunks(sweep, evaluate_chunks(sweep))
    monkeypatch.setattr("balcli.studies.sweep.CHUNK", 2_500)
    several = list(evaluate_chunks(sweep))
    assert len(several) > 5
    every = np.concatenate([np.stack(split_columns(sweep, chunk)) for chunk in several], axis=1)
    assert every.shape == (4, 36_000)
    assert np.array_equal(every[2:], [column.ravel() for column in whole])
    assert every[:2, [0, 1, 200, -1]].T.tolist() == [[0, 0.2], [0, 0.201], [1, 0.2], [179, 0.399]]


def test_csv_is_exact_and_an_axis_that_is_none_an_empty_cell() -> None:
    """In JSON it is null."""
    sweep = asked(GOOD, "piston.mass=0.1,0.5", of="force.2.major,force.2.axis,force.1.axis")
    text = "".join(sweep_csv(sweep, evaluate_chunks(sweep)))
    force = [repr(float(v)) for v in join_chunks(sweep, evaluate_chunks(sweep))[0]]
    assert text == f"piston.mass,force.2.major,force.2.axis,force.1.axis\n0.1,{force[0]},0.0,\n0.5,{force[1]},0.0,\n"
    document = json.loads("".join(sweep_json(sweep, evaluate_chunks(sweep))))
    assert document["columns"] == text.split()[0].split(",")
    assert document["rows"] == [[0.1, float(force[0]), 0, None], [0.5, float(force[1]), 0, None]]


def test_a_system_that_gives_no_thread_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: Thread) -> None:
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr("balcli.studies.sweep.CHUNK", 300)
    sweep = asked(VEE, *GRID, of="force.2.major")
    monkeypatch.setattr(Thread, "start", refuse)
    with pytest.raises(BalcliError, match=r"^jobs 5: can't start new thread; give fewer, such as jobs 1$"):
        list(evaluate_chunks(sweep, partial(share_among_threads, threads=5)))


GRID = ("layout.bank_angle=0:100:1", "rod.ratio=0.2:0.3:0.0002")


def test_threads_give_identical_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    """From the first box on, many more boxes than threads or fewer."""
    monkeypatch.setattr("balcli.studies.sweep.CHUNK", 30)
    sweep = asked(VEE, "layout.bank_angle=0:100:2", "rod.ratio=0.2:0.3:0.005", of="force.2.major,moment.1.backward")
    alone = "".join(sweep_csv(sweep, evaluate_chunks(sweep)))
    for threads in (2, 5, 64):
        share = partial(share_among_threads, threads=threads)
        assert "".join(sweep_csv(sweep, evaluate_chunks(sweep, share))) == alone, f"{threads} threads"


def test_threads_end_with_who_asks_for_their_figures(monkeypatch: pytest.MonkeyPatch) -> None:
    """After three of 51 boxes no more than what was under way is computed."""
    boxes: list[object] = []

    def counted(sweep: Sweep) -> list[Array]:
        boxes.append(sweep)
        return evaluate_sweep(sweep)

    monkeypatch.setattr("balcli.studies.sweep.CHUNK", 125)
    monkeypatch.setattr("balcli.studies.sweep.evaluate_sweep", counted)
    sweep = asked(VEE, *GRID, of="force.2.major")
    chunks = evaluate_chunks(sweep, partial(share_among_threads, threads=2))
    assert len([next(chunks) for _ in range(3)]) == 3
    del chunks
    assert len(boxes) <= 1 + 2 * 2 + 2


@pytest.mark.slow
@pytest.mark.stress
def test_a_mistake_in_a_later_box_is_told_by_threads_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """A ripple that stops the crank between the corners of the grid."""
    ripple = "[[operation.speed_ripple]]\norder = 1\namplitude = 0.6\n"
    ripple += "[[operation.speed_ripple]]\norder = 2\namplitude = 0.5\n"
    sweep = asked(VEE + ripple, "operation.speed_ripple.2.angle=0:360:0.01", of="force.1.major")
    monkeypatch.setattr("balcli.studies.sweep.CHUNK", 1_000)
    chunks = evaluate_chunks(sweep, partial(share_among_threads, threads=2))
    assert len(next(chunks).values[0]) <= 1_000
    with pytest.raises(InputError, match="the crank would"):
        list(chunks)
