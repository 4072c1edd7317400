"""Run times where a user waits, as ratios measured in turn: python benchmarks/ratios.py

The yardstick of variants is a script that anybody would write: force and moment of a V8 at 360
steps of a turn, and their orders 1 to 8 by a Fourier transform. Commands are compared with `balcli
analyze` of the same file, and torsion with openTorsion, which is installed into an environment of
its own (`--peers`). All times are processor times, with one thread of linear algebra: other work on
the machine makes both sides of a ratio slower. With `-o growth.svg`, growth is also drawn.
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
from collections.abc import Callable, Iterator
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
DIESEL = HERE.parent / "engines" / "i6_diesel.toml"
OPENTORSION = "opentorsion==0.3.2"
PAIRS = 5
VARIANTS = 20
SIZES = [(nodes, 24, speeds) for nodes in (12, 48) for speeds in (50, 200)]

Run = Callable[[], object]


class Ratio(NamedTuple):
    """How many times as long as something else a run takes.

    Attributes:
        what: What is compared.
        quartiles: Quartiles of the ratios of several pairs.
        wanted: Largest ratio that is wanted; None: none is named.
    """

    what: str
    quartiles: tuple[float, float, float]
    wanted: float | None = None

    def __str__(self) -> str:
        low, middle, high = self.quartiles
        wanted = "" if self.wanted is None else f"{self.wanted:g}"
        return f"{middle:8.2f}  [{low:.2f} to {high:.2f}]  {wanted:>5}  {self.what}"


def time_run(run: Run) -> float:
    """Return the processor time of a run, s."""
    start = time.process_time()
    run()
    return time.process_time() - start


def time_command(*argv: str) -> float:
    """Return the processor time of a Python program in a new process, s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, *argv], capture_output=True, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def compare(
    what: str,
    measure: Callable[[], float],
    other: Callable[[], float],
    wanted: float | None = None,
    pairs: int = PAIRS,
) -> Ratio:
    """Return the ratio of two times that are measured in turn."""
    ratios = [measure() / other() for _ in range(pairs)]
    return Ratio(what, tuple(np.quantile(ratios, [0.25, 0.5, 0.75]).tolist()), wanted)


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
        ("shaft stress, inertia varied", "shaft.flywheel.stress", "torsion.rear.1.inertia", 20),
        ("largest torque, imep varied", "torque.max", "gas.imep", 2),
        ("gas torque of order 3, imep varied", "gas.3.amplitude", "gas.imep", 2),
    ]
    for what, quantity, path, wanted in cases:
        values = {path: inertia if "inertia" in path else pressure}
        run = partial(balcli.sweep, engine, values, [quantity], jobs=1)
        few = {name: array[:1] for name, array in values.items()}
        run_one = partial(balcli.sweep, engine, few, [quantity], jobs=1)

        def measure(run: Run = run, run_one: Run = run_one) -> float:
            return (time_run(run) - time_run(run_one)) / (VARIANTS - 1)

        yield compare(f"a variant ({what}) to the naive script", measure, time_naively, wanted)


# ------------------------------------------------------------------ commands
def list_commands() -> Iterator[Ratio]:
    """Yield what commands cost, in runs of `balcli analyze`."""
    file = str(DIESEL)
    basic = partial(time_command, "-m", "balcli", "analyze", file)
    over = ("-m", "balcli", "torsion", file, "--speeds", "600:2400:20", "--damper")
    stress = ("-m", "balcli", "scatter", file, "-q", "shaft.flywheel.stress")
    yield compare(
        "torsion --damper viscous to analyze", partial(time_command, *over, "viscous"), basic, 3
    )
    yield compare(
        "torsion --damper rubber to analyze", partial(time_command, *over, "rubber"), basic, 3
    )
    yield compare(
        "scatter -q shaft.flywheel.stress to analyze", partial(time_command, *stress), basic, 12, 1
    )
    imports = partial(time_command, "-c", LIBRARIES)
    plain = str(DIESEL.parent / "v8_crossplane.toml")
    cold = partial(time_command, "-m", "balcli", "analyze", plain)
    yield compare("cold analyze to its libraries' import", cold, imports, 1.9)


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
            2,
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


def compare_with_peer(python: Path, nodes: int, orders: int, speeds: int) -> Ratio:
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
            0.5,
        )
        peer.stdin.close()
    return ratio


def list_peers(python: Path) -> Iterator[Ratio]:
    """Yield what `torsion` costs, in runs of openTorsion."""
    for size in SIZES:
        yield compare_with_peer(python, *size)


# ------------------------------------------------------------------ growth
def measure_growth() -> dict[str, dict[int, float]]:
    """Return processor times (s) by size of orders, nodes, variants and throws."""
    engine = balcli.load(DIESEL)

    def time_variants(count: int) -> float:
        values = {"torsion.rear.1.inertia": np.linspace(2.0e6, 2.1e6, count)}
        return time_run(partial(balcli.sweep, engine, values, ["shaft.flywheel.stress"], jobs=1))

    def time_throws(count: int) -> float:
        return time_run(partial(analyze, balcli.load(describe_engine(count)), only=QUANTITIES))

    return {
        "orders (torsion, 12 nodes, 50 speeds)": {n: time_torsion(12, n, 50) for n in (24, 48, 96)},
        "nodes (torsion, 24 orders, 50 speeds)": {n: time_torsion(n, 24, 50) for n in (12, 24, 48)},
        "variants (shaft stress)": {n: time_variants(n) for n in (10, 20, 40)},
        "throws (analyze)": {n: time_throws(n) for n in (100, 300, 1000)},
    }


def draw_growth(growth: dict[str, dict[int, float]], path: Path) -> None:
    """Draw the times over the sizes, both logarithmic."""
    from matplotlib.figure import Figure  # only for a picture

    figure = Figure(figsize=(7, 5), layout="constrained")
    axes = figure.add_subplot()
    for what, times in growth.items():
        axes.loglog(list(times), list(times.values()), "o-", label=what)
    axes.set_xlabel("size")
    axes.set_ylabel("processor time, s")
    axes.grid(visible=True, which="both", alpha=0.3)
    axes.legend()
    figure.savefig(path)


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
    options = parser.parse_args()
    print("   ratio  [quartiles]  wanted  what")
    groups = [list_variants(), list_commands(), list_throws()]
    if not options.without_peers:
        groups.append(list_peers(install_peers(options.peers)))
    for group in groups:
        for ratio in group:
            print(ratio, flush=True)
    growth = measure_growth()
    for what, times in growth.items():
        least = min(times.values())
        steps = ", ".join(f"{size}: {seconds / least:.1f}" for size, seconds in times.items())
        print(f"growth by {what}: {steps}")
    if options.output:
        draw_growth(growth, options.output)


if __name__ == "__main__":
    main()
