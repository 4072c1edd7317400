"""Hostile input in numbers: 2000 cases in this process, some of them counted, 50 as processes of
their own, and the costliest files.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import fuzz
import pytest
from support.paths import SOURCE

from balcli.core.phasors import Phasors

pytestmark = pytest.mark.stress

SEED = 20


@pytest.fixture
def place() -> Iterator[Path]:
    with fuzz.folder() as folder:
        yield folder


@pytest.mark.parametrize(
    ("run", "only", "count", "accepted"),
    [(fuzz.run, "force", 1700, 200), (fuzz.run, "", 300, 30), (fuzz.counted, "", 60, 6)],
)
def test_nothing_brings_it_down(place, run, only, count, accepted):
    """Enough of the files are sound, so that what lies behind the reader is met as well."""
    done = [(case, run(case, place)) for case in fuzz.cases(SEED, count, only)]
    assert [(case.number, wrong) for case, outcome in done if (wrong := fuzz.fault(case, outcome))] == []
    assert sum(outcome.status == 0 for _, outcome in done) >= accepted


def process(args: list[str], place: Path) -> fuzz.Outcome:
    """A command as a process of its own."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        running = subprocess.Popen(
            [sys.executable, "-m", "balcli", *args],
            cwd=place,
            stdout=out,
            stderr=err,
            stdin=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": str(SOURCE), "OMP_NUM_THREADS": "1"},
        )
        running.wait(fuzz.ALARM)
        texts = []
        for stream in (out, err):
            stream.seek(0)
            texts.append(stream.read().decode("utf-8", "replace"))
    return fuzz.Outcome(running.returncode, *texts, "", tuple(sorted(path.name for path in place.iterdir())))


def test_as_processes(place):
    cases = islice((case for case in fuzz.cases(SEED + 1, 1000) if "." not in case.args), 50)
    done = [(case, process(fuzz.prepared(case, place), place)) for case in cases]
    assert len(done) == 50
    assert [(case.number, wrong) for case, outcome in done if (wrong := fuzz.fault(case, outcome))] == []


BODY = "[crank]\nstroke = 90\n{crank}\n[rod]\nlength = 160\nmass = 0.6\ncg = 50\n[piston]\nmass = 0.5\n{more}\n"


def body(crank: str = "", more: str = "") -> str:
    return BODY.format(crank=crank, more=more)


def listed(items: object) -> str:
    return f"[{','.join(map(str, items))}]"  # type: ignore[call-overload]


COSTLY = {
    "tables": ("".join(f"[{k:x}]\n" for k in range(179_000)), "179003 mistakes"),
    "dotted tables": ("".join(f"[{k:x}.a.a.a.a.a.a]\n" for k in range(25_700)), "25703 mistakes"),
    "deep tables": ("".join(f"[{k:x}{'.a' * 29}]\n" for k in range(5_900)), "5903 mistakes"),
    "6 MB of tables": ("[a]\n" * 1_500_000, "has more than 180000 keys, lists and values; no engine file needs that"),
    "lines": ("#\n" * 500_000, "crank: is missing"),
    "wrong lists": (
        body(
            f"throws = {listed(['true'] * 9_990)}\npositions = {listed(['true'] * 9_990)}",
            f"[layout]\nbanks = {listed(['true'] * 9_990)}\nfiring_order = {listed(['true'] * 9_990)}",
        ),
        " mistakes\n  crank.throws: the 1st value true is not a number",
    ),
    "cylinders": (
        body(f"throws = {listed([0] * 10_000)}", "[layout]\nradial = 10000"),
        "layout: 10000 banks on 10000 throws are too many; no engine has more than 1000 cylinders",
    ),
    "alternating": (
        body(f"throws = {listed([0] * 10_000)}", "[layout]\nradial = 10000\nrods = 'alternating'"),
        "layout: 10000 banks on 10000 throws",
    ),
    "ripple": (
        body(
            more="[operation]\nspeed_ripple = " + listed(f"{{order={k},amplitude=0.001}}" for k in [*range(1, 257), 1])
        ),
        "operation: speed_ripple has 257 orders; no more than 256 can be given",
    ),
    "most throws": (body(f"throws = {listed(k * 137.1 for k in range(1000))}"), ""),
    "most shafts": (body(more="[[shaft]]\nratio = 999\nunbalance = 1\n" * 1000), ""),
    "most ripple": (
        body(more="[operation]\nspeed_ripple = " + listed(f"{{order={k},amplitude=0.001}}" for k in range(1, 257))),
        "",
    ),
    "most articulated rods": (
        body(more="[layout]\nradial = 1000\n[articulation]\nknuckle_radius = 10\nrod = {length = 150}"),
        "",
    ),
}


@pytest.mark.parametrize("what", COSTLY)
def test_the_costliest_files(place, what):
    """What a file of a few bytes to 6 MB can ask for at worst, refused or not, stays below the
    limits of memory and of calls.
    """
    text, message = COSTLY[what]
    case = fuzz.Case(0, text.encode(), ("analyze", "FILE", "--format", "csv"))
    done = fuzz.weighed(case, place, fuzz.counted)
    assert fuzz.fault(case, done) == ""
    assert (done.status, message in done.err) == (2 if message else 0, True)


