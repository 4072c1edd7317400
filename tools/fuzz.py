"""Hostile input: engine files and options that nobody would write, through the entry of the command
line.

Every case must end as a result or as a message: no traceback, no hang, no half-written file, no
control character on the terminal, and a message that names the file or the option. `python
tools/fuzz.py --cases 20000 --seed 1` runs many.
"""

from __future__ import annotations

import argparse
import cProfile
import gc
import io
import json
import os
import random
import re
import shutil
import signal
import sys
import tempfile
import tomllib
import traceback
import tracemalloc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import tomli_w

from balcli.sizing.schemes import NAMES

ROOT = Path(__file__).parents[1]
MOST_CALLS = 15_000_000  # of functions, Python's and C's, for one case
CALLS_A_MB = 1_000_000  # further ones for each MB of results that a case asks for
MOST_MEMORY = 250  # MB that a case may ask for at a time
ALARM = 300.0  # seconds after which a case is taken for hung, however busy the machine
Tree = Any  # what TOML can hold
_CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")


class Hung(BaseException):
    """A case took longer than ALARM."""


# ------------------------------------------------------------------ values
UNITS = (
    "mm",
    "kg",
    "deg",
    "rpm",
    "in",
    "oz in",
    "lb in^2",
    "s",
    "turn",
    "rad/s",
    "furlong",
    "K",
    "degC",
    "dB",
    "A",
    "N m",
    "mm**9",
    "m^-9",
    "zorks",
    "__import__",
    "%",
    "m/m",
    "km/h",
    "·",
    "° ",
    "µm",
    "kg*mm^2",
    "mol",
    "hectare",
    "light_year",
    "parsec^9",
    "yg",
    "Δ",
    "count",
    "pi",
)
HOSTILE = (
    "",
    " ",
    "nan",
    "inf",
    "-inf",
    "true",
    "1e999 mm",
    "1e-999 mm",
    "9**9**9 mm",
    "90 mm**999999999",
    "(1+1) mm",
    "__import__('os').abort() mm",
    "{0.__class__}",
    "%s%n",
    "1/0 turn",
    "0/0 deg",
    "1_000 mm",
    "٣ mm",
    "９０ mm",
    "1e9999 kg",
    "0x10 mm",
    "1" * 400 + " mm",
    "mm",
    "1 mm mm mm mm",
    "\x1b[31mred\x1b[0m",
    "\x1b]0;title\x07",
    "\x9b31m",
    "a\r\nb",
    "\x00",
    "\x7f",
    "[bold]x[/]",
    "[/red]",
    "[link=x]",
    "$x_{",
    "$\\frac{1}{",
    "<script>alert(1)</script>",
    "</script><!--",
    "|a|b|",
    "=1+1",
    "../../x",
    "é" * 40,
    "\u202egnirts",
    "\ufeff",
    "𝔘𝔫𝔦",
    "👩‍🔧",
    "a\tb",
    "x" * 5000,
    "`code`",
    "{{ name }}",
    "{% raw %}",
    "\\",
    '"',
    "'",
    "&amp;",
    "shared",
    "alternating",
    "small_end",
)
NUMBERS = (
    0,
    -0.0,
    1,
    -1,
    2,
    3,
    4,
    8,
    90,
    1e-300,
    5e-324,
    1e-12,
    1e-9,
    1e-6,
    0.5,
    0.999999,
    1.0000001,
    1e6,
    1e9,
    1e12,
    1e24,
    1e300,
    1.7e308,
    -1e300,
    float("nan"),
    float("inf"),
    float("-inf"),
    2**31,
    2**63,
    2**64,
    -(2**63),
    10**30,
    10**400,
    360,
    720,
    1000,
    10_000,
    10_001,
    100_000,
)


