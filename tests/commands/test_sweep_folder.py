"""Sweeps written into folders: the same variants as in one file, and whole or not there."""

from __future__ import annotations

import os
import sys
from contextlib import nullcontext
from functools import partial
from pathlib import Path

import pytest
from support.commands import refusal, run_here
from support.engines import GOOD, changed

from balcli.commands.progress import Progress
from balcli.commands.sweep_folder import write_parts
from balcli.files import discard
from balcli.studies.sweep import read_sweep
from balcli.studies.threads import share_work

dataset = pytest.importorskip("pyarrow.dataset")
parquet = pytest.importorskip("pyarrow.parquet")

unix = pytest.mark.skipif(sys.platform == "win32", reason="symbolic links")
VARY = ("--vary", "rod.ratio=0.2:0.299:0.001", "--vary", "piston.mass=0.4,0.5,0.6")
FIGURES = ("-q", "force.2.major,force.1.axis")
ASKED = (*VARY, *FIGURES)
# Between the corners of this grid the crank would turn back: a mistake in a later part.
RIPPLE = "[[operation.speed_ripple]]\norder = 1\namplitude = 0.6\n"
RIPPLE += "[[operation.speed_ripple]]\norder = 2\namplitude = 0.5\n"
TURN_BACK = ("--vary", "operation.speed_ripple.2.angle=0:360:1", "-q", "force.1.major")


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    """A folder with an engine file, and parts of 30 variants in boxes of 10."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("balcli.studies.sweep.CHUNK", 10)
    monkeypatch.setattr("balcli.studies.sweep.PRODUCTS", 1)
    monkeypatch.setattr("balcli.studies.boxes.JOINED", 10)
    monkeypatch.setattr("balcli.commands.sweep_folder.ROWS_A_PART", 30)
    Path("good.toml").write_text(GOOD)


refuse_sweep = partial(refusal, "sweep", "good.toml")


@pytest.mark.parametrize("jobs", [(), ("-j", "1"), ("-j", "3")])
def test_a_folder_holds_what_one_file_does(jobs, monkeypatch):
    monkeypatch.setattr("balcli.studies.threads.share_work.__defaults__", (0.0,))
    assert run_here("sweep", "good.toml", *ASKED, *jobs, "-o", "out/") == (0, "", "")
    assert run_here("sweep", "good.toml", *ASKED, "-o", "one.parquet")[0] == 0
    assert len(os.listdir("out")) > 5
    assert dataset.dataset("out").to_table().equals(parquet.read_table("one.parquet"))
    whole = parquet.read_schema("one.parquet")
    assert dataset.dataset("out").schema.equals(whole, check_metadata=True)
    assert sorted(os.listdir()) == ["good.toml", "one.parquet", "out"]


def test_workers_of_a_cluster_write_the_same_files():
    distributed = pytest.importorskip("distributed")
    from balcli.studies.dask_cluster import run_on_cluster

    sweep = read_sweep("good.toml", [VARY[1], VARY[3]], FIGURES[1])
    progress = Progress("variants", sweep.variants, at_once=False, shown=False)
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=False, dashboard_address=None) as local,
        distributed.Client(local) as client,
    ):
        share = nullcontext(partial(run_on_cluster, client))
        assert write_parts(sweep, Path("there"), share, progress, force=False) == ""
    run_here("sweep", "good.toml", *ASKED, "-o", "here/")
    assert sorted(os.listdir("there")) == sorted(os.listdir("here"))
    for name in os.listdir("here"):
        assert Path("there", name).read_bytes() == Path("here", name).read_bytes()


def test_an_earlier_sweep_is_replaced_by_force_alone_and_whole():
    assert run_here("sweep", "good.toml", *ASKED, "-o", "out/")[0] == 0
    before = sorted(os.listdir("out"))
    few = ("--vary", "rod.ratio=0.2,0.3", "-q", "force.2.major")
    assert refuse_sweep(*few, "-o", "out/") == (
        "out/: holds an earlier sweep; choose another folder, or --force to replace it"
    )
    assert sorted(os.listdir("out")) == before
    assert run_here("sweep", "good.toml", *few, "-o", "out/", "--force")[0] == 0
    assert os.listdir("out") == ["part-000000.parquet"]
    assert dataset.dataset("out").to_table()["rod.ratio"].to_pylist() == [0.2, 0.3]
    assert sorted(os.listdir()) == ["good.toml", "out"]


def test_an_empty_folder_is_taken_and_another_mans_is_not():
    os.mkdir("out")
    assert run_here("sweep", "good.toml", *ASKED, "-o", "out/")[0] == 0
    Path("out/notes.txt").write_text("mine")
    for force in ((), ("--force",)):
        assert refuse_sweep(*ASKED, "-o", "out/", *force) == (
            "out/: holds notes.txt, which is no part of a sweep; choose a folder that is empty or not there"
        )
    assert refuse_sweep(*ASKED, "-o", "good.toml/").endswith("choose another name")
    Path("file").write_text("mine")
    assert refuse_sweep(*ASKED, "-o", "file/") == ("file/: is a file; choose another name for the folder")


def test_what_does_not_go_into_a_folder_is_refused():
    assert refuse_sweep(*ASKED, "-o", "out/", "-f", "csv") == (
        "--output out/: a folder takes Parquet files, but --format says csv; leave one of them out"
    )
    assert refuse_sweep(*ASKED, "-o", "out/", "--plot", "a.svg") == (
        "--plot a.svg: figures that go into a folder are not kept for a picture; write one file, or leave --plot out"
    )
    assert refuse_sweep(*ASKED, "-o", "nowhere/out/") == ("nowhere/out: cannot be written (there is no folder nowhere)")
    assert run_here("sweep", "good.toml", *ASKED, "-o", "out/", "-f", "parquet")[0] == 0


def test_a_sweep_that_fails_leaves_nothing():
    Path("good.toml").write_text(changed(more=RIPPLE))
    assert "the crank would" in refuse_sweep(*TURN_BACK, "-o", "out/")
    assert os.listdir() == ["good.toml"]


def test_what_a_lost_worker_has_not_finished_is_not_kept():
    """One that began the first part, and did not say that it is written."""
    sweep = read_sweep("good.toml", [VARY[1], VARY[3]], FIGURES[1])
    progress = Progress("variants", sweep.variants, at_once=False, shown=False)

    def share(work, tasks):
        (folder, _) = work.args
        (folder / ".part-000000.parquet.half").write_text("half")
        return share_work(work, tasks, 1)

    assert write_parts(sweep, Path("out"), nullcontext(share), progress, force=False) == ""
    assert dataset.dataset("out").count_rows() == sweep.variants
    assert not [name for name in os.listdir("out") if not name.startswith("part-")]


def test_what_is_written_until_ctrl_c_is_whole():
    """Of a sweep that is stopped after its second part."""
    sweep = read_sweep("good.toml", [VARY[1], VARY[3]], FIGURES[1])
    progress = Progress("variants", sweep.variants, at_once=False, shown=False)

    def share(work, tasks):
        for count, done in enumerate(share_work(work, tasks, 3, alone_s=0.0), 1):
            progress.stopped = count == 2
            yield done

    place = write_parts(sweep, Path("out"), nullcontext(share), progress, force=False)
    assert place == "they are in out.part/"
    assert sorted(os.listdir("out.part")) == ["part-000000.parquet", "part-000001.parquet"]
    assert dataset.dataset("out.part").count_rows() == progress.done < sweep.variants
    assert sorted(os.listdir()) == ["good.toml", "out.part"]


@pytest.mark.parametrize("what", ["notes", "file", pytest.param("link", marks=unix)])
def test_ctrl_c_spares_what_stands_where_the_part_would_go(what):
    """After hours there is nobody to choose another name."""
    part = Path("out.part")
    match what:
        case "notes":
            part.mkdir()
            (part / "notes.txt").write_text("mine")
        case "file":
            part.write_text("mine")
        case _:
            os.mkdir("elsewhere")
            part.symlink_to("elsewhere")
    before = part.lstat().st_ino, part.is_symlink()
    sweep = read_sweep("good.toml", [VARY[1], VARY[3]], FIGURES[1])
    for _ in range(2):  # an earlier part makes way
        progress = Progress("variants", sweep.variants, at_once=False, shown=False)
        progress.stopped = True
        share = nullcontext(partial(share_work, threads=1))
        place = write_parts(sweep, Path("out"), share, progress, force=False)
        assert place == "they are in out.part2/"
    assert os.listdir("out.part2") == ["part-000000.parquet"]
    assert (part.lstat().st_ino, part.is_symlink()) == before
    assert what != "notes" or os.listdir(part) == ["notes.txt"]
    assert [name for name in sorted(os.listdir()) if name.startswith(".")] == []


def test_a_folder_that_cannot_be_written_is_named(monkeypatch):
    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("balcli.commands.sweep_folder.write_sweep_parquet", full)
    assert refuse_sweep(*ASKED, "-o", "out/") == "out/: cannot be written (No space left on device)"
    assert os.listdir() == ["good.toml"]


def test_an_earlier_sweep_stays_where_the_new_one_cannot_take_its_place(monkeypatch):
    assert run_here("sweep", "good.toml", *ASKED, "-o", "out/")[0] == 0
    before, rename = sorted(os.listdir("out")), Path.rename
    renamed: list[Path] = []

    def busy(path, target):
        renamed.append(path)
        if len(renamed) == 2:  # after the earlier one has made way
            raise OSError(16, "Device or resource busy")
        return rename(path, target)

    monkeypatch.setattr(Path, "rename", busy)
    few = ("--vary", "rod.ratio=0.2,0.3", "-q", "force.2.major")
    assert refuse_sweep(*few, "-o", "out/", "--force") == ("out/: cannot be written (Device or resource busy)")
    assert sorted(os.listdir("out")) == before
    assert sorted(os.listdir()) == ["good.toml", "out"]


def test_what_is_unfinished_is_discarded_with_its_files():
    os.mkdir("folder")
    Path("folder/part").write_text("half")
    Path("file").write_text("half")
    for name in ("folder", "file", "never made"):
        discard(Path(name))
    assert os.listdir() == ["good.toml"]


def test_force_without_a_folder_is_told_to_count_for_nothing():
    told = run_here("sweep", "good.toml", *ASKED, "--force")
    assert (told.status, told.err) == (
        0,
        "warning: --force is for a folder of parts (-o variants/); a file is replaced without it\n",
    )
