"""Run times where a user waits, as ratios measured in turn: python benchmarks/ratios.py

The yardstick of variants is a script that anybody would write: force and moment of a V8 at 360
steps of a turn, and their orders 1 to 8 by a Fourier transform. Commands are compared with `balcli
analyze` of the same file, and torsion with openTorsion, which is installed into an environment of
its own (`--peers`). All times are processor times, with one thread of linear algebra, and the
quickest of some runs: other work on the machine makes both sides of a ratio slower. With `-o
growth.svg`, growth is also drawn; `--page` writes ratios and growth into docs/accuracy.md.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
import venv
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # before numpy is imported

import numpy as np

import balcli
from balcli.analysis.answer import QUANTITIES, UNASKED, analyze
from balcli.bench.starts import LIBRARIES
from balcli.torsional_vibration.answer import torsion

HERE = Path(__file__).resolve().parent
PAGE = HERE.parent / "docs" / "accuracy.md"
START = "<!-- ratios -->\n"
END = "<!-- end of ratios -->\n"
DIESEL = HERE.parent / "engines" / "i6_diesel.toml"
OPENTORSION = "opentorsion==0.3.2"
PAIRS = 5
ROUNDS = 3  # runs of both sides for a pair, of which the quickest counts
VARIANTS = 20

Run = Callable[[], object]


class Goal(NamedTuple):
    """Ratio that is wanted, and ratios from which the work on speed started (November 2026).

    Attributes:
        before: Smallest and largest ratio measured before.
        wanted: Largest ratio that is wanted.
    """

    before: tuple[float, float]
    wanted: float

    @property
    def start(self) -> str:
        """The ratios before, as they are printed."""
        least, largest = self.before
        return f"{least:g}" if least == largest else f"{least:g} to {largest:g}"


class Ratio(NamedTuple):
    """How many times as long as something else a run takes.

    Attributes:
        what: What is compared.
        quartiles: Quartiles of the ratios of several pairs.
        goal: What is wanted.
    """

    what: str
    quartiles: tuple[float, float, float]
    goal: Goal

    @property
    def spread(self) -> str:
        """First and third quartile, as they are printed."""
        return f"{self.quartiles[0]:.2f} to {self.quartiles[2]:.2f}"

    def __str__(self) -> str:
        now = f"{self.quartiles[1]:8.2f}  [{self.spread}]"
        return f"{now:28}  {self.goal.start:>12}  {self.goal.wanted:6g}  {self.what}"


class Growth(NamedTuple):
    """Processor times by size.

    Attributes:
        what: What grows, and what is run.
        seconds: Processor time by size, s; sizes rise.
    """

    what: str
    seconds: dict[int, float]

    @property
    def shares(self) -> list[float]:
        """Times as multiples of that of the smallest size."""
        times = list(self.seconds.values())
        return [time / times[0] for time in times]


STRESS = Goal((57, 85), 20)
GAS = Goal((14, 18), 2)
DAMPER = Goal((6, 8), 3)
SCATTER = Goal((48, 48), 12)
COLD = Goal((2.06, 2.06), 1.9)
THROWS = Goal((4, 4), 2)
PEERS = {  # by nodes, orders and speeds
    (12, 24, 50): Goal((3, 9), 0.5),
    (12, 24, 200): Goal((0.33, 1), 0.5),
    (48, 24, 50): Goal((4, 4), 0.5),
    (48, 24, 200): Goal((4, 4), 0.5),
}


def time_run(run: Run) -> float:
    """Return the processor time of a run, s."""
    start = time.process_time()
    run()
    return time.process_time() - start


def time_command(*argv: str) -> float:
    """Return the processor time of a Python program in a new process, s."""
    environment = dict(os.environ)
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # compiling again is no part of a start
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, *argv], capture_output=True, check=True, env=environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def compare(
    what: str,
    measure: Callable[[], float],
    other: Callable[[], float],
    goal: Goal,
    pairs: int = PAIRS,
) -> Ratio:
    """Return the ratio of two times that are measured in turn. Of some runs of each side, the
    quickest counts, since other work on the machine only adds to a time.
    """
    ratios = []
    for _ in range(pairs):
        times = [(measure(), other()) for _ in range(ROUNDS)]
        ours, theirs = (min(side) for side in zip(*times, strict=True))
        ratios.append(ours / theirs)
    return Ratio(what, tuple(np.quantile(ratios, [0.25, 0.5, 0.75]).tolist()), goal)


# ------------------------------------------------------------------ variants
def compute_naively() -> tuple[np.ndarray, np.ndarray]:
    """Return the amplitudes of orders 1 to 8 of force and moment of a V8, N and N m."""
    angle = np.radians(np.arange(360.0))
    axes = np.radians([45, 45, 45, 45, -45, -45, -45, -45])
    throws = np.radians([0, 90, 270, 180, 0, 90, 270, 180])
    places = np.linspace(-0.2, 0.2, 8)
    ratio = 0.28
    psi = angle + (throws - axes)[:, None]
    sine = np.sin(psi)
    cosine = np.cos(psi)
    root = np.sqrt(1 - (ratio * sine) ** 2)
    bend = ratio * (cosine**2 - sine**2) / root + ratio**3 * (sine * cosine) ** 2 / root**3
    force = 0.5 * 0.045 * 300**2 * np.exp(1j * axes)[:, None] * (cosine + bend)
    moment = places[:, None] * force
    orders = np.fft.fft(np.array([force.sum(axis=0), moment.sum(axis=0)]))[:, 1:9] / len(angle)
    return np.abs(orders[0]), np.abs(orders[1])


def time_naively() -> float:
    """Return the processor time of `compute_naively`, s."""
    times = 100
    return time_run(lambda: [compute_naively() for _ in range(times)]) / times


def list_variants() -> Iterator[Ratio]:
    """Yield what a variant costs, in runs of the naive script."""
    engine = balcli.load(DIESEL)
    inertia = np.linspace(2.0e6, 2.1e6, VARIANTS)
    pressure = np.linspace(13.0, 15.0, VARIANTS)
    cases = [
        ("shaft stress, inertia varied", "shaft.flywheel.stress", "torsion.rear.1.inertia", STRESS),
        ("largest torque, imep varied", "torque.max", "gas.imep", GAS),
        ("gas torque of order 3, imep varied", "gas.3.amplitude", "gas.imep", GAS),
    ]
    for what, quantity, path, goal in cases:
        values = {path: inertia if "inertia" in path else pressure}
        run = partial(balcli.sweep, engine, values, [quantity], jobs=1)
        few = {name: array[:1] for name, array in values.items()}
        run_one = partial(balcli.sweep, engine, few, [quantity], jobs=1)

        def measure(run: Run = run, run_one: Run = run_one) -> float:
            all_variants = min(time_run(run) for _ in range(ROUNDS))
            one = min(time_run(run_one) for _ in range(ROUNDS))
            return (all_variants - one) / (VARIANTS - 1)

        yield compare(f"a variant ({what}) to the naive script", measure, time_naively, goal)


# ------------------------------------------------------------------ commands
def list_commands() -> Iterator[Ratio]:
    """Yield what commands cost, in runs of `balcli analyze`."""
    file = str(DIESEL)
    basic = partial(time_command, "-m", "balcli", "analyze", file)
    over = ("-m", "balcli", "torsion", file, "--speeds", "600:2400:20", "--damper")
    stress = ("-m", "balcli", "scatter", file, "-q", "shaft.flywheel.stress")
    basic()  # compiles modules and reads them from the disk
    for damper in ("viscous", "rubber"):
        sized = partial(time_command, *over, damper)
        yield compare(f"torsion --damper {damper} to analyze", sized, basic, DAMPER)
    scattered = partial(time_command, *stress)
    yield compare("scatter -q shaft.flywheel.stress to analyze", scattered, basic, SCATTER, 3)
    imports = partial(time_command, "-c", LIBRARIES)
    plain = str(DIESEL.parent / "v8_crossplane.toml")
    cold = partial(time_command, "-m", "balcli", "analyze", plain)
    yield compare("cold analyze to its libraries' import", cold, imports, COLD)


def describe_engine(throws: int) -> str:
    """Return the file of an in-line engine with this number of throws."""
    angles = [(137.5 * k) % 360 for k in range(throws)]
    return f"""