def scalar(random: random.Random) -> Tree:
    kind = random.randrange(9)
    if kind < 3:
        return random.choice(NUMBERS)
    if kind == 3:
        return random.uniform(-1, 1) * 10 ** random.uniform(-12, 12)
    if kind == 4:
        return random.randint(-20, 20)
    if kind == 5:
        return random.random() < 0.5
    if kind == 6:
        return random.choice(HOSTILE)
    if kind == 7:
        return (
            f"{random.choice(NUMBERS[:25])}{random.choice(('', ' ', '/7 '))}{random.choice(UNITS)}"
        )
    return "".join(
        chr(
            random.choice(
                (random.randrange(32, 127), random.randrange(0x20), random.randrange(0x80, 0x3000))
            )
        )
        for _ in range(random.randrange(12))
    )


def tree(random: random.Random, depth: int = 0) -> Tree:
    """A scalar mostly; else a list, a table, or something very long or deep."""
    kind = random.randrange(12)
    if depth > 3 or kind < 7:
        return scalar(random)
    if kind < 9:
        return [tree(random, depth + 1) for _ in range(random.randrange(6))]
    if kind == 9:
        return {random.choice(KEYS): tree(random, depth + 1) for _ in range(random.randrange(4))}
    if kind == 10:
        one = scalar(random)
        return [one] * random.choice(
            (2, 3, 16, 100, 513, 10_000, 20_001) if len(str(one)) < 100 else (2, 16)
        )
    nested: Tree = scalar(random)
    for _ in range(random.choice((5, 50, 90))):
        nested = [nested]
    return nested


# ------------------------------------------------------------------ files
def _bases() -> list[dict[str, Tree]]:
    names = (
        "i4",
        "single_shaft",
        "v8_crossplane",
        "vr6",
        "radial9",
        "w12",
        "car/tsinghua_ca72",
        "boxer2",
        "v6_90_split",
        "i4_shafts",
    )
    return [
        tomllib.loads((ROOT / "engines" / f"{name}.toml").read_text(encoding="utf-8"))
        for name in names
    ]


def _keys() -> tuple[str, ...]:
    from balcli.enginefile import messages as mistakes

    tables = (*mistakes.import_tables().values(), *mistakes.import_lists().values())
    fields = [(key, field) for table in tables for key, field in table.model_fields.items()]
    inner = filter(None, (mistakes.find_table(field.annotation) for _, field in fields))
    own = {key for key, _ in fields} | {key for table in inner for key in table.model_fields}
    return (
        *mistakes.KNOWN,
        *sorted(own),
        "1",
        "2",
        "9",
        "0",
        "x",
        "",
        "strok",
        "\x1b[2J",
        "a.b",
        "é",
        "[/]",
        "crank.stroke",
    )


KEYS = _keys()
BASES = _bases()


def _tables(data: Tree) -> list[Any]:
    """All tables and lists in a file, itself included."""
    parts = (
        list(data.values()) if isinstance(data, dict) else data if isinstance(data, list) else []
    )
    return ([data] if isinstance(data, (dict, list)) else []) + [
        inner for part in parts for inner in _tables(part)
    ]


def mutated(random: random.Random) -> dict[str, Tree]:
    """A valid engine with one to five things about it changed."""
    data = tomllib.loads(tomli_w.dumps(random.choice(BASES)))
    if random.random() < 0.3:
        data["name"] = random.choice(HOSTILE)
    for _ in range(random.choice((0, 1, 1, 1, 1, 2, 3, 5))):
        place = random.choice(_tables(data))
        known = random.random() < 0.8 and len(place)
        if known and random.random() < 0.5:  # the same figure, larger or smaller
            key = random.choice(range(len(place)) if isinstance(place, list) else list(place))
            if isinstance(place[key], (int, float)) and abs(place[key]) < 1e300:
                place[key] = place[key] * random.choice(
                    (-1, 0, 1e-9, 0.01, 0.5, 0.9, 1.1, 2, 10, 1e3, 1e9)
                )
        elif isinstance(place, list):
            row = random.randrange(len(place) + 1)
            place[row : row + (1 if known else 0)] = [tree(random)] * (random.random() < 0.9)
        elif known and random.random() < 0.2:
            place.pop(random.choice(list(place)))
        else:
            place[random.choice(list(place)) if known else random.choice(KEYS)] = tree(random)
    return data


