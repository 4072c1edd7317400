# ruff: noqa: E501, SIM115
"""A golden corpus: what some 700 runs of the command line and Python calls print and write.

    python tools/golden.py record FILE          run everything, and record it
    python tools/golden.py compare FILE         run everything, and list what differs from the record
    python tools/golden.py compare FILE --only PATTERN    the cases whose names match

JSON and CSV agree by keys, their order, and figures to 1e-11 of the largest in their group; SVG and
PNG by being there; other texts to the letter. `--texts` shows the lines that differ.
"""

from __future__ import annotations

import argparse
import csv
import difflib
import io
import json
import math
import os
import re
import shutil
import sys
import tempfile
import time
import traceback
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "src"), str(ROOT / "tools")]
ENGINES = sorted(p.relative_to(ROOT).as_posix() for p in (ROOT / "engines").rglob("*.toml"))
GAS = [e for e in ENGINES if "[gas]" in (ROOT / e).read_text()]
TORSION = [e for e in ENGINES if "[torsion" in (ROOT / e).read_text()]
TOLERANCE = 1e-11

BAD = {  # each is i4.toml with one text replaced
    "unit": ("stroke     = 86", 'stroke = "86 lightyears"'),
    "unquoted": ("stroke     = 86", "stroke = 86 mm"),
    "comma": ("stroke     = 86", "stroke = 86,5"),
    "negative": ("stroke     = 86", "stroke = -86"),
    "key": ("stroke ", "strok "),
    "table": ("[piston]", "[pistons]"),
    "twice": ("[rod]", "[crank]\nstroke = 3\n[rod]"),
    "ratio": ("[rod]", "[rod]\nratio = 0.3"),
    "order": ("[1, 3, 4, 2]", "[1, 2, 4, 3, 3]"),
    "disagree": ("[1, 3, 4, 2]", "[1, 4, 3, 2]"),
    "list": ("[0, 180, 180, 0]", "0 180 180 0"),
    "text": ("[rod]", "[rod]\nmass = 'heavy'"),
    "short": ("stroke     = 86", "stroke = 400"),
    "inch": ("stroke     = 86", "stroke = 3.4"),
    "empty": ("[crank]", "[crank"),
    "many": (
        "[rod]",
        "[rod]\nfoo = 1\nbar = 2\n[cylinder.9]\npiston_mass = 1\n[[shaft]]\nangle = 3\n[x]",
    ),
}

