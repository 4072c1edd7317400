"""Mutation testing: is every small change of the numerical code noticed by some test?

    python tools/mutants.py core sizing/effects.py core/peaks.py:36 --sample 40 --seconds 20

One node of a module's syntax tree is changed at a time: operators, comparisons, conditions,
constants, functions by their counterparts, results by None, statements left out. Tests run once,
with the lines that each of them reaches; then every mutant has a process of its own, forked when
all is imported, in which the changed functions are put in place and the tests that reach the line
run, those first that reach little else or have found others, until one fails or those left would
take longer than `--seconds`. Survivors are printed and end the run with exit code 1;
docs/mutation-testing.md says which are known, and why.
"""

from __future__ import annotations

import argparse
import ast
import copy
import functools
import importlib
import os
import pickle
import random
import re
import resource
import signal
import sys
import time
import traceback
import types
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import coverage
import pytest
from hypothesis import Phase, settings

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "balcli"
LEFT_OUT = (
    "bench",
    "commands",
    "test_cli",
    "test_docs",
    "test_examples",
    "test_fuzz",
    "test_hygiene",
    "test_plot",
    "test_regression",
    "test_report",
    "test_schema",
    "test_structure",
    "test_table",
    "test_terminal_plot",
    "test_units",
)  # processes, pictures, our own results
MEMORY = 4 << 30  # bytes of a mutant's process
PATIENCE = 5.0, 10.0  # seconds of a test before it is taken for hung, and times its usual duration


# ------------------------------------------------------------------ what is changed
OPERATORS: dict[type, tuple[type, ...]] = {
    ast.Add: (ast.Sub,),
    ast.Sub: (ast.Add,),
    ast.Mult: (ast.Div,),
    ast.Div: (ast.Mult,),
    ast.FloorDiv: (ast.Mult,),
    ast.Mod: (ast.Mult,),
    ast.Pow: (ast.Mult,),
    ast.MatMult: (ast.Mult,),
    ast.BitAnd: (ast.BitOr,),
    ast.BitOr: (ast.BitAnd,),
    ast.LShift: (ast.RShift,),
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.And: (ast.Or,),
    ast.Or: (ast.And,),
}
_PAIRS = (
    "min max",
    "minimum maximum",
    "argmin argmax",
    "sin cos",
    "any all",
    "real imag",
    "forward backward",
    "floor ceil",
    "x y",
    "low high",
    "zeros ones",
    "zeros_like ones_like",
    "arcsin arccos",
    "radius thickness",
    "eps lam",
    "throws_m z",
)
NAMES = {a: b for pair in _PAIRS for a, b in (pair.split(), pair.split()[::-1])}
PLAIN = (
    "abs",
    "conj",
    "conjugate",
    "round",
    "sorted",
    "sqrt",
    "rint",
    "degrees",
    "unique",
    "exp",
    "log",
    "sign",
    "clip",
)

Change = tuple[str, ast.AST | None]


def changes(node: ast.AST) -> Iterator[Change]:
    """What a node may be replaced by; None: left out."""
    for kind in (_of_operators, _of_constants, _of_names, _of_calls, _of_statements):
        yield from kind(node)


def _of_operators(node: ast.AST) -> Iterator[Change]:
    match node:
        case ast.BinOp() | ast.BoolOp() | ast.AugAssign():
            for other in OPERATORS[type(node.op)]:
                yield other.__name__, _with(node, op=other())
        case ast.Compare():
            for k, op in enumerate(node.ops):
                for other in OPERATORS[type(op)]:
                    yield (
                        other.__name__,
                        _with(node, ops=[*node.ops[:k], other(), *node.ops[k + 1 :]]),
                    )
        case ast.UnaryOp(op=ast.USub() | ast.Not()):
            yield "without sign or not", node.operand


def _of_constants(node: ast.AST) -> Iterator[Change]:
    match node:
        case ast.Constant(value=bool() as value):
            yield str(not value), ast.Constant(not value)
        case ast.Constant(value=int() | float() | complex() as value):
            other = (
                value * 1e4
                if 0 < abs(value) < 1e-3
                else 2 * value
                if isinstance(value, float) and value
                else value + 1
            )
            yield str(other), ast.Constant(other)
        case ast.Constant(value=str() as value):
            yield "other text", ast.Constant(value + "?")
        case ast.Slice():
            for field in ("lower", "upper", "step"):
                if getattr(node, field) is not None:
                    yield f"without {field}", _with(node, **{field: None})


def _of_names(node: ast.AST) -> Iterator[Change]:
    match node:
        case ast.Attribute(attr=name) if name in NAMES:
            yield NAMES[name], _with(node, attr=NAMES[name])
        case ast.Name(id=name, ctx=ast.Load()) if name in ("min", "max", "any", "all"):
            yield NAMES[name], _with(node, id=NAMES[name])