[crank]
stroke = 80
throws = {angles}
spacing = 90
throw_mass = 1.0
[rod]
length = 140
mass = 0.5
cg = 40
[piston]
mass = 0.4
"""


def list_throws() -> Iterator[Ratio]:
    """Yield what sizing and ladder add to the analysis of a thousand throws."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "throws.toml"
        file.write_text(describe_engine(1000), encoding="utf-8")
        whole = partial(time_command, "-m", "balcli", "analyze", str(file))
        yield compare(
            "analyze of 1000 throws to the same without sizing and ladder",
            whole,
            partial(whole, "--only", ",".join(UNASKED)),
            THROWS,
            3,
        )


# ------------------------------------------------------------------ torsion
def make_chain(nodes: int, orders: int, speeds: int) -> dict[str, list]:
    """Return a random chain with torques of all orders on every node, as lists."""
    rng = np.random.default_rng(1)
    falling = 1000 / np.arange(1, orders + 1)[:, None]
    return {
        "inertia": rng.uniform(0.05, 0.4, nodes).tolist(),
        "stiffness": rng.uniform(1e6, 3e6, nodes - 1).tolist(),
        "damping": rng.uniform(50, 200, nodes - 1).tolist(),
        "orders": (np.arange(1, orders + 1) / 2).tolist(),
        "cos": (rng.normal(size=(orders, nodes)) * falling).tolist(),
        "sin": (rng.normal(size=(orders, nodes)) * falling).tolist(),
        "rpm": np.linspace(600, 2400, speeds).tolist(),
    }