COMMANDS = """
--help
--version
analyze --help
balance --help
balance --schemes
engines
engines i4
engines --find v8
engines --find marine
engines i3 mine.toml
engines nosuch
new inline x.toml
new mounts x.toml
new torsion x.toml
new radial
new field
new nosuch
schema
schema --of analysis
schema --of field
schema --of torsion
tables
tables --errata
tables --errata -f json
tables --errata -f csv
tables nosuch
layouts
layouts -f json
layouts -f csv
check engines
nosuch
analize engines/i4.toml
analyze
analyze nosuch.toml
analyze engines
analyze engines/i4.toml --nosuch
analyze engines/i4.toml --orders x
analyze engines/i4.toml --speed 0
analyze engines/i4.toml --speed 3000
analyze engines/i4.toml --only nosuch
analyze engines/i4.toml --orders 0.5-4
analyze engines/i4.toml engines/i3.toml -f json
analyze engines/i4.toml -o x.json
analyze engines/i4.toml -o x.csv
analyze engines/i4.toml -o x.md
analyze engines/i4.toml -o x.txt
analyze engines/i4.toml -o x.nosuch
analyze engines/i4.toml -o nosuch/x.json
analyze engines/i4.toml --units imperial
analyze engines/i4.toml --units imperial -f csv
analyze engines/i4.toml --digits 9
analyze engines/i4.toml --by cylinder -f json
analyze engines/i4.toml --by cylinder -f csv
analyze engines/v6_60.toml --why
analyze engines/i3.toml --why
analyze engines/i4.toml -v
analyze engines/i4.toml -q
analyze engines/i4.toml --format marine
analyze engines/i4.toml --only inner -f json
analyze engines/i4.toml --only inner,guide -f csv
analyze engines/vtwin45.toml --only xy
analyze engines/boxer2.toml --all
balance engines/i4.toml --scheme two-shaft --at=-60,80
balance engines/i4.toml --scheme two-shaft --at=-60,80 -f json
balance engines/i4.toml --scheme two-shaft --at=-60,80 --write x.toml
balance engines/i4.toml --scheme two-shaft --roll zero --at=-60,80 -f json
balance engines/i3.toml --scheme single-shaft -f json
balance engines/i3.toml --scheme couple-shaft -f json
balance engines/i3.toml --scheme counterweights --planes ends -f json
balance engines/i3.toml --scheme counterweights --planes=-100,120 -f json
balance engines/single.toml --scheme four-shaft -f json
balance engines/single.toml --scheme eccentric-slider -f json
balance engines/single.toml --scheme eccentric-slider
balance engines/single.toml --scheme oldham -f json
balance engines/single.toml --scheme minimax -f json
balance engines/single.toml --scheme minimax -f csv
balance engines/single.toml --scheme slider --order 2 -f json
balance engines/single.toml --factor 50% -f json
balance engines/single.toml --factor 50%:60%:2%
balance engines/single.toml --factor 50%:60%:2% -f csv
balance engines/vtwin45.toml --factor 55% --format card
balance engines/v8_crossplane.toml --factor 51% --planes ends --drill 19 --max-depth 32
balance engines/v8_crossplane.toml --factor 51% --planes ends --drill 19 --max-depth 32 -f json
balance engines/v8_crossplane.toml --factor 51% --planes ends --drill 19 --slug tungsten -f json
balance engines/v8_crossplane.toml --factor 51% --planes ends --grade G16 --mass 25
balance engines/twin360.toml --measured "812 g" -f json
balance engines/radial7_articulated.toml --scheme knuckles
balance engines/radial7_articulated.toml --scheme knuckles --write x.toml
balance engines/i4.toml --scheme nosuch
balance engines/i4.toml --scheme oldham
balance engines/i4.toml --factor 300%
compare engines/v6_60.toml engines/v6_90_split.toml
compare engines/v6_60.toml engines/v6_90_split.toml -f json
compare engines/v6_60.toml engines/v6_90_split.toml -f csv
compare engines/v6_60.toml engines/v6_90_split.toml -f markdown
sum engines/i4.toml engines/i4.toml -f json
sum engines/i3.toml engines/i3.toml --phase 180
curves engines/i4.toml --step 10
curves engines/i4.toml --step 10 -f json
curves engines/i4.toml --cylinder 2 --step 15
curves engines/i4_wiebe.toml --step 30
curves engines/vr6.toml --cylinder 1 --step 30 -f json
numbers engines/i4_wiebe.toml
numbers engines/i4_mounts.toml -f json
numbers engines/i6_diesel.toml -f csv
sweep engines/i4.toml --vary rod.ratio=0.24:0.32:0.02 -f csv
sweep engines/i4.toml --vary rod.ratio=0.24:0.32:0.02 -f json
sweep engines/i4.toml --vary rod.ratio=0.24:0.32:0.02 -f table
sweep engines/v6_60.toml --vary layout.bank_angle=0:180:30 --vary rod.ratio=0.25,0.3 -q force.2.x,moment.1.backward,peak.force -f csv
sweep engines/v8_wiebe.toml --vary operation.speed=2000:6000:2000 -q torque.mean,torque.max,gas.4.amplitude,fluctuation -f csv
sweep engines/i4_mounts.toml --vary operation.speed=800,3000 -q mode.1.Hz,mount.left.force -f csv
sweep engines/i6_diesel.toml --vary torsion.throw_stiffness.1=1e6,2e6 -q torsion.1.Hz -f csv
sweep engines/vtwin45.toml --vary piston.offset=0:4:1 -q force.1.major,roll.1.amplitude,couple.1.amplitude -f json
sweep engines/i4.toml --vary rod.ratio=0.24:0.32:0.02 -o x.csv
sweep engines/i4.toml --vary rod.ratio=0.24:0.32:0.02 --plot x.svg
sweep engines/i4.toml --vary nosuch=1:2:1
sweep engines/i4.toml --vary rod.ratio=1:2
sweep engines/i4.toml --vary rod.ratio=0.2:0.3:0.1 -q nosuch
search engines/i5.toml --over throws --minimise moment.1.major -f json
search engines/i6.toml --over firing_order --minimise moment.1.major -f json
search engines/v6_60.toml --over bank_angle --minimise force.2.major=1,moment.2.major=0.5 -f json
search engines/v6_90_split.toml --over splay --minimise moment.1.major -f csv
search engines/i4.toml --over rod.ratio=0.2:0.3 --minimise force.2.major -f json
search engines/i5.toml --over throws --minimise moment.2.major
search engines/i5.toml --over throws --minimise moment.1.major --require even-firing -f json
search engines/v8_crossplane.toml --over throws --minimise moment.1.major --top 3 --write x.toml
search engines/i5.toml --over throws --minimise moment.1.major --limit 'moment.2.major<1000' -f json
search engines/i5.toml --over throws --minimise nosuch
scatter engines/i4.toml --samples 2000 --seed 1 -f json
scatter engines/i4.toml --samples 2000 --seed 1
scatter engines/i3.toml --samples 500 --seed 2 --length-scatter 0.2% --angle-scatter "0.1 deg" -f csv
scatter engines/i4_mounts.toml --samples 50 --seed 1 -q mode.1.Hz -f json
scatter engines/i6_diesel.toml --samples 50 --seed 1 -q torsion.1.Hz -f json
mounts engines/i4_mounts.toml
mounts engines/i4_mounts.toml -f json
mounts engines/i4_mounts.toml -f csv
mounts engines/i4_mounts.toml --speeds 700:6000:500 -f json
mounts engines/i4_mounts.toml --speeds 700,3000 --scheme two-shaft -f json
mounts engines/i4_mounts.toml --plot x.svg
mounts engines/i4.toml
torsion engines/i6_diesel.toml
torsion engines/i6_diesel.toml -f json
torsion engines/i6_diesel.toml -f csv
torsion engines/i6_diesel.toml --speeds 600:2400:100 -f json
torsion engines/i6_diesel.toml --speeds 600:2400:100 -f csv
torsion engines/i6_diesel.toml --speeds 600:2400:50
torsion engines/i6_diesel.toml --holzer 1 --holzer "12 Hz"
torsion engines/i6_diesel.toml --holzer 1 -f json
torsion engines/i6_diesel.toml --damper viscous --speeds 600:2400:100 -f json
torsion engines/i6_diesel.toml --damper rubber --speeds 600:2400:100 --write x.toml
torsion engines/i6_diesel.toml --damper pendulum --speeds 600:2400:100
torsion engines/i6_diesel.toml --misfire 2 --speeds 1000,2000 -f json
torsion engines/i6_diesel.toml --speeds 600:2400:100 --plot x.svg
torsion engines/marine/marine6.toml -f json
locomotive engines/historic/locomotive2.toml
locomotive engines/historic/locomotive4.toml -f json
locomotive engines/historic/locomotive4.toml --factor 0:1:0.25 --units imperial
torque engines/v8_wiebe.toml
torque engines/v8_wiebe.toml -f json
torque engines/v8_wiebe.toml --fluctuation 1/200 -f json
torque engines/v8_wiebe.toml --fluctuation 1/200
torque engines/v8_wiebe.toml --loads pin,main -f json
torque engines/v8_wiebe.toml --loads pin,main
torque engines/v8_wiebe.toml --misfire 3 -f csv
torque engines/i4_wiebe.toml --write x.toml
torque engines/i4_wiebe.toml --units imperial
torque engines/i4.toml
plot engines/i4.toml -o x.svg
plot engines/i4.toml -o x.png
plot engines/i3.toml -o x.svg --what orders
plot engines/v6_60.toml -o x.svg --what bank
plot engines/single.toml -o x.svg --what factor
plot engines/i4_wiebe.toml -o x.svg --what all
plot engines/i4_wiebe.toml -o x.svg --what pin,main
plot engines/i4.toml -o x.svg --what nosuch
report engines/i3.toml -o x.html
report engines/i4_wiebe.toml -o x.html
""".strip().splitlines()
COMMANDS += [
    f"tables {name} {form}".strip()
    for name in [
        "tsinghua-1-1",
        "tsinghua-1-2",
        "tsinghua-1-3",
        "tsinghua-1-4",
        "tsinghua-1-5",
        "tsinghua-1-6",
        "liu-1",
        "liu-2",
        "liu-3",
        "wang-1",
        "kvasnikov-1",
        "kvasnikov-2",
        "liang-examples",
        "series",
    ]
    for form in ("", "-f json", "-f csv")
]
COMMANDS += [
    f"analyze {e} {form}".strip() for e in ENGINES for form in ("", "-f json", "-f csv --all")
]
COMMANDS += [f"balance {e} -f json" for e in ENGINES]
COMMANDS += [f"torque {e} -f json" for e in GAS]
COMMANDS += [f"analyze bad/{name}.toml" for name in BAD]

