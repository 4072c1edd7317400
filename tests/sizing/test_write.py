"""Writing remedies: the original text stays, and what is read back is what was analysed."""

import re

import pytest
from support.engines import GOOD, SINGLE, build_text
from support.paths import ENGINE_FILES, ENGINES
from support.remedies import size_scheme

from balcli.analysis.answer import analyze
from balcli.balancing.answer import insert_remedy
from balcli.errors import BalcliError
from balcli.file.edit import format_value
from balcli.forces.spectrum import compute_spectra
from balcli.sizing.options import SCHEMES
from balcli.sizing.remedy import Remedy, fit_devices
from balcli.sizing.sizing import size


def figures(engine):
    """Every phasor, of as many orders as the largest force and moment are made of."""
    found = compute_spectra(engine, range(1, 41), ["force", "moment", "couple", "torque", "roll"])
    return [(p.forward.tolist(), p.backward.tolist()) for _, p in found.items()]


def check(text: bytes, remedy: Remedy) -> None:
    """The text with a remedy is exactly the engine with its devices."""
    assert figures(build_text(insert_remedy(text, remedy))) == figures(fit_devices(build_text(text), remedy))


WRITTEN = sorted(set(SCHEMES) - {"compensator", "eccentric-slider", "oldham", "step"})


def list_pairs():
    """Every scheme with every fourth example; by default, each of them with every third of the others."""
    for row, path in enumerate(ENGINE_FILES[::4]):
        for column, scheme in enumerate(WRITTEN):
            marks = [pytest.mark.slow] if (row + column) % 3 else []
            yield pytest.param(path, scheme, marks=marks, id=f"{path.stem}-{scheme}")


@pytest.mark.parametrize(("path", "scheme"), [*list_pairs()])
def test_every_written_engine_reads_back_to_exactly_what_was_promised(path, scheme):
    text = path.read_bytes()
    engine = build_text(text)
    if path.stem == "locomotive4":
        pytest.skip("weights on one of several cranked axles have to name it")
    if engine.rotary and scheme == "factor":
        pytest.skip("pins that stand still have no factor")
    wanted = {"direction": 20.0, "ratio": 0.4} if scheme == "ellipse" else {}
    remedy = size_scheme(engine, scheme, small=0, **wanted)
    check(text, remedy)


@pytest.mark.parametrize("scheme", ["auto", "minimax", "two-shaft", "slider", "factor"])
def test_devices_of_the_file_stay(scheme):
    own = (
        "[[shaft]]\nratio = 1\nunbalance = 700\nangle = 33\n"
        '[[slider]]\norder = 2\nunbalance = "3 kg*mm"\ndirection = 20\n'
        "[[counterweight]]\nmass = 0.3\nradius = 50\n"
    )
    check((SINGLE + own).encode(), size(build_text(SINGLE + own), scheme))


def test_the_text_stays_and_reasons_stand_beside_the_devices():
    text = GOOD.rstrip("\n") + " # the last comment"
    remedy = size(build_text(text), "auto")
    new = insert_remedy(text.encode(), remedy)
    assert new.startswith(text + "\n\n# fitted by balcli, scheme auto\n# Counterweights at every throw ")
    assert "\n# Order 2 force turning with the crank: " in new
    assert new.count("[[shaft]]") == 2


@pytest.mark.parametrize(
    "dressed", [lambda t: "\ufeff" + t, lambda t: t.replace("\n", "\r\n"), lambda t: t.rstrip("\n")]
)
def test_marks_and_line_ends(dressed):
    text = dressed(SINGLE).encode()
    check(text, size(build_text(text), "auto"))


def test_an_inline_list_of_devices_is_written_anew():
    text = "counterweight = [{ unbalance = 500, angle = 180 }]  # by hand\n" + SINGLE
    remedy = size(build_text(text), "auto")
    new = insert_remedy(text.encode(), remedy)
    assert new.startswith("# Comments and layout of the original could not be kept")
    check(text.encode(), remedy)


@pytest.mark.parametrize("scheme", ["eccentric-slider", "oldham"])
def test_what_no_file_can_describe_is_not_written(scheme):
    remedy = size_scheme(build_text(SINGLE), scheme)
    with pytest.raises(BalcliError, match=f"scheme {scheme}: no engine file can describe its devices"):
        insert_remedy(SINGLE.encode(), remedy)


def test_written_numbers_have_at_most_twelve_digits():
    text = (ENGINES / "i3.toml").read_bytes()
    remedy = size_scheme(build_text(text), "auto")
    new = insert_remedy(text, remedy)
    figures_of_devices = re.findall(r"[\d.]+", new.partition("# fitted")[2])
    assert max(len(figure.replace(".", "").lstrip("0")) for figure in figures_of_devices) == 12
    assert format_value([40480.200000000004, 360 / 7]) == "[40480.2, 51.42857142857143]"
    assert format_value({"count": 1234567890123, "on": True}) == "{ count = 1234567890123, on = true }"


def test_what_the_digits_of_a_file_leave_is_balanced():
    """Twelve digits leave 1e-12 of a device's force: rounding, as long as it is no more."""
    engine = build_text((ENGINES / "i3.toml").read_bytes())
    remedy = size_scheme(engine, "auto")
    assert abs(analyze(fit_devices(engine, remedy), [1]).spectra["moment"].forward[0]) == 0
    first, *others = remedy.devices
    heavier = first.model_copy(update={"unbalance": first.unbalance * (1 + 1e-9)})
    left = analyze(fit_devices(engine, remedy._replace(devices=(heavier, *others))), [1])
    assert abs(left.spectra["moment"].forward[0]) > 0