def _of_calls(node: ast.AST) -> Iterator[Change]:
    match node:
        case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name), args=[first, *_]) if (
            name in PLAIN
        ):
            yield f"without {name}", first
        case ast.Call(func=ast.Attribute(value=first, attr=name), args=[]) if name in PLAIN:
            yield f"without {name}", first
    if isinstance(node, ast.Call):
        for k, keyword in enumerate(node.keywords):
            if keyword.arg not in (None, "strict"):  # strict: a safeguard against ourselves
                yield (
                    f"without {keyword.arg}=",
                    _with(node, keywords=node.keywords[:k] + node.keywords[k + 1 :]),
                )


def _of_statements(node: ast.AST) -> Iterator[Change]:
    match node:
        case ast.If() | ast.IfExp() | ast.While():
            yield "condition negated", _with(node, test=ast.UnaryOp(ast.Not(), node.test))
        case ast.comprehension(ifs=[_, *_]):
            yield "without if", _with(node, ifs=[])
        case ast.Return(value=ast.expr() as value) if ast.unparse(value) != "None":
            yield "None", _with(node, value=ast.Constant(None))
        case (
            ast.AugAssign()
            | ast.Raise()
            | ast.Break()
            | ast.Continue()
            | ast.Expr(value=ast.Call())
        ):
            yield "left out", ast.Pass()


def _with(node: ast.AST, **fields: Any) -> ast.AST:
    other = copy.copy(node)
    for name, value in fields.items():
        setattr(other, name, value)
    return other


class Mutant(NamedTuple):
    """A changed module; `lines` are those whose tests may notice, the nearest first: statement,
    function, module.
    """

    module: str
    line: int
    text: str
    code: types.CodeType
    lines: tuple[range, ...]


def mutants(path: Path) -> Iterator[Mutant]:
    """All of a module, docstrings, annotations and texts with values left alone."""
    source = path.read_text(encoding="utf-8")
    tree = ast.parse(source)
    everything = range(1, len(source.splitlines()) + 1)
    for holder, field, node, near in list(_nodes(tree, (everything,))):
        for text, other in changes(node):
            before = ast.unparse(node).splitlines()[0]
            _put(
                holder,
                field,
                ast.fix_missing_locations(ast.copy_location(other, node))
                if other is not node
                else other,
            )
            code = compile(ast.fix_missing_locations(tree), str(path), "exec")
            _put(holder, field, node)
            yield Mutant(
                path.relative_to(SOURCE).as_posix(),
                getattr(node, "lineno", near[0][0]),
                f"{before[:70]} -> {text}",
                code,
                near,
            )


def _put(holder: ast.AST | list[Any], field: Any, node: ast.AST) -> None:
    if isinstance(holder, list):
        holder[field] = node
    else:
        setattr(holder, field, node)


def _nodes(
    node: ast.AST, near: tuple[range, ...]
) -> Iterator[tuple[Any, Any, ast.AST, tuple[range, ...]]]:
    """Every node that may be changed, with what holds it, and the lines around it."""
    if isinstance(node, ast.FunctionDef):
        near = (range(node.lineno, node.end_lineno + 1), *near)
    for field, value in ast.iter_fields(node):
        if field in ("annotation", "returns", "decorator_list", "bases") or isinstance(
            node, ast.JoinedStr
        ):
            continue
        children = (
            [(value, k, child) for k, child in enumerate(value)]
            if isinstance(value, list)
            else [(node, field, value)]
        )
        for holder, key, child in children:
            if not isinstance(child, ast.AST) or _without_effect(child):
                continue
            simple = isinstance(child, ast.stmt) and not hasattr(child, "body")
            loop = isinstance(child, ast.expr) and isinstance(node, ast.For)
            inner = (range(child.lineno, child.end_lineno + 1), *near) if simple or loop else near
            yield holder, key, child, inner
            yield from _nodes(child, inner)


def _without_effect(node: ast.AST) -> bool:
    """Docstrings, and `strict=True`."""
    return (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)) or (
        isinstance(node, ast.keyword) and node.arg == "strict"
    )


# ------------------------------------------------------------------ putting it in place
def patch(mutant: Mutant) -> None:
    """The functions, classes and constants of the changed module in place of the module's own,
    wherever they were imported.
    """
    name = _dotted(mutant.module)
    module = importlib.import_module(name)
    fresh = {
        "__name__": name,
        "__package__": module.__package__,
        "__file__": module.__file__,
        "__path__": getattr(module, "__path__", []),
    }
    exec(mutant.code, fresh)
    for key, new in fresh.items():
        old = vars(module).get(key)
        if key.startswith("__") or isinstance(new, types.ModuleType) or new is old:
            continue
        if not _graft(old, new):
            for other in _ours():
                for place in [k for k, v in vars(other).items() if v is old]:
                    setattr(other, place, new)