PYTHON = """
print(json.dumps(balcli.analyze(balcli.load_example("{e}")).to_dict()))
for row in balcli.analyze(balcli.load_example("{e}")).rows(): print(json.dumps(list(row.values()) if isinstance(row, dict) else [str(c) for c in row]))
print(balcli.analyze(balcli.load_example("{e}"))._repr_html_())
print(balcli.analyze(balcli.load_example("{e}")))
print(json.dumps(pickle.loads(pickle.dumps(balcli.analyze(balcli.load_example("{e}")))).to_dict()))
print(json.dumps(balcli.balance(balcli.load_example("{e}")).to_dict()))
print(json.dumps(balcli.compare(balcli.load_example("{e}"), balcli.load_example("i4")).to_dict()))
""".strip().splitlines()
PYTHON = [
    line.format(e=e) for e in ("v8_crossplane", "i3", "radial7_articulated") for line in PYTHON
]
PYTHON += """
print(json.dumps(balcli.torque(balcli.load_example("v8_wiebe")).to_dict()))
print(json.dumps(balcli.torsion(balcli.load_example("i6_diesel")).to_dict()))
print(json.dumps(pickle.loads(pickle.dumps(balcli.torsion(balcli.load_example("i6_diesel"), [1000, 2000]))).to_dict()))
print(json.dumps(balcli.mounts(balcli.load_example("i4_mounts")).to_dict()))
print(balcli.mounts(balcli.load_example("i4_mounts")).to_pandas().to_csv())
print(balcli.analyze(balcli.load_example("i4")).to_pandas().to_csv())
print(json.dumps(balcli.tables("tsinghua-1-2").to_dict()))
print(json.dumps(balcli.search(balcli.load_example("i5"), over="throws", minimise="moment.1.major").to_dict()))
print(json.dumps(balcli.scatter(balcli.load_example("i4"), samples=1000, seed=3).to_dict()))
print(balcli.sweep(balcli.load_example("i4"), {"rod.ratio": [0.25, 0.3]}, ["force.2.major"]).to_pandas().to_csv())
print(json.dumps(balcli.curves(balcli.load_example("i4"), 10).to_dict()))
balcli.analyze(balcli.load_example("i4"), [1, -3])
balcli.load("nosuch.toml")
balcli.balance(balcli.load_example("i4"), "nosuch")
balcli.mounts(balcli.load_example("i4"))
""".strip().splitlines()


