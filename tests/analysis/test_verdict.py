"""The verdict: a record of which orders matter, and a sentence for each order, in words that need no
key.
"""

import numpy as np
import pytest
from support.cases import cases
from support.engines import GOOD, build_text
from support.paths import ENGINES as ENGINE_FILES
from support.remedies import size_scheme

from balcli import Engine, analyze, curves, load, load_example
from balcli.analysis.couple import Couple, select_couple
from balcli.analysis.verdict import Cure, Finding, Part, Rocking, Verdict, judge
from balcli.analysis.verdict_words import VerdictWords
from balcli.core.phasors import Phasors
from balcli.forces.spectrum import Spectra
from balcli.show.units import SI
from balcli.sizing.remedy import fit_devices
from balcli.sizing.residual import Scales

SCALES = Scales(1000.0, 2000.0, 100.0)
NO_SCALES = Scales(0.0, 0.0, 0.0)


def spectra(order: float, forward: complex, backward: complex, kind: str = "force") -> Spectra:
    """One order of a force or moment."""
    orders = np.array([float(order)])
    phasors = Phasors.of(orders, np.array([forward], complex), np.array([backward], complex), np.zeros(1))
    return Spectra(orders, kinds={kind: phasors})


def write(found: Spectra, scales: Scales = NO_SCALES, engine: Engine | None = None, **options) -> tuple[str, ...]:
    """The sentences of the verdict on some spectra."""
    return VerdictWords(found, scales, SI, engine).write(judge(found, scales, engine=engine, **options))


@cases("analysis/verdict", "each_order_in_words")
def test_each_order_in_words(order: int, what: str, vectors: list[list[float]], text: str) -> None:
    assert write(spectra(order, *(complex(*vector) for vector in vectors), what)) == (text,)


@cases("analysis/verdict", "what_is_small_beside_one_cylinder")
def test_what_is_small_beside_one_cylinder(force: dict, moment: dict, told: list[str]) -> None:
    """A cylinder makes 1000 N and 2000 N m; vectors of equal size turn both ways."""
    orders = np.array([1.0, 2, 4, 6, 12])

    def phasors(sizes: dict) -> Phasors:
        v = np.array([sizes.get(f"{n:g}", 0) for n in orders], complex)
        return Phasors.of(orders, v, v, np.zeros(5))

    found = Spectra(orders, kinds={"force": phasors(force), "moment": phasors(moment)})
    assert write(found, SCALES) == tuple(told)


DEVICES = [
    f"{table}\nunbalance = 9\n"
    for table in ("[[counterweight]]\nangle = 180", "[[shaft]]\nratio = -1", "[[shaft]]\nratio = 2")
]
ENGINES = [build_text(GOOD + "".join(DEVICES[:k])) for k in range(4)]


@pytest.mark.parametrize(
    ("order", "text"),
    [
        (1, "further counterweights cancel 50 N of it, a further shaft at -1 the other 50 N."),
        (2, "further shafts at +2 and -2 cancel it."),
    ],
)
def test_a_device_like_one_of_the_file_is_a_further_one(order: int, text: str) -> None:
    (told,) = write(spectra(order, 50, 50), engine=ENGINES[3])
    assert told.endswith(text)


@cases("analysis/verdict", "force_and_moment_keep_their_shares")
def test_force_and_moment_keep_their_shares(order: int, force: list[float], moment: list[float], told: str) -> None:
    """A cylinder makes 1000 N and 2000 N m."""
    kinds = spectra(order, *force).kinds | spectra(order, *moment, "moment").kinds
    found = Spectra(np.array([float(order)]), kinds=kinds)
    (written,) = write(found, SCALES)
    assert written.partition(": ")[2] == told


@pytest.mark.parametrize("seed", range(40))
def test_a_sentence_has_at_most_25_words_or_35_on_force_and_moment(seed):
    """Whatever turns, wherever it points, with or without `up`."""
    random = np.random.default_rng(seed)
    orders = np.array([1.0, 2, 3, 4, 6, 8, 10, 12])

    def phasors() -> Phasors:
        parts = random.normal(size=(4, 8)) * (random.random((4, 8)) < 0.7) * 10.0 ** random.integers(-4, 6, (4, 8))
        return Phasors.of(orders, parts[0] + 1j * parts[1], parts[2] + 1j * parts[3], np.zeros(8))

    up = None if seed % 2 else float(random.integers(-180, 180))
    found = Spectra(orders, up, {"force": phasors(), "moment": phasors()})
    verdict = judge(found, SCALES, engine=ENGINES[seed % 4])
    words = VerdictWords(found, SCALES, SI, ENGINES[seed % 4])
    about_both = {words.write_order(finding) for finding in verdict.matter if len(finding.large) == 2}
    for written in words.write(verdict):
        assert len(written.split()) <= (35 if written in about_both else 25)