def _dotted(module: str) -> str:
    return "balcli." + module.removesuffix(".py").replace("/__init__", "").replace("/", ".")


def _graft(old: Any, new: Any) -> bool:
    """New code into old functions; False where it is no function or class."""
    for inner in ("fget", "func", "__func__", "__wrapped__"):
        if not isinstance(new, types.FunctionType) and isinstance(
            getattr(new, inner, None), types.FunctionType
        ):
            return _graft(getattr(old, inner), getattr(new, inner))
    if isinstance(new, types.FunctionType):
        old.__code__, old.__defaults__, old.__kwdefaults__ = (
            new.__code__,
            new.__defaults__,
            new.__kwdefaults__,
        )
        return True
    if not isinstance(new, type) or new.__module__ != old.__module__:
        return False
    for key, value in list(vars(new).items()):
        if (
            key in vars(old)
            and not _graft(vars(old)[key], value)
            and not key.startswith("__")
            and vars(old)[key] != value
        ):
            setattr(old, key, value)
    return True


# ------------------------------------------------------------------ running
def in_child(work: Callable[[], Any]) -> Any:
    """What `work` returns in a process of its own, or None if that ended otherwise."""
    get, put = os.pipe()
    if child := os.fork():
        os.close(put)
        with os.fdopen(get, "rb") as pipe:
            found = pipe.read()
        os.waitpid(child, 0)
        return pickle.loads(found) if found else None
    with open(os.devnull, "w") as nothing:
        os.dup2(nothing.fileno(), 1)  # what pytest has to say of failing tests
    try:
        found = pickle.dumps(work())
        with os.fdopen(put, "wb") as pipe:
            pipe.write(found)
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
    finally:
        os._exit(0)


class Trace(NamedTuple):
    """Usual duration of a test, and the files and lines that it reaches."""

    seconds: float
    places: set[tuple[str, int]]


class Runner:
    """The plugin: instead of running the tests once, they are run for every mutant."""

    def __init__(self, options: argparse.Namespace) -> None:
        self.options = options
        self.failed = ""
        self.traced: dict[str, Trace] = {}
        self.survivors: list[Mutant] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self.failed = report.nodeid

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        self.items = {item.nodeid: item for item in session.items}
        for module, _ in self.options.modules:
            importlib.import_module(_dotted(module))
        self._trace()
        for module, lines in self.options.modules:
            self._module(module, lines)
        return True

    def _trace(self) -> None:
        """What each test reaches, and how long it takes; from the file of an earlier run, unless a
        module that it reaches has changed.
        """
        kept, sources = (
            self.options.trace,
            {p.relative_to(SOURCE).as_posix(): p.read_bytes() for p in SOURCE.rglob("*.py")},
        )
        before, self.traced = (
            pickle.loads(kept.read_bytes()) if kept and kept.exists() else ({}, {})
        )
        moved = {module for module in before if before[module] != sources.get(module)}
        self.traced = {
            name: t
            for name, t in self.traced.items()
            if moved.isdisjoint(module for module, _ in t.places)
        }
        new = [name for name in self.items if name not in self.traced]
        found = in_child(lambda: self._traced(new))
        if found is None or self.failed:
            raise pytest.UsageError("the tests must pass without any change")
        self.traced |= found
        if kept:
            kept.write_bytes(pickle.dumps((sources, self.traced)))
        self.reached: defaultdict[tuple[str, int], set[str]] = defaultdict(set)
        for name in self.items:
            for place in self.traced[name].places:
                self.reached[place].add(name)
        print(
            f"{len(self.items)} tests, "
            f"{sum(self.traced[name].seconds for name in self.items):.0f} s",
            flush=True,
        )

    def _traced(self, names: list[str]) -> dict[str, Trace]:
        found = {}
        for name in names:
            _forget()
            tracer = coverage.Coverage(data_file=None, config_file=False, source=[str(SOURCE)])
            tracer.set_option("run:disable_warnings", ["no-data-collected"])
            started = time.perf_counter()
            with tracer.collect():
                self._run(self.items[name], None)
            if self.failed:
                raise AssertionError(self.failed)
            seconds, data = time.perf_counter() - started, tracer.get_data()
            found[name] = Trace(
                seconds,
                {
                    (Path(file).relative_to(SOURCE).as_posix(), line)
                    for file in data.measured_files()
                    for line in data.lines(file) or ()
                },
            )
        return found

    def _run(self, item: pytest.Item, following: pytest.Item | None) -> None:
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)

    def _module(self, module: str, lines: set[int]) -> None:
        chosen = [m for m in mutants(SOURCE / module) if not lines or m.line in lines]
        if self.options.again:
            chosen = [m for m in chosen if (module, m.text) in self.options.again]
        total = len(chosen)
        if self.options.sample < total:
            chosen = sorted(
                random.Random(self.options.seed).sample(chosen, self.options.sample),
                key=lambda m: m.line,
            )
        kills: Counter[str] = Counter()
        alive = 0
        for mutant in chosen:
            tests = self._tests(mutant, kills)
            killer = in_child(lambda mutant=mutant, tests=tests: self._killer(mutant, tests))
            if killer == "":
                alive += 1
                self.survivors.append(mutant)
                print(f"{module}:{mutant.line}: {mutant.text} ({len(tests)} tests)", flush=True)
            elif killer:
                kills[killer] += 1
        print(
            f"{module}: {len(chosen) - alive} of {len(chosen)} killed ({total} mutants in all)",
            flush=True,
        )

    def _tests(self, mutant: Mutant, kills: Counter[str]) -> list[str]:
        """Those which reach the mutant, as many as there is time for."""
        names: set[str] = next(
            (
                found
                for near in mutant.lines
                if (found := set().union(*(self.reached.get((mutant.module, n), ()) for n in near)))
            ),
            set(),
        )
        chosen, spent = [], 0.0
        for name in sorted(
            names, key=lambda name: (len(self.traced[name].places) / (1 + 10 * kills[name]), name)
        ):
            spent += self.traced[name].seconds
            if not chosen or spent <= self.options.seconds:
                chosen.append(name)
        return chosen

    def _killer(self, mutant: Mutant, tests: list[str]) -> str:
        """The test that fails, "" if there is none; a test that hangs ends the process."""
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        _forget()
        try:
            signal.setitimer(signal.ITIMER_REAL, PATIENCE[0])
            patch(mutant)
        except Exception:
            return "import"
        items = [self.items[name] for name in tests]
        for item, following in zip(items, [*items[1:], None], strict=True):
            signal.setitimer(
                signal.ITIMER_REAL, PATIENCE[0] + PATIENCE[1] * self.traced[item.nodeid].seconds
            )
            self._run(item, following)
            if self.failed:
                return self.failed
        return ""