def document_cases() -> Iterator[tuple[str, str]]:
    """Commands that documents show, with the name of their document."""
    from docs_examples import DOCUMENTS, shown

    for document in DOCUMENTS:
        for number, one in enumerate(shown(document.read_text(encoding="utf-8"))):
            if one.command.startswith("balcli ") and not set("|&;<>$*?") & set(one.command):
                yield f"{document.stem}#{number}", one.command.removeprefix("balcli ")


def run(case: str, code: str | None) -> dict[str, object]:
    """Run a command (or Python) in a process forked from this one, within a folder of its own."""
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary) / "here"
        shutil.copytree(ROOT / "engines", folder / "engines")
        (folder / "bad").mkdir()
        text = (ROOT / "engines/i4.toml").read_text()
        for name, (old, new) in BAD.items():
            (folder / "bad" / f"{name}.toml").write_text(text.replace(old, new))
        from docs_examples import DOCUMENTS, files

        for document in DOCUMENTS:
            for name, content in files(document.read_text(encoding="utf-8")).items():
                (folder / name).write_text(content, encoding="utf-8")
        before = {p for p in folder.rglob("*") if p.is_file()}
        out = Path(temporary) / "out"
        err = Path(temporary) / "err"
        child = os.fork()
        if not child:
            _child(case, code, folder, out, err)
        started = time.monotonic()
        while True:
            done, status = os.waitpid(child, os.WNOHANG)
            if done:
                break
            if time.monotonic() - started > 240:
                os.kill(child, 9)
            time.sleep(0.005)
        written = {
            p.relative_to(folder).as_posix(): ""
            if p.suffix in (".png", ".svg", ".pdf")
            else p.read_text()
            for p in sorted(folder.rglob("*"))
            if p.is_file() and p not in before and p.suffix != ".parquet"
        }
        clean = {"out": out.read_text(), "err": err.read_text()}
        for key, value in clean.items():
            clean[key] = value.replace(str(folder), "HERE")
        return {"status": os.waitstatus_to_exitcode(status), **clean, "files": written}