def test_small_is_what_is_asked_for():
    found = spectra(2, 10, 10)
    assert write(found, SCALES) == ("Small: force of 20 N (order 2).",)
    told = "Second order: force of 20 N along x; shafts at +2 and -2 cancel it."
    assert write(found, SCALES, small=0.01) == (told,)


@pytest.mark.parametrize(("couple", "told"), [(0, "force, moment and couple"), (1, "force and moment")])
def test_the_couple_is_judged_with_force_and_moment(couple: float, told: str) -> None:
    none = spectra(1, 0, 0).force
    some = spectra(1, couple, couple).force
    found = Spectra(none.orders, kinds={"force": none, "moment": none, "couple": some})
    assert write(found) == (f"Order 1: {told} balanced.",)


HEAVY = {"crank.stroke": 90, "rod.length": 200, "rod.mass": 2, "rod.cg": 50, "rod.inertia": 15000, "piston.mass": 1}
HEAVY["operation.speed"] = 2000
NO_H = "; a rod dynamically equivalent to two masses at its ends has none."


@pytest.mark.parametrize(
    ("changes", "causes", "told"),
    [
        ({"rod.inertia": 9000}, ("rods",), f"the rods{NO_H}"),
        ({"piston.offset": 10}, ("offset_pistons",), "offset pistons."),
        (
            {"rod.inertia": 9000, "piston.offset": 10},
            ("rods", "offset_pistons"),
            "the rods and offset pistons.",
        ),
        (
            {"frame.reference": [0, 80, 0]},
            ("reference_point",),
            "forces whose lines miss the point of reference.",
        ),
        (
            {"operation.speed_ripple": "[{ order = 2, amplitude = 0.05 }]"},
            ("angular_acceleration",),
            "the acceleration of turning parts.",
        ),
    ],
)
def test_the_causes_of_the_couple_are_named(changes: dict, causes: tuple[str, ...], told: str) -> None:
    """Its size is the largest harmonic of the sampled couple."""
    engine = build_text("".join(f"{key} = {value}\n" for key, value in (HEAVY | changes).items()))
    found = analyze(engine)
    couple = np.abs(np.fft.rfft(curves(engine).curves["couple_Nm"][:360])) / 180
    order = int(couple[1:].argmax()) + 1
    assert found.verdict.couple == Couple(order, causes)
    text = VerdictWords(found.spectra, found.scales, SI, engine).write_couple(found.verdict.couple)
    assert text == f"Transverse couple: up to {couple[order]:.4g} N·m (order {order}), from {told}"


def test_several_cranks_have_a_couple_without_causes() -> None:
    engine = load(ENGINE_FILES / "geared" / "napier_deltic.toml")
    assert analyze(engine).verdict.couple == Couple(6)


def test_a_negligible_couple_is_not_named() -> None:
    engine = build_text("".join(f"{key} = {value}\n" for key, value in HEAVY.items()))
    assert analyze(engine).verdict.couple is None


# ------------------------------------------------------------------ the record
COUNTERWEIGHTS = Cure(1, on_crank=True)
SHAFT = Cure(-1)


@pytest.mark.parametrize(
    ("order", "forward", "backward", "cures"),
    [
        (1, 50, 50, (COUNTERWEIGHTS, SHAFT)),
        (1, 49.9, 50, (SHAFT,)),
        (1, 50, 49.9, (COUNTERWEIGHTS,)),
        (2, 50, 50, (Cure(2), Cure(-2))),
        (2, 49.9, 49.9, ()),
        (1.5, 50, 50, None),
    ],
)
def test_a_device_for_each_direction_of_a_large_vector(order, forward, backward, cures):
    """A cylinder makes 1000 N: from 50 N on a vector is large."""
    verdict = judge(spectra(order, forward, backward), SCALES)
    assert verdict == Verdict(matter=(Finding(order, ("force",), cures),))


def test_a_mean_force_is_no_order():
    assert judge(spectra(0, 100, 0), SCALES) == Verdict()