# ------------------------------------------------------------------ cases that once failed
@pytest.mark.parametrize("name", ["\x1b[31mred", "\x9b31m", "a\nb", "\x00", "\x7f", "a\tb"])
def test_a_name_that_commands_a_terminal_is_refused(place, name):
    escaped = "".join(f"\\u{ord(letter):04X}" for letter in name)
    done = fuzz.run(fuzz.Case(0, f'name = "{escaped}"\n{body()}'.encode(), ("analyze", "FILE")), place)
    control = next(letter for letter in name if not letter.isprintable())
    assert (done.status, done.out) == (2, "")
    assert (
        done.err == f"balcli: case.toml: name: has the control character U+{ord(control):04X}, which could "
        "command a terminal or disguise what it shows; leave it out\n"
    )


def test_a_name_that_would_fill_gigabytes_is_refused(place):
    """It stands in every line of a CSV: 5000 characters made 100 MB of the orders 1 to 512."""
    done = fuzz.run(fuzz.Case(0, f'name = "{"x" * 201}"\n{body()}'.encode(), ("analyze", "FILE")), place)
    assert (done.status, done.out) == (2, "")
    assert (
        done.err == "balcli: case.toml: name: has 201 characters; it stands in every line of a CSV, at "
        "most 200 are taken\n"
    )


def test_a_source_may_have_lines(place):
    data = f'source = """weighed,\n\tin May"""\n{body()}'.encode()
    assert fuzz.run(fuzz.Case(0, data, ("analyze", "FILE")), place).status == 0


@pytest.mark.parametrize(
    "args",
    [
        ("analyze", "FILE", "--orders=\x9b31m"),
        ("analyze", "FILE", "--by=\x1b[2J"),
        ("analyze", "\x1b]0;x\x07.toml"),
        ("check", "\x1b[31m.toml"),
    ],
)
def test_options_and_paths_are_told_without_control_characters(place, args):
    done = fuzz.run(fuzz.Case(0, body().encode(), args), place)
    assert (done.status, fuzz.fault(fuzz.Case(0, b"", args), done)) == (2, "")
    assert len(done.err) > 30


def test_file_names_among_results_have_no_control_characters(place):
    (place / "\x1b[31m.toml").write_text(body())
    for args in (("check", "."), ("compare", "\x1b[31m.toml", "\x1b[31m.toml")):
        case = fuzz.Case(0, body().encode(), args)
        fuzz.prepared(case, place)
        (place / "\x1b[31m.toml").write_text(body())
        done = process(list(args), place)
        assert "\x1b" not in done.out + done.err
        assert "?[31m" in done.out


@pytest.mark.parametrize(
    "record", [b"[" * 100_000, b"9" * 5000, b"{", b"[]", b"\xff", b'{"orders": [{"order": 1e300}]}']
)
def test_a_broken_record_is_a_difference(place, record):
    done = fuzz.run(fuzz.Case(0, body().encode(), ("check", "FILE"), record), place)
    assert (done.status, done.failure) == (1, "")
    assert "cannot be read" in done.out


def test_many_orders_along_the_crank_take_work_in_proportion(place, monkeypatch):
    """Each figure was once computed for all orders each time: here the orders are counted for which
    axes are computed.
    """
    axis, computed = Phasors.axis_deg.fget, []
    monkeypatch.setattr(
        Phasors, "axis_deg", property(lambda phasors: (computed.append(len(phasors.orders)), axis(phasors))[1])
    )
    work = []
    for orders in ("1-512", "1-2048"):
        computed.clear()
        case = fuzz.Case(
            0,
            body("throws = [0, 180, 180, 0]\nspacing = 90").encode(),
            ("analyze", "FILE", "--only=inner", "--format=json", f"--orders={orders}"),
        )
        assert fuzz.run(case, place).status == 0
        work.append(sum(computed))
    assert 0 < work[1] <= 4 * work[0]


MANY = body(f"throws = {listed(k * 137.1 % 360 for k in range(1000))}\nspacing = 100").encode()
DISTINCT = body(f"throws = {listed(range(0, 345, 15))}\nspacing = 100").encode()


@pytest.mark.parametrize(
    ("data", "over", "message"),
    [
        (DISTINCT, "throws", "crank.throws: 23 throws can be arranged in more than 1e+10 ways, too many to search"),
        (MANY, "throws", "crank.throws: 1000 throws can be arranged in more than 1e+10 ways, too many to search"),
        (MANY, "firing_order", "1000 cylinders are too many to look for firing orders; up to 64 are allowed"),
    ],
)
def test_a_search_that_cannot_end_is_refused(place, data, over, message):
    done = fuzz.counted(fuzz.Case(0, data, ("search", "FILE", f"--over={over}", "--minimise=moment.1.major")), place)
    assert (done.status, done.err) == (2, f"balcli: {message}\n")
    assert done.calls < fuzz.MOST_CALLS / 3


@pytest.mark.parametrize(
    "args",
    [
        ("curves", "--step=0.1"),
        ("curves", "--step=0.1", "--cylinder=3"),
        ("scatter", "--samples=2000"),
        ("sum", "GOOD"),
        ("balance", "--scheme=factor"),
        ("sweep", "--vary=crank.stroke=80:90:1"),
        ("report", "-o", "x.html"),
    ],
    ids=" ".join,
)
def test_most_cylinders_take_no_more_memory_than_allowed(place, args):
    case = fuzz.Case(0, MANY, (args[0], "FILE", *args[1:]))
    done = fuzz.weighed(case, place)
    assert (done.status, fuzz.fault(case, done)) == (0, "")
