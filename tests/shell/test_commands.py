"""Commands as users give them, in this process: plot, report, bench, cluster and files of sweeps,
and what the schemes refuse.
"""

import re
import sys
from functools import partial
from types import ModuleType

import pytest
from support.cases import cases
from support.commands import ask, ask_csv, ask_json, refusal
from support.engines import GOOD
from support.paths import ENGINES, write

from balcli.bench import starts, tasks
from balcli.bench.records import Bench, Block, Measured, OrderError, Ratio, Times
from balcli.errors import BalcliError

METHODS = (
    Measured("closed form", "exact", Times(1.5e-6, 2e-6, 3e-6), (OrderError(2, 0.0), OrderError(8, 1e-16))),
    Measured("series of two terms", "formula", Times(1e-6, 1e-6, 1e-6), (OrderError(2, 3.2e-2), OrderError(8, 1.0))),
)
MEASURED = Bench.of([Block("orders of one cylinder", METHODS, 1, 0.25)], [Ratio(what="one to other", value=1.25)])


@pytest.fixture
def four(tmp_path):
    return write(tmp_path / "four.toml", GOOD)


def test_plot_refuses_a_scheme_where_nothing_is_compared(tmp_path):
    for what, more in (("bank", "; bank takes only --scheme two-shaft with --order"), ("modes", ""), ("pressure", "")):
        wanted = f"--what {what} shows the engine as it is: leave --scheme and its options out{more}"
        for option in ("--scheme=factor", "--factor=51%", "--planes=ends"):
            told = refusal("plot", ENGINES / "i6_diesel.toml", tmp_path / "x.svg", "--what", what, option)
            assert told == wanted
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("command", ["plot", "report", "mounts"])
def test_options_of_schemes_are_judged_as_in_balance(tmp_path, command):
    four = ENGINES / "i4_mounts.toml"
    file = tmp_path / ("x.html" if command == "report" else "x.svg")
    where = ["--plot", file] if command == "mounts" else ["-o", file]
    for options in (["--planes=nowhere"], ["--at=1,2"], ["--scheme=factor", "--factor=51"]):
        assert refusal("balance", four, *options) in refusal(command, four, *where, *options)
        assert not file.exists()


# ------------------------------------------------------------------ bench
@pytest.fixture
def measured(monkeypatch):
    monkeypatch.setattr(tasks, "measure", lambda: MEASURED)


@pytest.mark.usefixtures("measured")
def test_bench_in_every_format():
    table = ask("bench")
    assert "Orders of one cylinder, λ = 0.25, one variant" in table
    assert re.search(r"series of two terms +1 +1–1 +3e-02 +not found", table)
    assert re.search(r"closed form +2 +1.5–3 +rounding +rounding", table)
    sentence = "as closed form (rounding) or series of two terms (not every order)."
    assert sentence in " ".join(table.split())
    lines = ask_csv("bench")
    assert [line["error"] for line in lines] == ["0.0", "1e-16", "0.032", "1.0", ""]
    assert lines[2]["seconds"] == "1e-06"
    assert lines[-1]["ratio"] == "1.25"
    document = ask_json("bench")
    assert document["ratios"] == [{"what": "one to other", "value": 1.25}]
    assert document["unbeaten"][0]["methods"] == ["closed form", "series of two terms"]


@pytest.mark.usefixtures("measured")
def test_bench_draws_a_picture_in_addition_to_its_tables(tmp_path):
    assert "Orders of one cylinder" in ask("bench", "-o", tmp_path / "bench.svg")
    picture = (tmp_path / "bench.svg").read_text(encoding="utf-8")
    for text in ("λ = 0.25, one variant", "µs per variant", "closed form", "order 8", "rounding"):
        assert text in picture


def test_cold_starts_are_compared_by_medians(monkeypatch):
    """By a clock of ours: a busy machine disturbs some of the rounds, not their medians; the first is not counted."""
    clock = [0.0]
    started = []

    def start(argv, **_):
        name = argv[2]
        started.append(name)
        disturbed = 50 if len(started) in (1, 4, 9) else 1
        clock[0] += {"balcli": 1.0, starts.LIBRARIES: 0.2}.get(name, 0.5) * disturbed

    monkeypatch.setattr(starts.time, "perf_counter", lambda: clock[0])
    monkeypatch.setattr(starts.subprocess, "run", start)
    ratios = list(starts.compare_starts("engine"))
    assert [ratio.value for ratio in ratios] == pytest.approx([5, 2])
    assert started == ["balcli", starts.LIBRARIES, starts.SMALLEST] * 5


# ------------------------------------------------------------------ sweeps: cluster and files
SWEEP = ("--vary", "rod.ratio=0.2,0.25,0.3", "--quantity", "force.2.major")
VARY_2 = ("--vary", "crank.stroke=80,90,100")


def dask(**names: object) -> ModuleType:
    made = ModuleType("distributed")
    vars(made).update(names)
    return made