def _devices(random: random.Random) -> str:
    """Tables of plausible devices, overrides and an articulation, at the end of a file."""
    lines = []
    for _ in range(random.randrange(1, 4)):
        table = random.choice(
            (
                "[[counterweight]]",
                "[[shaft]]",
                "[[slider]]",
                "[cylinder.1]",
                "[cylinder.2]",
                "[articulation]",
                "[frame]",
                "[bobweight]",
            )
        )
        lines += [
            table,
            *(
                f"{random.choice(KEYS[12:-10])} = "
                f"{random.choice((0, 1, -1, 2, 40, 100.5, '[0, 80]', '[0,0,0]', '1e9'))}"
                for _ in range(random.randrange(1, 6))
            ),
        ]
    return "\n".join(lines)


def engine_file(random: random.Random) -> bytes:
    """An engine file: mostly sound TOML with wrong content, sometimes broken text, sometimes
    bytes.
    """
    kind = random.randrange(20)
    if kind == 0:
        return random.randbytes(random.choice((0, 1, 10, 1000)))
    text = tomli_w.dumps(mutated(random) if kind > 2 else random.choice(BASES))
    if kind in (1, 2, 3):
        lines = text.splitlines()
        for _ in range(random.randrange(1, 4)):
            k, junk = (
                random.randrange(len(lines)),
                random.choice(
                    (
                        random.choice(lines),
                        "[crank]",
                        "x = [",
                        "a.b.c = 1",
                        "= 1",
                        '"""',
                        "[[shaft]]",
                        "\x1b[2J",
                        "}{",
                        "[",
                    )
                ),
            )
            lines[k : k + random.randrange(2)] = [junk]
        text = "\n".join(lines)
    elif kind == 4:
        text += "\n" + _devices(random)
    data = text.encode()
    if kind == 5:
        data = data[: random.randrange(len(data))]
    elif kind == 6:
        flipped = bytearray(data)
        for _ in range(random.randrange(1, 8)):
            flipped[random.randrange(len(flipped))] = random.randrange(256)
        data = bytes(flipped)
    return data


# ------------------------------------------------------------------ commands
TEXTS = (
    *HOSTILE[:40],
    "1",
    "0",
    "-1",
    "0.5",
    "1-8",
    "1,2,4",
    "0:1:0.1",
    "1:0:1",
    "0:1:1e-300",
    "1e400",
    "50%",
    "0.1 deg",
    "3000",
    "ends",
    "throws",
    "zero",
    "force",
    "force.1.major",
    "moment.2.x,couple.1.amplitude",
    "peak.force",
    "force.9999999999.major",
    "force.1",
    "-40,60",
    "0,0,0",
    "1,2",
    "nan,nan,nan",
    "auto",
    "crank.stroke=80,90",
    "rod.ratio=0.2:0.3:0.05",
    "crank.throws.1=0:360:90",
    "crank.stroke=-1",
    "rod.length=1:1000:1",
    "x=1",
    "=",
    "rod.ratio=0:1:1e-18",
    "crank.stroke=1e999",
    "layout.bank_angle=0:180:45",
    "counterweight.1.unbalance=0,1",
    "cylinder.1.piston_mass=1,2",
    "operation.speed=1000,2000",
    "cylinder.99.bank=1",
    "moment.1.major<10",
    "force.1.major=0.5",
    "force.1.major=nan",
    "even-firing",
)
SCHEMES = (*NAMES, "nonsense")
FORMATS = ("table", "json", "csv", "markdown")


def text(random: random.Random, *likely: str) -> str:
    """An option's value; no zero byte, which no system lets through."""
    return random.choice(likely if likely and random.random() < 0.7 else TEXTS).replace("\0", "?")


def _some(random: random.Random, **options: tuple[str, ...]) -> list[str]:
    """Some of the options; an empty tuple is a flag."""
    chosen = random.sample(sorted(options), min(len(options), random.choice((0, 0, 1, 1, 2, 3))))
    return [
        f"--{name.replace('_', '-')}"
        + (f"={text(random, *options[name])}" if options[name] else "")
        for name in chosen
    ]