def _child(case: str, code: str | None, folder: Path, out: Path, err: Path) -> None:
    import shlex

    os.chdir(folder)
    for number, path in ((1, out), (2, err)):
        file = os.open(path, os.O_WRONLY | os.O_CREAT)
        os.dup2(file, number)
    sys.stdout = open(1, "w", encoding="utf-8", closefd=False)
    sys.stderr = open(2, "w", encoding="utf-8", closefd=False)
    status = 0
    try:
        if code is None:
            from balcli.cli import main

            sys.argv = ["balcli", *shlex.split(case)]
            main()
        else:
            import pickle

            import balcli

            exec(code, {"balcli": balcli, "json": json, "pickle": pickle})
    except SystemExit as end:
        status = int(end.code or 0)
    except BaseException as error:
        sys.stderr.write("".join(traceback.format_exception_only(error)))
        status = 99
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


def record(pattern: str) -> dict[str, dict[str, object]]:
    os.environ |= {"COLUMNS": "80", "NO_COLOR": "1", "BALCLI_CONFIG": ""}
    for module in (
        "balcli.cli",
        "numpy",
        "matplotlib.pyplot",
        "pandas",
        "jinja2",
        "dask",
        "rich.table",
    ):
        import_module(module)
    for path in (ROOT / "src/balcli").rglob("*.py"):
        name = ".".join(path.relative_to(ROOT / "src").with_suffix("").parts)
        if not name.endswith(("__main__", "__init__")):
            import_module(name)
    cases = {c: (c, None) for c in COMMANDS}
    cases |= {f"python {c}": (c, c) for c in PYTHON}
    cases |= {f"{name}: {command}": (command, None) for name, command in document_cases()}
    cases = {name: case for name, case in cases.items() if re.search(pattern, name)}
    with ThreadPoolExecutor(2) as pool:
        return dict(zip(cases, pool.map(lambda c: run(*c), cases.values()), strict=True))


def numbers_differ(old: object, new: object) -> str | None:
    """The first difference of two JSON values, but for figures that agree."""
    largest: dict[str, float] = {}

    def walk(value: object, path: str) -> Iterator[tuple[str, str, object]]:
        if isinstance(value, dict):
            yield path, path, list(value)
            for key, part in value.items():
                yield from walk(part, f"{path}.{key}")
        elif isinstance(value, list):
            for part in value:
                yield from walk(part, path)
            yield path, path, len(value)
        else:
            if isinstance(value, float):
                largest[path] = max(largest.get(path, 0), abs(value))
            yield path, path, value

    olds = list(walk(old, ""))
    news = list(walk(new, ""))
    for (path, _, a), (other, _, b) in zip(olds, news, strict=False):
        if path != other:
            return f"{path} became {other}"
        if a == b or _close(a, b, largest.get(path, 0.0), path):
            continue
        return f"{path}: {str(a)[:300]} -> {str(b)[:300]}"
    return None if len(olds) == len(news) else "another length"