def test_a_force_is_small_by_its_largest_value():
    """Its vectors are each half of it."""
    assert judge(spectra(2, 24.9, 24.9), SCALES) == Verdict(small=(Part(2, "force"),))
    assert judge(spectra(2, 0.49, 0.49), SCALES) == Verdict()


@pytest.mark.parametrize(("small", "orders"), [(0, [1, 2, 4]), (0.001, [1, 2, 4]), (0.01, [1, 2]), (0.5, [1])])
def test_what_is_small_is_nowhere_larger_than_what_is_not(small, orders):
    sizes = np.array([400, 30, 2], complex)
    numbers = np.array([1.0, 2, 4])
    found = Spectra(numbers, kinds={"force": Phasors.of(numbers, sizes, sizes, np.zeros(3))})
    verdict = judge(found, SCALES, small=small)
    assert [finding.order for finding in verdict.matter] == orders
    rest = [order for order in (1, 2, 4) if order not in orders]
    assert [part.order for part in verdict.small] == rest[:1]


ROLLS = [(24.9, None), (25, Rocking("inertia", 2))]


@pytest.mark.parametrize(("size", "rocking"), ROLLS)
def test_roll_without_gas_is_named_from_a_quarter_of_one_cylinder_on(size, rocking):
    """Its force times the crank radius is 100 N m."""
    kinds = spectra(2, 50, 50).kinds | spectra(2, size / 2, size / 2, "roll").kinds
    found = Spectra(np.array([2.0]), kinds=kinds)
    assert judge(found, SCALES).rocking == rocking
    told = write(found, SCALES)[-1]
    assert (told == "Order 2 rocks the engine most: roll of 25 N·m (inertia alone).") is bool(rocking)


@pytest.mark.parametrize(
    ("gas", "inertia", "causes"), [(25, 12, "gas 25 N·m, inertia 12 N·m"), (25, 0, "from gas"), (0, 25, "from inertia")]
)
def test_the_causes_of_a_roll_with_gas_are_named(gas, inertia, causes):
    kinds = spectra(2, 50, 50).kinds
    for kind, size in (("gas", gas), ("roll", inertia), ("roll_total", gas + inertia)):
        kinds = kinds | spectra(2, size / 2, size / 2, kind).kinds
    told = write(Spectra(np.array([2.0]), kinds=kinds), SCALES)[-1]
    assert told == f"Order 2 rocks the engine most: roll of {gas + inertia} N·m ({causes})."


@pytest.mark.parametrize(("size", "named"), [(0.99, False), (1, True)])
def test_a_couple_is_named_from_a_hundredth_of_one_cylinder_on(size, named):
    couple = spectra(2, size / 2, size / 2, "couple").couple
    assert (select_couple(couple, SCALES) is not None) is named


def test_roll_of_inertia_is_not_named_if_that_of_gas_is_not_known():
    engine = load_example("i4_wiebe")
    assert analyze(engine, only=["force", "roll"]).verdict.rocking is None
    assert analyze(engine, only=["force", "roll", "gas"]).verdict.rocking.of == "total"


@pytest.mark.parametrize(
    ("number", "further"),
    [(0, (False, False)), (1, (True, False)), (2, (True, True)), (3, (True, True))],
)
def test_a_device_that_the_file_has_is_further(number, further):
    (finding,) = judge(spectra(1, 50, 50), SCALES, engine=ENGINES[number]).matter
    assert tuple(cure.further for cure in finding.cures) == further


def test_a_slider_does_not_turn():
    """So a shaft that turns beside it is the first of its kind."""
    slider = build_text(GOOD + "[[slider]]\nunbalance = 9\norder = 2\ndirection = 30\n")
    (finding,) = judge(spectra(2, 50, 50), SCALES, engine=slider).matter
    assert finding.cures == (Cure(2), Cure(-2))


SINGLE = "[crank]\nstroke = 90\nthrow_mass = 0.8\n[rod]\nlength = 160\nmass = 0.6\ncg = 45\n[piston]\nmass = 0.5\n[operation]\nspeed = 6000\n"
OVERBALANCED = SINGLE + "[[counterweight]]\nunbalance = {}\nangle = 180\nposition = 0\n"
SETTLED = "would take back those of the file."