def _analyze(random: random.Random) -> list[str]:
    return [
        "analyze",
        "FILE",
        f"--format={random.choice(FORMATS)}",
        *_some(
            random,
            speed=("3000", "1e8"),
            orders=("1-8", "1-512", "256"),
            only=("force", "inner", "guide", "peak", "sizing", "roll,torque"),
            by=("cylinder",),
            why=(),
            units=("imperial",),
            plot=(),
            output=("out.txt",),
        ),
    ]


def _balance(random: random.Random) -> list[str]:
    return [
        "balance",
        "FILE",
        f"--scheme={random.choice(SCHEMES)}",
        f"--format={random.choice((*FORMATS, 'card'))}",
        *_some(
            random,
            order=("1", "2", "4"),
            at=("-40,60", "0,0"),
            position=("0", "1e9"),
            planes=("ends", "throws", "-100,100"),
            factor=("0.5", "51%", "0:1:0.1"),
            measured=("812", "812 g", "0"),
            roll=("zero",),
            radius=("40", "0"),
            thickness=("10",),
            disc=("50",),
            drill=("10", "1 in", "1e-9"),
            max_depth=("10", "1e9"),
            slug=("tungsten", "18.5", "8"),
            grade=("G16", "6.3"),
            mass=("31", "31 kg"),
            even=("dead-centres", "strokes"),
            write=("new.toml",),
            speed=("1",),
            orders=("1-8",),
            output=("out.txt",),
        ),
    ]


def _sum(random: random.Random) -> list[str]:
    return [
        "sum",
        "FILE",
        random.choice(("FILE", "GOOD")),
        f"--format={random.choice(FORMATS)}",
        *_some(
            random,
            phase=("90", "1e300"),
            at=("0,300,0", "1e300,0,0"),
            turn=("180",),
            reverse=(),
            orders=("1-4",),
        ),
    ]


def _sweep(random: random.Random) -> list[str]:
    file = random.choice(("FILE", "GOOD"))
    return [
        "sweep",
        file,
        f"--vary={text(random, *TEXTS[-25:])}",
        *_some(
            random,
            vary=TEXTS[-25:],
            quantity=("force.1.major", "peak.force"),
            format=("json",),
            output=("out.csv",),
        ),
    ]


def _search(random: random.Random) -> list[str]:
    return [
        "search",
        "FILE",
        f"--over={text(random, 'throws', 'firing_order', 'bank_angle', 'splay')}",
        f"--minimise={text(random, 'moment.1.major', 'force.2.major')}",
        *_some(
            random,
            limit=("moment.2.major<100",),
            require=("even-firing",),
            top=("3",),
            write=("new.toml",),
        ),
    ]


def _scatter(random: random.Random) -> list[str]:
    return [
        "scatter",
        random.choice(("FILE", "FILE", "GOOD")),
        f"--samples={random.choice((1, 200))}",
        "--seed=1",
        *_some(
            random,
            mass_scatter=("1%", "0%"),
            length_scatter=("1%",),
            angle_scatter=("0.1 deg",),
            quantity=("force.1.major", "couple.2.amplitude"),
            distribution=("normal",),
        ),
    ]


def _curves(random: random.Random) -> list[str]:
    return [
        "curves",
        "FILE",
        "--step=10",
        *_some(
            random,
            step=("0", "nan", "1e-300", "400"),
            cylinder=("1", "2", "0", "99"),
            speed=("1",),
            format=("json",),
            output=("o.csv",),
        ),
    ]


COMMANDS: tuple[Callable[[random.Random], list[str]], ...] = (
    _analyze,
    _analyze,
    _analyze,
    _balance,
    _balance,
    _balance,
    _sum,
    _sweep,
    _search,
    _scatter,
    _curves,
    lambda r: ["check", r.choice(("FILE", "FILE", "."))],
    lambda r: ["compare", "FILE", "GOOD", *_some(r, format=FORMATS, orders=("1-4",))],
)