def _forget() -> None:
    """Nothing is kept from one test to the next: each reaches the lines that it needs."""
    for module in _ours():
        for value in vars(module).values():
            if isinstance(value, functools._lru_cache_wrapper):
                value.cache_clear()


def _ours() -> list[types.ModuleType]:
    return [
        m for name, m in list(sys.modules.items()) if name.startswith(("balcli", "test_")) and m
    ]


def wanted(names: Iterable[str]) -> list[tuple[str, set[int]]]:
    """Modules by folder, file, or file and line."""
    found: defaultdict[str, set[int]] = defaultdict(set)
    for name in names:
        place, _, line = name.partition(":")
        path = SOURCE / place
        for file in sorted(path.glob("*.py")) if path.is_dir() else [path]:
            found[file.relative_to(SOURCE).as_posix()] |= {int(line)} if line else set()
    return list(found.items())


def printed(log: str) -> set[tuple[str, str]]:
    """Module and change of the survivors that an earlier run printed; their lines may have moved
    since.
    """
    found = re.findall(
        r"(?m)^([\w/]+\.py):\d+: (.*) \(\d+ tests\)$", Path(log).read_text(encoding="utf-8")
    )
    return {(module, text) for module, text in found}


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "modules",
        nargs="*",
        default=["core", "sizing"],
        help="below src/balcli, with or without a line",
    )
    parser.add_argument("--sample", type=int, default=10**9, help="so many of each module at most")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument(
        "--seconds",
        type=float,
        default=15.0,
        help="usual duration of the tests of one mutant at most",
    )
    parser.add_argument(
        "--trace", type=Path, help="file that keeps what each test reaches for the next run"
    )
    parser.add_argument(
        "--again", type=printed, help="what an earlier run printed: its survivors alone"
    )
    parser.add_argument("--tests", nargs="*", help="files of tests (default: all quick ones)")
    options = parser.parse_args()
    options.modules = wanted(options.modules)
    files = options.tests or [
        str(f)
        for f in sorted((ROOT / "tests").rglob("test_*.py"))
        if not {f.stem, f.parent.name} & set(LEFT_OUT)
    ]
    settings.register_profile(
        "mutants",
        deadline=None,
        derandomize=True,
        max_examples=20,
        phases=[Phase.explicit, Phase.generate],
    )
    os.chdir(ROOT)
    runner = Runner(options)
    failed = pytest.main(
        [
            "-n",
            "0",
            "-s",
            "-W",
            "ignore::pytest.PytestAssertRewriteWarning",
            "--hypothesis-profile=mutants",
            *files,
        ],
        plugins=[runner],
    )
    return int(failed) or int(bool(runner.survivors))


if __name__ == "__main__":
    sys.exit(main())