@pytest.mark.parametrize(("unbalance", "takes_back"), [(50_000, None), (80_000, True)])
def test_counterweights_that_would_take_back_those_of_the_file(unbalance, takes_back):
    """70 454 g mm balance what turns with the crank; more are the maker's choice, which the ladder respects, too."""
    result = analyze(build_text(OVERBALANCED.format(unbalance)), only=["force", "ladder"])
    weights, shaft = result.verdict.matter[0].cures
    assert weights == Cure(1, on_crank=True, further=True, takes_back=takes_back)
    assert shaft == Cure(-1)
    assert result.ladder.steps[1].takes_back == takes_back
    told = VerdictWords(result.spectra, result.scales, SI, result.engine).write(result.verdict)[0]
    assert told.endswith(f"; counterweights against it {SETTLED}") is bool(takes_back)


def test_verdict_and_ladder_agree_on_weights_that_take_back():
    result = analyze(load_example("ford_ecoboost_1_0"), only=["force", "moment", "ladder"])
    told = VerdictWords(result.spectra, result.scales, SI, result.engine).write(result.verdict)
    assert any(step.takes_back for step in result.ladder.steps)
    assert told[0].endswith(SETTLED)


def test_in_a_rotary_engine_the_cylinders_turn():
    engine = load(ENGINE_FILES / "historic" / "gnome_monosoupape.toml")
    assert write(spectra(1, 2, 0), engine=engine)[0].startswith("First order: force of 2 N turning with the cylinders;")
    told = "Second order: force of 2 N turning at twice the speed of the cylinders, against the cylinders;"
    assert write(spectra(2, 0, 2), engine=engine)[0].startswith(told)


def test_a_crank_that_turns_backwards_can_carry_weights():
    (finding, *_) = analyze(load(ENGINE_FILES / "geared" / "napier_deltic.toml")).verdict.matter
    assert finding.cures == (Cure(1, on_crank=True), Cure(-1, on_crank=True))


@pytest.mark.parametrize(
    ("forces", "balanced"),
    [
        ({}, (1, 2)),
        ({1: 100}, (2,)),
        ({1: 100, 2: 100}, ()),
        ({1: 100, 2: 1}, ()),
        ({2: 1}, (1,)),
    ],
)
def test_only_balanced_orders_that_are_worth_naming(forces, balanced):
    orders = np.array([0.5, 1, 2, 3])
    sizes = np.array([forces.get(order, 0) for order in orders], complex)
    found = Spectra(orders, kinds={"force": Phasors.of(orders, sizes, sizes, np.zeros(4))})
    assert judge(found, SCALES).balanced == balanced


@pytest.mark.parametrize(("orders", "force", "balanced"), [([0.5, 3], 0, (0.5,)), ([3, 4], 0, (3, 4)), ([3, 4], 1, ())])
def test_other_balanced_orders_only_if_no_order_is_named(orders, force, balanced):
    sizes = np.array([0, force], complex)
    listed = np.array(orders, float)
    found = Spectra(listed, kinds={"force": Phasors.of(listed, sizes, sizes, np.zeros(2))})
    assert judge(found, SCALES).balanced == balanced


@pytest.mark.parametrize(("places", "introduced"), [((3.0,), True), ((-2.0, 3.0), False)])
def test_what_compensators_leave(places, introduced):
    """A pair introduces no force; a single compensator does."""
    drawn = load_example("i3")
    position = places if len(places) > 1 else places[0]
    fitted = fit_devices(drawn, size_scheme(drawn, "compensator", order=2, position=position))
    (found,) = analyze(fitted).verdict.compensated
    assert (found.order, found.at_m, found.vertical_Nm) == (2, places, 0)
    assert bool(found.introduced_N) == introduced
    half = analyze(fitted.vary({"shaft.1.unbalance": 0})).verdict.compensated[0]
    assert half.vertical_Nm > 10


def test_no_device_is_named_at_uneven_speed():
    uneven = build_text(GOOD.replace("[operation]", "[operation]\nspeed_ripple = [{ order = 2, amplitude = 0.05 }]"))
    verdict = judge(spectra(1, 50, 50), SCALES, engine=uneven)
    assert (verdict.uneven, verdict.matter) == (True, (Finding(1, ("force",)),))


def test_a_document_has_the_verdict():
    found = analyze(ENGINES[3], only=["force", "moment"]).to_dict()["verdict"]
    assert [finding["order"] for finding in found["matter"]] == [2]
    assert found["matter"][0]["large"] == ["force"]
    assert found["matter"][0]["cures"] == [
        {"ratio": 2, "on_crank": False, "further": True},
        {"ratio": -2, "on_crank": False, "further": False},
    ]
    assert "verdict" not in analyze(ENGINES[3], only=["roll"]).to_dict()