def describe_chain(chain: dict[str, list]) -> dict[str, list]:
    """Return the tables of a chain file."""
    shafts = zip(chain["stiffness"], chain["damping"], strict=True)
    excitations = []
    for row, order in enumerate(chain["orders"]):
        for k, (cosine, sine) in enumerate(zip(chain["cos"][row], chain["sin"][row], strict=True)):
            excitations.append({"node": f"n{k}", "order": order, "cos": cosine, "sin": sine})
    return {
        "node": [{"name": f"n{k}", "inertia": j * 1e6} for k, j in enumerate(chain["inertia"])],
        "shaft": [
            {"from": f"n{k}", "to": f"n{k + 1}", "stiffness": spring, "damping": dashpot}
            for k, (spring, dashpot) in enumerate(shafts)
        ],
        "excitation": excitations,
    }


def time_torsion(nodes: int, orders: int, speeds: int) -> float:
    """Return the least processor time of `torsion` in three runs, s."""
    chain = make_chain(nodes, orders, speeds)
    tables = describe_chain(chain)
    return min(time_run(partial(torsion, tables, chain["rpm"])) for _ in range(3))


def install_peers(folder: Path) -> Path:
    """Return the Python of an environment with openTorsion, which is made if it does not exist."""
    python = folder / "bin" / "python"
    if not python.exists():
        venv.create(folder, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", OPENTORSION], check=True)
    return python


def compare_with_peer(python: Path, nodes: int, orders: int, speeds: int, goal: Goal) -> Ratio:
    """Return what `torsion` costs, in runs of openTorsion, and check that both compute the same."""
    chain = make_chain(nodes, orders, speeds)
    tables = describe_chain(chain)
    command = [python, HERE / "opentorsion_torques.py"]
    with subprocess.Popen(command, stdin=-1, stdout=-1, text=True) as peer:

        def ask(line: str = "") -> list[float]:
            peer.stdin.write(f"{line}\n")
            peer.stdin.flush()
            return json.loads(peer.stdout.readline())

        _, theirs = ask(f"{json.dumps(chain)}\n")
        shafts = torsion(tables, chain["rpm"]).response.shafts
        ours = max(float(shaft.sum_of_amplitudes_Nm.max()) for shaft in shafts)
        assert abs(ours / theirs - 1) < 1e-9, (ours, theirs)
        ratio = compare(
            f"torsion to openTorsion: {nodes} nodes, {orders} orders, {speeds} speeds",
            lambda: time_run(partial(torsion, tables, chain["rpm"])),
            lambda: ask()[0],
            goal,
        )
        peer.stdin.close()
    return ratio


def list_peers(python: Path) -> Iterator[Ratio]:
    """Yield what `torsion` costs, in runs of openTorsion."""
    for size, goal in PEERS.items():
        yield compare_with_peer(python, *size, goal)


# ------------------------------------------------------------------ growth
def measure_growth() -> Iterator[Growth]:
    """Yield processor times by number of orders, nodes, variants and throws."""
    engine = balcli.load(DIESEL)

    def time_variants(count: int) -> float:
        values = {"torsion.rear.1.inertia": np.linspace(2.0e6, 2.1e6, count)}
        return time_run(partial(balcli.sweep, engine, values, ["shaft.flywheel.stress"], jobs=1))

    def time_throws(count: int) -> float:
        return time_run(partial(analyze, balcli.load(describe_engine(count)), only=QUANTITIES))

    yield Growth("orders: torsion of 12 nodes", {n: time_torsion(12, n, 50) for n in (24, 48, 96)})
    yield Growth("nodes: torsion of 24 orders", {n: time_torsion(n, 24, 50) for n in (12, 24, 48)})
    yield Growth("variants: sweep of a stress", {n: time_variants(n) for n in (50, 100, 200)})
    yield Growth("throws: analyze", {n: time_throws(n) for n in (100, 300, 1000)})


def draw_growth(growths: Sequence[Growth], path: Path) -> None:
    """Draw times over sizes, as multiples of those of the smallest size, both logarithmic."""
    from matplotlib.figure import Figure  # only for a picture

    figure = Figure(figsize=(7, 5), layout="constrained")
    axes = figure.add_subplot()
    for growth in growths:
        sizes = list(growth.seconds)
        label = f"{growth.what}, {sizes[0]} to {sizes[-1]}"
        axes.loglog(np.divide(sizes, sizes[0]), growth.shares, "o-", label=label)
    axes.loglog([1, 10], [1, 10], "k:", label="in proportion")
    axes.set_xlabel("size / smallest size")
    axes.set_ylabel("processor time / that of the smallest size")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter("{x:g}")
    axes.grid(visible=True, which="both", alpha=0.3)
    axes.legend()
    figure.savefig(path)


# ------------------------------------------------------------------ docs/accuracy.md
def write_page(ratios: Sequence[Ratio], growths: Sequence[Growth]) -> None:
    """Write the tables of this run into the page."""
    page = PAGE.read_text(encoding="utf-8")
    before, _, rest = page.partition(START)
    _, found, after = rest.partition(END)
    if not found:
        sys.exit(f"{PAGE}: has no {END.strip()}")
    lines = [
        "| what takes how many times as long | before | wanted | now | quartiles |",
        "| --- | ---: | ---: | ---: | ---: |",
    ]
    for ratio in ratios:
        now = f"{ratio.quartiles[1]:.2f} | {ratio.spread}"
        lines.append(f"| {ratio.what} | {ratio.goal.start} | {ratio.goal.wanted:g} | {now} |")
    lines += ["", "| growth with | sizes | times |", "| --- | ---: | ---: |"]
    for growth in growths:
        sizes = ", ".join(map(str, growth.seconds))
        shares = ", ".join(f"{share:.1f}" for share in growth.shares)
        lines.append(f"| {growth.what} | {sizes} | {shares} |")
    tables = "\n".join(lines)
    PAGE.write_text(f"{before}{START}\n{tables}\n\n{END}{after}", encoding="utf-8")


def main() -> None:
    """Print all ratios, and the growth."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--peers", type=Path, default=HERE / ".peers", help="environment of openTorsion"
    )
    parser.add_argument(
        "--without-peers", action="store_true", help="do not compare with openTorsion"
    )
    parser.add_argument("-o", "--output", type=Path, help="picture of the growth")
    parser.add_argument("--page", action="store_true", help="write the tables of docs/accuracy.md")
    options = parser.parse_args()
    if options.page and options.without_peers:
        parser.error("--page needs the peers")
    print("   ratio  [quartiles]               before  wanted  what")
    groups = [list_variants(), list_commands(), list_throws()]
    if not options.without_peers:
        groups.append(list_peers(install_peers(options.peers)))
    ratios = []
    for group in groups:
        for ratio in group:
            print(ratio, flush=True)
            ratios.append(ratio)
    growths = []
    for growth in measure_growth():
        pairs = zip(growth.seconds, growth.shares, strict=True)
        steps = ", ".join(f"{size}: {share:.1f}" for size, share in pairs)
        print(f"growth by {growth.what}: {steps}", flush=True)
        growths.append(growth)
    if options.output:
        draw_growth(growths, options.output)
    if options.page:
        write_page(ratios, growths)


if __name__ == "__main__":
    main()