def _close(a: object, b: object, largest: float, path: str = "") -> bool:
    if not isinstance(a, int | float) or not isinstance(b, int | float) or isinstance(a, bool):
        return False
    if "deg" in path and math.isclose(abs(a - b) % 180, 180, abs_tol=1e-9):
        return True
    return abs(a - b) <= TOLERANCE * max(largest, abs(a))


def csv_differs(old: str, new: str) -> str | None:
    largest: dict[object, float] = {}

    def cells(text: str) -> list[list[tuple[object, object]]]:
        rows = []
        for row in csv.reader(io.StringIO(text)):
            line = []
            for k, cell in enumerate(row):
                try:
                    number: object = float(cell)
                except ValueError:
                    number = cell
                else:
                    largest[k, row[-1]] = max(largest.get((k, row[-1]), 0), abs(number))
                line.append(((k, row[-1]), number))
            rows.append(line)
        return rows

    one = cells(old)
    other = cells(new)
    if len(one) != len(other):
        return f"{len(one)} rows became {len(other)}"
    for a, b in zip(one, other, strict=True):
        if len(a) != len(b) or any(
            x != y and not _close(x, y, largest.get(key, 0.0), str(a))
            for (key, x), (_, y) in zip(a, b, strict=True)
        ):
            return f"{[c for _, c in a]} -> {[c for _, c in b]}"
    return None


def differs(name: str, old: str, new: str) -> tuple[str, str] | None:
    """Kind ("data" or "text") and description of a difference."""
    if old == new:
        return None
    try:
        pairs = list(zip(old.strip().splitlines(), new.strip().splitlines(), strict=True))
        if pairs and old[:1] in "[{":
            parts = (
                [(json.loads(a), json.loads(b)) for a, b in pairs]
                if old[1:2] != "\n"
                else [(json.loads(old), json.loads(new))]
            )
            for a, b in parts:
                if found := numbers_differ(a, b):
                    return "data", found
            return None
    except ValueError:
        pass
    if name.endswith(".csv") or "csv" in name or re.match(r"[\w, ]+,[\w, ]+\n", old):
        found = csv_differs(old, new)
        return ("data", found) if found else None
    lines = [
        d
        for d in difflib.unified_diff(old.splitlines(), new.splitlines(), n=0, lineterm="")
        if d[:3] not in ("---", "+++")
    ]
    return "text", "\n      ".join(lines[1:40])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("action", choices=["record", "compare"])
    parser.add_argument("file", type=Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--texts", action="store_true")
    given = parser.parse_args()
    found = record(given.only)
    if given.action == "record":
        given.file.write_text(json.dumps(found))
        print(f"{len(found)} runs, {sum(c['status'] == 99 for c in found.values())} faults")
        return
    recorded = json.loads(given.file.read_text())
    counts = {"same": 0, "status": 0, "data": 0, "text": 0, "gone": 0}
    for name, case in found.items():
        old = recorded.get(name)
        if old is None:
            counts["gone"] += 1
            continue
        kinds = set()
        if old["status"] != case["status"]:
            print(f"STATUS {name}: {old['status']} -> {case['status']}\n      {case['err'][:500]}")
            kinds.add("status")
        pairs = [(name, old["out"], case["out"]), (f"{name} (stderr)", old["err"], case["err"])]
        pairs += [
            (f"{name} ({f})", t, case["files"].get(f, "gone")) for f, t in old["files"].items()
        ]
        for label, a, b in pairs:
            if difference := differs(label, a, b):
                kinds.add(difference[0])
                if difference[0] == "data" or given.texts:
                    print(f"{difference[0].upper()} {label}\n      {difference[1]}")
        for kind in kinds or {"same"}:
            counts[kind] += 1
    print(len(found), "runs:", ", ".join(f"{n} {kind}" for kind, n in counts.items()))


if __name__ == "__main__":
    main()
