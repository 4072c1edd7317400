"""Several pages of `balcli plot` at once."""

import re

import pytest
from support.commands import refusal, run_here
from support.paths import ENGINES, write

from balcli.report.command import complete_pages, parse_pages
from balcli.report.names import PAGES

FOUR = ENGINES / "i4_wiebe.toml"
DIESEL = ENGINES / "i6_diesel.toml"


@pytest.mark.stress
@pytest.mark.parametrize("form", ["svg", "png"])
def test_each_page_goes_into_a_file_of_its_name_and_is_that_page(tmp_path, form):
    told = run_here("plot", DIESEL, "--what", "modes,polar", "-o", tmp_path / f"two.{form}")
    assert told == (0, "", "")
    assert {file.name for file in tmp_path.iterdir()} == {f"two-modes.{form}", f"two-polar.{form}"}
    for page in ("modes", "polar"):
        alone = tmp_path / f"alone.{form}"
        assert run_here("plot", DIESEL, "--what", page, "-o", alone).status == 0
        assert alone.read_bytes() == (tmp_path / f"two-{page}.{form}").read_bytes()


@pytest.mark.stress
def test_a_pdf_has_them_one_after_the_other(tmp_path):
    """Each of its own size; the same every time."""

    def draw(what: str) -> bytes:
        file = tmp_path / "x.pdf"
        assert run_here("plot", FOUR, "--what", what, "-o", file).status == 0
        assert [each.name for each in tmp_path.iterdir()] == ["x.pdf"]
        return file.read_bytes()

    def sizes(pdf: bytes) -> list[bytes]:
        return re.findall(rb"/MediaBox \[([^]]*)\]", pdf)

    torque = draw("torque")
    polar = draw("polar")
    both = draw("torque,polar")
    assert sizes(torque) != sizes(polar)
    assert sizes(both) == sizes(torque) + sizes(polar)
    assert draw("torque,polar") == both


def test_nothing_is_written_unless_all_of_it_can_be(tmp_path):
    told = refusal("plot", ENGINES / "i4.toml", "--what", "polar,pin", "-o", tmp_path / "x.svg")
    assert "has no [gas]" in told
    assert list(tmp_path.iterdir()) == []


def test_standard_input_is_read_once(tmp_path):
    text = DIESEL.read_text(encoding="utf-8")
    assert run_here("plot", "-", "--what", "polar,spectrum", "-o", tmp_path / "x.svg", stdin=text) == (0, "", "")
    told = refusal("plot", "-", "--what", "polar,modes", "-o", tmp_path / "x.svg", stdin=text)
    assert told == "standard input (-) is named twice, and can be read only once"


def test_no_page_goes_onto_the_engine_file(tmp_path):
    path = write(tmp_path / "x-pin.svg", FOUR.read_text(encoding="utf-8"))
    told = refusal("plot", path, "--what", "torque,pin", "-o", tmp_path / "x.svg")
    assert told == (f"--what pin {path}: this file is read and must not change; choose another name")


def test_names_of_pages():
    assert parse_pages(" pin, Torque,pin,") == ("pin", "torque")
    assert "torque,pin" in complete_pages("torque,p")
    there = ", ".join(PAGES)
    told = refusal("plot", FOUR, "--what", "torque,torqe", "-o", "x.svg")
    assert told == f'--what "torqe": choose from {there}; did you mean torque?'
    assert refusal("plot", FOUR, "--what", ",", "-o", "x.svg") == f'--what "": choose from {there}'


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--speeds", "1000:2000"], "--speeds has an effect only on pages of torsion"),
        (["--what", "modes", "--speed", "1500"], "--speed has no effect on pages of torsion"),
        (["--what", "modes", "--speeds", "1000:2000"], None),
        (["--what", "modes,polar", "--speeds", "1000:2000", "--speed", "1500"], None),
    ],
)
def test_a_speed_that_no_page_heeds_is_told(tmp_path, monkeypatch, options, told):
    monkeypatch.setattr("balcli.report.plot.make_figures_of_torsion", lambda *_: [None])
    monkeypatch.setattr("balcli.report.plot._make_pages", lambda *_: [None])
    monkeypatch.setattr("balcli.report.plot.write_pages", lambda *_: None)
    status, _, err = run_here("plot", DIESEL, *options, "-o", tmp_path / "x.pdf")
    assert status == 0
    assert err.startswith(f"warning: {told}") if told else err == ""
