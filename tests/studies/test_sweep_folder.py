"""Sweeps written into folders: the same variants as in one file, whole blocks, nothing of others lost."""

import json
import os
from functools import partial
from pathlib import Path

import pytest
from support.commands import refusal, run_here
from support.engines import GOOD

from balcli.shell.progress import Progress
from balcli.studies.sweep import read_sweep
from balcli.studies.sweep_write import MANIFEST, write_blocks

dataset = pytest.importorskip("pyarrow.dataset")
parquet = pytest.importorskip("pyarrow.parquet")

VARY = ("--vary", "rod.ratio=0.2:0.299:0.001", "--vary", "piston.mass=0.4,0.5,0.6")
FIGURES = ("-q", "force.2.major,force.1.axis")
ASKED = (*VARY, *FIGURES)
FEW = ("--vary", "rod.ratio=0.2,0.3", "-q", "force.2.major")


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    """A folder with an engine file, and blocks of 30 variants in boxes of 10."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("balcli.studies.sweep.CHUNK", 10)
    monkeypatch.setattr("balcli.studies.sweep_write.ROWS_A_BLOCK", 30)
    Path("good.toml").write_text(GOOD)


refuse_sweep = partial(refusal, "sweep", "good.toml")


def plan():
    sweep = read_sweep("good.toml", [VARY[1], VARY[3]], FIGURES[1])
    return sweep, Progress("variants", sweep.variants, shown=False)


def test_a_folder_holds_what_one_file_does():
    assert run_here("sweep", "good.toml", *ASKED, "-j", "3", "-o", "out/") == (0, "", "")
    assert run_here("sweep", "good.toml", *ASKED, "-o", "one.parquet")[0] == 0
    assert len(os.listdir("out")) > 5
    assert dataset.dataset("out").to_table().equals(parquet.read_table("one.parquet"))
    whole = parquet.read_schema("one.parquet")
    assert dataset.dataset("out").schema.equals(whole, check_metadata=True)
    assert sorted(os.listdir()) == ["good.toml", "one.parquet", "out"]


def test_workers_of_a_cluster_write_the_same_files():
    distributed = pytest.importorskip("distributed")
    from balcli.studies.sweep_write import run_on_cluster

    sweep, progress = plan()
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=False, dashboard_address=None) as local,
        distributed.Client(local) as client,
    ):
        write_blocks(sweep, Path("there"), partial(run_on_cluster, client), progress, force=False)
    run_here("sweep", "good.toml", *ASKED, "-o", "here/")
    assert sorted(os.listdir("there")) == sorted(os.listdir("here"))
    for name in os.listdir("here"):
        assert Path("there", name).read_bytes() == Path("here", name).read_bytes()


def test_the_same_sweep_goes_on_where_it_was_stopped():
    """Blocks that are there stay; notes of others as well."""
    sweep, progress = plan()

    def stop_after_two(work, blocks):
        for count, done in enumerate(map(work, blocks), 1):
            yield done
            if count == 2:
                raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_blocks(sweep, Path("out"), stop_after_two, progress, force=False)
    assert progress.done == dataset.dataset("out").count_rows() == 60
    assert sorted(os.listdir("out")) == [MANIFEST, "part-000000.parquet", "part-000001.parquet"]
    assert json.loads(Path("out", MANIFEST).read_text())["variants"] == sweep.variants
    first = os.stat("out/part-000000.parquet").st_ino
    Path("out/notes.txt").write_text("mine")
    assert run_here("sweep", "good.toml", *ASKED, "-o", "out/")[0] == 0
    assert os.stat("out/part-000000.parquet").st_ino == first
    assert Path("out/notes.txt").read_text() == "mine"
    os.remove("out/notes.txt")
    assert run_here("sweep", "good.toml", *ASKED, "-o", "one.parquet")[0] == 0
    assert dataset.dataset("out").to_table().equals(parquet.read_table("one.parquet"))


@pytest.mark.parametrize("other", ["engine", "values", "quantities"])
def test_another_sweep_is_replaced_by_force_alone(other):
    assert run_here("sweep", "good.toml", *ASKED, "-o", "out/")[0] == 0
    asked = {"values": (*FEW[:2], *FIGURES), "quantities": (*VARY, *FEW[2:])}.get(other, ASKED)
    Path("out/.part-000003.parquet.0123456789ab").write_text("of a run that was killed")
    before = sorted(os.listdir("out"))
    if other == "engine":
        Path("good.toml").write_text(GOOD.replace("mass = 0.5", "mass = 0.51"))
    told = "out/: holds another sweep; choose another folder, or --force to replace it"
    assert refuse_sweep(*asked, "-o", "out/") == told
    assert sorted(os.listdir("out")) == before
    assert run_here("sweep", "good.toml", *asked, "-o", "out/", "--force")[0] == 0
    assert run_here("sweep", "good.toml", *asked, "-o", "one.parquet")[0] == 0
    assert dataset.dataset("out").to_table().equals(parquet.read_table("one.parquet"))


@pytest.mark.parametrize("name", ["notes.txt", "part-000000.parquet"])
def test_a_folder_of_somebody_else_is_refused(name):
    os.mkdir("out")
    Path("out", name).write_text("mine")
    for force in ((), ("--force",)):
        assert refuse_sweep(*ASKED, "-o", "out/", *force) == (
            f"out/: holds {name}, which is not part of a sweep; choose an empty or new folder"
        )
    assert Path("out", name).read_text() == "mine"
    os.remove(f"out/{name}")
    assert run_here("sweep", "good.toml", *ASKED, "-o", "out/")[0] == 0
    Path("file").write_text("mine")
    assert refuse_sweep(*ASKED, "-o", "file/") == "file/: is a file; choose another name for the folder"


def test_what_does_not_go_into_a_folder_is_refused():
    assert refuse_sweep(*ASKED, "-o", "out/", "-f", "csv") == (
        "--output out/: a folder takes Parquet files, but --format is csv; leave one of them out"
    )
    assert refuse_sweep(*ASKED, "-o", "out/", "--plot", "a.svg") == (
        "--plot a.svg: variants in a folder are not kept for a picture; write one file, or leave --plot out"
    )
    assert refuse_sweep(*ASKED, "-o", "nowhere/out/") == "nowhere/out: cannot be written (there is no folder nowhere)"
    assert run_here("sweep", "good.toml", *ASKED, "-o", "out/", "-f", "parquet")[0] == 0


def test_a_folder_that_cannot_be_written_is_named(monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("balcli.studies.sweep_write.write_sweep_parquet", full)
    assert "No space left on device" in refuse_sweep(*ASKED, "-o", "out/")