def test_no_dask_no_cluster(four, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert refusal("sweep", four, *SWEEP, "--dask", "local") == "--dask needs dask: install balcli[scale]"


def test_a_cluster_that_does_not_answer(monkeypatch):
    from balcli.studies import sweep_write as cluster

    def refuse(address: str, timeout: float) -> None:
        raise OSError(f"nobody at {address}")

    monkeypatch.setitem(sys.modules, "distributed", dask(Client=refuse))
    with (
        pytest.raises(BalcliError, match=r"^dask tcp://host:1: no cluster answers there \(nobody at tcp://host:1\)"),
        cluster.connect_cluster("tcp://host:1"),
    ):
        pass


class KilledError(Exception):
    """As distributed.KilledWorker."""


class Lost:
    """A client whose workers are all killed; what it is given is what a task brings with it."""

    def __init__(self):
        self.given = []

    def nthreads(self):
        return {"one": 1}

    def submit(self, work, sweep, **options):
        self.given += [(sweep, options["retries"] > 0)]
        return self

    def result(self):
        raise KilledError("task")


def test_workers_that_are_all_killed_are_a_message(monkeypatch, four):
    from balcli.studies import sweep_write as cluster
    from balcli.studies.sweep import evaluate_chunks, read_sweep

    monkeypatch.setitem(sys.modules, "distributed", dask(KilledWorker=KilledError))
    monkeypatch.setattr("balcli.studies.sweep.CHUNK", 1)
    sweep = read_sweep(str(four), ["crank.stroke=80,90"], "force.2.major")
    client = Lost()
    with pytest.raises(BalcliError, match=r"^dask: the cluster has lost its workers \(KilledError\)"):
        list(evaluate_chunks(sweep, partial(cluster.run_on_cluster, client)))
    assert [(part.variants, again) for part, again in client.given] == [(1, True), (1, True)]
    values = [part.parameters[0].values.tolist() for part, _ in client.given]
    assert values == [[80], [90]]  # a task brings what it computes, and no more


def test_no_pyarrow_no_parquet(four, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    told = refusal("sweep", four, *SWEEP, "-o", tmp_path / "x.parquet")
    assert told == "a .parquet file needs pyarrow: install balcli[scale]"
    assert not (tmp_path / "x.parquet").exists()


@pytest.mark.parametrize(("more", "labels"), [([], {"force.2.major", "N"}), (VARY_2, {"force.2.major, N"})])
def test_pictures_of_one_and_two_parameters(four, tmp_path, more, labels):
    ask("sweep", four, *SWEEP, *more, "-o", tmp_path / "x.csv", "--plot", tmp_path / "x.svg")
    assert labels <= set(re.findall(r">([^<>]+)</text>", (tmp_path / "x.svg").read_text("utf-8")))


def test_curves_of_one_picture_have_one_unit(tmp_path):
    """A moment in kN·m would else lie below one in N·m that is smaller."""
    picture = tmp_path / "x.svg"
    asked = ["--vary", "layout.bank_angle=60:120:30", "--plot", picture, "-o", tmp_path / "x.csv"]
    ask("sweep", ENGINES / "v6_60.toml", *asked)
    told = re.findall(r">((?:force|moment)\.[^<]*|k?N(?:·m)?)<", picture.read_text(encoding="utf-8"))
    assert told == [*("N", "force.1.major", "force.2.major"), *("kN·m", "moment.1.major", "moment.2.major")]


# ------------------------------------------------------------------ refusals, word for word
@cases("shell/commands", "refusals_say_what_would_be_right")
def test_refusals_say_what_would_be_right(command, engine, options, message):
    assert message in refusal(command, ENGINES / f"{engine}.toml", *options.split())


def test_devices_of_a_sizing_that_is_asked_for_in_csv():
    """Those of its JSON, in the units of an engine file; without asking, CSV has none of them."""
    three = ENGINES / "i3.toml"
    sizing = ask_json("analyze", three, "--only", "sizing")["sizing"]
    lines = ask_csv("analyze", three, "--only", "sizing")
    figures = {(line["quantity"], line["figure"]): float(line["value"]) for line in lines}
    assert [*lines[0]] == ["engine", "cylinder", "quantity", "order", "figure", "value", "unit"]
    assert {part for part, _ in figures} == {
        *(f"counterweight {k + 1}" for k in range(len(sizing["counterweights"]))),
        *(f"shaft {k + 1}" for k in range(len(sizing["shafts"]))),
    }
    for k, shaft in enumerate(sizing["shafts"], 1):
        assert figures[f"shaft {k}", "ratio"] == shaft["ratio"]
        assert figures[f"shaft {k}", "position"] == shaft["position_mm"]
        assert figures[f"shaft {k}", "unbalance"] == pytest.approx(1e6 * shaft["unbalance_kg_m"])
    assert "counterweight" not in ask("analyze", three, "--format", "csv")
