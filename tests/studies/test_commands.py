"""sweep, search, scatter, compare and bench as commands."""

import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from support.commands import HANGS, ask, ask_json, refusal, run_here, start_command
from support.engines import GOOD
from support.paths import write


@pytest.fixture
def engine(tmp_path: Path) -> str:
    path = write(tmp_path / "four.toml", GOOD)
    return str(path)


def test_a_variant_that_cannot_be_is_told_before_anything_is_written(tmp_path: Path) -> None:
    """One between the corners of the grid, the ripple's angle; the first such is named."""
    file = write(
        tmp_path / "rip.toml",
        "[crank]\nstroke = 90\n[rod]\nlength = 160\n[piston]\nmass = "
        "0.5\n[operation]\nspeed_ripple = ["
        "{ order = 1, amplitude = 0.6 }, { order = 2, amplitude = 0.5 }]\n",
    )
    vary = ("--vary", "operation.speed_ripple.2.angle=0:360:30", "--quantity", "force.1.major")
    told = refusal("sweep", file, *vary)
    theta = np.radians(np.arange(0, 360, 0.1))
    first = next(
        angle
        for angle in range(0, 361, 30)
        if min(1 + 0.6 * np.cos(theta) + 0.5 * np.cos(2 * theta - np.radians(angle))) <= 0
    )
    assert told.startswith(
        f"{file}: operation.speed_ripple.2.angle = {first}: operation.speed_ripple: the crank would turn back: at crank "
    )


def test_a_corner_that_cannot_be_is_named(tmp_path: Path) -> None:
    """A V6 whose crank and split pins fire evenly at a bank angle of 60 deg alone."""
    file = write(
        tmp_path / "v6.toml",
        "[crank]\nstroke = 80\nspacing = 100\nsplay = -60\n[rod]\nlength = 150\n[piston]\n"
        "mass = 0.5\n[layout]\nbank_angle = 60\nfiring_order = [1, 2, 3, 4, 5, 6]\n"
        "numbering = [[1, 3, 5], [2, 4, 6]]\n",
    )
    vary = ("--vary", "layout.bank_angle=60:90:15", "--vary", "rod.ratio=0.2,0.3")
    told = refusal("sweep", file, *vary, "--quantity", "force.1.major")
    assert told.startswith(f"{file}: layout.bank_angle = 90, rod.ratio = 0.2: layout.firing_order: ")


def read_markdown(text: str) -> list[list[str]]:
    """Cells of a table, its heads first."""
    lines = [line for line in text.splitlines() if line.startswith("|")]
    cells = [[cell.strip().replace("\\", "") for cell in line.split("|")[1:-1]] for line in lines]
    return [cells[0], *cells[2:]]


def sweep_strokes(engine: str, values: str, *options: object) -> str:
    asked = ("--vary", f"crank.stroke={values}", "-q", "force.2.major,force.1.axis")
    return ask("sweep", engine, *asked, *options)


@pytest.mark.parametrize("count", [1, 50, 51, 2000])
def test_a_table_of_variants(engine: str, count: int) -> None:
    """Fifty are shown whole; of more the first fifty, as CSV has them."""
    values = f"40:{40 + 0.05 * (count - 1)}:0.05" if count > 1 else "40"
    csv = [line.split(",") for line in sweep_strokes(engine, values, "-f", "csv").splitlines()[1:]]
    assert len(csv) == count
    text = sweep_strokes(engine, values, "-f", "markdown")
    heads, *rows = read_markdown(text)
    assert heads[0] == "crank.stroke, mm"
    assert heads[1] in ("force.2.major, N", "force.2.major, kN")
    size = 1e3 if "kN" in heads[1] else 1
    if count > 50:
        assert f"{count} variants, {count - 50} of them not shown" in text
    for row, exact in zip(rows, csv[:50], strict=True):
        assert float(row[0]) == float(exact[0])
        assert float(row[1]) * size == pytest.approx(float(exact[1]), rel=1e-4)
        assert (row[2], exact[2]) == ("–", "")