def recorded(random: random.Random) -> bytes:
    """A recorded result for `check`: sound, changed or broken."""
    data = json.loads((ROOT / "engines" / "expected" / "i4.json").read_text(encoding="utf-8"))
    for _ in range(random.randrange(4)):
        place = random.choice(_tables(data))
        key = (
            random.choice(range(len(place)) if isinstance(place, list) else list(place))
            if place
            else None
        )
        if key is not None:
            place[key] = tree(random)
    text = json.dumps(data)
    return random.choice(
        (text, text, text, text[: random.randrange(len(text))], "[" * 100_000, "9" * 5000)
    ).encode("utf-8", "replace")


def _drawn(random: random.Random) -> list[str]:
    """The slow ones: pages and pictures."""
    if random.random() < 0.5:
        return ["report", "FILE", "-o", "page.html", *_some(random, scheme=SCHEMES)]
    return [
        "plot",
        "FILE",
        "-o",
        f"page.{random.choice(('svg', 'png', 'x'))}",
        *_some(random, what=("polar", "orders", "factor", "bank", "inner"), scheme=SCHEMES),
    ]


# ------------------------------------------------------------------ running
@dataclass(frozen=True)
class Case:
    """An engine file and a command on it; FILE stands for its name, GOOD for that of a sound
    engine.
    """

    number: int
    data: bytes
    args: tuple[str, ...]
    recorded: bytes = b""


def cases(seed: int, count: int, only: str = "") -> Iterator[Case]:
    """Cases that depend on the seed and their number alone. `only`: "force" for the quick analysis,
    "drawn" for pictures.
    """
    for number in range(count):
        source = random.Random(f"{seed}/{number}")
        data = engine_file(source)
        args = (
            ["analyze", "FILE", "--only=force", "--format=json"]
            if only == "force"
            else (_drawn(source) if only == "drawn" else source.choice(COMMANDS)(source))
        )
        yield Case(
            number,
            data,
            tuple(args),
            recorded(source) if args[0] == "check" and source.random() < 0.7 else b"",
        )


@dataclass(frozen=True)
class Outcome:
    """What a case came to; `failure` is the traceback of what no user may see."""

    status: int
    out: str
    err: str
    failure: str
    left: tuple[str, ...]
    calls: int = 0
    memory: float = 0.0  # MB, of Python's objects and of arrays, at a time


@contextmanager
def folder() -> Iterator[Path]:
    """An empty working directory with a sound engine in it."""
    before, place = Path.cwd(), Path(tempfile.mkdtemp(prefix="fuzz"))
    os.chdir(place)
    try:
        yield place
    finally:
        os.chdir(before)
        shutil.rmtree(place, ignore_errors=True)


def _clear(place: Path) -> None:
    for path in place.iterdir():
        if path.is_dir():
            shutil.rmtree(path)
        else:
            path.unlink()


def prepared(case: Case, place: Path) -> list[str]:
    """The files of a case in an emptied folder, and its arguments."""
    _clear(place)
    (place / "case.toml").write_bytes(case.data)
    if case.recorded:
        (place / "expected").mkdir()
        (place / "expected" / "case.json").write_bytes(case.recorded)
    if "GOOD" in case.args:
        (place / "good.toml").write_text(tomli_w.dumps(BASES[0]))
    return [{"FILE": "case.toml", "GOOD": "good.toml"}.get(arg, arg) for arg in case.args]


def run(case: Case, place: Path) -> Outcome:
    """One case in this process, as the console script would run it."""
    from balcli.cli import main

    def hung(*_: object) -> None:
        raise Hung

    args = prepared(case, place)
    kept = sys.argv, sys.stdout, sys.stderr
    sys.argv = ["balcli", *args]
    sys.stdout, sys.stderr = (
        io.TextIOWrapper(io.BytesIO(), encoding="utf-8", errors="replace") for _ in "oe"
    )
    out, err, failure, status = sys.stdout, sys.stderr, "", -1
    signal.signal(signal.SIGALRM, hung)
    signal.setitimer(signal.ITIMER_REAL, ALARM)
    try:
        main()
    except SystemExit as done:
        status = int(done.code or 0)
    except BaseException:
        failure = traceback.format_exc()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        sys.argv, sys.stdout, sys.stderr = kept
        gc.unfreeze()  # main() takes the process for ended
    shown = [_all(stream) for stream in (out, err)]
    return Outcome(status, *shown, failure, tuple(sorted(path.name for path in place.iterdir())))


def counted(case: Case, place: Path) -> Outcome:
    """The same with its calls of functions: as many on any machine, however busy."""
    profile = cProfile.Profile()
    profile.enable()
    try:
        done = run(case, place)
    finally:
        profile.disable()
    return replace(done, calls=sum(entry.callcount for entry in profile.getstats()))


def weighed(case: Case, place: Path, way: Callable[[Case, Path], Outcome] = run) -> Outcome:
    """The same with the memory it asks for: as much on any machine, and on any number of
    threads.
    """
    tracemalloc.start()
    try:
        done = way(case, place)
        return replace(done, memory=tracemalloc.get_traced_memory()[1] / 1e6)
    finally:
        tracemalloc.stop()


def _all(stream: io.TextIOWrapper) -> str:
    stream.flush()
    return stream.buffer.getvalue().decode("utf-8", "replace")  # type: ignore[attr-defined]


def fault(case: Case, done: Outcome) -> str:
    """What is wrong with an outcome; empty if nothing is."""
    if done.failure:
        return done.failure
    if done.status not in (0, 2, *[1] * (case.args[0] == "check")):
        return f"status {done.status}: {done.err[-500:]}"
    if "Traceback" in done.err + done.out or "Warning:" in done.err:
        return done.err
    if done.calls > MOST_CALLS + CALLS_A_MB * len(done.out) / 1e6:
        return f"took {done.calls} calls"
    if done.memory > MOST_MEMORY:
        return f"took {done.memory:.0f} MB"
    if found := _CONTROL.search(done.out + done.err):
        return (
            f"control character {found[0]!r}: "
            f"{(done.out + done.err)[max(found.start() - 60, 0) : found.start() + 60]!r}"
        )
    if done.status == 2 and not re.search(r"(?m)^(balcli: .|Error: .)", done.err):
        return f"refused without a word: {done.err!r}"
    if len(done.err) > 100_000:
        return f"a message of {len(done.err)} characters"
    return _strays(case, done)


def _strays(case: Case, done: Outcome) -> str:
    """Files that nobody asked for, or that a refusal left."""
    there = {"case.toml", "expected", *(["good.toml"] if "GOOD" in case.args else [])}
    asked = {
        arg.partition("=")[2] for arg in case.args if arg.startswith(("--output=", "--write="))
    }
    asked |= {b for a, b in zip(case.args, case.args[1:], strict=False) if a == "-o"}
    new = set(done.left) - there
    if hidden := [name for name in new if name not in asked]:
        return f"left {hidden} behind"
    return (
        f"refused, yet wrote {new}: {done.err}"
        if new and done.status == 2 and not any("--write" in a for a in case.args)
        else ""
    )


def main() -> None:
    """Run many cases and report."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="begin with this case")
    parser.add_argument("--only", default="", choices=("", "force", "drawn"))
    asked = parser.parse_args()
    costliest, largest, faults, accepted = (0, -1), (0.0, -1), 0, 0
    with folder() as place:
        for case in cases(asked.seed, asked.cases, asked.only):
            if case.number < asked.first:
                continue
            done = weighed(case, place, counted)
            accepted += done.status == 0
            costliest, largest = (
                max(costliest, (done.calls, case.number)),
                max(largest, (done.memory, case.number)),
            )
            if wrong := fault(case, done):
                faults += 1
                print(f"{case.number}: {case.args}\n{wrong}\n", flush=True)
    print(
        f"{asked.cases - asked.first} cases, {accepted} accepted, {faults} faults; "
        f"most calls {costliest[0]} (case {costliest[1]}), most memory {largest[0]:.0f} MB (case "
        f"{largest[1]})"
    )


if __name__ == "__main__":
    main()