def test_chunks_of_a_long_table_are_passed_over(engine: str, monkeypatch) -> None:
    """Its rows do not depend on where the chunks end."""
    whole = sweep_strokes(engine, "40:60:0.1", "-f", "table")
    monkeypatch.setattr("balcli.studies.sweep.CHUNK", 7)
    assert sweep_strokes(engine, "40:60:0.1", "-f", "table") == whole


def test_a_terminal_shows_a_table_and_a_pipe_csv(engine: str) -> None:
    asked = ("sweep", engine, "--vary", "crank.stroke=80,90")
    seen = run_here(*asked, terminal=True).out
    assert "in-line four: variants" in seen
    assert "crank.stroke,force" not in seen
    piped = run_here(*asked).out
    assert piped.startswith("crank.stroke,force.1.major,")
    assert run_here(*asked, "-f", "csv", terminal=True).out == piped


def test_doubts_are_of_what_does_not_vary(tmp_path: Path) -> None:
    file = write(tmp_path / "heavy.toml", GOOD.replace("mass = 0.5", "mass = 51"))
    for vary, doubted in (("rod.length=150,160", True), ("piston.mass=0.5,0.6", False)):
        assert ("piston.mass: 51 kg" in run_here("sweep", file, "--vary", vary, "-q", "force.2.major").err) is doubted


@pytest.mark.stress
@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_ctrl_c_leaves_the_older_file_and_what_others_wrote(engine: str, tmp_path: Path) -> None:
    target = write(tmp_path / "x.json", "old")
    other = write(tmp_path / "x.json.part", "mine")
    process = start_command(
        *("sweep", engine, "-q", "force.2.major", "-f", "json", "-o", target),
        *("--vary", "rod.ratio=0.2:0.3:0.00001", "--vary", "crank.stroke=80:90:0.001"),
        stderr=subprocess.PIPE,
        encoding="utf-8",
        preexec_fn=partial(signal.signal, signal.SIGINT, signal.SIG_DFL),  # jobs in the background ignore it
    )
    end = time.monotonic() + HANGS
    while not any(path.stat().st_size > 100_000 for path in tmp_path.glob(".x.json*")):
        assert process.poll() is None
        assert time.monotonic() < end
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    errors = process.communicate(timeout=HANGS)[1]
    assert (process.returncode, errors.startswith("balcli: stopped after ")) == (130, True)
    assert (target.read_text(), other.read_text(), len(list(tmp_path.iterdir()))) == ("old", "mine", 3)


def test_search_writes_the_best(engine: str, tmp_path: Path) -> None:
    target = tmp_path / "best.toml"
    found = ask_json("search", engine, "--over", "throws", "--minimise", "moment.1.major", "--write", target)
    best = found["results"][0]
    assert (found["format"], best["throws"], best["objective"]) == ("balcli.search/1", [0, 180, 180, 0], 0)
    ask("analyze", target)


def test_a_refused_search_names_the_file(engine: str) -> None:
    told = refusal("search", engine, "--over", "crank.stroke=400:500", "--minimise", "force.2.major")
    assert told.startswith(f"{engine}: rod.length: the crank cannot turn: ")


def test_normal_deviations_may_exceed_the_bound_and_the_note_says_so(tmp_path: Path) -> None:
    """One piston: 3 standard deviations are its tolerance, and 1 of 370 samples lies beyond."""
    file = write(tmp_path / "one.toml", "[crank]\nstroke = 90\n[rod]\nlength = 160\n[piston]\nmass = 1\n")
    command = ["scatter", str(file), "--mass-scatter=1%", "--seed=1", "-q", "force.1.major"]
    texts = {shape: run_here(*command, f"--distribution={shape}").out for shape in ("uniform", "normal")}
    told = "1 of 370 exceeds the tolerance"
    assert [told in " ".join(text.split()) for text in texts.values()] == [False, True]
    document = ask_json(*command, "--distribution=normal")
    figures = document["quantities"]["force.1.major"]
    assert document["distribution"] == "normal"
    assert figures["max"] > figures["bound"]
